// Mixes fit and samples: the fit's share is as large as the other half of the film does not contradict.
#include "lib/invocation.glsl"
#include "film/filter/filter.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilterPush push; };
uniform samplerBuffer filter_before, filter_fitted, filter_judged;
layout(scalar) writeonly buffer FilterChosen { vec4 chosen[]; };

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  ivec2 size = ivec2(push.width, push.height), xy = ivec2(pixel % push.width, pixel / push.width);
  float against = 0.0, variance = 0.0, all = 0.0;
  for (int y = -k_filter_judged_reach; y <= k_filter_judged_reach; ++y) {
    float w = filter_judged_weight(y);
    vec3 row = texelFetch(filter_judged, clamp(xy.y + y, 0, size.y - 1) * size.x + xy.x).xyz;
    against += w * row.x;
    variance += w * w * row.y;
    all += w * row.z;
  }
  // The expected value of `all` is bias^2 + noise^2 of a half, that of -`against` is bias^2. Both halves have the bias, but
  // their mean has half of noise^2: the best share of the fit is (noise^2 / 2) / (bias^2 + noise^2 / 2).
  float bias = clamp(-against - k_filter_doubt * sqrt(variance), 0.0, all);
  float share = all > 0.0 ? (all - bias) / (all + bias) : 0.0;
  FilterLight f = filter_light(texelFetch(filter_fitted, int(pixel))), b = filter_light(texelFetch(filter_before, int(pixel)));
  // The residual beside the fit is noise where it exceeds the residual of the other half.
  vec3 even = b.even - f.even, odd = b.odd - f.odd;
  float e = length(even), o = length(odd);
  even *= e > 0.0 ? min(1.0, k_filter_confirmed * o / e) : 0.0;
  odd *= o > 0.0 ? min(1.0, k_filter_confirmed * e / o) : 0.0;
  chosen[pixel] = filter_texel(FilterLight(f.even + (1.0 - share) * even, f.odd + (1.0 - share) * odd, 0.0, b.in_both));
}
