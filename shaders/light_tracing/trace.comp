// One vertex of every live light path. A vertex on a diffuse surface, reached by mirrors and glass alone, is connected to
// the camera: a shadow ray carries its light to the pixel that shows the surface. Then the path continues.
//
// A pixel is the mean of radiance over its area on the plane at distance 1 before the eye. A light path that carries flux F to
// x stands for irradiance F / dA there, so that the pixel gets
//   F f_D(wi, we) |wi.ns| / |wi.ng| * |we.ng| d / (z^3 A),
// d: distance to the eye, z: the part of it along the view, A: the pixel's area; for dA |we.ng| / d^2 is a solid angle of
// cos^3 times an area of that plane. With parallel rays it is |we.ng| / A, A the area of the pixel itself. With a lens the eye is a
// random point of it: its density is the inverse of the lens's area, over which the pixel is a mean (lib/lens.glsl).
#include "shaders/shared/emission.h"
#include "transport/light_vertex.glsl"
#include "shaders/shared/splat.h"
#include "lib/emission.glsl"
#if LUCERNA_CATCHER
#include "lib/catcher.glsl"
#endif
#if LUCERNA_THIN_LENS
#include "lib/lens.glsl"
#endif
#if LUCERNA_SPLATS_WEIGHED
layout(scalar) readonly buffer LightRoundBlock { EmitPush light_round; };
#endif

layout(scalar) buffer LightPathCounts { uint light_path_counts[]; };
layout(scalar) readonly buffer SplatBlock { SplatFrame splat_frame; };
layout(scalar) buffer SplatCounts { uint splat_counts[]; };
layout(scalar) buffer ShadowQueue { uint shadow_queue[]; };

struct Seen {
  vec3 towards;     // to the eye, unit
  float distance;
  uint pixel;       // in the band that is summed
  float per_cosine; // d / (z^3 A), 1 / A, or 1 / (d^2 solid angle)
  bool inside;      // the pixel is in the band
};

// `off`: from the eye, at the distance d.
Seen wide_camera_sees(vec3 off, float d) {
  vec2 angles = angles_towards(off / max(d, 1e-30)), half_angles = vec2(length(frame.camera_right), length(frame.camera_up));
  vec2 at = floor((angles / half_angles * vec2(0.5, -0.5) + 0.5) * vec2(frame.width, frame.height));
  // Of the pixel: its part of the picture in squared angles, as a solid angle.
  float pixel_area = 4.0 * half_angles.x * half_angles.y / (float(frame.width) * float(frame.height));
  float solid_angle = pixel_area * wide_stretch(frame.projection, angles);
  Seen s;
  s.inside = d > 0.0 && solid_angle > 0.0 && wide_covers(frame.projection, angles) && at.x >= 0.0 && at.y >= 0.0 &&
             at.x < float(frame.width) && at.y < float(frame.height);
  s.pixel = s.inside ? uint(at.y) * frame.width + uint(at.x) - splat_frame.first : 0u;
  s.inside = s.inside && s.pixel < splat_frame.pixels;
  s.towards = -off / max(d, 1e-30);
  s.distance = d;
  s.per_cosine = s.inside ? 1.0 / (d * d * solid_angle) : 0.0;
  return s;
}

// `eye`: from the camera's origin.
Seen camera_sees(vec3 x, vec3 eye) {
  vec3 off = x - frame.camera_origin;
#if LUCERNA_THIN_LENS
  off -= eye;
#endif
  float z = dot(off, frame.camera_axis), d = length(off);
  if (is_wide(frame.projection)) return wide_camera_sees(off, d);
  bool parallel = is_parallel(frame.projection);
  vec3 aside = frame.camera_forward - frame.camera_axis;
  float right2 = dot(frame.camera_right, frame.camera_right), up2 = dot(frame.camera_up, frame.camera_up);
  float scale = parallel ? 1.0 : 1.0 / max(z, 1e-30);
  vec2 ndc = vec2(dot(off, frame.camera_right) / right2, -dot(off, frame.camera_up) / up2) * scale;
  ndc -= vec2(dot(aside, frame.camera_right) / right2, -dot(aside, frame.camera_up) / up2);
#if LUCERNA_THIN_LENS
  ndc += vec2(dot(eye, frame.camera_right) / right2, -dot(eye, frame.camera_up) / up2) / frame.focus_distance;
#endif
  vec2 at = floor((ndc * 0.5 + 0.5) * vec2(frame.width, frame.height));
  float area = 4.0 * sqrt(right2 * up2) / (float(frame.width) * float(frame.height));
  Seen s;
  s.inside = z > 0.0 && at.x >= 0.0 && at.y >= 0.0 && at.x < float(frame.width) && at.y < float(frame.height);
  s.pixel = s.inside ? uint(at.y) * frame.width + uint(at.x) - splat_frame.first : 0u;
  s.inside = s.inside && s.pixel < splat_frame.pixels;
  s.towards = parallel ? -frame.camera_axis : -off / max(d, 1e-30);
  s.distance = parallel ? z : d;
  s.per_cosine = (parallel ? 1.0 : d / (z * z * z)) / area;
  return s;
}

// f_D |wi.ns| / |wi.ng| towards the eye; wi points to where the light comes from.
vec3 reflected_to_eye(Surface surface, vec3 towards, vec3 wi_world) {
  surface.front = dot(surface.normal_g, towards) > 0.0;
  surface.parameters.inside = surface.parameters.solid && !surface.front;
  mat3 to_world = shading_frame(surface, towards);
#if LUCERNA_CATCHER
  if (is_catcher(surface)) surface.parameters.base = catcher_color(surface, -towards);
#endif
  vec3 side = surface.front ? surface.normal_g : -surface.normal_g;
  Bsdf bsdf = surface_bsdf(surface, to_world, towards);
  vec3 light = diffuse_of_flux(bsdf, to_world, surface.normal_g, wi_world, dot(wi_world, side) > 0.0);
#if LUCERNA_PARALLAX
  if (surface.relief.deep) {
    // Light has met a place of the relief that it sees; eye paths choose from those that the eye sees.
    vec3 n = to_world[2], g = surface.normal_g;
    light *= abs(dot(towards, n) * dot(wi_world, g)) / max(abs(dot(towards, g) * dot(wi_world, n)), 1e-4);
    if (hidden_by_relief(surface, towards)) light = vec3(0.0);
  }
#endif
  return light;
}

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  uint slot = push.use_queue != 0u ? queue[index] : index;
  Ray ray = load_ray(slot);
  Hit hit = load_hit(slot);
  PathState path = load_path(slot);
  if (path.pixel == 0xffffffffu) return;
  if (hit.prim == k_no_hit) {
    atomicAdd(light_path_counts[k_light_paths_escaped], 1u);
    return;
  }
  uint state = path_automaton(path), depth = path_depth(path);
  Sampler random = make_light_sampler(path.pixel, path.sample_index, frame.seed);
  LightVertex v = light_vertex(path, ray, hit, random);
  bool diffuse = max3(v.bsdf.diffuse_albedo + v.bsdf.transmitted_albedo) > 0.0;
  // The number of events of the whole path, including this surface's, is within the limit of eye paths.
  bool wanted = v.lit && diffuse && is_component(automaton_component(state)) && depth <= frame.max_depth;
  vec3 eye = vec3(0.0);
#if LUCERNA_THIN_LENS
  eye = lens_point(sample_vertex(random, depth, k_pad_light_uv));  // free behind the emission
#endif
  Seen seen = camera_sees(v.surface.position, eye);
#if LUCERNA_PARALLAX
  // The eye sees this place of the relief through another point of the surface than the light.
  vec3 met = v.surface.position;
  if (v.surface.relief.deep) {
    v.surface.position += v.surface.relief.shift + v.surface.relief.depth * relief_aside(seen.towards, v.surface.normal_g);
    seen = camera_sees(v.surface.position, eye);
  }
#endif
  wanted = wanted && seen.inside;
#if LUCERNA_SECTION
  // What the plane cuts off is not visible; what lies behind it is, whatever is before the plane.
  float behind = dot(v.surface.position, frame.section_normal) - frame.section_offset;
  float nearing = -dot(seen.towards, frame.section_normal);
  bool cut = seen.distance * nearing > behind;  // the eye is before the plane
  if (cut) {
    wanted = wanted && behind >= 0.0;
    seen.distance = min(seen.distance, behind / max(nearing, 1e-30));
  }
#endif
  // Alpha coverage: the visible share of the surface.
  vec3 light = v.coverage * v.arriving * reflected_to_eye(v.surface, seen.towards, -ray.direction) *
               (abs(dot(seen.towards, v.surface.normal_g)) * seen.per_cosine);
#if LUCERNA_VOLUMES
  bool reflected = dot(seen.towards, v.surface.normal_g) > 0.0 == v.surface.front;
  light *= media_transmittance(reflected ? path.media : media_behind(v.surface, path.media), seen.distance);
#endif
  bool finite = is_finite(light);
  if (wanted && !finite) atomicAdd(counters[k_counter_dropped], 1u);
  if (wanted && finite && max3(light) > 0.0) {
    atomicAdd(splat_counts[k_splats_joined], 1u);
    vec3 origin = offset_origin(v.surface, seen.towards);
    float distance = max(0.0, seen.distance - dot(origin - v.surface.position, seen.towards));
    store_shadow_ray(slot, Ray(origin, distance, seen.towards, slot));
    uint stratum = 0u;
#if LUCERNA_SPLATS_WEIGHED && LUCERNA_LIGHTS
    // An unaimed path counts only with the light that no aimed path could contribute.
    Emission e = sample_emission(random, light_round.step);
    stratum = e.stratum;
    light *= stratum == 0u ? e.unaimed : 1.0;
#endif
    store_shadow_state(slot, ShadowState(light, seen.pixel, vec3(0.0), stratum));
    shadow_queue[queue_place(k_counter_shadow, k_counter_shadow_rays, automaton_account(state))] = slot;
  }
#if LUCERNA_PARALLAX
  v.surface.position = met;
#endif
  light_continue(slot, v, path, ray, path.travelled + hit.t, min(frame.max_depth, k_most_light_events) - 1u, random);
}
