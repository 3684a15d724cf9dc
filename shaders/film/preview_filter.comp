// One pass of an edge-avoiding a-trous filter over the grid (Dammertz et al. 2010): 3x3 cells, `step` apart, weighted by
// similarity of the surfaces, and of their light relative to its noise (Schied et al. 2017). The first pass weights by
// surfaces only and estimates the noise, from the halves of the samples if there are two, else from the differences of
// neighbours.
//
// The first pass reduces the weight of the few cells that hold most of the light of single paths, which would show as
// specks. The removed light is spread over the same surface and added back in the preview's picture; otherwise rooms would
// look too dark while samples are few.
#include "lib/invocation.glsl"
#include "film/preview.glsl"
#ifndef LUCERNA_PREVIEW_FIRST
#define LUCERNA_PREVIEW_FIRST 0  // first pass
#endif
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PreviewFilterPush push; };
uniform samplerBuffer grid_texels, grid_surfaces, before_texels, lost_texels, change_texels, texture_texels;
layout(scalar) writeonly buffer FilteredBefore { vec4 filtered_before[]; };  // filtered with the same weights, for comparison
layout(scalar) writeonly buffer Filtered { vec4 filtered[]; };
layout(scalar) writeonly buffer FilteredLost { vec4 filtered_lost[]; };  // luminance, by component
layout(scalar) writeonly buffer FilteredTexture { vec4 filtered_texture[]; };
layout(scalar) writeonly buffer GridNoise { vec4 grid_noise[]; };  // standard error of a cell, by component

// Maximum luminance of a cell, in units of white, that is added back.
const float k_most_lost = 32.0;
// Per sample of a cell: how fast a cell alone on its surface becomes trusted.
const float k_alone_until = 0.05;
const float k_around = 9.0;                    // cells whose paths could have found the light
const float k_dark = 0.25, k_not_dark = 0.75;  // of the expected light
// Light from lamps and caustics have bright parts with sharp borders, which would glow if lost light were spread there. It is
// added back as far as the halves of the samples disagree about it.
const float k_agree = 0.3, k_disagree = 0.8;  // standard error over light

vec3 ray_at(vec2 cell) {
  vec2 p = vec2(2.0, -2.0) * (cell + 0.5) / vec2(push.across, push.down) + vec2(-1.0, 1.0);
  return p.x * push.right + p.y * push.up;
}
vec3 point_at(vec3 ray, float depth) {
  if (is_wide(push.projection)) {
    vec3 x = normalize(push.right), y = normalize(push.up);
    return depth * wide_direction(push.projection, vec2(dot(ray, x), dot(ray, y)), x, y, push.forward);
  }
  return is_parallel(push.projection) ? ray + depth * push.forward : depth * (ray + push.forward);
}

void main() {
  uint cell = global_index();
  if (cell >= push.across * push.down) return;
  ivec2 xy = ivec2(cell % push.across, cell / push.across);
  PreviewSurface here = preview_surface(texelFetch(grid_surfaces, int(cell)));
  PreviewLight own = preview_light(grid_texels, int(cell));
  vec4 own_luminance = preview_luminances(own), own_noise = preview_errors(own);
  vec3 ray = ray_at(vec2(xy)), point = point_at(ray, max(here.depth, 0.0));
  // Width of a cell at that depth, with a margin for curved surfaces.
  float scale = (is_parallel(push.projection) ? 1.0 : max(here.depth, 0.0)) *
                    (2.0 * length(push.right) / float(push.across) * float(push.step)) * 0.3 + 5e-4 * max(here.depth, 0.0) + 1e-6;
  vec3 sum[k_component_count];
  for (uint c = 0u; c < k_component_count; ++c) sum[c] = vec3(0.0);
  vec4 weights = vec4(0.0), variance = vec4(0.0), before = vec4(0.0), lost = vec4(0.0);
  float plain_sum = 0.0;
  PreviewTexture colours = k_preview_no_texture;
#if LUCERNA_PREVIEW_FIRST
  vec4 mean = vec4(0.0), square_mean = vec4(0.0), known = vec4(0.0), any_mean = vec4(0.0), any_square = vec4(0.0);
  vec4 around[k_component_count];  // on any surface; w: weights
  for (uint c = 0u; c < k_component_count; ++c) around[c] = vec4(0.0);
  float alike_square = 0.0, others = 0.0, known_sum = 0.0, any_sum = 0.0;
  vec4 bright = vec4(0.0), by_chance = vec4(0.0), brightest = vec4(0.0), next_bright = vec4(0.0), certain = vec4(0.0);
#endif
  for (int k = 0; k < 9; ++k) {
    ivec2 at = xy + int(push.step) * (ivec2(k % 3, k / 3) - 1);
    bool inside = all(greaterThanEqual(at, ivec2(0))) && at.x < int(push.across) && at.y < int(push.down);
    int there = inside ? at.y * int(push.across) + at.x : int(cell);
    PreviewSurface s = preview_surface(texelFetch(grid_surfaces, there));
    PreviewLight l = preview_light(grid_texels, there);
    float kernel = (k == 4 ? 4.0 : (k & 1) == 1 ? 2.0 : 1.0) * (inside ? 1.0 : 0.0) * min(s.samples, 1.0);
    float alike = preview_alike(here, s, point_at(ray_at(vec2(at)), max(s.depth, 0.0)) - point, scale);
    // Cells without samples take any light rather than none.
    if (here.samples <= 0.0) alike = max(alike, 1e-4);
    vec4 y = preview_luminances(l), noise = preview_errors(l);
    float plain = kernel * alike;
    vec4 w = vec4(plain);
    plain_sum += plain;
    colours = preview_sum(colours, preview_texture(texelFetch(texture_texels, there)), plain);
#if LUCERNA_PREVIEW_FIRST
    // Few cells hold most of the light of single paths; they get less weight, so that they do not show as specks.
    float white = 1.0 / luminance(preview_modulation(s));
    vec4 damped = 1.0 + max(y / white - 1.0, vec4(0.0));
    w /= damped;
    lost += plain * min(y, vec4(k_most_lost * white));
    vec4 above = plain * (damped - 1.0) * white;
    bright += above;
    vec4 disagree = smoothstep(vec4(k_agree), vec4(k_disagree), noise / max(y, vec4(1e-4)));
    vec4 alike_above = alike * min(kernel, 1.0) * (damped - 1.0);
    by_chance += above * disagree;
    certain = max(certain, alike_above * (1.0 - disagree));
    next_bright = max(next_bright, min(alike_above, brightest));
    brightest = max(brightest, alike_above);
    if (k != 4 && (s.depth > 0.0) == (here.depth > 0.0)) {
      others += plain;
      vec4 bounded = kernel / damped;
      for (uint c = 0u; c < k_component_count; ++c) around[c] += bounded[c] * vec4(l.of[c].rgb, 1.0);
    }
    alike_square += plain * plain;
    any_sum += kernel;
    any_mean += kernel * y;
    any_square += kernel * y * y;
    mean += plain * y;
    square_mean += plain * y * y;
    if (l.of[0].w >= 0.0) known += plain * noise * noise, known_sum += plain;
#else
    lost += plain * texelFetch(lost_texels, there);
    // Noise of both cells: where no path has found light yet, a cell alone seems noise-free.
    vec4 chance = 3.0 * max(max(own_noise, noise), vec4(0.0)) + 0.02 * own_luminance + 1e-4;
    w *= exp2(-min(abs(y - own_luminance) / chance, vec4(40.0)));
#endif
    for (uint c = 0u; c < k_component_count; ++c) sum[c] += w[c] * l.of[c].rgb;
    if (push.history != 0u) before += w * texelFetch(before_texels, there);
    weights += w;
    variance += w * w * max(noise, vec4(0.0)) * max(noise, vec4(0.0));
  }
  vec4 inverse = vec4(1.0) / max(weights, vec4(1e-20));
  vec4 error = sqrt(variance) * inverse;
#if LUCERNA_PREVIEW_FIRST
  mean /= max(plain_sum, 1e-20);
  // With few similar cells, their differences are uncertain: all cells around are used.
  any_mean /= max(any_sum, 1e-20);
  vec4 any = max(any_square / max(any_sum, 1e-20) - any_mean * any_mean, vec4(0.0));
  vec4 alike = max(square_mean / max(plain_sum, 1e-20) - mean * mean, vec4(0.0));
  vec4 spread = mix(any, alike, clamp(plain_sum / max(any_sum, 1e-20) * 2.0 - 1.0, 0.0, 1.0)) * (9.0 / 8.0);
  vec4 of_cell = known_sum > 0.5 * plain_sum ? known / max(known_sum, 1e-20) : spread;
  if (push.blocks_across > 0u) {
    // Few paths that find almost no light underestimate the noise: then that of samples of the expected light is used.
    uvec2 blocks = uvec2(push.blocks_across, push.blocks_down);
    vec4 change = preview_change(change_texels, blocks, vec2(xy));
    vec4 expected = texelFetch(before_texels, int(cell)) * mix(change, vec4(0.0), greaterThan(change, vec4(k_preview_most_growth)));
    vec4 dark = k_preview_by_way * (1.0 - smoothstep(vec4(k_dark), vec4(k_not_dark), mean / max(expected, vec4(1e-6))));
    vec4 noise = texelFetch(change_texels, int(blocks.x * blocks.y));
    // Probability that all paths around missed the light if one path in 1 + noise finds it.
    vec4 missed = exp(-k_around * here.samples / (1.0 + noise));
    of_cell = max(of_cell, dark * missed * noise * expected * expected / max(here.samples, 1e-3));
  }
  grid_noise[cell] = sqrt(of_cell);
  // A cell alone on its surface has only its few paths; even cells of other surfaces around predict its light better.
  float alone = (1.0 - smoothstep(0.05, 0.2, others / max(any_sum - 4.0, 1e-20))) / (1.0 + k_alone_until * here.samples);
  of_cell = mix(of_cell, max(of_cell, any), alone);
  error = sqrt(of_cell * alike_square) / max(plain_sum, 1e-20);
#endif
  lost /= max(plain_sum, 1e-20);
  filtered_texture[cell] = plain_sum > 0.0 ? preview_texel(preview_sum(k_preview_no_texture, colours, 1.0 / plain_sum))
                                           : texelFetch(texture_texels, int(cell));
  PreviewLight result;
  for (uint c = 0u; c < k_component_count; ++c) result.of[c] = vec4(sum[c] * inverse[c], error[c]);
#if LUCERNA_PREVIEW_FIRST
  for (uint c = 0u; c < k_component_count; ++c)
    if (around[c].w > 0.0) result.of[c].rgb = mix(result.of[c].rgb, around[c].rgb / around[c].w, alone);
#endif
#if LUCERNA_PREVIEW_FIRST
  // Cells beside certainly bright ones are a border, where halves differ by the positions of samples within a pixel. Without
  // halves, a single bright cell counts as chance.
  vec4 chance = by_chance / max(bright, vec4(1e-20)) *
                (1.0 - smoothstep(vec4(k_agree), vec4(k_disagree), certain / max(brightest, vec4(1e-20))));
  if (own.of[0].w < 0.0) chance = 1.0 - smoothstep(vec4(k_agree), vec4(k_disagree), next_bright / max(brightest, vec4(1e-20)));
  vec4 back = max(k_preview_by_way, chance);
  lost = back * max(lost - preview_luminances(result), vec4(0.0));
#endif
  filtered_lost[cell] = lost;
  if (push.history != 0u) filtered_before[cell] = before * inverse;
  LUCERNA_PREVIEW_STORE(filtered, cell, result)
}
