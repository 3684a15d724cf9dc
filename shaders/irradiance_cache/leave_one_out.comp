// Leaves every record out in turn: what the others around would have said of the light at its place, less what it says
// itself. Beyond their noise that is what interpolation is off by there, with its sign. What a record extrapolates with its
// slopes is off by the light's second derivatives, so in proportion to the square of the distance q = 1 - w, w its weight;
// the mean of those squares over the others here, by their weights, says what the residual would be at distance 1, where
// the record ends. That is kept: propagate_errors.comp scales it back. And since the residual is a sum of records' light, their errors
// are propagated through it lane by lane, so that over a region, where most of them cancel, what is left of the noise is known
// too. (Leave-one-out residuals: D. M. Allen, "The relationship between variable selection and data
// augmentation and a method for prediction", 1974.) One invocation a record.
#include "irradiance_cache/reading.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PoolPush push; };
layout(scalar) writeonly buffer Residuals { vec4 residuals[]; };

// Where the others are as near as that (a third of the reach) they tell little of what is further off.
const float k_least_square = 0.1;

// What a record says of the luminance at a point with that normal, by its gradients.
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
  vec4 noise[k_record_lanes / 4u];
  for (uint g = 0u; g < k_record_lanes / 4u; ++g) noise[g] = vec4(0.0);
  float others = 0.0, weights = 0.0, squares = 0.0;
  OctreeRange range = cache_range(x, light > 0.0);
  for (uint i = range.first; i < range.last; ++i) {
    uint other = octree_sphere(i);
    float weight = other == record ? 0.0 : read_weight(x, n, record_media(record), i);
    vec3 facing = texelFetch(record_texels, int(other * k_record_texels + 1u)).xyz;
    others += weight > 0.0 ? weight * extrapolated(other, facing, x - octree_copy(i).xyz, n) : 0.0;
    weights += weight;
    squares += weight * square(1.0 - weight);
    for (uint g = 0u; g < k_record_lanes / 4u; ++g) noise[g] += weight * record_error(other) * record_signs(other, g);
  }
  bool estimated = weights > 0.0;
  float at_border = 1.0 / max(squares / max(weights, 1e-30), k_least_square);
  int at = int(record * k_residual_texels);
  residuals[at] = vec4(estimated ? at_border * (others / weights / light - 1.0) : 0.0, 0.0, 0.0, 0.0);
  for (uint g = 0u; g < k_record_lanes / 4u; ++g)
    residuals[at + 1 + int(g)] = estimated ? at_border * (noise[g] / weights - record_error(record) * record_signs(record, g)) / light : vec4(0.0);
}
