// Sums the paths of a batch of records in a fixed order: irradiance, gradients, distances and noise. One invocation a
// record.
// For cells (j, k) of M elevations and N azimuths, with radiance L and distance r:
//
//   E        = pi/(MN) sum L
//   grad_r E = pi/(MN) sum_k v_k sum_j T_j (L_jk - mean)           T_j: mean of the tangent over cell j
//   grad_t E = sum_k { u_k 2pi/N sum_{j>0} s_j c_j^2 (L_jk - L_{j-1,k}) / min(r_jk, r_{j-1,k})
//                      + v_k- sum_j (s_{j+1} - s_j) (L_jk - L_{j,k-1}) / min(r_jk, r_{j,k-1}) }
//
// (Ward and Heckbert 1992; Krivanek et al. 2005.) s_j, c_j: sine and cosine at the cell's lower border; u_k towards the
// cell's middle azimuth, v_k a right angle further, v_k- a right angle further than its lower border. The means over a
// cell of the tangent (grad_r) and of cot theta sin theta (grad_t) are exact where the papers take the value at the
// sample, which grows without bound at the horizon and at the pole.
#define LUCERNA_PUSH RecordPush
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/wavefront.glsl"
#include "irradiance_cache/hemisphere.glsl"

uniform samplerBuffer first_hit_texels;
uniform samplerBuffer irradiance_texels;
layout(scalar) writeonly buffer Records { vec4 records[]; };
layout(scalar) writeonly buffer Irradiance { vec4 irradiance[]; };

float inverse_distance(uint slot) { return inverse_distance(texelFetch(first_hit_texels, int(slot))); }
vec3 cell_radiance(uint slot, uint part) { return texelFetch(radiance_texels, int(radiance_texel(slot, lane_of(0u, part)))).rgb; }
float border_sine(uint j) { return sqrt(float(j) / float(push.elevations)); }
// Integral of tan(theta) d(sin^2 theta) up to border j.
float tangent_integral(uint j) {
  float u = float(j) / float(push.elevations);
  return asin(sqrt(u)) - sqrt(u * (1.0 - u));
}

// Bound on the first level's inverse distances in gradients, over the mean of the nonzero ones.
const float k_steepest = 10.0;

// Range of validity of translational gradients, as a fraction of the nearest distance. They describe how the near geometry
// shifts and occludes; beyond this range, along edges, they are noise of the rays that hit that geometry, and made half of
// the records' error there.
const float k_of_nearest = 0.5;

void main() {
  uint index = global_index();
  if (index >= push.records) return;
  uint record = record_list[push.first + index];
  uint m = push.elevations, n = push.azimuths;
  float cells = float(m * n);

  vec3 mean[k_part_count];
  for (uint p = 0u; p < k_part_count; ++p) mean[p] = vec3(0.0);
  float inverse_sum = 0.0, inverse_most = 0.0, hits = 0.0, scatter = 0.0;
  for (uint j = 0u; j < m; ++j) {
    float before = 0.0;
    for (uint k = 0u; k <= n; ++k) {  // one step further than n, for the difference between the last azimuth and the first
      uint slot = cell_slot(j, k == n ? 0u : k, index);
      float counts = k < n ? 1.0 : 0.0, bright = 0.0;
      for (uint p = 0u; p < k_part_count; ++p) {
        if ((push.parts >> p & 1u) == 0u) continue;
        vec3 l = cell_radiance(slot, p);
        bright += luminance(l);
        mean[p] += counts * l;
      }
      scatter += k > 0u ? square(bright - before) : 0.0;
      before = bright;
      float inverse = counts * inverse_distance(slot);
      inverse_sum += inverse;
      hits += inverse > 0.0 ? 1.0 : 0.0;
      inverse_most = max(inverse_most, inverse);
    }
  }
  for (uint p = 0u; p < k_part_count; ++p) mean[p] /= cells;

  // Weighted mean with earlier levels, by ray counts.
  int at = int(record * k_record_texels);
  vec4 place = texelFetch(record_texels, at), facing = texelFetch(record_texels, at + 1), texel = texelFetch(record_texels, at + 2);
  float rays = float(push.rays_before) + cells;
  float now = cells / rays, then = push.rays_before == 0u ? 0.0 : 1.0 - now;
  // The variance within a cell is at most that between neighbouring cells: half the mean squared difference.
  float error = k_pi * sqrt(0.5 * scatter) / cells;
  float inverse = now * inverse_sum / cells + (then > 0.0 ? then / facing.w : 0.0);
  records[at + 1].w = inverse > 0.0 ? 1.0 / inverse : k_infinity;
  float nearest = inverse_most > 0.0 ? 1.0 / inverse_most : k_infinity;
  records[at + 2].x = uintBitsToFloat(push.rays_before + m * n);
  records[at + 2].y = then > 0.0 ? min(texel.y, nearest) : nearest;
  records[at + 2].z = sqrt(square(now * error) + (then > 0.0 ? square(then * texel.z) : 0.0));

  // Geometry nearer than the record's reach changes within the reach, so its slope does not hold over the whole disc;
  // without this bound one ray that hits a crack would tilt the light of the whole record. The first level does not know the
  // reach yet and uses a multiple of the mean inverse distance.
  float steepest = push.rays_before > 0u ? 1.0 / place.w : k_steepest * inverse_sum / max(hits, 1.0);
  for (uint p = 0u; p < k_part_count; ++p) {
    if ((push.parts >> p & 1u) == 0u) continue;
    vec3 rotation_t = vec3(0.0), rotation_b = vec3(0.0), translation_t = vec3(0.0), translation_b = vec3(0.0);
    for (uint k = 0u; k < n; ++k) {
      uint previous = k == 0u ? n - 1u : k - 1u;
      vec3 turn = vec3(0.0), along = vec3(0.0), across = vec3(0.0);
      vec3 below = vec3(0.0);
      float below_inverse = 0.0;
      for (uint j = 0u; j < m; ++j) {
        uint slot = cell_slot(j, k, index), aside = cell_slot(j, previous, index);
        vec3 l = cell_radiance(slot, p), beside = cell_radiance(aside, p);
        float inverse_here = inverse_distance(slot);
        turn += float(m) * (tangent_integral(j + 1u) - tangent_integral(j)) * (l - mean[p]);
        float s = border_sine(j);
        along += s * (1.0 - s * s) * min(max(inverse_here, below_inverse), steepest) * (j > 0u ? l - below : vec3(0.0));
        across += (border_sine(j + 1u) - s) * min(max(inverse_here, inverse_distance(aside)), steepest) * (l - beside);
        below = l;
        below_inverse = inverse_here;
      }
      float low = 2.0 * k_pi * float(k) / float(n), middle = low + k_pi / float(n);
      rotation_t -= sin(middle) * turn;
      rotation_b += cos(middle) * turn;
      translation_t += 2.0 * k_pi / float(n) * cos(middle) * along - sin(low) * across;
      translation_b += 2.0 * k_pi / float(n) * sin(middle) * along + cos(low) * across;
    }
    vec3 e = k_pi * mean[p];
    rotation_t *= k_pi / cells;
    rotation_b *= k_pi / cells;
    int to = int((record * k_part_count + p) * k_part_texels);
    vec4 o0 = texelFetch(irradiance_texels, to), o1 = texelFetch(irradiance_texels, to + 1);
    vec4 o2 = texelFetch(irradiance_texels, to + 2), o3 = texelFetch(irradiance_texels, to + 3);
    bool fresh = then == 0.0;  // old memory is not multiplied by 0: it may hold NaN
    irradiance[to] = now * vec4(e, rotation_t.x) + (fresh ? vec4(0.0) : then * o0);
    irradiance[to + 1] = now * vec4(rotation_t.yz, rotation_b.xy) + (fresh ? vec4(0.0) : then * o1);
    irradiance[to + 2] = now * vec4(rotation_b.z, translation_t) + (fresh ? vec4(0.0) : then * o2);
    vec3 slope_b = now * translation_b + (fresh ? vec3(0.0) : then * o3.xyz);
    irradiance[to + 3] = vec4(slope_b, min(k_of_nearest * (fresh ? nearest : min(texel.y, nearest)), k_record_slope_most));
  }
}
