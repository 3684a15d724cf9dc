// The previous picture on surfaces that rays have found from another camera: each takes the light of the previous picture's
// pixels that show the same place. Unlike moved pixels (preview_scatter.comp), it has no holes between them, the borders of the
// surfaces, and their colours. Places that were not visible stay unknown.
#include "lib/invocation.glsl"
#include "film/preview.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PreviewFetchPush push; };
uniform samplerBuffer from_texels, from_surfaces, seen_surfaces;
layout(scalar) writeonly buffer Packed { vec4 packed[]; };
layout(scalar) writeonly buffer PackedSurfaces { vec4 packed_surfaces[]; };

const float k_off = 0.02;      // tolerance of the distance from a plane, over the depth: depths are means over a pixel
const float k_least = 0.02;    // least weight of pixels of the same place
const float k_negligible = 1e-4;
const int k_around = 2;        // pixels to search where there are none: pixels at borders show two surfaces

PreviewLight light;
float weights = 0.0;

// Adds a pixel of the previous picture, as far as it shows the surface `here` at `point`, from that picture's camera.
void add(PreviewSurface here, vec3 point, float far, ivec2 at, float weight) {
  ivec2 size = ivec2(push.width, push.height);
  if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) return;
  int pixel = at.y * size.x + at.x;
  PreviewSurface was = preview_surface(texelFetch(from_surfaces, pixel));
  // What a pane or a mirror shows of a place is no light of that place.
  if (was.depth < 0.0 || (preview_beyond(was) && preview_direct(here)) || (preview_direct(was) && preview_beyond(here))) return;
  // A film's picture does not say which surfaces emit.
  was.emits = here.emits;
  vec2 p = preview_position(uvec2(at), vec2(size));
  vec3 offset = preview_point(push.before, push.projections & 15u, p, was.depth) - point;
  float w = weight * preview_alike(here, was, offset, k_off * far);
  if (w < k_negligible) return;
  PreviewLight l = preview_light(from_texels, pixel);
  if (!preview_lit(l, was)) return;
  vec3 modulation = preview_modulation(was);
  for (uint c = 0u; c < k_component_count; ++c)
    light.of[c] += w * vec4(l.of[c].rgb / modulation, max(l.of[c].w, 0.0) / luminance(modulation));
  weights += w;
}

void main() {
  uint index = global_index();
  if (index >= push.across * push.down) return;
  uint projection_before = push.projections & 15u, projection_now = push.projections >> 4;
  vec4 texel = texelFetch(seen_surfaces, int(index));
  PreviewSurface here = preview_surface(texel);
  vec2 p = preview_position(uvec2(index % push.across, index / push.across), vec2(push.across, push.down));
  float far = here.depth > 0.0 ? here.depth : k_preview_far, depth;
  vec3 point = push.now.origin - push.before.origin + preview_point(push.now, projection_now, p, far);
  vec2 size = vec2(push.width, push.height), there = preview_projection(push.before, projection_before, point, size, depth) - 0.5;
  for (uint c = 0u; c < k_component_count; ++c) light.of[c] = vec4(0.0);
  bool visible = here.depth >= 0.0 && depth > 0.0 && all(greaterThan(there, vec2(-1.0))) && all(lessThan(there, size));
  ivec2 base = ivec2(floor(there));
  vec2 f = there - vec2(base);
  for (int k = 0; visible && k < 4; ++k) {
    ivec2 corner = ivec2(k & 1, k >> 1);
    vec2 g = mix(1.0 - f, f, vec2(corner));
    add(here, point, far, base + corner, g.x * g.y + 1e-3);
  }
  if (visible && weights <= k_least) {
    const int across = 2 * k_around + 1;
    for (int k = 0; k < across * across; ++k) {
      ivec2 at = ivec2(round(there)) + ivec2(k % across, k / across) - k_around;
      vec2 away = vec2(at) - there;
      add(here, point, far, at, exp2(-0.5 * dot(away, away)));
    }
  }
  vec3 m = preview_modulation(here);
  bool known = weights > k_least;
  float inverse = 1.0 / max(weights, 1e-20);
  for (uint c = 0u; c < k_component_count; ++c)
    light.of[c] = known ? light.of[c] * inverse * vec4(m, luminance(m)) : vec4(0.0, 0.0, 0.0, -1.0);
  LUCERNA_PREVIEW_STORE(packed, index, light)
  packed_surfaces[index] = known || push.keep != 0u ? vec4(texel.xyz, 0.0) : vec4(-1.0, 0.0, 0.0, 0.0);
}
