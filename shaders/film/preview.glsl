// Access to the pixels of shaders/shared/preview.h.
#ifndef LUCERNA_FILM_PREVIEW
#define LUCERNA_FILM_PREVIEW
#include "lib/math.glsl"
#include "lib/projection.glsl"
#include "shaders/shared/lanes.h"
#include "shaders/shared/preview.h"

// 1 for components with light from other surfaces, which single paths find by chance: secondary and tertiary. Light of visible
// lamps has no such noise.
const vec4 k_preview_by_way = vec4(0.0, 1.0, 1.0, 0.0);

// Light by component: rgb, standard error of the luminance.
struct PreviewLight {
  vec4 of[k_component_count];
};

PreviewLight preview_unpack(vec4 a, vec4 b) {
  uvec4 x = floatBitsToUint(a), y = floatBitsToUint(b);
  PreviewLight l;
  l.of[0] = vec4(unpackHalf2x16(x.x), unpackHalf2x16(x.y));
  l.of[1] = vec4(unpackHalf2x16(x.z), unpackHalf2x16(x.w));
  l.of[2] = vec4(unpackHalf2x16(y.x), unpackHalf2x16(y.y));
  l.of[3] = vec4(unpackHalf2x16(y.z), unpackHalf2x16(y.w));
  return l;
}
// Reads a pixel or cell: two texels.
PreviewLight preview_light(samplerBuffer texels, int at) {
  return preview_unpack(texelFetch(texels, 2 * at), texelFetch(texels, 2 * at + 1));
}
vec4 preview_luminances(PreviewLight l) {
  return vec4(luminance(l.of[0].rgb), luminance(l.of[1].rgb), luminance(l.of[2].rgb), luminance(l.of[3].rgb));
}
vec4 preview_errors(PreviewLight l) { return vec4(l.of[0].w, l.of[1].w, l.of[2].w, l.of[3].w); }
uvec2 preview_pack(vec4 c) {
  vec4 v = min(c, vec4(60000.0));
  return uvec2(packHalf2x16(v.xy), packHalf2x16(v.zw));
}
vec4 preview_texel(vec4 c, vec4 d) { return uintBitsToFloat(uvec4(preview_pack(c), preview_pack(d))); }
#define LUCERNA_PREVIEW_STORE(buffer, at, light)                   \
  buffer[2u * (at)] = preview_texel((light).of[0], (light).of[1]); \
  buffer[2u * (at) + 1u] = preview_texel((light).of[2], (light).of[3]);

// Octahedral normals (Cigolle et al. 2014).
uint preview_normal(vec3 n) {
  n /= abs(n.x) + abs(n.y) + abs(n.z) + 1e-20;
  vec2 o = n.z >= 0.0 ? n.xy : (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
  return packSnorm2x16(o);
}
vec3 preview_normal(uint bits) {
  vec2 o = unpackSnorm2x16(bits);
  vec3 n = vec3(o, 1.0 - abs(o.x) - abs(o.y));
  float t = max(-n.z, 0.0);
  n.xy += vec2(n.x >= 0.0 ? -t : t, n.y >= 0.0 ? -t : t);
  return normalize(n);
}

struct PreviewSurface {
  float depth;  // [m]; 0: no surface; below 0: unknown
  vec3 normal, albedo;
  float samples;
  bool emits;     // true only if a ray has hit it
  float covered;  // share of the samples with a hit, if any has one
};
const float k_preview_least_covered = 1.0 / 255.0;
PreviewSurface preview_surface(vec4 texel) {
  vec4 albedo = unpackUnorm4x8(floatBitsToUint(texel.z));
  bool emits = albedo.a < 0.5 * k_preview_least_covered;
  return PreviewSurface(texel.x, preview_normal(floatBitsToUint(texel.y)), albedo.rgb, texel.w, emits, emits ? 1.0 : albedo.a);
}
vec4 preview_texel(PreviewSurface s) {
  float covered = s.emits ? 0.0 : max(s.covered, k_preview_least_covered);
  return vec4(s.depth, uintBitsToFloat(preview_normal(s.normal)), uintBitsToFloat(packUnorm4x8(vec4(s.albedo, covered))), s.samples);
}

// How a surface that a ray has hit is seen, in place of PreviewSurface::samples. Both of the next two false: unknown.
float preview_seen(bool beyond, float mirrors) { return beyond ? k_preview_beyond : k_preview_direct - 0.5 * mirrors; }
bool preview_beyond(PreviewSurface s) { return s.samples == k_preview_beyond; }
bool preview_direct(PreviewSurface s) { return s.samples < 0.0 && s.samples > k_preview_beyond; }
// Share of the light that another camera sees from another place, 0..1.
float preview_mirrors(PreviewSurface s) { return preview_beyond(s) ? 0.5 : preview_direct(s) ? clamp(2.0 * (k_preview_direct - s.samples), 0.0, 1.0) : 0.0; }

// Whether a pixel has information about the light: it was shown or has samples.
bool preview_lit(PreviewLight l, PreviewSurface s) { return l.of[0].w >= 0.0 || s.samples > 0.0; }

// Centre of a pixel in a picture, -1..1 to the right and up.
vec2 preview_position(uvec2 pixel, vec2 size) { return vec2(2.0, -2.0) * (vec2(pixel) + 0.5) / size + vec2(-1.0, 1.0); }
// The unit view axis, without lens shift.
vec3 preview_axis(PreviewCamera camera) {
  vec3 across = normalize(cross(camera.right, camera.up));
  return dot(across, camera.forward) < 0.0 ? -across : across;
}
// The point at that position and depth, from the camera's origin.
vec3 preview_point(PreviewCamera camera, uint projection, vec2 position, float depth) {
  vec3 ray = position.x * camera.right + position.y * camera.up;
  if (is_wide(projection)) {
    float right = length(camera.right), up = length(camera.up);
    return depth * wide_direction(projection, position * vec2(right, up), camera.right / right, camera.up / up, camera.forward);
  }
  return is_parallel(projection) ? ray + depth * camera.forward : depth * (ray + camera.forward);
}
// Where a point from the camera's origin is in a picture [pixels], if its depth is above 0.
vec2 preview_projection(PreviewCamera camera, uint projection, vec3 point, vec2 size, out float depth) {
  if (is_wide(projection)) {
    depth = length(point);
    float right = length(camera.right), up = length(camera.up);
    vec2 angles = wide_angles(projection, point / max(depth, 1e-30), camera.right / right, camera.up / up, camera.forward);
    if (!wide_covers(projection, angles)) depth = 0.0;
    return (angles / vec2(right, up) * vec2(0.5, -0.5) + 0.5) * size;
  }
  vec3 axis = preview_axis(camera);
  depth = dot(point, axis);
  float ratio = is_parallel(projection) ? 1.0 : 1.0 / depth;
  point = ratio * point - (camera.forward - axis);
  vec2 q = vec2(dot(point, camera.right) / dot(camera.right, camera.right), dot(point, camera.up) / dot(camera.up, camera.up));
  return (q * vec2(0.5, -0.5) + 0.5) * size;
}
// Depth of a point where there is no surface.
const float k_preview_far = 1e8;

// Change of light by component, interpolated between the centres of blocks (film/preview_change.comp); 1 without blocks. Above
// k_preview_most_growth: beside a block with k_preview_other_light.
const float k_preview_other_light = 1e9;
vec4 preview_change(samplerBuffer ratios, uvec2 blocks, vec2 cell) {
  if (blocks.x == 0u) return vec4(1.0);
  vec2 p = (cell + 0.5) / float(k_preview_change_step) - 0.5;
  ivec2 last = ivec2(blocks) - 1, lo = clamp(ivec2(floor(p)), ivec2(0), last), hi = min(lo + 1, last);
  vec2 f = clamp(p - vec2(lo), 0.0, 1.0);
  int row = int(blocks.x);
  return mix(mix(texelFetch(ratios, lo.y * row + lo.x), texelFetch(ratios, lo.y * row + hi.x), f.x),
             mix(texelFetch(ratios, hi.y * row + lo.x), texelFetch(ratios, hi.y * row + hi.x), f.x), f.y);
}

// A shown colour of which that share is light from before the last edit, marked as such: in shades of one hue.
vec3 preview_tinted(vec3 shown, float share) {
  vec3 marked = k_preview_former_tint * mix(0.15, 1.0, luminance(shown));
  return mix(shown, marked, 0.7 * clamp(share, 0.0, 1.0));
}

// Divisor of light for filtering: the surface's colour, if there is a surface.
vec3 preview_modulation(PreviewSurface s) { return s.depth > 0.0 ? max(s.albedo, vec3(0.04)) : vec3(1.0); }

// Correlation of light with the colour of a surface, in luminance: `with_light`, product of the differences of both between
// adjacent pixels; `square` and `light_square`, squared differences of colour and of light; `few`, inverse number of averaged
// sums; `inverse`, mean inverse of preview_modulation().
struct PreviewTexture {
  vec3 inverse;
  float with_light, square, light_square, few;
};
PreviewTexture preview_texture(vec4 texel) {
  vec4 a = vec4(unpackHalf2x16(floatBitsToUint(texel.x)), unpackHalf2x16(floatBitsToUint(texel.y)));
  vec4 b = vec4(unpackHalf2x16(floatBitsToUint(texel.z)), unpackHalf2x16(floatBitsToUint(texel.w)));
  return PreviewTexture(a.xyz, a.w, b.x, b.y, b.z);
}
vec4 preview_texel(PreviewTexture t) { return preview_texel(vec4(t.inverse, t.with_light), vec4(t.square, t.light_square, t.few, 0.0)); }
PreviewTexture preview_sum(PreviewTexture a, PreviewTexture b, float weight) {
  return PreviewTexture(a.inverse + weight * b.inverse, a.with_light + weight * b.with_light, a.square + weight * b.square,
                        a.light_square + weight * b.light_square, a.few + square(weight) * b.few);
}
const PreviewTexture k_preview_no_texture = PreviewTexture(vec3(0.0), 0.0, 0.0, 0.0, 0.0);

// Whether two pixels show the same surface.
bool preview_same(PreviewSurface a, PreviewSurface b) {
  if (a.depth <= 0.0 || b.depth <= 0.0) return a.depth == b.depth;
  return abs(a.depth - b.depth) < 0.1 * a.depth && dot(a.normal, b.normal) > 0.7 && a.emits == b.emits;
}
// Likewise, with a pixel of the previous picture; true if either is unknown. False for newly visible surfaces.
bool preview_may_be_same(PreviewSurface now, PreviewSurface was) {
  return now.depth < 0.0 || was.depth < 0.0 || preview_same(now, was);
}

// Surface hit by a ray through a pixel's centre; depth below 0: unknown. `known`: k_preview_surface_* of `surfaces`.
PreviewSurface preview_centre(samplerBuffer surfaces, uint known, int pixel) {
  PreviewSurface s = preview_surface(texelFetch(surfaces, pixel));
  if (known != k_preview_surface_seen) s.depth = -1.0;
  return s;
}
// Whether the centre of an adjacent pixel shows an emitter. `surfaces`: hits of rays through the pixels' centres.
bool preview_beside_emitter(samplerBuffer surfaces, uvec2 size, uint pixel) {
  ivec2 xy = ivec2(pixel % size.x, pixel / size.x);
  bool beside = false;
  for (int k = 0; k < 9 && !beside; ++k) {
    ivec2 at = clamp(xy + ivec2(k % 3, k / 3) - 1, ivec2(0), ivec2(size) - 1);
    beside = preview_surface(texelFetch(surfaces, at.y * int(size.x) + at.x)).emits;
  }
  return beside;
}
// Whether the samples of a pixel show several surfaces, or a surface and the background: then its depth, normal and colour are
// means, and its light is a mixture. `centre`: surface hit by a ray through its centre; depth below 0: unknown. `primary`:
// luminance of the primary component, in units of white. `surfaces`: as for preview_beside_emitter.
const float k_preview_bright = 0.25, k_preview_facing = 0.95;
bool preview_mixed(PreviewSurface s, PreviewSurface centre, float primary, samplerBuffer surfaces, uvec2 size, uint pixel) {
  if (s.samples <= 0.0 || s.depth <= 0.0) return false;
  if (s.samples >= 2.0) {
    if (s.covered < 1.0) return true;
    if (centre.depth >= 0.0 && (!preview_same(s, centre) || dot(s.normal, centre.normal) < k_preview_facing)) return true;
  }
  if (centre.depth < 0.0) return false;
  return !s.emits && primary > k_preview_bright && preview_beside_emitter(surfaces, size, pixel);
}

// Similarity of two surfaces, 0..1: how well the light of one predicts the other's. `offset`: between their points; `scale`:
// tolerance of the distance from each other's plane [m]. Colours that differ by a factor of four count half: light over
// colour is not irradiance where the surface is glossy, and a dark mat next to a bright table would glow.
float preview_alike(PreviewSurface a, PreviewSurface b, vec3 offset, float scale) {
  if (a.depth < 0.0 || b.depth < 0.0) return 1.0;
  if (a.depth == 0.0 || b.depth == 0.0) return a.depth == b.depth ? 1.0 : 0.0;
  if (a.emits != b.emits) return 0.0;
  float facing = max(dot(a.normal, b.normal), 0.0);
  float off = max(abs(dot(a.normal, offset)), abs(dot(b.normal, offset))) / scale;
  float facing8 = square(square(square(facing)));
  float colours = 0.5 * log2(luminance(preview_modulation(a)) / luminance(preview_modulation(b)));
  return square(facing8) * exp2(-off * off - square(square(colours)));
}
#endif
