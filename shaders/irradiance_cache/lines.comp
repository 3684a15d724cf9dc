// Draws lines over a rectangle of the picture, in their order, and the border of one record's disc where it lies on what
// the camera sees. Each with a dark edge, so that it shows on any ground.
#include "lib/invocation.glsl"
#include "irradiance_cache/seen.glsl"
#include "shaders/shared/cache_inspect.h"
#include "shaders/shared/irradiance_cache.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CacheLinesPush push; };
uniform samplerBuffer record_texels;
layout(scalar) readonly buffer Lines { CacheLine lines[]; };
layout(scalar) buffer Picture { uint picture[]; };

const float k_edge = 1.0;     // pixels
const float k_hidden = 0.25;  // of the alpha, where a surface is in front

vec4 lay(vec4 under, vec3 ink, float alpha) { return vec4(mix(under.rgb, ink, alpha), 1.0); }

void main() {
  uint index = global_index();
  if (index >= push.across * push.down) return;
  uvec2 xy = uvec2(push.left + index % push.across, push.top + index / push.across);
  uint pixel = xy.y * push.width + xy.x;
  vec2 here = vec2(xy) + 0.5;
  Seen seen = seen_at(pixel, push.width, push.height);
  uint packed = picture[pixel];
  vec4 color = vec4(packed & 0xffu, packed >> 8 & 0xffu, packed >> 16 & 0xffu, 255u) / 255.0;
  if (push.ring != k_no_record) {
    vec4 place = texelFetch(record_texels, int(push.ring * k_record_texels));
    vec4 facing = texelFetch(record_texels, int(push.ring * k_record_texels + 1u));
    vec4 shape = texelFetch(record_texels, int(push.ring * k_record_texels + 3u));
    float away = abs(distance(seen.position, place.xyz) - seen_reach(seen, place, shape) + 0.5 * seen.size) / seen.size;
    if (seen.solid && seen_on_plane(seen, place, facing, shape)) {
      color = lay(color, vec3(0.0), 0.6 * clamp(2.5 - away, 0.0, 1.0));
      color = lay(color, vec3(1.0), clamp(1.5 - away, 0.0, 1.0));
    }
  }
  for (uint i = 0u; i < push.lines; ++i) {
    CacheLine line = lines[i];
    vec2 along = line.to - line.from;
    float t = clamp(dot(here - line.from, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
    float away = distance(here, line.from + t * along);
    float depth = depth_between(line.from_depth, line.to_depth, t);
    // A line between two places of a curved surface runs below it: that is not hidden.
    bool hidden = seen.solid && depth > 1.02 * seen.depth + 4.0 * seen.size;
    float alpha = line.alpha * (hidden ? k_hidden : 1.0);
    color = lay(color, vec3(0.0), 0.6 * alpha * clamp(line.half_width + k_edge + 0.5 - away, 0.0, 1.0));
    color = lay(color, line.color, alpha * clamp(line.half_width + 0.5 - away, 0.0, 1.0));
  }
  uvec3 bytes = uvec3(clamp(color.rgb, vec3(0.0), vec3(1.0)) * 255.0 + 0.5);
  picture[pixel] = bytes.x | bytes.y << 8 | bytes.z << 16 | 0xff000000u;
}
