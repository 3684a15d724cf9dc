// Evidence of each pixel for or against a fit, by the other half of the film. Sums rows; choose.comp sums columns.
#include "lib/invocation.glsl"
#include "film/filter/filter.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilterPush push; };
uniform samplerBuffer filter_lights, filter_before, filter_fitted;
layout(scalar) writeonly buffer FilterJudged { vec4 judged[]; };

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  ivec2 size = ivec2(push.width, push.height), xy = ivec2(pixel % push.width, pixel / push.width);
  // With d = fitted - before: d (other half - fitted), of expected value -d (fitted - truth); its variance; d squared.
  vec3 sums = vec3(0.0);
  for (int x = -k_filter_judged_reach; x <= k_filter_judged_reach; ++x) {
    int there = xy.y * size.x + clamp(xy.x + x, 0, size.x - 1);
    FilterLight l = filter_light(texelFetch(filter_lights, there)), f = filter_light(texelFetch(filter_fitted, there)),
                b = filter_light(texelFetch(filter_before, there));
    vec3 even = f.even - b.even, odd = f.odd - b.odd;
    // A pixel counts relative to its light, and less with a larger d, so that no single pixel dominates.
    float light = square(luminance(f.even + f.odd)) + 1e-8;
    vec2 d = vec2(dot(even, even), dot(odd, odd)), scale = 1.0 / (light + k_filter_judged_most * d);
    float t = scale.x * dot(even, l.odd - f.even) + scale.y * dot(odd, l.even - f.odd), w = filter_judged_weight(x);
    // Noise common to both halves that the fit removes is no evidence against the fit.
    t += dot(scale, min(vec2(square(l.in_both)), d));
    // The variance of t is the samples' variance along d: for grey, a third of it. Near bright edges this is too much, and t
    // itself bounds it.
    float variance = min(square(l.deviation) / 3.0 * dot(scale * scale, d), t * t);
    sums += vec3(w * t, w * w * variance, w * dot(scale, d));
  }
  judged[pixel] = vec4(sums, 0.0);
}
