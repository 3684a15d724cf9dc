// Bounds the ellipse of a record so that no ray hit lies inside, and nothing stands between the record and a point that it
// serves. One invocation a record.
#define LUCERNA_PUSH RecordPush
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/wavefront.glsl"
#include "irradiance_cache/hemisphere.glsl"
#include "irradiance_cache/ellipse.glsl"

uniform samplerBuffer first_hit_texels;
layout(scalar) writeonly buffer Records { vec4 records[]; };

void main() {
  uint index = global_index();
  if (index >= push.records) return;
  uint record = record_list[push.first + index];
  Principal p = principal_curvatures(texelFetch(record_texels, int(record * k_record_texels + 4u)).xyz);
  float squeeze = 1.0 - 1.0 / square(p.ratio), least = k_infinity;
  for (uint k = 0u; k < push.azimuths; ++k)
    for (uint j = 0u; j < push.elevations; ++j) {
      CellRay r = cell_ray(j, k, record);
      float near = inverse_distance(texelFetch(first_hit_texels, int(cell_slot(j, k, index))));
      float reach = sqrt(1.0 - squeeze * square(r.sine * dot(vec2(cos(r.phi), sin(r.phi)), p.along)));
      least = min(least, near > 0.0 ? reach / near : k_infinity);
    }
  records[record * k_record_texels + 5u].y = least;
}
