// Lays the marks of places that are being chosen (placement.comp) over the picture, which is dimmed so that they stand out
// on any ground.
#include "lib/invocation.glsl"
#include "lib/math.glsl"
layout(local_size_x = 64) in;
#include "shaders/shared/ramp.h"
#include "shaders/shared/cache_placement.h"
layout(push_constant, scalar) uniform Push { PlacementPush push; };
layout(scalar) readonly buffer Places { PlacedPoint places[]; };
layout(scalar) readonly buffer Marks { uint marks[]; };
layout(scalar) buffer Picture { uint picture[]; };

const float k_dim = 0.6, k_grey = 0.6;

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  uint packed = picture[pixel];
  vec3 color = vec3(packed & 0xffu, packed >> 8 & 0xffu, packed >> 16 & 0xffu) / 255.0;
  color = k_dim * mix(color, vec3(dot(color, vec3(0.2126, 0.7152, 0.0722))), k_grey);
  uint mark = marks[pixel];
  if (mark != 0u) {
    uint rank = mark >> k_mark_rank_shift;
    float cover = float(mark >> k_mark_cover_shift & 0x7fu) / 127.0;
    uint bits = places[k_mark_point - (mark & k_mark_point)].bits;
    vec3 ink = vec3(0.0);
    float alpha = 0.55;
    if (rank == k_rank_candidate) {
      uint cluster = bits >> k_placed_cluster_shift;
      bool by_cluster = push.by_cluster != 0u && cluster > 0u;
      ink = by_cluster ? placed_cluster_ink(cluster - 1u) : ramp_hue(bits >> k_placed_origin_shift & 3u);
      alpha = by_cluster ? 0.75 : 0.8;
    } else if (rank == k_rank_rejected) {
      ink = k_rejected_ink, alpha = 0.7;
    } else if (rank == k_rank_faint_ring) {
      ink = k_tried_ink, alpha = 1.0;
    } else if (rank == k_rank_tried) {
      ink = k_tried_ink, alpha = 1.0;
    } else if (rank != k_rank_edge) {
      ink = k_chosen_ink, alpha = rank == k_rank_ring ? 0.85 : 1.0;
    }
    color = mix(color, ink, alpha * cover);
  }
  uvec3 bytes = uvec3(clamp(color, vec3(0.0), vec3(1.0)) * 255.0 + 0.5);
  picture[pixel] = bytes.x | bytes.y << 8 | bytes.z << 16 | 0xff000000u;
}
