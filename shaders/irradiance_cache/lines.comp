// Draws lines over a rectangle of the picture in their order, and below them the border of one record's disc on the visible
// surface.
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
#include "irradiance_cache/seen.glsl"
#include "overlay/lines.glsl"
#include "shaders/shared/irradiance_cache/inspect.h"
#include "shaders/shared/irradiance_cache/records.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CacheLinesPush push; };
uniform samplerBuffer record_texels;
layout(scalar) buffer Picture { uint picture[]; };

void main() {
  uint index = global_index();
  if (index >= push.across * push.down) return;
  uvec2 xy = uvec2(push.left + index % push.across, push.top + index / push.across);
  uint pixel = xy.y * push.width + xy.x;
  Seen seen = seen_at(pixel, push.width, push.height);
  vec3 color = picture_color(picture[pixel]);
  if (push.ring != k_no_record) {
    vec4 place = texelFetch(record_texels, int(push.ring * k_record_texels));
    vec4 facing = texelFetch(record_texels, int(push.ring * k_record_texels + 1u));
    vec4 shape = texelFetch(record_texels, int(push.ring * k_record_texels + 3u));
    float away = abs(pixels_beyond(seen, pixel_steps(seen, push.width, push.height), place, shape) + 0.5);
    if (seen.solid && seen_on_plane(seen, place, facing, shape)) {
      color = mix(color, vec3(0.0), 0.6 * clamp(2.5 - away, 0.0, 1.0));
      color = mix(color, vec3(1.0), clamp(1.5 - away, 0.0, 1.0));
    }
  }
  picture[pixel] = picture_packed(lay_lines(color, vec2(xy) + 0.5, seen, push.lines));
}
