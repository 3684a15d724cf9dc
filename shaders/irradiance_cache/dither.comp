// Which points of the screen-space stage become candidates, and for which level.
//
// A point's probability is density * falloff^k * detail at level k, summed over the levels. With a falloff of 1/4 every
// cell in which detail is full asks for as many, at every scale; cells about an edge are full up to the distance of their
// own width, so that the density of candidates falls with the square of the distance from the edge, as the density of
// records does whose radii grow with the distances that they see. What is flat has a density of its own on top.
//
// One threshold a point decides for all levels: they have intervals of 0..1, one after the other, as long as their
// probabilities. Thresholds are the radical inverse of the points' Morton codes, in which every block of 2^j x 2^j has its
// parts shuffled by itself (after A. Ahmed and P. Wonka, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error
// via Hierarchical Ordering of Pixels", 2020): of a block's 4^j points one has its threshold in each 4^-j of 0..1.
#include "lib/invocation.glsl"
#include "lib/math.glsl"
#include "lib/sampler.glsl"
#include "shaders/shared/irradiance_cache/discontinuity.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { DitherPush push; };
uniform samplerBuffer surface_texels;
layout(scalar) readonly buffer Lit { vec3 lit[]; };
layout(scalar) readonly buffer Details { float details[]; };
layout(scalar) writeonly buffer Taken { uint taken[]; };            // 0 or 1
layout(scalar) writeonly buffer TakenLevels { uint taken_levels[]; };

uint spread(uint x) {  // a zero bit after each of 16
  x = (x | x << 8) & 0x00ff00ffu;
  x = (x | x << 4) & 0x0f0f0f0fu;
  x = (x | x << 2) & 0x33333333u;
  return (x | x << 1) & 0x55555555u;
}

void main() {
  uint point = global_index();
  if (point >= push.across * push.down) return;
  uvec2 xy = uvec2(point % push.across, point / push.across);
  uint shuffled = owen_scramble(spread(xy.x) | spread(xy.y) << 1, push.key);
  float threshold = float(bitfieldReverse(shuffled) >> 8) * (1.0 / 16777216.0);
  float depth = texelFetch(surface_texels, int(point * k_surface_texels)).w;
  vec3 light = lit[point];

  float width = push.pixel * (push.parallel != 0u ? 1.0 : depth);  // of what a point stands for [m]
  float sum = 0.0, probability = push.density;
  uint drawn = push.levels, first = 0u;
  for (uint k = 0u; k < push.levels; ++k) {
    uvec2 cells = (uvec2(push.across, push.down) + (1u << k) - 1u) >> k, cell = xy >> k;
    float detail = details[first + cell.y * cells.x + cell.x];
    bool draws = k >= push.first_level && width * float(1u << k) >= push.finest;
    sum += draws ? probability * detail : 0.0;
    drawn = threshold < sum && drawn == push.levels ? k : drawn;
    first += cells.x * cells.y;
    probability *= push.falloff;
  }
  // Where nothing changes too, or records would be few and far between there, each alone with its noise.
  float side = width / max(push.flat_side, width);
  uint flat_level = uint(max(ceil(-log2(side)), 0.0));
  bool flat_draws = push.flat_side > 0.0 && drawn == push.levels && threshold < sum + push.density * side * side;
  drawn = flat_draws ? min(flat_level, push.levels - 1u) : drawn;
  float least = push.spacing * width * float(1u << min(drawn, 31u));
  bool wanted = push.spacing > 0.0 ? light.x >= 0.0 && light.y > least : light.x == -1.0;
  bool takes = depth >= 0.0 && drawn < push.levels && wanted;
  taken[point] = takes ? 1u : 0u;
  taken_levels[point] = drawn;
}
