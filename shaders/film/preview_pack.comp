// Pixels of the preview from the film: means, their noise from the two halves of the samples, surfaces.
#include "lib/film.glsl"
#include "lib/invocation.glsl"
#include "film/preview.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PreviewPackPush push; };
layout(scalar) writeonly buffer Packed { vec4 packed[]; };
layout(scalar) writeonly buffer PackedSurfaces { vec4 packed_surfaces[]; };
layout(scalar) writeonly buffer PackedSums { vec2 packed_sums[]; };  // sum of the shown luminance, number of samples
uniform samplerBuffer guide_surfaces;

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  uint count = film_count[pixel];
  float n = float(max(count, 1u)), even = float(max((count + 1u) / 2u, 1u)), odd = float(max(count / 2u, 1u));
  PreviewLight light;
  FilmRatio ratio = film_ratio(pixel);
  float shown = 0.0;
  for (uint c = 0u; c < k_component_count; ++c) {
    FilmPixel p = film_load(c, pixel, ratio);
    vec3 a = p.even.sum + p.even.compensation, b = p.odd.sum + p.odd.compensation;
    float noise = count < 2u ? -1.0 : 0.5 * abs(luminance(a) / even - luminance(b) / odd);
    light.of[c] = push.exposure * vec4((a + b) / n, push.noise * noise);
    if (count < 2u) light.of[c].w = -1.0;
    if ((push.show >> c & 1u) != 0u) shown += push.exposure * luminance(a + b);
  }
  packed_sums[pixel] = vec2(shown, float(count));
  LUCERNA_PREVIEW_STORE(packed, pixel, light)
  vec4 albedo = texelFetch(film_albedo, int(pixel)), normal = texelFetch(film_normal, int(pixel));
  PreviewSurface s;
  s.depth = albedo.w > 0.0 ? normal.w / albedo.w : 0.0;
  s.normal = normal.xyz / max(length(normal.xyz), 1e-20);
  s.albedo = albedo.xyz / max(albedo.w, 1.0);
  s.samples = float(count);
  s.covered = albedo.w > 0.0 ? albedo.w / n : 1.0;
  vec4 guide = push.guided != 0u ? texelFetch(guide_surfaces, int(pixel)) : vec4(-1.0, 0.0, 0.0, 0.0);
  PreviewSurface seen = preview_surface(guide);
  bool beyond = push.guided != 0u && seen.samples == k_preview_beyond;
  s.emits = push.guided != 0u && seen.emits;
  // Samples have hit the mirror or the glass.
  if (beyond) {
    float samples = s.samples;
    s = seen;
    s.samples = samples;
  }
  // As in preview_resolve.comp.
  if (push.taken != 0u && push.guided != 0u && seen.samples < 0.0 && count > 1u) s.samples = seen.samples;
  vec4 texel = count > 0u ? preview_texel(s) : vec4(guide.xyz, 0.0);
  packed_surfaces[pixel] = texel;
}
