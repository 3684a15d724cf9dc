// One vertex of every live light path: the segment from the vertex before, for display.
#include "shaders/shared/emission.h"
#include "transport/light_vertex.glsl"
#include "lib/emission.glsl"
#include "shaders/shared/overlay.h"

layout(scalar) buffer LightPathCounts { uint light_path_counts[]; };
layout(scalar) readonly buffer LightPathsBlock { LightPathsView view; };
layout(scalar) writeonly buffer OverlaySegments { OverlaySegment segments[]; };

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  uint slot = push.use_queue != 0u ? queue[index] : index;
  Ray ray = load_ray(slot);
  Hit hit = load_hit(slot);
  PathState path = load_path(slot);
  if (path.pixel == 0xffffffffu) return;
  uint depth = path_depth(path), events = depth - 1u + path.nulls;
  Sampler random = make_light_sampler(path.pixel, path.sample_index, frame.seed);
#if LUCERNA_LIGHTS
  if (view.light != k_all_lights && sample_emission(random, view.step).light != view.light) return;
#endif
  bool missed = hit.prim == k_no_hit;
  // A ray that leaves the scene is drawn for a tenth of the radius; one from a distant light from two radii before its hit.
  float length = missed ? 0.1 * view.radius : hit.t;
  float begin = depth == 1u ? max(0.0, length - 2.0 * view.radius) : 0.0;
  vec3 light = sqrt(path.throughput / max(max3(path.throughput), 1e-37));  // encoded
  if (events < k_drawn_events) {
    OverlaySegment s;
    s.from = ray.origin + begin * ray.direction;
    s.to = ray.origin + length * ray.direction;
    s.half_width = depth == 1u ? 0.5 : 0.8;
    s.edge_width = 0.0;
    s.color = light;
    // Segments before the first vertex are faint; those after it are prominent.
    s.alpha = missed ? 0.15 : depth == 1u ? 0.3 : 0.85;
    s.strength = 1.0;
    s.slack = 0.0;
    s.rank = depth == 1u ? k_rank_low : k_rank_least + min(depth - 1u, k_rank_most - k_rank_least);
    segments[path.pixel * k_drawn_events + events] = s;
  }
  if (missed) return;
  LightVertex v = light_vertex(path, ray, hit, random);
  light_continue(slot, v, path, ray, path.travelled + hit.t, min(frame.max_depth, k_most_light_events) - 1u, random);
}
