// Grid to filter from the pixels of the preview: light over the surface's colour, of all samples in a cell, including preview
// samples.
#include "lib/invocation.glsl"
#include "film/preview.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PreviewHalvePush push; };
uniform samplerBuffer packed_texels, surface_texels, guide_surfaces, draft_texels, draft_surfaces, history_texels, history_surfaces;
layout(scalar) writeonly buffer Grid { vec4 grid[]; };
layout(scalar) writeonly buffer GridSurfaces { vec4 grid_surfaces[]; };
// Luminance of the previous picture by component, likewise over the colour; the present luminance where it is unknown.
layout(scalar) writeonly buffer GridBefore { vec4 grid_before[]; };
layout(scalar) writeonly buffer GridTexture { vec4 grid_texture[]; };

const float k_doubtful = 0.01;  // weight of samples that may have hit another surface

PreviewSurface centre_of(int pixel) { return preview_centre(guide_surfaces, push.surfaces, pixel); }

// Surface of a pixel, from the film or, without samples, from the guide.
PreviewSurface surface_at(int pixel) {
  if (push.sampled != 0u) return preview_surface(texelFetch(surface_texels, pixel));
  vec4 texel = push.surfaces != k_preview_surface_unknown ? texelFetch(guide_surfaces, pixel) : vec4(-1.0, 0.0, 0.0, 0.0);
  return preview_surface(vec4(texel.xyz, 0.0));
}

// Whether a pixel's samples show several surfaces.
bool mixed(int pixel, PreviewSurface s) {
  float primary = luminance(preview_light(packed_texels, pixel).of[0].rgb);
  return preview_mixed(s, centre_of(pixel), primary, guide_surfaces, uvec2(push.width, push.height), uint(pixel));
}

uvec2 draft_size() { return uvec2(push.draft_width, push.draft_height); }
// Surface of a preview sample; if its centre shows a mirror or glass, the surface seen there.
PreviewSurface draft_surface(uvec2 at) {
  PreviewSurface s = preview_surface(texelFetch(draft_surfaces, int(at.y * push.draft_width + at.x)));
  if (push.surfaces != k_preview_surface_seen) return s;
  uvec2 size = uvec2(push.width, push.height), middle = min((2u * at + 1u) * size / (2u * draft_size()), size - 1u);
  PreviewSurface seen = preview_surface(texelFetch(guide_surfaces, int(middle.y * push.width + middle.x)));
  if (seen.samples != k_preview_beyond) return s;
  seen.samples = s.samples;
  return seen;
}

// Whether a preview sample's pixel also has a surface of the other kind, emitting or not: light of both, side by side in one
// plane, would show as specks.
bool mixed_draft(uvec2 at, bool emits) {
  if (push.surfaces != k_preview_surface_seen) return false;
  uvec2 size = uvec2(push.width, push.height), draft = uvec2(push.draft_width, push.draft_height);
  uvec2 first = min(at * size / draft, size - 1u), last = min((at + 1u) * size / draft, size) - 1u;
  bool other = false;
  for (uint k = 0u; k < 4u; ++k) {
    uvec2 corner = uvec2(k % 2u == 0u ? first.x : last.x, k / 2u == 0u ? first.y : last.y);
    PreviewSurface s = preview_surface(texelFetch(guide_surfaces, int(corner.y * push.width + corner.x)));
    other = other || s.emits != emits;
  }
  return other;
}

PreviewLight total;
float weights = 0.0;
bool noise_known = true;

void add(vec4 a, vec4 b, PreviewSurface s, float weight) {
  if (weight <= 0.0) return;
  PreviewLight l = preview_unpack(a, b);
  vec3 m = preview_modulation(s);
  for (uint c = 0u; c < k_component_count; ++c) {
    noise_known = noise_known && l.of[c].w >= 0.0;
    total.of[c] += vec4(weight * l.of[c].rgb / m, square(weight * l.of[c].w / luminance(m)));
  }
  weights += weight;
}

int pixel_of(uvec2 xy, uint k) {
  uvec2 at = min(xy + push.step / 2u * uvec2(k % 2u, k / 2u), uvec2(push.width, push.height) - 1u);
  return int(at.y * push.width + at.x);
}
uvec2 draft_at(uvec2 xy) {
  return min(xy * draft_size() / uvec2(push.width, push.height), draft_size() - 1u);
}
bool alike(PreviewSurface a, PreviewSurface b) {
  return (a.depth > 0.0) == (b.depth > 0.0) && dot(a.normal, b.normal) > 0.8 && a.emits == b.emits;
}

// Light, in units of white, up to which its correlation with colour is measured (preview_resolve.comp).
const float k_most_light = 4.0;
// Four pixels, two rows of two.
struct Quad {
  float light[4], colour[4];
  bool known[4];
};
PreviewTexture texture_of(Quad q, uint pairs) {
  PreviewTexture t = k_preview_no_texture;
  t.few = 4.0 / float(pairs);
  for (uint k = 0u; k < pairs; ++k) {  // horizontally and vertically, from the first and from the last pixel
    uint a = k < 2u ? 0u : 3u, b = k % 2u == 0u ? 1u : 2u;
    if (!q.known[a] || !q.known[b]) continue;
    t.with_light += (q.light[a] - q.light[b]) * (q.colour[a] - q.colour[b]);
    t.square += square(q.colour[a] - q.colour[b]);
    t.light_square += square(q.light[a] - q.light[b]);
  }
  return t;
}
float shown(vec4 y) { return min(y.x + y.y + y.z + y.w, k_most_light); }

PreviewTexture texture_of_pixels(uvec2 xy, PreviewSurface here, bool show_others[4]) {
  Quad q;
  vec3 sum = vec3(0.0);
  float count = 0.0;
  for (uint k = 0u; k < 4u; ++k) {
    int pixel = pixel_of(xy, k);
    PreviewSurface s = surface_at(pixel);
    q.known[k] = s.samples > 0.0 && s.depth > 0.0 && alike(s, here) && !show_others[k];
    if (!q.known[k]) continue;
    vec3 m = preview_modulation(s);
    q.light[k] = shown(preview_luminances(preview_light(packed_texels, pixel)));
    q.colour[k] = luminance(m);
    sum += 1.0 / m;
    count += 1.0;
  }
  PreviewTexture t = texture_of(q, 4u);
  t.inverse = sum / max(count, 1.0);
  return t;
}
// Likewise, of a preview sample and its right and lower neighbours.
PreviewTexture texture_of_draft(uvec2 at, PreviewSurface here) {
  Quad q;
  uvec2 size = draft_size();
  vec3 own = vec3(0.0);
  for (uint k = 0u; k < 3u; ++k) {
    uvec2 there = at + uvec2(k % 2u, k / 2u);
    q.known[k] = all(lessThan(there, size));
    if (!q.known[k]) continue;
    int pixel = int(there.y * size.x + there.x);
    PreviewSurface s = draft_surface(there);
    q.known[k] = s.samples > 0.0 && s.depth > 0.0 && alike(s, here);
    if (!q.known[k]) continue;
    vec3 m = preview_modulation(s);
    q.light[k] = shown(preview_luminances(preview_light(draft_texels, pixel)));
    q.colour[k] = luminance(m);
    if (k == 0u) own = 1.0 / m;
  }
  PreviewTexture t = texture_of(q, 2u);
  t.inverse = own;
  return t;
}

void main() {
  uint cell = global_index();
  if (cell >= push.across * push.down) return;
  uvec2 xy = push.step * uvec2(cell % push.across, cell / push.across);
  for (uint c = 0u; c < k_component_count; ++c) total.of[c] = vec4(0.0);
  // The cell's surface is that of its first pixel; pixels known to show another one are omitted.
  int first = int(xy.y * push.width + xy.x);
  PreviewSurface here = surface_at(first), centre = centre_of(first);
  if (centre.depth >= 0.0 && mixed(first, here)) {
    centre.samples = here.samples;
    here = centre;
  }
  if (push.draft_width > 0u) {
    uvec2 at = draft_at(xy);
    int pixel = int(at.y * push.draft_width + at.x);
    PreviewSurface s = draft_surface(at);
    bool doubtful = push.sampled == 0u && push.surfaces != k_preview_surface_seen;
    if ((here.depth < 0.0 || doubtful) && s.samples > 0.0) here = s;
    if (push.repainted != 0u && here.samples <= 0.0 && s.samples > 0.0) here.albedo = s.albedo;
    // Across an edge it is another surface's light, with a small weight better than none.
    bool akin = (s.depth > 0.0) == (here.depth > 0.0) &&
                 (s.depth <= 0.0 || (dot(s.normal, here.normal) > 0.8 && abs(s.depth - here.depth) < 0.1 * here.depth));
    akin = akin && !mixed_draft(at, here.emits);
    float weight = push.draft_share * s.samples * (akin ? 1.0 : 1e-3);
    add(texelFetch(draft_texels, 2 * pixel), texelFetch(draft_texels, 2 * pixel + 1), s, weight);
  }
  vec4 before = vec4(0.0);
  float before_known = 0.0;
  // Pixels that show several surfaces are omitted if others show only this one.
  bool show_others[4] = bool[](true, true, true, true), pure = false;
  for (uint k = 0u; k < 4u && push.sampled != 0u; ++k) {
    int pixel = pixel_of(xy, k);
    PreviewSurface s = surface_at(pixel);
    show_others[k] = mixed(pixel, s);
    pure = pure || (s.samples > 0.0 && alike(s, here) && !show_others[k]);
  }
  for (uint k = 0u; k < 4u; ++k) {  // wider cells exist only with preview samples; four of their pixels are enough
    int pixel = pixel_of(xy, k);
    PreviewSurface s = surface_at(pixel);
    if (s.samples > 0.0 && (alike(s, here) || s.depth < 0.0) && !(pure && show_others[k]))
      add(texelFetch(packed_texels, 2 * pixel), texelFetch(packed_texels, 2 * pixel + 1), s, s.samples);
    if (push.history == 0u) continue;
    PreviewSurface was = preview_surface(texelFetch(history_surfaces, pixel));
    PreviewLight l = preview_light(history_texels, pixel);
    if (preview_lit(l, was) && (alike(s, here) || s.depth < 0.0) && (push.moved == 0u || preview_may_be_same(s, was))) {
      vec3 m = push.history_scale / (was.depth >= 0.0 ? preview_modulation(was) : preview_modulation(here));
      before += vec4(luminance(m * l.of[0].rgb), luminance(m * l.of[1].rgb), luminance(m * l.of[2].rgb), luminance(m * l.of[3].rgb));
      before_known += 1.0;
    }
  }
  float scale = weights > 0.0 ? 1.0 / weights : 0.0;
  for (uint c = 0u; c < k_component_count; ++c) {
    total.of[c].rgb *= scale;
    total.of[c].w = noise_known && weights > 0.0 ? scale * sqrt(total.of[c].w) : -1.0;
  }
  vec4 now = vec4(luminance(total.of[0].rgb), luminance(total.of[1].rgb), luminance(total.of[2].rgb), luminance(total.of[3].rgb));
  grid_before[cell] = before_known > 0.0 ? before / before_known : now;
  LUCERNA_PREVIEW_STORE(grid, cell, total)
  // If all of them may contain light of an adjacent emitter, they have little information about the surface's own light.
  bool lit_beside = push.sampled != 0u && !pure && !here.emits && luminance(preview_modulation(here) * total.of[0].rgb) > k_preview_bright &&
                  push.surfaces == k_preview_surface_seen &&
                  preview_beside_emitter(guide_surfaces, uvec2(push.width, push.height), uint(first));
  here.samples = weights * (lit_beside ? k_doubtful : 1.0);
  grid_surfaces[cell] = preview_texel(here);
  PreviewTexture t = k_preview_no_texture;
  if (push.sampled != 0u) t = texture_of_pixels(xy, here, show_others);
  if (t.inverse.x <= 0.0 && push.draft_width > 0u) t = texture_of_draft(draft_at(xy), here);
  if (t.inverse.x <= 0.0) t.inverse = 1.0 / preview_modulation(here);
  grid_texture[cell] = preview_texel(t);
}
