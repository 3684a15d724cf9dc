// Picture of the preview: for each component the pixel's own samples as far as their noise permits, else the filtered grid
// times the surface's colour; mixed with the previous picture where that is not visibly wrong.
//
// For new light N of variance v and older light O of variance u, the difference d = N - O measures the change: the mean of
// its square is v + u + change^2. The mix w O + (1 - w) N has the least error for w = v / (v + u + change^2). Both are
// filtered for the difference, so that detail lost in filtering does not count as change. Before that, O is scaled by the
// change measured over many pixels (film/preview_change.comp). Another sky, or another colour of light, may look alike in
// luminance: the edit says how much change to expect at least (doubt).
#include "lib/display.glsl"
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
#include "film/preview.glsl"
#include "shaders/shared/film.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PreviewResolvePush push; };
uniform samplerBuffer packed_texels, surface_texels, guide_surfaces, history_texels, history_surfaces;
uniform samplerBuffer filtered_texels, grid_surfaces, noise_texels, before_texels, lost_texels, change_texels, texture_texels;
layout(scalar) writeonly buffer Packed { vec4 packed[]; };
layout(scalar) writeonly buffer PackedSurfaces { vec4 packed_surfaces[]; };
layout(scalar) writeonly buffer Picture { uint picture[]; };
layout(scalar) writeonly buffer Shares { PreviewShares shares[]; };
// Two half floats: shown luminance, and its expected relative error over a mean of 3x3 pixels (1 at most).
layout(scalar) writeonly buffer Shown { uint shown_pixels[]; };

// Maximum squared difference, over its variance, that counts as chance: noise of few paths has far outliers, and without a
// change of light almost all differences are outliers.
const float k_by_chance = 3.0, k_by_chance_same = 16.0;
const float k_mirrored = 2.0;  // light in mirrors over that of diffuse surfaces: windows and lamps are brighter
const float k_least_noise = 0.5;  // minimum relative noise of a sample where light has not changed
// Relative noise of a pixel up to which it is shown unfiltered, and from which it is fully filtered.
const float k_clean = 0.02, k_noisy = 0.08;
// Expected share of light that does not follow the colours; inverse of the maximum number of independent filtered sums.
const float k_prior = 0.35, k_fewest = 1.0 / 256.0;
// A pixel's own noise is used if it exceeds this times the noise of its surroundings.
const float k_outlier = 3.0;
// A lamp is as before if its light has not changed by this factor: samples of a thin one are uncertain.
const float k_same_lamp = 2.0;
// Assumed relative error of filtered light.
const float k_filter_error = 0.04;
// Mean absolute deviation in standard errors: sqrt(2 / pi) for a normal variable, times 1.25, measured on filtered interiors,
// where few samples underestimate their noise.
const float k_mean_deviation = 1.25 * 0.798;

// Minimum weight of the nearest cells on a pixel's surface. With less, cells farther away are searched.
const float k_alone = 0.02;
const int k_wide = 3;
// A pixel on no cell's surface, or an outlier, is filtered fully up to the first number of samples, not at all from the second.
const float k_alone_until = 16.0, k_not_alone_from = 96.0;
// Maximum lost light that is added back to filtered light: in units of white, and relative to itself.
const float k_most_back = 1.0, k_most_back_relative = 3.0;

shared vec4 group_shares[64];

// Weighted sums over the cells that contribute to the pixel.
vec4 light[k_component_count];
vec4 noise = vec4(0.0), before_smooth = vec4(0.0), lost = vec4(0.0);
vec3 modulation = vec3(0.0);
PreviewTexture colours = k_preview_no_texture;
float weights = 0.0, nearest_weight = 0.0, nearest_depth = -1.0;
ivec2 grid_size() { return ivec2(push.across, push.down); }
bool in_grid(ivec2 at) { return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, grid_size())); }
int cell_at(ivec2 at) { return at.y * int(push.across) + at.x; }

// Weight of a cell by how much of its light is its own surface's (doubtful samples of preview_halve.comp count little).
float own_light(PreviewSurface s) { return clamp(4.0 * s.samples, 1e-3, 1.0); }

// `other`: a cell of another surface, in case there are none of the pixel's own. Dark cells then weigh more than bright ones: a
// window's frame is not as bright as its panes.
void add_cell(int cell, PreviewSurface s, float w, bool other) {
  PreviewLight l = preview_light(filtered_texels, cell);
  vec4 shown = preview_luminances(l);
  if (other) w *= 1e-4 / square(1.0 + 8.0 * (shown.x + shown.y + shown.z + shown.w));
  bool known = (l.of[0].w + l.of[1].w + l.of[2].w + l.of[3].w) >= 0.0 && s.samples > 0.0;
  float there = w * (known ? own_light(s) : 1e-6);
  for (uint c = 0u; c < k_component_count; ++c) light[c] += there * l.of[c];
  lost += there * texelFetch(lost_texels, cell);
  if (push.history != 0u) before_smooth += there * texelFetch(before_texels, cell);
  if (push.sampled != 0u) noise += there * texelFetch(noise_texels, cell) * sqrt(max(s.samples, 1e-3));  // per sample
  modulation += there * preview_modulation(s);
  colours = preview_sum(colours, preview_texture(texelFetch(texture_texels, cell)), there);
  weights += there;
  if (s.samples > 0.0 && s.depth >= 0.0 && there > nearest_weight) nearest_weight = there, nearest_depth = s.depth;
}

// Parts around a pixel whose samples show several surfaces: the surface at its centre, other surfaces, the background.
const uint k_own = 0u, k_other = 1u, k_background = 2u, k_part_count = 3u;
uint part_of(PreviewSurface cell, PreviewSurface centre) {
  if (cell.depth == 0.0) return k_background;
  return preview_same(cell, centre) ? k_own : k_other;
}
struct Part {
  float weight, depth, primary, emits;
  vec3 normal, albedo;
};
const int k_mix_across = 3;  // cells
const float k_apart = 0.3;   // relative difference of depths that counts as much as one of normals

// The k-th cell around a position, with its weight; false if it is unknown.
bool near_cell(vec2 p, int k, out int cell, out PreviewSurface s, out float weight) {
  ivec2 at = ivec2(round(p)) + ivec2(k % k_mix_across, k / k_mix_across) - k_mix_across / 2;
  if (!in_grid(at)) return false;
  cell = cell_at(at);
  s = preview_surface(texelFetch(grid_surfaces, cell));
  vec2 away = vec2(at) - p;
  weight = exp2(-dot(away, away)) * own_light(s);
  return s.depth >= 0.0 && s.samples > 0.0;
}

// Share of part a in the hit surfaces, from the position of the pixel's means between both parts.
float share_of(Part a, Part b, PreviewSurface here, float primary) {
  vec3 normal = a.normal - b.normal, albedo = a.albedo - b.albedo;
  float depth = (a.depth - b.depth) / (k_apart * here.depth), light = a.primary - b.primary;
  float off = dot(here.normal - b.normal, normal) + dot(here.albedo - b.albedo, albedo) + (here.depth - b.depth) / (k_apart * here.depth) * depth;
  float all = dot(normal, normal) + dot(albedo, albedo) + square(depth);
  // Emitted light has no noise.
  if (max(a.emits, b.emits) > 0.5) {
    off = light * (primary - b.primary);
    all = square(light);
  }
  return all > 0.0 ? clamp(off / all, 0.0, 1.0) : 1.0;
}

// Light of a pixel that shows several surfaces: mixed from nearby pixels that show each of them alone, in the shares that
// the pixel's means and hit count imply. False, and nothing is done, if no nearby pixel shows its surfaces.
bool mix_cells(vec2 p, PreviewSurface here, PreviewSurface centre, float primary) {
  if (centre.depth <= 0.0) centre = here;
  Part parts[k_part_count];
  for (uint i = 0u; i < k_part_count; ++i) parts[i] = Part(0.0, 0.0, 0.0, 0.0, vec3(0.0), vec3(0.0));
  int cell;
  PreviewSurface s;
  float w;
  for (int k = 0; k < k_mix_across * k_mix_across; ++k) {
    if (!near_cell(p, k, cell, s, w)) continue;
    uint i = part_of(s, centre);
    parts[i].weight += w;
    parts[i].depth += w * s.depth;
    parts[i].normal += w * s.normal;
    parts[i].albedo += w * s.albedo;
    parts[i].emits += s.emits ? w : 0.0;
    parts[i].primary += w * luminance(preview_modulation(s) * preview_light(filtered_texels, cell).of[0].rgb);
  }
  if (parts[k_own].weight <= 0.0) return false;
  for (uint i = 0u; i < k_part_count; ++i) {
    float scale = 1.0 / max(parts[i].weight, 1e-20);
    parts[i].depth *= scale;
    parts[i].normal *= scale;
    parts[i].albedo *= scale;
    parts[i].emits *= scale;
    parts[i].primary *= scale;
  }
  float own = parts[k_other].weight > 0.0 ? share_of(parts[k_own], parts[k_other], here, primary) : 1.0;
  float met = parts[k_background].weight > 0.0 ? here.covered : 1.0;
  float share[k_part_count];
  share[k_own] = met * own / parts[k_own].weight;
  share[k_other] = met * (1.0 - own) / max(parts[k_other].weight, 1e-20);
  share[k_background] = (1.0 - met) / max(parts[k_background].weight, 1e-20);
  for (int k = 0; k < k_mix_across * k_mix_across; ++k) {
    if (!near_cell(p, k, cell, s, w)) continue;
    w *= share[part_of(s, centre)];
    vec3 m = preview_modulation(s);
    float shown = luminance(m);
    PreviewLight l = preview_light(filtered_texels, cell);
    for (uint c = 0u; c < k_component_count; ++c) light[c] += w * l.of[c] * vec4(m, shown);
    lost += w * shown * texelFetch(lost_texels, cell);
    if (push.history != 0u) before_smooth += w * shown * texelFetch(before_texels, cell);
    noise += w * shown * texelFetch(noise_texels, cell) * sqrt(max(s.samples, 1e-3));
  }
  weights = 1.0;
  return true;
}

// Share of the light that follows a surface's colours, 0..1; mirrored light does not. `falling`: light over the colour. A
// regression of differences of light on those of colour; the prior is 1 with standard deviation k_prior.
float follows_colour(PreviewTexture t, float falling) {
  float scale = falling * t.square;
  if (scale <= 1e-9) return 1.0;
  // Four pairs a cell.
  float variance = 0.25 * t.light_square * t.square * max(t.few, k_fewest) / square(scale);
  return clamp(1.0 + (t.with_light / scale - 1.0) * square(k_prior) / (square(k_prior) + variance), 0.0, 1.0);
}

// Whether no adjacent pixel shows its surface, such as one ray's hit on a veil or on leaves finer than pixels.
bool isolated(ivec2 at, PreviewSurface here) {
  bool akin = false;
  for (int k = 0; k < 9 && !akin; ++k) {
    ivec2 there = at + ivec2(k % 3, k / 3) - 1;
    bool inside = k != 4 && all(greaterThanEqual(there, ivec2(0))) && there.x < int(push.width) && there.y < int(push.height);
    akin = inside && preview_same(here, preview_surface(texelFetch(guide_surfaces, there.y * int(push.width) + there.x)));
  }
  return !akin;
}

// Luminance of a lamp of which the pixel may show a part, if it shines as it did before the edit; 0: none.
float lamp_beside(ivec2 at) {
  float lamp = 0.0;
  for (int k = 0; k < 9; ++k) {
    ivec2 there = at + ivec2(k % 3, k / 3) - 1;
    if (any(lessThan(there, ivec2(0))) || there.x >= int(push.width) || there.y >= int(push.height)) continue;
    int pixel = there.y * int(push.width) + there.x;
    if (!preview_surface(texelFetch(guide_surfaces, pixel)).emits) continue;
    float now = luminance(preview_light(packed_texels, pixel).of[0].rgb);
    float was = luminance(push.history_scale * preview_light(history_texels, pixel).of[0].rgb);
    if (max(now, was) < k_same_lamp * min(now, was)) lamp = max(lamp, max(now, was));
  }
  return lamp;
}

void main() {
  uint pixel = global_index(), lane = gl_LocalInvocationIndex;
  vec4 totals = vec4(0.0);
  if (pixel < push.width * push.height) {
    vec4 surface = vec4(-1.0, 0.0, 0.0, 0.0);
    PreviewLight own;
    for (uint c = 0u; c < k_component_count; ++c) own.of[c] = vec4(0.0, 0.0, 0.0, -1.0);
    if (push.sampled != 0u) {
      surface = texelFetch(surface_texels, int(pixel));
      own = preview_light(packed_texels, int(pixel));
    } else if (push.surfaces != k_preview_surface_unknown) {
      surface = vec4(texelFetch(guide_surfaces, int(pixel)).xyz, 0.0);
    }
    PreviewSurface here = preview_surface(surface);
    if (push.surfaces == k_preview_surface_seen && here.samples <= 0.0 &&
        isolated(ivec2(pixel % push.width, pixel / push.width), here))
      here.depth = -1.0;
    vec2 p = (vec2(pixel % push.width, pixel / push.width) + 0.5) / float(push.step) - 0.5;
    ivec2 base = ivec2(floor(p));
    vec2 f = p - vec2(base);
    for (uint c = 0u; c < k_component_count; ++c) light[c] = vec4(0.0);
    PreviewSurface centre = preview_centre(guide_surfaces, push.surfaces, int(pixel));
    float primary = luminance(own.of[0].rgb);
    bool mixed = push.sampled != 0u && preview_mixed(here, centre, primary, guide_surfaces, uvec2(push.width, push.height), pixel);
    bool mixture = mixed && mix_cells(p, here, centre, primary);
    // A slat before a lamp, on no cell: its samples have mostly the lamp's light, which has no noise.
    bool mostly_lamp = mixed && !mixture && primary > k_preview_bright &&
                       preview_beside_emitter(guide_surfaces, uvec2(push.width, push.height), pixel);
    float akin = mixture ? 1.0 : 0.0;
    // The four nearest cells of the grid, without those of other surfaces.
    for (int k = 0; k < 4 && !mixture; ++k) {
      ivec2 corner = ivec2(k & 1, k >> 1);
      ivec2 at = clamp(base + corner, ivec2(0), grid_size() - 1);
      int cell = cell_at(at);
      PreviewSurface s = preview_surface(texelFetch(grid_surfaces, cell));
      vec2 g = mix(1.0 - f, f, vec2(corner));
      float w = g.x * g.y + 1e-3;
      bool other = false;
      if (here.depth >= 0.0 && s.depth >= 0.0) {
        bool alike = preview_same(here, s);
        akin += alike ? w * own_light(s) : 0.0;
        other = !alike;
      } else {
        akin = 1.0;
      }
      add_cell(cell, s, w, other);
    }
    // A narrow surface has few cells of its own, perhaps not next to this pixel.
    for (int k = 0; akin <= k_alone && k < 2 * k_wide * 2 * k_wide; ++k) {
      ivec2 at = base + ivec2(k % (2 * k_wide), k / (2 * k_wide)) - (k_wide - 1);
      if (!in_grid(at)) continue;
      int cell = cell_at(at);
      PreviewSurface s = preview_surface(texelFetch(grid_surfaces, cell));
      vec2 away = vec2(at) - p;
      if (s.depth >= 0.0 && preview_same(here, s)) add_cell(cell, s, exp2(-dot(away, away)), false);
    }
    if (akin <= k_alone && weights > k_alone) akin = 1.0;
    float inverse = 1.0 / max(weights, 1e-20);
    if (mixture) {
      modulation = vec3(1.0);  // included in each part
    } else if (here.depth >= 0.0 && (push.repainted == 0u || here.samples > 0.0)) {
      modulation = preview_modulation(here);
      float falling = 0.0;
      for (uint c = 0u; c < k_component_count; ++c) falling += max(luminance(light[c].rgb) * inverse, 0.0);
      vec3 plain = 1.0 / max(inverse * colours.inverse, vec3(1e-6));
      modulation = mix(plain, modulation, follows_colour(preview_sum(k_preview_no_texture, colours, inverse), falling));
    } else {
      modulation *= inverse;
    }
    noise *= inverse * luminance(modulation) * inversesqrt(max(here.samples, 1.0));
    // Then the cells' noise is not that of this pixel, and two paths without light are no certainty.
    float few = 1.0 - smoothstep(k_alone_until, k_not_alone_from, here.samples), alone = akin > k_alone ? 0.0 : few;
    PreviewLight old;
    for (uint c = 0u; c < k_component_count; ++c) old.of[c] = vec4(0.0);
    bool has_old = false;
    bvec4 other_light = bvec4(false);
    if (push.history != 0u) {
      old = preview_light(history_texels, int(pixel));
      PreviewSurface was = preview_surface(texelFetch(history_surfaces, int(pixel)));
      has_old = preview_lit(old, was) && (push.moved == 0u || preview_may_be_same(here, was));
      // With another surface colour, the old light is scaled by the ratio of colours; likewise if a texture seen from nearer has
      // more detail.
      bool finer = push.moved != 0u && push.surfaces == k_preview_surface_seen;
      vec3 colour = here.depth >= 0.0 ? preview_modulation(here) : modulation;
      vec3 repaint = (push.recoloured != 0u || finer) && was.depth > 0.0 ? min(colour / preview_modulation(was), vec3(8.0)) : vec3(1.0);
      vec4 change = preview_change(change_texels, uvec2(push.blocks_across, push.blocks_down), p);
      other_light = greaterThan(change, vec4(k_preview_most_growth));
      change = min(change, vec4(k_preview_most_growth));
      before_smooth *= change;
      for (uint c = 0u; c < k_component_count; ++c) old.of[c] *= change[c] * vec4(repaint, luminance(repaint));
    }
    // For later camera positions.
    if (here.depth < 0.0 && nearest_depth >= 0.0) surface = vec4(k_preview_about - nearest_depth, 0.0, 0.0, 0.0);
    PreviewSurface seen = preview_surface(texelFetch(guide_surfaces, int(pixel)));
    if (push.surfaces != k_preview_surface_seen) seen.samples = 0.0;
    // A previous picture needs to know how a ray has hit the surface, and not the number of samples.
    if (seen.samples < 0.0) surface.w = seen.samples;
    packed_surfaces[pixel] = surface;
    float mirrors = push.moved != 0u ? min(k_mirrored * preview_mirrors(seen), 1.0) : 0.0;
    float by_chance = push.same_light != 0u ? k_by_chance_same : k_by_chance;
    PreviewLight result;
    vec3 color = vec3(0.0);
    float lamp = 0.0;
    if (has_old && push.sampled != 0u && push.moved == 0u && push.surfaces == k_preview_surface_seen &&
        max(primary, luminance(push.history_scale * old.of[0].rgb)) > k_preview_bright)
      lamp = lamp_beside(ivec2(pixel % push.width, pixel / push.width));
    float former = 0.0;    // luminance of older light in the shown colour
    float variance = 0.0;  // of a mean of the shown picture over 3x3 pixels
    bool unknown = false;
    for (uint c = 0u; c < k_component_count; ++c) {
      float plain = luminance(light[c].rgb) * inverse, back = min(lost[c] * inverse, k_most_back + k_most_back_relative * plain);
      vec3 colour = plain > 1e-4 ? light[c].rgb * (inverse / plain) : vec3(1.0);
      vec3 smooth_light = (plain + back) * colour * modulation;
      float smooth_luminance = luminance(smooth_light), own_luminance = luminance(own.of[c].rgb);
      // Where light was lost nearby, paths without light are uncertain.
      noise[c] = max(noise[c], luminance(modulation) * back);
      // So is a pixel whose halves differ by far more than those around: a rare bright path would show as a speck.
      float doubt_own = own.of[c].w > k_outlier * noise[c] ? own.of[c].w : 0.0;
      float relative = max(noise[c], doubt_own) / max(max(smooth_luminance, own_luminance), k_luminance_floor);
      // If few paths are far brighter than the surroundings, two may agree by chance. Borders of emitters look the same.
      bool far_above = k_preview_by_way[c] > 0.0 && own_luminance > 2.0 * smooth_luminance + k_outlier * noise[c];
      float unlikely = far_above ? few * smoothstep(k_clean, k_noisy, noise[c] / max(smooth_luminance, k_luminance_floor)) : 0.0;
      // Share of filtered light.
      float rough = here.samples > 0.0 ? max(smoothstep(k_clean, k_noisy, relative), max(unlikely, alone)) : 1.0;
      if (mostly_lamp && c == 0u) rough = 0.0;
      float amount = push.filtering != 0u || here.samples <= 0.0 ? rough : 0.0;
      vec3 now = mix(own.of[c].rgb, smooth_light, amount);
      float smooth_error = luminance(modulation) * max(light[c].w, 0.0) * inverse + k_filter_error * smooth_luminance;
      float error = mix(noise[c], smooth_error, amount);
      bool kept = has_old && !other_light[c];
      vec3 before = kept ? old.of[c].rgb * push.history_scale : vec3(0.0);
      float u = kept ? square(old.of[c].w) + square(mirrors * luminance(before)) : 0.0, v = square(error) + 1e-8;
      // Paths that have found no light yet seem noise-free: older light shows how much to expect.
      float unsure = rough;
      if (push.same_light != 0u) {
        float n = max(here.samples, 1.0), least = k_least_noise * luminance(before);
        v = max(v, square(least) / n);
        unsure = max(rough, smoothstep(k_clean, k_noisy, least / (n * max(max(smooth_luminance, own_luminance), k_luminance_floor))));
      }
      // The samples of a pixel at a lamp's edge show its share of the lamp by chance.
      if (c == 0u && lamp > 0.0) {
        float n = max(here.samples, 1.0), share = clamp(luminance(before) / lamp, 0.0, 1.0);
        float by_share = lamp * sqrt(share * (1.0 - share) / n);
        v = max(v, square(by_share));
        unsure = max(unsure, smoothstep(k_clean, k_noisy, by_share / max(max(smooth_luminance, own_luminance), k_luminance_floor)));
      }
      float difference = luminance(modulation) * before_smooth[c] * inverse - smooth_luminance;
      // Chance alone must not count as change: it would show as specks.
      float change = max(square(difference) - by_chance * (u + v), square(push.doubt * luminance(before)));
      float keep = kept ? unsure * v / (v + u + change) : 0.0;
      bool nothing = weights <= 1e-5 && here.samples <= 0.0;
      if (nothing) keep = kept ? 1.0 : 0.0;
      now = mix(now, before, keep);
      // Where light has changed, the reported error counts all that samples hold against the old, chance or not.
      float doubt = push.same_light != 0u ? change : max(square(difference) - u - v, square(push.doubt * luminance(before)));
      float of_before = keep * keep * (u + doubt), left = sqrt(square((1.0 - keep) * error) + of_before);
      result.of[c] = vec4(now, nothing && !kept ? -1.0 : left);
      if ((push.show >> c & 1u) != 0u) color += now;
      float showing = float(push.show >> c & 1u), shown = luminance(now) * showing;
      former += keep * shown;
      totals.xyz += vec3(shown, keep * shown, amount * (1.0 - keep) * shown);
      // Pixels' own samples are independent; what is filtered, or was there before, errs alike in pixels side by side.
      variance += showing * (square(1.0 - keep) * (square((1.0 - amount) * noise[c]) / 9.0 + square(amount * smooth_error)) + of_before);
      unknown = unknown || (nothing && !kept);
    }
    totals.xyz = min(totals.xyz, vec3(4.0));
    totals.w = unknown ? 1.0 : min(k_mean_deviation * sqrt(variance) / max(luminance(color), k_preview_dark), 1.0);
    shown_pixels[pixel] = packHalf2x16(vec2(min(luminance(color), 60000.0), totals.w));
    LUCERNA_PREVIEW_STORE(packed, pixel, result)
    vec3 displayed = display_color(color, push.curve);
    if (push.tint != 0u) displayed = preview_tinted(displayed, former / max(luminance(color), 1e-20));
    picture[pixel] = picture_packed(displayed);
  }
  group_shares[lane] = totals;
  barrier();
  if (lane == 0u) {
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < 64u; ++i) sum += group_shares[i];
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (group < (push.width * push.height + 63u) / 64u) shares[group] = PreviewShares(sum.x, sum.y, sum.z);
  }
}
