// Draws places of records while they are chosen: a dot each, and a ring in its plane with the radius that its record would
// have. One invocation a place.
#include "lib/invocation.glsl"
#include "shaders/shared/irradiance_cache/placement_view.h"
#include "shaders/shared/overlay.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PlacementPush push; };
layout(scalar) readonly buffer Places { PlacedPoint places[]; };
layout(scalar) writeonly buffer OverlayPoints { OverlayPoint points[]; };
layout(scalar) writeonly buffer OverlayDiscs { OverlayDisc discs[]; };

// [pixels]; dots: in units of push.tried_dot.
const float k_rejected_dot = 0.6, k_tried_dot = 0.75, k_edge = 0.7, k_half_ring = 0.4;
const float k_faint = 0.35;  // strength of the rings of places that are only tried

// Drawing order.
const uint k_rank_faint_ring = k_rank_least, k_rank_rejected = k_rank_least + 1u, k_rank_ring = k_rank_least + 2u;
const uint k_rank_tried = k_rank_least + 3u, k_rank_chosen = k_rank_most;

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  PlacedPoint place = places[index];
  uint kind = place.bits & k_placed_mask;
  bool chosen = kind == k_placed_chosen, tried = kind == k_placed_tried;

  OverlayPoint p;
  p.position = place.position;
  p.half_width = push.tried_dot * (chosen ? 1.0 : tried ? k_tried_dot : k_rejected_dot);
  p.edge_width = chosen || tried ? k_edge : 0.0;
  p.color = chosen ? k_chosen_ink : tried ? k_tried_ink : k_rejected_ink;
  p.alpha = chosen || tried ? 1.0 : 0.7;
  p.rank = chosen ? k_rank_chosen : tried ? k_rank_tried : k_rank_rejected;
  if (kind == k_placed_candidate) {
    uint cluster = place.bits >> k_placed_cluster_shift;
    bool by_cluster = push.by_cluster != 0u && cluster > 0u;
    p.half_width = push.dot;
    p.color = by_cluster ? placed_cluster_ink(cluster - 1u) : ramp_hue(place.bits >> k_placed_origin_shift & 3u);
    p.alpha = 0.9;
    p.rank = k_rank_low;
  }
  points[index] = p;
  if (index >= push.rings) return;
  discs[index] = OverlayDisc(place.position, place.radius, place.normal, k_half_ring, chosen ? k_chosen_ink : k_tried_ink,
                             chosen ? 0.6 : 1.0, chosen ? k_edge : 0.0, chosen ? 1.0 : k_faint,
                             chosen ? k_rank_ring : k_rank_faint_ring);
}
