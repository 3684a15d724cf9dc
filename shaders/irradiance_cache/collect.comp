// Appends candidates, in the order of slot_of() or, with LUCERNA_FROM_SCREEN, of the points of the screen-space stage.
#include "lib/variants.glsl"
#include "shaders/shared/irradiance_cache/placement.h"
#include "shaders/shared/irradiance_cache/records.h"
#include "shaders/shared/irradiance_cache/discontinuity.h"
#include "irradiance_cache/collect.glsl"
uniform samplerBuffer candidate_texels;
uniform samplerBuffer surface_texels;
layout(scalar) readonly buffer Taken { uint taken[]; };
layout(scalar) readonly buffer TakenBefore { uint taken_before[]; };
layout(scalar) readonly buffer TakenLevels { uint taken_levels[]; };
layout(scalar) writeonly buffer Places { vec4 places[]; };
layout(scalar) writeonly buffer Facings { vec4 facings[]; };
layout(scalar) writeonly buffer Media { uint media[]; };

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  if (taken[index] == 0u) return;
#if LUCERNA_FROM_SCREEN
  vec4 place = texelFetch(surface_texels, int(index * k_surface_texels));
  vec4 facing = texelFetch(surface_texels, int(index * k_surface_texels + 1u));
  uint origin = k_origin_screen, bits = floatBitsToUint(facing.w), own_media = bits >> k_surface_media_shift;
  facing.w = uintBitsToFloat(bits & ((1u << k_surface_media_shift) - 1u));
  float reach = push.cell * push.pixel * float(1u << min(taken_levels[index], 31u)) * (push.parallel != 0u ? 1.0 : place.w);
#else
  int slot = int(slot_of(index) * k_candidate_texels);
  vec4 place = texelFetch(candidate_texels, slot), facing = texelFetch(candidate_texels, slot + 1);
  uint origin_code = uint(place.w) - 1u, origin = origin_code % k_candidate_media, own_media = origin_code / k_candidate_media;
  float reach = origin == k_origin_recursive ? max(push.spacing, push.spacing_beyond) : push.spacing;
#endif
  float seen = push.parallel != 0u ? 1.0 : distance(place.xyz, push.eye);
  uint to = push.to + taken_before[index];
  places[to] = vec4(place.xyz, max(reach, push.spacing_of_distance * seen));
  media[to] = own_media;
  facings[to] = vec4(facing.xyz, uintBitsToFloat(floatBitsToUint(facing.w) | origin << k_place_origin_shift));
}
