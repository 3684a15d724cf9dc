// Draws the records over the picture, where the surfaces that the camera sees are: each as the disc of its validity with
// a mark at its centre, and how many serve a pixel as a heat map. The place on the surface comes from the film's depth, so
// that what is hidden stays hidden.
#include "lib/frame.glsl"
#include "lib/film.glsl"
#include "lib/invocation.glsl"
#include "irradiance_cache/lookup.glsl"
#include "shaders/shared/ramp.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { OverlayPush push; };
layout(scalar) buffer Picture { uint picture[]; };

// Distinct hues of even lightness, one a pass or an origin (OKLab: lightness 0.8, chroma 0.13).
vec3 hue(uint index) {
  float angle = 0.9 + 2.399963 * float(index);  // the golden angle: neighbours stay apart
  vec2 ab = 0.13 * vec2(cos(angle), sin(angle));
  vec3 lms = vec3(0.8 + 0.3963377774 * ab.x + 0.2158037573 * ab.y, 0.8 - 0.1055613458 * ab.x - 0.0638541728 * ab.y,
                  0.8 - 0.0894841775 * ab.x - 1.2914855480 * ab.y);
  lms = lms * lms * lms;
  vec3 linear = vec3(dot(lms, vec3(4.0767416621, -3.3077115913, 0.2309699292)),
                     dot(lms, vec3(-1.2684380046, 2.6097574011, -0.3413193965)),
                     dot(lms, vec3(-0.0041960863, -0.7034186147, 1.7076147010)));
  return sqrt(clamp(linear, vec3(0.0), vec3(1.0)));
}

vec3 ink_of(uint record) {
  vec4 told = texelFetch(record_texels, int(record * k_record_texels + 2u));
  uint flags = floatBitsToUint(told.w);
  if (push.color == k_record_by_pass) return hue(flags & k_record_pass);
  if (push.color == k_record_by_origin) return hue((flags >> k_record_origin_shift) & 3u);
  float value = told.z;
  if (push.color == k_record_by_rays) value = float(floatBitsToUint(told.x));
  if (push.color == k_record_by_distance) value = texelFetch(record_texels, int(record * k_record_texels + 1u)).w;
  return ramp_color(k_ramp_viridis, ramp_position(value, push.lo, push.hi, 1u));
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  vec4 albedo = texelFetch(film_albedo, int(pixel)), seen = texelFetch(film_normal, int(pixel));
  float hits = albedo.w;
  // Where most samples of a pixel met nothing there is no place.
  bool solid = hits > 0.5 * float(film_count[pixel]) && hits > 0.0;
  float depth = seen.w / max(hits, 1.0);
  vec2 xy = vec2(pixel % push.width, pixel / push.width) + 0.5;
  vec2 ndc = xy / vec2(push.width, push.height) * 2.0 - 1.0;
  vec3 shift = ndc.x * frame.camera_right - ndc.y * frame.camera_up;
  vec3 x = frame.orthographic != 0u ? frame.camera_origin + shift + depth * frame.camera_forward
                                    : frame.camera_origin + depth * (frame.camera_forward + shift);
  float size = 2.0 * length(frame.camera_up) / float(push.height) * (frame.orthographic != 0u ? 1.0 : depth);
  vec3 n = dot(seen.xyz, seen.xyz) > 0.0 ? normalize(seen.xyz) : -frame.camera_forward;

  uint overlap = 0u;
  vec4 over = vec4(0.0);  // premultiplied
  OctreeRange range = cache_range(x, solid);
  for (uint i = range.first; i < range.last; ++i) {
    uint record = octree_sphere(i);
    int at = int(record * k_record_texels);
    vec4 place = texelFetch(record_texels, at), facing = texelFetch(record_texels, at + 1);
    vec3 away = x - place.xyz;
    // Discs follow the surface where it is curved, and a pixel's depth is a mean over its samples: off the plane too.
    bool on_it = abs(dot(away, facing.xyz)) < 2.0 * size + 0.15 * place.w && dot(n, facing.xyz) > 0.7;
    overlap += record_weight(x, n, place, facing) > 0.0 ? 1u : 0u;
    float from = length(away);
    vec3 ink = ink_of(record);
    float rim = clamp(1.25 - abs(place.w - 0.5 * size - from) / size, 0.0, 1.0) * 0.8;
    float dot_ = clamp(2.0 - from / size, 0.0, 1.0);
    float inside = from < place.w ? 0.06 : 0.0;
    float alpha = on_it && push.discs != 0u ? max(max(rim, dot_), inside) : 0.0;
    over += (1.0 - over.a) * vec4(ink * alpha, alpha);
  }
  uint packed = picture[pixel];
  vec3 color = vec3(packed & 0xffu, packed >> 8 & 0xffu, packed >> 16 & 0xffu) / 255.0;
  if (push.overlap != 0u && solid) {
    // One colour a count up to the scale's end, none served in red.
    vec3 ink = overlap == 0u ? vec3(0.75, 0.12, 0.16) : ramp_color(k_ramp_viridis, float(overlap) / push.overlap_most);
    color = mix(color, ink, 0.8);
  }
  color = color * (1.0 - over.a) + over.rgb;
  uvec3 bytes = uvec3(clamp(color, vec3(0.0), vec3(1.0)) * 255.0 + 0.5);
  picture[pixel] = bytes.x | bytes.y << 8 | bytes.z << 16 | 0xff000000u;
}
