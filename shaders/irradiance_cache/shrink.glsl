// Reduces the reach of records.
#ifndef LUCERNA_IRRADIANCE_CACHE_SHRINK
#define LUCERNA_IRRADIANCE_CACHE_SHRINK
#include "irradiance_cache/least_radius.glsl"

layout(scalar) writeonly buffer Records { vec4 records[]; };
layout(scalar) writeonly buffer Spheres { vec4 spheres[]; };  // bounds in the octree

// Shrinks a record (texels 0 and 3: `place`, `shape`) to `factor` of its reach, but not below the minimum. Scales both radii
// of an ellipse.
void shrink_record(uint record, vec4 place, vec4 shape, float factor) {
  factor = min(1.0, max(factor, least_radius(place.xyz) / shape.w));
  float radius = factor * place.w;
  records[record * k_record_texels].w = radius;
  records[record * k_record_texels + 3u] = vec4(factor > 0.0 ? shape.xyz / factor : vec3(0.0), factor * shape.w);
  spheres[record] = vec4(place.xyz, radius);
}
#endif
