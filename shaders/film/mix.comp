// Picture of all components from the mix of light groups, for immediate display of a changed mix. The film's format
// (LUCERNA_GROUP_SUMS: compact sums) and the tone curve (LUCERNA_TONE_CURVE) are compiled in, because lavapipe executes both
// sides of a branch, and a loop of zero iterations once.
#include "lib/variants.glsl"
#include "film/mix.glsl"
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
#include "shaders/shared/film.h"
#include "shaders/shared/tone.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { MixPush push; };
layout(scalar) writeonly buffer Picture { uint picture[]; };

#if LUCERNA_GROUP_SUMS
layout(scalar) readonly buffer FilmCount { uint film_count[]; };

vec3 mixed_light(uint pixel, uint pixels) {
  vec3 color = vec3(0.0);
  for (uint group = 0u; group < push.groups; ++group) {
    uvec4 sums = texelFetch(group_sums, int(group * pixels + pixel));
    color += light_weight(group) * (group_sum_value(GroupSum(sums.x, sums.y)) + group_sum_value(GroupSum(sums.z, sums.w)));
  }
  return color / float(max(film_count[pixel], 1u));
}
#else
uniform samplerBuffer group_lights;

vec3 light_of(uint rg, uint b) { return vec3(unpackHalf2x16(rg), unpackHalf2x16(b).x); }
vec3 mixed_light(uint pixel, uint pixels) {
  vec3 color = vec3(0.0);
  for (uint pair = 0u; pair < (push.groups + 1u) / 2u; ++pair) {
    uvec4 two = floatBitsToUint(texelFetch(group_lights, int(pair * pixels + pixel)));
    color += light_weight(2u * pair) * light_of(two.x, two.y);
    if (2u * pair + 1u < push.groups) color += light_weight(2u * pair + 1u) * light_of(two.z, two.w);
  }
  return color;
}
#endif

void main() {
  uint pixel = global_index(), pixels = push.width * push.height;
  if (pixel >= pixels) return;
  picture[pixel] = picture_packed(tone_map(mixed_light(pixel, pixels) * push.exposure, LUCERNA_TONE_CURVE));
}
