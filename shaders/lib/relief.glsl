// Relief by a height texture, in metres from black to white along the front normal.
//
// Shallow relief turns the shading normal (J. F. Blinn, "Simulation of Wrinkled Surfaces", 1978; surface gradient as in
// M. Mikkelsen, "Bump Mapping Unparametrized Surfaces on the GPU", 2010). Deep relief (LUCERNA_PARALLAX) lies below the
// surface, white on it: rays from the front are followed down to it, so that it hides and shadows itself (parallax occlusion
// mapping: N. Tatarchuk, "Dynamic Parallax Occlusion Mapping with Approximate Soft Shadows", 2006). Its geometry ends at the
// surface: outlines stay straight, and what lies on the surface touches its plane.
//
// Every path that meets deep relief sees it: of the eye and of lights. A ray that leaves a point of it and meets relief again
// starts once more straight above the place it has met; only the direction from which that place is seen is not kept. So
// paths agree with real geometry. Light between slopes reaches the whole relief if photons carry it, and records hold that of
// the flat surface: on deep joints in low sun, photons were 4 to 8 % above paths and records 1 to 4 % below.
#ifndef LUCERNA_LIB_RELIEF
#define LUCERNA_LIB_RELIEF

struct Relief {
  float height;        // metres; 0: none here
  vec3 across_1, across_2;  // gradients of the second and third vertex's barycentric coordinate in the triangle's plane [1/m]
  vec3 gradient_x, gradient_y;  // of the height texture's coordinates [1/m]
  vec2 at;             // these coordinates
  vec2 texel;          // size of a texel in them
  vec4 rect;           // of the texture on its page
  uint bits;
#if LUCERNA_PARALLAX
  bool deep;
  float depth;         // of this point below the surface [m]
  vec3 shift;          // from where the ray has met the surface to straight above this point, along the surface [m]
  vec2 inside;         // barycentric coordinates where the ray has met it
#endif
};

float relief_height(Relief r, vec2 at) { return texture_read(r.bits, LUCERNA_HEIGHT_BUCKETS, r.rect, at).r; }

// `material`: its first texel; corners and texture coordinates of the triangle; `uv`: at the point.
Relief make_relief(int material, vec3 p0, vec3 p1, vec3 p2, vec2 t0, vec2 t1, vec2 t2, vec2 uv) {
  Relief r;
  int use = material + int(k_material_textures + k_texture_texels * k_use_height);
  vec4 values = texelFetch(scene_materials, material + int(k_material_relief)), bits = texelFetch(scene_materials, use + 1);
  r.rect = texelFetch(scene_materials, use);
  r.bits = floatBitsToUint(bits.x);
  r.texel = values.zw;
#if LUCERNA_UV_TRANSFORMS
  vec4 m = texelFetch(scene_materials, use + 2);
  mat2 turn = mat2(m.x, m.z, m.y, m.w);
  r.at = turn * uv + bits.yz;
  vec2 d1 = turn * (t1 - t0), d2 = turn * (t2 - t0);
#else
  r.at = uv;
  vec2 d1 = t1 - t0, d2 = t2 - t0;
#endif
  vec3 e1 = p1 - p0, e2 = p2 - p0, n = cross(e1, e2);
  float n2 = max(dot(n, n), 1e-37);
  r.across_1 = cross(e2, n) / n2;
  r.across_2 = cross(n, e1) / n2;
  r.gradient_x = d1.x * r.across_1 + d2.x * r.across_2;
  r.gradient_y = d1.y * r.across_1 + d2.y * r.across_2;
  // Without a direction of the coordinates there is no slope.
  bool mapped = dot(r.gradient_x, r.gradient_x) > 0.0 && dot(r.gradient_y, r.gradient_y) > 0.0;
  r.height = (r.bits & k_texture_present) != 0u && mapped ? values.x : 0.0;
#if LUCERNA_PARALLAX
  r.deep = r.height > 0.0 && values.y > 0.0;
  r.depth = 0.0;
  r.shift = vec3(0.0);
#endif
  return r;
}

// `normal`, which belongs to the smooth surface, turned by the relief's slope: central differences over two texels.
vec3 relief_normal(Relief r, vec3 normal) {
  vec2 x = vec2(r.texel.x, 0.0), y = vec2(0.0, r.texel.y);
  float dx = (relief_height(r, r.at + x) - relief_height(r, r.at - x)) / (2.0 * r.texel.x);
  float dy = (relief_height(r, r.at + y) - relief_height(r, r.at - y)) / (2.0 * r.texel.y);
  vec3 slope = r.height * (r.gradient_x * dx + r.gradient_y * dy);
  vec3 turned = normal - (slope - dot(slope, normal) * normal);
  return dot(turned, turned) > 0.0 ? normalize(turned) : normal;
}

#if LUCERNA_PARALLAX
const float k_least_relief_cosine = 0.05;  // directions closer to the surface go this steeply
const uint k_fewest_relief_steps = 8u, k_most_relief_steps = 96u;
const float k_relief_gap = 0.004;  // of the height: relief does not shadow itself within it

// Steps that pass about a texel each, over a distance in texture coordinates.
uint relief_steps(Relief r, vec2 distance) {
  vec2 texels = abs(distance) / r.texel;
  return clamp(uint(min(max(texels.x, texels.y), 1e4)), k_fewest_relief_steps, k_most_relief_steps);
}
// Distance along the surface for each metre of height.
vec3 relief_aside(vec3 direction, vec3 normal) {
  float c = dot(direction, normal);
  return (direction - c * normal) / max(abs(c), k_least_relief_cosine);
}
vec2 relief_coordinates(Relief r, vec3 along) { return vec2(dot(r.gradient_x, along), dot(r.gradient_y, along)); }

// Follows a ray from the front down to the relief. `normal`: of the surface, towards the ray.
void relief_meet(inout Relief r, vec3 direction, vec3 normal) {
  vec3 aside = relief_aside(direction, normal);
  vec2 slope = relief_coordinates(r, aside);
  uint steps = relief_steps(r, slope * r.height);
  float dz = r.height / float(steps), low = 0.0, high = 0.0;
  for (uint i = 0u; i <= steps; ++i) {
    high = float(i) * dz;
    if (high >= r.height * (1.0 - relief_height(r, r.at + slope * high))) break;
    low = high;
  }
  for (uint i = 0u; i < 6u; ++i) {
    float middle = 0.5 * (low + high);
    if (middle >= r.height * (1.0 - relief_height(r, r.at + slope * middle))) high = middle; else low = middle;
  }
  r.depth = high;
  r.shift = aside * high;
  r.at += slope * high;
}

// Whether the relief hides its point from that direction, which may point below the surface: then it does. `met`: along the
// surface to straight above the place that hides it [m].
bool relief_hides(Relief r, vec3 direction, vec3 normal, out vec3 met) {
  met = vec3(0.0);
  float gap = k_relief_gap * r.height;
  bool rises = dot(direction, normal) > 0.0;
  if (!r.deep || (rises && r.depth <= gap)) return false;
  vec3 aside = relief_aside(direction, normal);
  vec2 slope = relief_coordinates(r, aside);
  float way = rises ? r.depth : r.height - r.depth;
  uint steps = relief_steps(r, slope * way);
  float step = way / float(steps);
  for (uint i = 1u; i < steps; ++i) {
    float gone = float(i) * step, depth = r.depth + (rises ? -gone : gone);
    if (r.height * (1.0 - relief_height(r, r.at + slope * gone)) < depth - gap) {
      met = aside * gone;
      return true;
    }
  }
  if (!rises) met = aside * way;
  return !rises;
}
#endif
#endif
