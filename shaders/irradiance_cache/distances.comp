// Harmonic mean and minimum of the ray distances, for a batch of records. One invocation a record.
#define LUCERNA_PUSH RecordPush
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/wavefront.glsl"
#include "irradiance_cache/hemisphere.glsl"

uniform samplerBuffer first_hit_texels;
layout(scalar) writeonly buffer Records { vec4 records[]; };

void main() {
  uint index = global_index();
  if (index >= push.records) return;
  float sum = 0.0, most = 0.0;
  for (uint j = 0u; j < push.elevations; ++j)
    for (uint k = 0u; k < push.azimuths; ++k) {
      float inverse = inverse_distance(texelFetch(first_hit_texels, int(cell_slot(j, k, index))));
      sum += inverse;
      most = max(most, inverse);
    }
  int at = int(record_list[push.first + index] * k_record_texels);
  records[at + 1].w = sum > 0.0 ? float(push.elevations * push.azimuths) / sum : k_infinity;
  records[at + 2].y = most > 0.0 ? 1.0 / most : k_infinity;
}
