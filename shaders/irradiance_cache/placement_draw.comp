// Lays the marks of places that are being chosen (placement.comp) over the picture, which is dimmed so that they stand out
// on any ground. Where there are no samples yet the coarse picture's noise would drown them: there surfaces are shown in
// greys, by how they face the eye.
#include "lib/invocation.glsl"
#include "irradiance_cache/seen.glsl"
#include "shaders/shared/cache_placement.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PlacementPush push; };
layout(scalar) readonly buffer Places { PlacedPoint places[]; };
layout(scalar) readonly buffer Marks { uint marks[]; };
layout(scalar) buffer Picture { uint picture[]; };

const float k_dim = 0.6, k_grey = 0.6;
const float k_background = 0.1, k_edge_on = 0.1, k_facing = 0.4;  // encoded

float grey_of(uvec2 xy, uvec2 coarse_film) {
  uint pixel = xy.y * coarse_film.x + xy.x;
  vec4 albedo = texelFetch(coarse_albedo, int(pixel));
  vec3 normal = texelFetch(coarse_normal, int(pixel)).xyz;
  if (albedo.w < 0.5 * float(coarse_count[pixel]) || dot(normal, normal) == 0.0) return k_background;
  vec2 ndc = (vec2(xy) + 0.5) / vec2(coarse_film) * 2.0 - 1.0;
  vec3 shift = ndc.x * frame.camera_right - ndc.y * frame.camera_up;
  vec3 view = normalize(frame.orthographic != 0u ? frame.camera_forward : frame.camera_forward + shift);
  float light = sqrt(clamp(dot(albedo.xyz / albedo.w, vec3(0.2126, 0.7152, 0.0722)), 0.0, 1.0));
  return mix(k_edge_on, k_facing, abs(dot(normalize(normal), view))) * mix(0.5, 1.0, light);
}

// Smooth between the coarse film's pixels.
float grey_at(uvec2 xy) {
  uvec2 coarse_film = max(uvec2(push.width, push.height) / k_coarse_step, uvec2(1u));
  vec2 at = (vec2(xy) + 0.5) / float(k_coarse_step) - 0.5, low = floor(at), part = at - low;
  float sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    vec2 weight = mix(1.0 - part, part, vec2(corner));
    sum += weight.x * weight.y * grey_of(uvec2(clamp(ivec2(low) + corner, ivec2(0), ivec2(coarse_film) - 1)), coarse_film);
  }
  return sum;
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  uint packed = picture[pixel];
  vec3 color = vec3(packed & 0xffu, packed >> 8 & 0xffu, packed >> 16 & 0xffu) / 255.0;
  if (film_count[pixel] == 0u)
    color = vec3(grey_at(uvec2(pixel % push.width, pixel / push.width)));
  else
    color = k_dim * mix(color, vec3(dot(color, vec3(0.2126, 0.7152, 0.0722))), k_grey);
  uint mark = marks[pixel];
  if (mark != 0u) {
    uint rank = mark >> k_mark_rank_shift;
    float cover = float(mark >> k_mark_cover_shift & 0x7fu) / 127.0;
    uint bits = places[k_mark_point - (mark & k_mark_point)].bits;
    vec3 ink = vec3(0.0);
    float alpha = 0.55;
    if (rank == k_rank_candidate) {
      uint cluster = bits >> k_placed_cluster_shift;
      bool by_cluster = push.by_cluster != 0u && cluster > 0u;
      ink = by_cluster ? placed_cluster_ink(cluster - 1u) : ramp_hue(bits >> k_placed_origin_shift & 3u);
      alpha = 0.9;
    } else if (rank == k_rank_rejected) {
      ink = k_rejected_ink, alpha = 0.7;
    } else if (rank == k_rank_faint_ring) {
      ink = k_tried_ink, alpha = 1.0;
    } else if (rank == k_rank_tried) {
      ink = k_tried_ink, alpha = 1.0;
    } else if (rank != k_rank_edge) {
      ink = k_chosen_ink, alpha = rank == k_rank_ring ? 0.6 : 1.0;
    }
    color = mix(color, ink, alpha * cover);
  }
  uvec3 bytes = uvec3(clamp(color, vec3(0.0), vec3(1.0)) * 255.0 + 0.5);
  picture[pixel] = bytes.x | bytes.y << 8 | bytes.z << 16 | 0xff000000u;
}
