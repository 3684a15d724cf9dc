// Selects the points of the screen-space stage that become candidates, and their level.
//
// The probability of a point at level k is density * falloff^k * detail. With a falloff of 1/4, cells of full detail get the
// same number of candidates at every scale. Cells around an edge have full detail up to their own width away from it, so the
// candidate density falls with the squared distance from the edge, like the density of records whose radii are proportional
// to that distance. Flat regions have a separate base density.
//
// One threshold per point decides all levels: each level owns an interval of [0, 1), as long as its probability. Thresholds
// are the radical inverses of the points' Morton codes, with the quadrants of every 2^j x 2^j block shuffled separately
// (after A. Ahmed and P. Wonka, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering
// of Pixels", 2020): the 4^j points of a block have one threshold in each interval of length 4^-j.
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

uint spread(uint x) {  // inserts a zero bit after each of 16
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

  float width = push.pixel * (push.parallel != 0u ? 1.0 : depth);  // of the cell that a point represents [m]
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
  // Base density: without it flat regions would have few records, each noisy on its own.
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
