// Bounding boxes of runs of candidates.
#include "irradiance_cache/placement.glsl"
layout(scalar) writeonly buffer RunBounds { vec4 run_bounds[]; };

void main() {
  uint run = global_index();
  if (run >= k_bounds_runs) return;
  vec3 low = vec3(3.4e38), high = vec3(-3.4e38);
  uint length = (push.count + k_bounds_runs - 1u) / k_bounds_runs;
  for (uint i = run * length; i < min((run + 1u) * length, push.count); ++i) {
    vec3 p = texelFetch(place_texels, int(i)).xyz;
    low = min(low, p);
    high = max(high, p);
  }
  run_bounds[2u * run] = vec4(low, 0.0);
  run_bounds[2u * run + 1u] = vec4(high, 0.0);
}
