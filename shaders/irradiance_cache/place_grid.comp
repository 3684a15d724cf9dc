// Cell size for sorting candidates: a power of two, so that scaling is exact and equal on every device. One invocation.
#include "irradiance_cache/placement.glsl"
uniform samplerBuffer run_bound_texels;

void main() {
  if (global_index() > 0u) return;
  vec3 low = vec3(3.4e38), high = vec3(-3.4e38);
  for (int i = 0; i < int(k_bounds_runs); ++i) {
    low = min(low, texelFetch(run_bound_texels, 2 * i).xyz);
    high = max(high, texelFetch(run_bound_texels, 2 * i + 1).xyz);
  }
  vec3 extent = high - low;
  int exponent = exponent_of(max(max(extent.x, extent.y), max(extent.z, 1e-20))) + 1 - int(k_morton_bits);
  grid.origin = low;
  grid.scale = uintBitsToFloat(uint(127 - exponent) << 23);
  grid.exponent = exponent;
}
