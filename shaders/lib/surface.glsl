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
#if LUCERNA_NORMAL_MAPS
uniform samplerBuffer scene_tangents;
#endif
#if LUCERNA_VERTEX_EXTRA
uniform samplerBuffer scene_extra;
#endif
#include "lib/textures.glsl"

struct Surface {
  vec3 position;
  vec3 offset;       // |position - true position| is below this, componentwise; for robust ray origins
  vec3 normal_g;     // geometric, unit, front side (counter-clockwise; flipped instances mirrored)
  vec3 normal_s;     // shading, unit, on the front side's hemisphere
  vec3 normal_v;     // as normal_s, without the normal map
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
#if LUCERNA_TEX_BASE
  base *= read_use(m, k_use_base, LUCERNA_BASE_BUCKETS, s.uv0, uv1, vec4(1.0));
#endif
#if LUCERNA_TEX_METALLIC_ROUGHNESS
  vec4 mr = read_use(m, k_use_metallic_roughness, LUCERNA_METALLIC_ROUGHNESS_BUCKETS, s.uv0, uv1, vec4(1.0));
  surface.xy *= mr.zy;
#endif
#if LUCERNA_NORMAL_MAPS
  vec4 t = w * texelFetch(scene_tangents, int(tri.x)) + uv.x * texelFetch(scene_tangents, int(tri.y)) +
           uv.y * texelFetch(scene_tangents, int(tri.z));
  vec4 detail = texelFetch(scene_materials, m + int(k_material_detail));
  vec3 local = 2.0 * read_use(m, k_use_normal, LUCERNA_NORMAL_BUCKETS, s.uv0, uv1, vec4(0.5, 0.5, 1.0, 1.0)).xyz - 1.0;
  local.xy *= detail.x;
  vec3 bitangent = cross(s.normal_s, t.xyz) * (t.w < 0.0 ? -1.0 : 1.0);
  vec3 mapped = local.x * t.xyz + local.y * bitangent + local.z * s.normal_s;
  bool has_map = dot(t.xyz, t.xyz) > 1e-12 && dot(mapped, mapped) > 1e-12;
  s.normal_s = has_map ? normalize(mapped) : s.normal_s;
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
  p.solid = (s.flags & k_flag_solid) != 0u;
  p.inside = p.solid && !s.front;
  p.glass_row = int(texelFetch(scene_materials, m + int(k_material_volume)).w);
  s.parameters = p;
  return s;
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

// A shading frame on wo's side: z agrees with the geometric side, and wo keeps a positive cosine.
mat3 shading_frame(Surface s, vec3 wo) {
  vec3 ng = s.front ? s.normal_g : -s.normal_g;
  vec3 n = dot(s.normal_s, ng) < 0.0 ? -s.normal_s : s.normal_s;
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
  vec3 t, b;
  make_basis(n, t, b);
  return mat3(t, b, n);
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

#if LUCERNA_VOLUMES
// Media behind the surface, for a ray that passes it.
uint media_behind(Surface s, uint stack) {
  uint medium = uint(texelFetch(scene_materials, int(s.material * k_material_texels + k_material_detail)).z);
  if (medium == 0u) return stack;
  return s.front ? media_enter(stack, medium) : media_leave(stack, medium);
}
#endif

#endif
