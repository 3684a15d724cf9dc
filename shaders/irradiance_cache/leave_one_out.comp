// Leave-one-out residual of every record: what the other records predict at its place, minus its own value. Beyond noise
// this is the interpolation error there, with its sign. (D. M. Allen, "The relationship between variable selection and data
// augmentation and a method for prediction", 1974.) One invocation a record.
//
// Gradient extrapolation misses the second derivatives, so the error grows with the square of the distance q = 1 - w, w
// being the weight. The residual is divided by the weighted mean of q^2 over the other records, which scales it to q = 1,
// the border of validity; propagate_errors.comp scales it back. The residual is a linear combination of record values, so
// record errors are propagated through it lane by lane; this estimates the noise that remains after averaging over a region.
#include "irradiance_cache/reading.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PoolPush push; };
layout(scalar) writeonly buffer Residuals { vec4 residuals[]; };

// If the other records are nearer than this (a third of the reach), they contain little information about the border.
const float k_least_square = 0.1;

// Luminance that a record predicts at a point with normal `n`, extrapolated by its gradients.
float extrapolated(uint record, vec3 facing, vec3 away, vec3 n) {
  Extrapolation by = extrapolation(facing, away, n);
  float light = 0.0;
  for (uint p = 0u; p < k_part_count; ++p) light += luminance(record_part(record, p, by));
  return light;
}

void main() {
  uint record = push.first + global_index();
  if (record >= push.first + push.count) return;
  vec3 x = texelFetch(record_texels, int(record * k_record_texels)).xyz;
  vec3 n = texelFetch(record_texels, int(record * k_record_texels + 1u)).xyz;
  float light = record_crowded(record) ? 0.0 : record_luminance(record);
  vec4 noise[k_lookup_lanes / 4u];
  for (uint g = 0u; g < k_lookup_lanes / 4u; ++g) noise[g] = vec4(0.0);
  float others = 0.0, weights = 0.0, squares = 0.0;
  OctreeRange range = cache_range(x, light > 0.0);
  for (uint i = range.first; i < range.last; ++i) {
    uint other = octree_sphere(i);
    float weight = other == record ? 0.0 : read_weight(x, n, record_media(record), i);
    vec3 facing = texelFetch(record_texels, int(other * k_record_texels + 1u)).xyz;
    others += weight > 0.0 ? weight * extrapolated(other, facing, x - octree_copy(i).xyz, n) : 0.0;
    weights += weight;
    squares += weight * square(1.0 - weight);
    for (uint g = 0u; g < k_lookup_lanes / 4u; ++g) noise[g] += weight * record_errors(other, g);
  }
  bool estimated = weights > 0.0;
  float at_border = 1.0 / max(squares / max(weights, 1e-30), k_least_square);
  int at = int(record * k_residual_texels);
  residuals[at] = vec4(estimated ? at_border * (others / weights / light - 1.0) : 0.0, 0.0, 0.0, 0.0);
  for (uint g = 0u; g < k_lookup_lanes / 4u; ++g)
    residuals[at + 1 + int(g)] = estimated ? at_border * (noise[g] / weights - record_errors(record, g)) / light : vec4(0.0);
}
