// Second derivatives of a record's irradiance along its surface, occlusion included: J. Schwarzhaupt, H. W. Jensen and
// W. Jarosz, "Practical Hessian-Based Error Control for Irradiance Caching", 2012. One invocation a record.
//
// The ray hits form a mesh: two triangles for each four neighbouring cells, a fan around the normal, and a strip down to the
// horizon that repeats the lowest rays. Seen from the record the mesh does not occlude itself, so irradiance is a sum of
// form factors, and its derivatives are sums of theirs (form_factor.glsl). A triangle has the radiance of its farthest
// vertex: where it joins two surfaces, this is the radiance that becomes visible or hidden behind the nearer one. The mean
// radiance is subtracted first, which reduces rounding errors; for a closed mesh it changes nothing else.
//
// Output: Hessian of the luminance of all parts together, and that luminance (k_record_texels, texel 4).
#define LUCERNA_PUSH RecordPush
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/wavefront.glsl"
#include "irradiance_cache/hemisphere.glsl"
#include "irradiance_cache/form_factor.glsl"

uniform samplerBuffer first_hit_texels;
layout(scalar) writeonly buffer Records { vec4 records[]; };

struct Vertex {
  vec3 direction;  // in the frame of tangent, bitangent and normal
  float near;      // inverse distance [1/m]
  float light;     // luminance
};

float part_luminance(uint slot, uint part) {
  return (push.parts >> part & 1u) != 0u ? luminance(texelFetch(radiance_texels, int(radiance_texel(slot, lane_of(0u, part)))).rgb)
                                         : 0.0;
}
// Unrolled: iterations of loops are counted (Evaluator::k_most_rays).
float cell_luminance(uint slot) {
  return part_luminance(slot, 0u) + part_luminance(slot, 1u) + part_luminance(slot, 2u) + part_luminance(slot, 3u);
}
// Bounded so that its square is finite.
float cell_near(uint slot) { return min(inverse_distance(texelFetch(first_hit_texels, int(slot))), 1e9); }

vec3 cell_direction(uint j, uint k, uint record) {
  CellRay r = cell_ray(j, k, record);
  return vec3(r.sine * cos(r.phi), r.sine * sin(r.phi), r.cosine);
}

float furthest(Vertex a, Vertex b, Vertex c) {
  return a.near <= min(b.near, c.near) ? a.light : b.near <= c.near ? b.light : c.light;
}

void main() {
  uint index = global_index();
  if (index >= push.records) return;
  uint record = record_list[push.first + index];
  uint m = push.elevations, n = push.azimuths;

  float mean = 0.0;
  Vertex pole = Vertex(vec3(0.0, 0.0, 1.0), 0.0, 0.0);
  for (uint k = 0u; k < n; ++k) {
    uint highest = cell_slot(0u, k, index);
    pole.near += cell_near(highest) / float(n);
    pole.light += cell_luminance(highest) / float(n);
    for (uint j = 0u; j < m; ++j) mean += cell_luminance(cell_slot(j, k, index));
  }
  mean /= float(m * n);
  pole.light -= mean;

  vec3 hessian = vec3(0.0);
  for (uint k = 0u; k < n; ++k) {
    uint next = k + 1u < n ? k + 1u : 0u;
    // A and B at this azimuth, D and C at the next; A and D are the upper ones.
    Vertex a = pole, d = pole, b = pole, c = pole;
    vec3 da = vec3(0.0);
    for (uint j = 0u; j <= m; ++j) {
      if (j < m) {
        uint slot = cell_slot(j, k, index), aside = cell_slot(j, next, index);
        b = Vertex(cell_direction(j, k, record), cell_near(slot), cell_luminance(slot) - mean);
        c = Vertex(cell_direction(j, next, record), cell_near(aside), cell_luminance(aside) - mean);
      } else {
        b.direction = vec3(normalize(b.direction.xy), 0.0);
        c.direction = vec3(normalize(c.direction.xy), 0.0);
      }
      vec3 ab = edge_terms(a.direction, a.near, b.direction, b.near).hessian;
      vec3 bc = edge_terms(b.direction, b.near, c.direction, c.near).hessian;
      vec3 cd = edge_terms(c.direction, c.near, d.direction, d.near).hessian;
      vec3 ca = edge_terms(c.direction, c.near, a.direction, a.near).hessian;
      hessian += furthest(a, b, c) * (ab + bc + ca) + furthest(a, c, d) * (cd + da - ca);
      a = b;
      d = c;
      da = -bc;
    }
  }
  records[record * k_record_texels + 4u] = vec4(hessian, k_pi * mean);
}
