// Marks the pixels that records' normals go over: short lines from the centres, hidden by what is in front. One invocation a
// record; where several cross, the greatest mark stays, whoever came first. ticks_draw.comp lays the marks over the picture.
#include "lib/invocation.glsl"
#include "irradiance_cache/seen.glsl"
#include "shaders/shared/cache_inspect.h"
#include "shaders/shared/irradiance_cache.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CacheTicksPush push; };
uniform samplerBuffer record_texels;
layout(scalar) buffer Ticks { uint marks[]; };

// Pixels. Normals of small discs, which lie close together, fade out, so that the structure stays readable.
const float k_longest = 13.0, k_half_width = 0.5, k_edge = 1.0;
const float k_least_disc = 4.0, k_full_disc = 12.0;

void main() {
  uint record = global_index();
  if (record >= push.records) return;
  vec4 place = texelFetch(record_texels, int(record * k_record_texels));
  vec4 facing = texelFetch(record_texels, int(record * k_record_texels + 1u));
  vec3 foot = to_picture(place.xyz, push.width, push.height);
  float size = 2.0 * length(frame.camera_up) / float(push.height) * (frame.orthographic != 0u ? 1.0 : foot.z);
  bool shown = foot.z > 0.0 && place.w > k_least_disc * size && all(greaterThan(foot.xy, vec2(-k_longest))) &&
               all(lessThan(foot.xy, vec2(push.width, push.height) + k_longest));
  vec3 tip = to_picture(place.xyz + min(0.6 * place.w, k_longest * size) * facing.xyz, push.width, push.height);
  shown = shown && tip.z > 0.0;
  float strength = clamp((place.w / size - k_least_disc) / (k_full_disc - k_least_disc), 0.0, 1.0);
  vec2 along = tip.xy - foot.xy;
  ivec2 lo = max(ivec2(floor(min(foot.xy, tip.xy) - 2.0)), ivec2(0));
  ivec2 hi = min(ivec2(floor(max(foot.xy, tip.xy) + 2.0)), ivec2(push.width, push.height) - 1);
  int across = hi.x - lo.x + 1, cells = shown ? across * (hi.y - lo.y + 1) : 0;
  cells = across > 0 ? min(cells, 1024) : 0;
  for (int i = 0; i < cells; ++i) {
    ivec2 xy = lo + ivec2(i % across, i / across);
    vec2 here = vec2(xy) + 0.5;
    float t = clamp(dot(here - foot.xy, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
    float away = distance(here, mix(foot.xy, tip.xy, t));
    float core = clamp(k_half_width + 0.5 - away, 0.0, 1.0), edge = clamp(k_half_width + k_edge + 0.5 - away, 0.0, 1.0);
    if (edge <= 0.0) continue;
    uint pixel = uint(xy.y) * push.width + uint(xy.x);
    Seen seen = seen_at(pixel, push.width, push.height);
    if (seen.solid && depth_between(foot.z, tip.z, t) > 1.005 * seen.depth + 2.0 * size) continue;
    // The tick wins over all edges, and among equals the one that covers more.
    bool drawn = core > 0.2;
    uint cover = uint(strength * (drawn ? core : edge) * 127.0 + 0.5);
    atomicMax(marks[pixel], (drawn ? k_tick_core : 0u) | cover << k_tick_cover_shift | (k_tick_record - record));
  }
}
