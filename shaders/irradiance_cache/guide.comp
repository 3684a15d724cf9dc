// Guide tables of crowded records: the luminance of the last level's rays over the cells of guide.glsl, stored in place of
// irradiance. Each cell shares some light with its neighbours, because rays next to each other meet similar things. One
// invocation a record.
#define LUCERNA_PUSH RecordPush
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/wavefront.glsl"
#include "irradiance_cache/hemisphere.glsl"

layout(scalar) writeonly buffer Irradiance { vec4 irradiance[]; };

float ray_luminance(uint slot) {
  float sum = 0.0;
  for (uint p = 0u; p < k_part_count; ++p)
    if ((push.parts >> p & 1u) != 0u) sum += luminance(texelFetch(radiance_texels, int(radiance_texel(slot, lane_of(0u, p)))).rgb);
  return sum;
}

float cells[k_guide_azimuths * k_guide_elevations];

// Over three cells in elevation; two at the lowest and the highest.
float along_elevation(uint azimuth, uint elevation) {
  uint at = azimuth * k_guide_elevations + elevation;
  float below = cells[elevation > 0u ? at - 1u : at], above = cells[elevation + 1u < k_guide_elevations ? at + 1u : at];
  return 0.25 * below + 0.5 * cells[at] + 0.25 * above;
}
float blurred(uint azimuth, uint elevation) {
  uint before = (azimuth + k_guide_azimuths - 1u) % k_guide_azimuths, after = (azimuth + 1u) % k_guide_azimuths;
  return 0.25 * along_elevation(before, elevation) + 0.5 * along_elevation(azimuth, elevation) + 0.25 * along_elevation(after, elevation);
}

void main() {
  uint index = global_index();
  if (index >= push.records) return;
  uint record = record_list[push.first + index];
  uint flags = floatBitsToUint(texelFetch(record_texels, int(record * k_record_texels + 2u)).w);
  if ((flags & k_record_crowded) == 0u) return;

  uint m = push.elevations, n = push.azimuths;
  for (uint c = 0u; c < k_guide_azimuths * k_guide_elevations; ++c) cells[c] = 0.0;
  for (uint k = 0u; k < max(n, k_guide_azimuths); ++k)
    for (uint j = 0u; j < max(m, k_guide_elevations); ++j) {
      // The larger of both counts, so that every ray and every cell is visited.
      uint steps_k = max(n, k_guide_azimuths), steps_j = max(m, k_guide_elevations);
      float l = ray_luminance(cell_slot(j * m / steps_j, k * n / steps_k, index));
      cells[k * k_guide_azimuths / steps_k * k_guide_elevations + j * k_guide_elevations / steps_j] += is_finite(vec3(l)) ? l : 0.0;
    }
  float most = 0.0;
  for (uint c = 0u; c < k_guide_azimuths * k_guide_elevations; ++c) most = max(most, blurred(c / k_guide_elevations, c % k_guide_elevations));
  float scale = most > 0.0 ? float(k_guide_most) / most : 0.0;
  for (uint t = 0u; t < k_guide_texels; ++t) {
    uvec4 words = uvec4(0u);
    for (uint b = 0u; b < 16u; ++b) {
      uint cell = 16u * t + b;
      uint value = uint(blurred(cell / k_guide_elevations, cell % k_guide_elevations) * scale + 0.5);
      words[b >> 2u] |= min(value, k_guide_most) << 8u * (b & 3u);
    }
    irradiance[record * k_part_count * k_part_texels + t] = uintBitsToFloat(words);
  }
}
