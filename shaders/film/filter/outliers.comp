// Light removed by taming, per block of pixels; true light is removed from both halves. One invocation a block.
#include "lib/invocation.glsl"
#include "film/filter/filter.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilterPush push; };
uniform samplerBuffer filter_lights, filter_tamed;
layout(scalar) writeonly buffer FilterTaken { vec4 taken[]; };

void main() {
  uint block = global_index();
  uvec2 blocks = (uvec2(push.width, push.height) + k_filter_block - 1u) / k_filter_block;
  if (block >= blocks.x * blocks.y) return;
  uvec2 first = k_filter_block * uvec2(block % blocks.x, block / blocks.x);
  vec4 sums = vec4(0.0);  // removed from the even and the odd half, remaining in them
  for (uint y = 0u; y < k_filter_block; ++y)
    for (uint x = 0u; x < k_filter_block; ++x) {
      uvec2 at = first + uvec2(x, y);
      bool inside = all(lessThan(at, uvec2(push.width, push.height)));
      int pixel = inside ? int(at.y * push.width + at.x) : 0;
      FilterLight l = filter_light(texelFetch(filter_lights, pixel)), t = filter_light(texelFetch(filter_tamed, pixel));
      vec2 left = vec2(luminance(t.even), luminance(t.odd));
      vec2 had = vec2(luminance(l.even), luminance(l.odd));
      sums += inside ? vec4(max(had - left, 0.0), left) : vec4(0.0);
    }
  taken[block] = sums;
}
