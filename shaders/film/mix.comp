// Groups of lights in short, as they are mixed -> picture: for the moment in which a mix is changed, until the sums of the
// film have followed.
#include "film/mix.glsl"
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
#include "shaders/shared/film.h"
#include "shaders/shared/tone.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { MixPush push; };
layout(scalar) readonly buffer FilmCount { uint film_count[]; };
layout(scalar) writeonly buffer Picture { uint picture[]; };
uniform samplerBuffer group_lights;

vec3 light_of(uint rg, uint b) { return vec3(unpackHalf2x16(rg), unpackHalf2x16(b).x); }

void main() {
  uint pixel = global_index(), pixels = push.width * push.height;
  if (pixel >= pixels) return;
  vec3 color = vec3(0.0);
  // One of the loops runs not at all: a branch saves no work on lavapipe.
  for (uint group = 0u; group < (push.sums != 0u ? push.groups : 0u); ++group) {
    uvec4 sums = texelFetch(group_sums, int(group * pixels + pixel));
    color += light_weight(group) * (group_sum_value(GroupSum(sums.x, sums.y)) + group_sum_value(GroupSum(sums.z, sums.w)));
  }
  color /= push.sums != 0u ? float(max(film_count[pixel], 1u)) : 1.0;
  for (uint pair = 0u; pair < (push.sums != 0u ? 0u : (push.groups + 1u) / 2u); ++pair) {
    uvec4 two = floatBitsToUint(texelFetch(group_lights, int(pair * pixels + pixel)));
    color += light_weight(2u * pair) * light_of(two.x, two.y);
    if (2u * pair + 1u < push.groups) color += light_weight(2u * pair + 1u) * light_of(two.z, two.w);
  }
  picture[pixel] = picture_packed(tone_map(color * push.exposure, push.curve));
}
