// How much of what was fitted is taken: as much as the other half of the film does not speak against.
#include "lib/invocation.glsl"
#include "film/filter/filter.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilterPush push; };
uniform samplerBuffer filter_lights, filter_before, filter_fitted;
layout(scalar) writeonly buffer FilterChosen { vec4 chosen[]; };

const int k_reach = 3;

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  ivec2 size = ivec2(push.width, push.height), xy = ivec2(pixel % push.width, pixel / push.width);
  // Of d = fitted - before: d (other half - fitted), in the mean -d (fitted - truth); its square; and of d squared.
  float against = 0.0, spread = 0.0, all = 0.0, count = 0.0, squares = 0.0;
  for (int y = -k_reach; y <= k_reach; ++y)
    for (int x = -k_reach; x <= k_reach; ++x) {
      ivec2 at = clamp(xy + 2 * ivec2(x, y), ivec2(0), size - 1);
      int there = at.y * size.x + at.x;
      FilterLight l = filter_light(texelFetch(filter_lights, there)), f = filter_light(texelFetch(filter_fitted, there)),
                  b = filter_light(texelFetch(filter_before, there));
      vec3 even = f.even - b.even, odd = f.odd - b.odd;
      float w = exp2(-0.1 * float(x * x + y * y));
      float scale = 1.0 / (square(luminance(f.even + f.odd)) + 1e-8);
      float t = scale * (dot(even, l.odd - f.even) + dot(odd, l.even - f.odd));
      against += w * t;
      spread += w * t * t;
      all += w * scale * (dot(even, even) + dot(odd, odd));
      count += w;
      squares += w * w;
    }
  float sigma = sqrt(max(spread / count - square(against / count), 0.0) * squares);
  // In the mean `all` is bias^2 + noise^2 of a half, and -`against` is bias^2. Both halves have the bias, but their mean has
  // half of noise^2: the best share of the fit in it is (noise^2 / 2) / (bias^2 + noise^2 / 2).
  float bias = clamp(-against - k_filter_doubt * sigma, 0.0, all);
  float share = all > 0.0 ? (all - bias) / (all + bias) : 0.0;
  FilterLight f = filter_light(texelFetch(filter_fitted, int(pixel))), b = filter_light(texelFetch(filter_before, int(pixel)));
  // What is left besides the fit is noise as far as it is more than what the other half has left.
  vec3 even = b.even - f.even, odd = b.odd - f.odd;
  float e = length(even), o = length(odd);
  even *= e > 0.0 ? min(1.0, k_filter_confirmed * o / e) : 0.0;
  odd *= o > 0.0 ? min(1.0, k_filter_confirmed * e / o) : 0.0;
  chosen[pixel] = filter_texel(FilterLight(f.even + (1.0 - share) * even, f.odd + (1.0 - share) * odd, 0.0));
}
