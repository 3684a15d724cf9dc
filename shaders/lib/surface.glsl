// Evaluates the surface at a hit: position, normals and material.
//
// Position and its error bound: interpolated with barycentrics recomputed here from ray and triangle, so that the image
// does not depend on which tracer found the primitive.
#ifndef LUCERNA_LIB_SURFACE
#define LUCERNA_LIB_SURFACE
#include "lib/variants.glsl"
#include "lib/frame.glsl"
#include "lib/bsdf.glsl"
#include "lib/media.glsl"

uniform samplerBuffer scene_triangles;
uniform samplerBuffer scene_vertices;
uniform samplerBuffer scene_materials;
#if LUCERNA_TANGENTS
uniform samplerBuffer scene_tangents;
#endif
#if LUCERNA_VERTEX_EXTRA
uniform samplerBuffer scene_extra;
#endif
#include "lib/textures.glsl"
#if LUCERNA_HEIGHTS
#include "lib/relief.glsl"
#endif

struct Surface {
  vec3 position;
  vec3 offset;       // |position - true position| is below this, componentwise; for robust ray origins
  vec3 normal_g;     // geometric, unit, front side (counter-clockwise; flipped instances mirrored)
  vec3 normal_s;     // shading, unit, on the front side's hemisphere
  vec3 normal_v;     // likewise, without the normal map
#if LUCERNA_CLEARCOAT
  vec3 normal_c;     // of the clear coat, likewise
#endif
#if LUCERNA_ANISOTROPY
  vec3 grain;        // direction in which a brushed surface reflects most widely; need not be in the tangent plane; 0: none
#endif
#if LUCERNA_PARALLAX
  Relief relief;
#endif
#if LUCERNA_DISPERSION
  uint wavelength;   // of light that passes (lib/dispersion.glsl); 0: all
  vec3 spectrum;     // colour of that light
#endif
  bool front;        // the ray came from the front
  uint material;
  uint flags;
  vec4 base;         // with texture and vertex colour; a: coverage
  vec3 emission;     // radiance of the front side (both sides if double-sided)
  vec2 uv0;
  SurfaceParameters parameters;
};

// Barycentrics (u, v) of a ray's intersection with a triangle that it hits: signed volumes as in the watertight test,
// clamped to the triangle.
vec2 barycentrics(vec3 o, vec3 d, vec3 p0, vec3 p1, vec3 p2) {
  vec3 a = p0 - o, b = p1 - o, c = p2 - o;
  float w0 = dot(d, cross(b, c)), w1 = dot(d, cross(c, a)), w2 = dot(d, cross(a, b));
  float s = w0 + w1 + w2;
  float sign_s = s < 0.0 ? -1.0 : 1.0;
  w0 = max(0.0, w0 * sign_s);
  w1 = max(0.0, w1 * sign_s);
  w2 = max(0.0, w2 * sign_s);
  s = w0 + w1 + w2;
  return s > 0.0 ? vec2(w1, w2) / s : vec2(1.0 / 3.0);
}

// Texture of a use, or `neutral` without one. `material`: first texel of the material; `buckets`: constant set of the
// texture arrays in which the scene keeps textures for this use.
vec4 read_use(int material, uint use, uint buckets, vec2 uv0, vec2 uv1, vec4 neutral) {
  int at = material + int(k_material_textures + k_texture_texels * use);
  vec4 rect = texelFetch(scene_materials, at);
  vec4 a = texelFetch(scene_materials, at + 1);
  uint bits = floatBitsToUint(a.x);
  vec2 uv = (bits & k_texture_uv1) != 0u ? uv1 : uv0;
#if LUCERNA_UV_TRANSFORMS
  vec4 m = texelFetch(scene_materials, at + 2);
  vec2 t = vec2(m.x * uv.x + m.y * uv.y + a.y, m.z * uv.x + m.w * uv.y + a.z);
#else
  vec2 t = uv;
#endif
  vec4 texel = texture_read(bits, buckets, rect, t);
  return (bits & k_texture_present) != 0u ? texel : neutral;
}

#if LUCERNA_TANGENTS
// The normal that a normal map says: `local` in the frame of tangent, bitangent and n.
vec3 mapped_normal(vec3 n, vec4 tangent, vec3 local) {
  vec3 bitangent = cross(n, tangent.xyz) * (tangent.w < 0.0 ? -1.0 : 1.0);
  vec3 mapped = local.x * tangent.xyz + local.y * bitangent + local.z * n;
  bool has_map = dot(tangent.xyz, tangent.xyz) > 1e-12 && dot(mapped, mapped) > 1e-12;
  return has_map ? normalize(mapped) : n;
}
#endif

Surface make_surface(Ray ray, Hit hit) {
  Surface s;
  uvec4 tri = floatBitsToUint(texelFetch(scene_triangles, int(hit.prim)));
  vec4 a0 = texelFetch(scene_vertices, int(2u * tri.x)), b0 = texelFetch(scene_vertices, int(2u * tri.x + 1u));
  vec4 a1 = texelFetch(scene_vertices, int(2u * tri.y)), b1 = texelFetch(scene_vertices, int(2u * tri.y + 1u));
  vec4 a2 = texelFetch(scene_vertices, int(2u * tri.z)), b2 = texelFetch(scene_vertices, int(2u * tri.z + 1u));
  vec2 uv = barycentrics(ray.origin, ray.direction, a0.xyz, a1.xyz, a2.xyz);
  float w = 1.0 - uv.x - uv.y;
  s.position = w * a0.xyz + uv.x * a1.xyz + uv.y * a2.xyz;
  // pbrt's bound for interpolation is gamma(7) of the summed magnitudes, component by component. The next ray's test of
  // this plane's triangles mixes the components (it shears them along the ray), with errors in proportion to the largest
  // distance from here to a vertex; a floor at height exactly 0 has no error of the first kind but all of the second.
  vec3 magnitude = abs(w * a0.xyz) + abs(uv.x * a1.xyz) + abs(uv.y * a2.xyz);
  vec3 extent = max(abs(a0.xyz - s.position), max(abs(a1.xyz - s.position), abs(a2.xyz - s.position)));
  s.offset = error_gamma(8.0) * magnitude + vec3(error_gamma(16.0) * max3(extent));
  bool flipped = (tri.w & k_triangle_flipped) != 0u;
  vec3 cross_n = cross(a1.xyz - a0.xyz, a2.xyz - a0.xyz);
  s.normal_g = normalize(cross_n / max(max3(abs(cross_n)), 1e-37));
  if (flipped) s.normal_g = -s.normal_g;
  s.front = dot(s.normal_g, ray.direction) < 0.0;
  vec3 n = w * b0.xyz + uv.x * b1.xyz + uv.y * b2.xyz;
  s.normal_s = dot(n, n) > 1e-12 ? normalize(n) : s.normal_g;
  s.normal_v = s.normal_s;
  s.uv0 = w * vec2(a0.w, b0.w) + uv.x * vec2(a1.w, b1.w) + uv.y * vec2(a2.w, b2.w);
  vec2 uv1 = vec2(0.0);
  s.material = tri.w & k_triangle_material_mask;
  int m = int(s.material * k_material_texels);
  vec4 base = texelFetch(scene_materials, m);
  vec4 emission = texelFetch(scene_materials, m + int(k_material_emission));
  vec4 surface = texelFetch(scene_materials, m + int(k_material_surface));
  vec4 specular = texelFetch(scene_materials, m + int(k_material_specular));
  s.flags = floatBitsToUint(emission.w);
#if LUCERNA_VERTEX_EXTRA
  vec4 color = w * texelFetch(scene_extra, int(2u * tri.x)) + uv.x * texelFetch(scene_extra, int(2u * tri.y)) +
               uv.y * texelFetch(scene_extra, int(2u * tri.z));
  uv1 = w * texelFetch(scene_extra, int(2u * tri.x + 1u)).xy + uv.x * texelFetch(scene_extra, int(2u * tri.y + 1u)).xy +
        uv.y * texelFetch(scene_extra, int(2u * tri.z + 1u)).xy;
  base *= color;
#endif
#if LUCERNA_HEIGHTS
  vec2 t0 = vec2(a0.w, b0.w), t1 = vec2(a1.w, b1.w), t2 = vec2(a2.w, b2.w), at = s.uv0;
#if LUCERNA_VERTEX_EXTRA
  uint height_bits = floatBitsToUint(texelFetch(scene_materials, m + int(k_material_textures + k_texture_texels * k_use_height + 1u)).x);
  if ((height_bits & k_texture_uv1) != 0u) {
    t0 = texelFetch(scene_extra, int(2u * tri.x + 1u)).xy;
    t1 = texelFetch(scene_extra, int(2u * tri.y + 1u)).xy;
    t2 = texelFetch(scene_extra, int(2u * tri.z + 1u)).xy;
    at = uv1;
  }
#endif
  Relief relief = make_relief(m, a0.xyz, a1.xyz, a2.xyz, t0, t1, t2, at);
#if LUCERNA_PARALLAX
  relief.deep = relief.deep && s.front;
  relief.inside = uv;
  if (relief.deep) {
    relief_meet(relief, ray.direction, s.normal_g);
    // All textures are read where the ray meets the relief.
    vec2 by = vec2(dot(relief.across_1, relief.shift), dot(relief.across_2, relief.shift));
    s.uv0 += by.x * vec2(a1.w - a0.w, b1.w - b0.w) + by.y * vec2(a2.w - a0.w, b2.w - b0.w);
#if LUCERNA_VERTEX_EXTRA
    vec2 v0 = texelFetch(scene_extra, int(2u * tri.x + 1u)).xy;
    uv1 += by.x * (texelFetch(scene_extra, int(2u * tri.y + 1u)).xy - v0) + by.y * (texelFetch(scene_extra, int(2u * tri.z + 1u)).xy - v0);
#endif
  }
  s.relief = relief;
#endif
#endif
#if LUCERNA_TEX_BASE
  base *= read_use(m, k_use_base, LUCERNA_BASE_BUCKETS, s.uv0, uv1, vec4(1.0));
#endif
#if LUCERNA_TEX_METALLIC_ROUGHNESS
  vec4 mr = read_use(m, k_use_metallic_roughness, LUCERNA_METALLIC_ROUGHNESS_BUCKETS, s.uv0, uv1, vec4(1.0));
  surface.xy *= mr.zy;
#endif
#if LUCERNA_TANGENTS
  vec4 t = w * texelFetch(scene_tangents, int(tri.x)) + uv.x * texelFetch(scene_tangents, int(tri.y)) +
           uv.y * texelFetch(scene_tangents, int(tri.z));
#endif
#if LUCERNA_CLEARCOAT
  s.normal_c = s.normal_v;
#if LUCERNA_CLEARCOAT_NORMALS && LUCERNA_TANGENTS
  vec3 coat_map = 2.0 * read_use(m, k_use_clearcoat_normal, LUCERNA_CLEARCOAT_NORMAL_BUCKETS, s.uv0, uv1, vec4(0.5, 0.5, 1.0, 1.0)).xyz - 1.0;
  coat_map.xy *= texelFetch(scene_materials, m + int(k_material_coat)).z;
  s.normal_c = mapped_normal(s.normal_v, t, coat_map);
#endif
#endif
#if LUCERNA_NORMAL_MAPS && LUCERNA_TANGENTS
  vec4 detail = texelFetch(scene_materials, m + int(k_material_detail));
  vec3 local = 2.0 * read_use(m, k_use_normal, LUCERNA_NORMAL_BUCKETS, s.uv0, uv1, vec4(0.5, 0.5, 1.0, 1.0)).xyz - 1.0;
  local.xy *= detail.x;
  s.normal_s = mapped_normal(s.normal_s, t, local);
#endif
#if LUCERNA_HEIGHTS
  if (relief.height != 0.0) {
    s.normal_s = relief_normal(relief, s.normal_s);
#if LUCERNA_CLEARCOAT
    s.normal_c = relief_normal(relief, s.normal_c);
#endif
  }
#endif
#if LUCERNA_TEX_EMISSION
  emission.rgb *= read_use(m, k_use_emission, LUCERNA_EMISSION_BUCKETS, s.uv0, uv1, vec4(1.0)).rgb;
#endif
#if LUCERNA_TEX_SPECULAR
  surface.w *= read_use(m, k_use_specular, LUCERNA_SPECULAR_BUCKETS, s.uv0, uv1, vec4(1.0)).a;
  specular.rgb *= read_use(m, k_use_specular_color, LUCERNA_SPECULAR_COLOR_BUCKETS, s.uv0, uv1, vec4(1.0)).rgb;
#endif
#if LUCERNA_TEX_TRANSMISSION
  specular.w *= read_use(m, k_use_transmission, LUCERNA_TRANSMISSION_BUCKETS, s.uv0, uv1, vec4(1.0)).r;
#endif
  s.base = base;
  s.emission = emission.rgb;
  SurfaceParameters p;
  p.base = clamp(base.rgb, vec3(0.0), vec3(1.0));
  p.metallic = clamp(surface.x, 0.0, 1.0);
  p.roughness = clamp(surface.y, 0.0, 1.0);
  p.ior = surface.z;
  p.specular = clamp(surface.w, 0.0, 1.0);
  p.specular_color = specular.rgb;
  p.transmission = clamp(specular.w, 0.0, 1.0);
  p.diffuse_transmission = 0.0;
  p.diffuse_transmission_color = vec3(0.0);
#if LUCERNA_DIFFUSE_TRANSMISSION
  vec4 dt = texelFetch(scene_materials, m + int(k_material_diffuse_t));
#if LUCERNA_TEX_DIFFUSE_TRANSMISSION
  dt.w *= read_use(m, k_use_diffuse_t, LUCERNA_DIFFUSE_T_BUCKETS, s.uv0, uv1, vec4(1.0)).a;
  dt.rgb *= read_use(m, k_use_diffuse_t_color, LUCERNA_DIFFUSE_T_COLOR_BUCKETS, s.uv0, uv1, vec4(1.0)).rgb;
#endif
  p.diffuse_transmission = clamp(dt.w, 0.0, 1.0);
  p.diffuse_transmission_color = clamp(dt.rgb, vec3(0.0), vec3(1.0));
#endif
#if LUCERNA_CLEARCOAT
  vec4 coat = texelFetch(scene_materials, m + int(k_material_coat));
#if LUCERNA_TEX_CLEARCOAT
  coat.x *= read_use(m, k_use_clearcoat, LUCERNA_CLEARCOAT_BUCKETS, s.uv0, uv1, vec4(1.0)).r;
  coat.y *= read_use(m, k_use_clearcoat_roughness, LUCERNA_CLEARCOAT_ROUGHNESS_BUCKETS, s.uv0, uv1, vec4(1.0)).g;
#endif
  bool coated = (s.flags & k_flag_solid) == 0u || s.front;
  p.clearcoat = coated ? clamp(coat.x, 0.0, 1.0) : 0.0;
  p.clearcoat_roughness = clamp(coat.y, 0.0, 1.0);
  p.clearcoat_normal = vec3(0.0, 0.0, 1.0);
#endif
#if LUCERNA_SHEEN
  vec4 sheen = texelFetch(scene_materials, m + int(k_material_sheen));
#if LUCERNA_TEX_SHEEN
  sheen.rgb *= read_use(m, k_use_sheen_color, LUCERNA_SHEEN_COLOR_BUCKETS, s.uv0, uv1, vec4(1.0)).rgb;
  sheen.w *= read_use(m, k_use_sheen_roughness, LUCERNA_SHEEN_ROUGHNESS_BUCKETS, s.uv0, uv1, vec4(1.0)).a;
#endif
  p.sheen = clamp(sheen.rgb, vec3(0.0), vec3(1.0));
  p.sheen_roughness = clamp(sheen.w, 0.0, 1.0);
#endif
#if LUCERNA_ANISOTROPY
  vec4 grain = texelFetch(scene_materials, m + int(k_material_grain));
  vec2 turn = grain.yz;
#if LUCERNA_TEX_ANISOTROPY
  vec3 brushing = read_use(m, k_use_anisotropy, LUCERNA_ANISOTROPY_BUCKETS, s.uv0, uv1, vec4(1.0, 0.5, 1.0, 1.0)).rgb;
  vec2 brushed = 2.0 * brushing.xy - 1.0;
  turn = vec2(turn.x * brushed.x - turn.y * brushed.y, turn.y * brushed.x + turn.x * brushed.y);
  grain.x *= brushing.z;
#endif
  p.anisotropy = clamp(grain.x, 0.0, 1.0);
  p.grain = vec2(1.0, 0.0);
  s.grain = vec3(0.0);
  vec3 along = vec3(0.0);
  float handed = 1.0;
#if LUCERNA_TANGENTS
  along = t.xyz;
  handed = t.w < 0.0 ? -1.0 : 1.0;
#endif
  if (dot(along, along) < 1e-12) {
    // A surface that got its brushing by an edit has no tangents: along u on this triangle.
    vec2 d1 = vec2(a1.w - a0.w, b1.w - b0.w), d2 = vec2(a2.w - a0.w, b2.w - b0.w);
    along = (a1.xyz - a0.xyz) * d2.y - (a2.xyz - a0.xyz) * d1.y;
    float area = d1.x * d2.y - d1.y * d2.x;
    along = area != 0.0 && dot(along, along) > 0.0 ? normalize(along) * sign(area) : vec3(0.0);
  }
  s.grain = turn.x * along + turn.y * handed * cross(s.normal_v, along);
#endif
#if LUCERNA_IRIDESCENCE
  vec4 film = texelFetch(scene_materials, m + int(k_material_film));
  float thick = 1.0;
#if LUCERNA_TEX_IRIDESCENCE
  film.x *= read_use(m, k_use_iridescence, LUCERNA_IRIDESCENCE_BUCKETS, s.uv0, uv1, vec4(1.0)).r;
  thick = read_use(m, k_use_iridescence_thickness, LUCERNA_IRIDESCENCE_THICKNESS_BUCKETS, s.uv0, uv1, vec4(1.0)).g;
#endif
  p.film_thickness = mix(film.z, film.w, thick);
  // No thickness, no film.
  p.film = p.film_thickness > 0.0 ? clamp(film.x, 0.0, 1.0) : 0.0;
  p.film_ior = film.y;
#endif
#if LUCERNA_ROUGH_DIFFUSE
  p.diffuse_roughness = texelFetch(scene_materials, m + int(k_material_grain)).w;
#if LUCERNA_TEX_DIFFUSE_ROUGHNESS
  p.diffuse_roughness *= read_use(m, k_use_diffuse_roughness, LUCERNA_DIFFUSE_ROUGHNESS_BUCKETS, s.uv0, uv1, vec4(1.0)).r;
#endif
  p.diffuse_roughness = clamp(p.diffuse_roughness, 0.0, 1.0);
#endif
  p.solid = (s.flags & k_flag_solid) != 0u;
  p.inside = p.solid && !s.front;
#if LUCERNA_DISPERSION
  s.wavelength = 0u;
  s.spectrum = vec3(1.0);
#endif
  p.glass_row = int(texelFetch(scene_materials, m + int(k_material_volume)).w);
  s.parameters = p;
  return s;
}

// A shadow catcher, which only paths see that come from the eye without a diffuse reflection.
bool is_catcher(Surface s) {
#if LUCERNA_CATCHER
  return (s.flags & k_flag_catcher) != 0u;
#else
  return false;
#endif
}

// Probability that the surface is there: alpha mask and blend.
float surface_coverage(Surface s) {
#if LUCERNA_ALPHA
  float cutoff = texelFetch(scene_materials, int(s.material * k_material_texels + k_material_detail)).y;
  float a = clamp(s.base.a, 0.0, 1.0);
  if ((s.flags & k_flag_mask) != 0u) return a >= cutoff ? 1.0 : 0.0;
  if ((s.flags & k_flag_blend) != 0u) return a;
#endif
  return 1.0;
}

// A normal on wo's side: it agrees with the geometric side, and wo keeps a positive cosine.
vec3 facing_normal(Surface s, vec3 wo, vec3 normal) {
  vec3 ng = s.front ? s.normal_g : -s.normal_g;
  vec3 n = dot(normal, ng) < 0.0 ? -normal : normal;
  // A normal turned away from the viewer is bent back to a grazing angle (cosine 0.01), the smallest change that
  // keeps the lobes defined.
  const float least = 0.01;
  float c = dot(n, wo);
  if (c < least) {
    vec3 side = n - c * wo;
    float l2 = dot(side, side);
    n = l2 > 1e-12 ? normalize(least * wo + sqrt(1.0 - least * least) * side * inversesqrt(l2)) : ng;
    if (dot(n, wo) < 1e-4) n = wo;
  }
  return n;
}

// A shading frame with that normal as z.
mat3 shading_frame(Surface s, vec3 wo) {
  vec3 n = facing_normal(s, wo, s.normal_s);
  vec3 t, b;
  make_basis(n, t, b);
  return mat3(t, b, n);
}

// The surface's BSDF for light that leaves along wo_world; `to_world`: its shading frame there.
Bsdf surface_bsdf(Surface s, mat3 to_world, vec3 wo_world) {
  SurfaceParameters p = s.parameters;
#if LUCERNA_CLEARCOAT
  p.clearcoat_normal = facing_normal(s, wo_world, s.normal_c) * to_world;  // transposed
#endif
#if LUCERNA_ANISOTROPY
  vec2 grain = (s.grain * to_world).xy;
  float l2 = dot(grain, grain);
  if (l2 > 1e-12) p.grain = grain * inversesqrt(l2);
#endif
  return make_bsdf(p, wo_world * to_world);
}

// Radiance of a diffuse lobe from flux F that arrived from wi on an area dA of a facet with normal n_g, while eye paths
// weight light by the shading normal: L_i dw = F / (dA |wi.n_g|), so L = f_D |wi.n_s| / |wi.n_g| F / dA; returned without F
// / dA. `to_world`: shading frame on the viewer's side; `reflected`: wi is on that side.
vec3 diffuse_of_flux(Bsdf bsdf, mat3 to_world, vec3 normal_g, vec3 wi_world, bool reflected) {
  vec3 wi = wi_world * to_world;
  vec3 f = bsdf_diffuse(bsdf, wi);
  return reflected == (wi.z > 0.0) ? f / max(abs(dot(wi_world, normal_g)), 1e-4) : vec3(0.0);
}

// Origin of a ray that leaves along `direction`: moved off the surface, to that side, by the error bound.
vec3 offset_origin(Surface s, vec3 direction) {
  vec3 n = dot(direction, s.normal_g) < 0.0 ? -s.normal_g : s.normal_g;
  float d = dot(abs(n), s.offset);
  vec3 moved = s.position + n * d;
  // Round away from the surface.
  ivec3 bits = floatBitsToInt(moved) + ivec3(sign(n)) * (1 - 2 * ivec3(lessThan(moved, vec3(0.0))));
  bvec3 tiny = lessThan(abs(moved), vec3(1e-30));
  return mix(intBitsToFloat(bits), moved, tiny);
}

// Whether relief hides the point from that direction.
bool hidden_by_relief(Surface s, vec3 direction) {
#if LUCERNA_PARALLAX
  vec3 met;
  return dot(direction, s.normal_g) > 0.0 && relief_hides(s.relief, direction, s.normal_g, met);
#else
  return false;
#endif
}

// Whether a path that is reflected or transmitted may leave that way: transmitted, below the surface; reflected, above it, or
// within its relief.
bool can_leave(Surface s, vec3 side, vec3 direction, bool transmitted) {
#if LUCERNA_PARALLAX
  if (s.relief.deep && !transmitted) return true;
#endif
  return (dot(direction, side) > 0.0) == !transmitted;
}

// Origin of its next ray. If relief hides the point from there, the path goes on straight down onto the place that hides it,
// or onto where it has met the surface if that place is beyond the triangle.
vec3 next_origin(Surface s, bool transmitted, inout vec3 direction) {
#if LUCERNA_PARALLAX
  vec3 met;
  if (!transmitted && relief_hides(s.relief, direction, s.normal_g, met)) {
    direction = -s.normal_g;
    met += s.relief.shift;
    vec2 inside = s.relief.inside + vec2(dot(s.relief.across_1, met), dot(s.relief.across_2, met));
    if (inside.x >= 0.0 && inside.y >= 0.0 && inside.x + inside.y <= 1.0) s.position += met;
    return offset_origin(s, s.normal_g);
  }
#endif
  return offset_origin(s, direction);
}

#if LUCERNA_VOLUMES
// Media behind the surface, for a ray that passes it.
uint media_behind(Surface s, uint stack) {
  uint medium = uint(texelFetch(scene_materials, int(s.material * k_material_texels + k_material_detail)).z);
  if (medium == 0u) return stack;
  return s.front ? media_enter(stack, medium) : media_leave(stack, medium);
}
#endif

#endif
