// One vertex of a light path. Light paths carry flux, so f has its arguments exchanged compared to eye paths. For kernels
// that replace shade.comp (transport/wavefront.h, PathEnds::vertex).
#ifndef LUCERNA_TRANSPORT_LIGHT_VERTEX
#define LUCERNA_TRANSPORT_LIGHT_VERTEX
#include "lib/variants.glsl"
#include "lib/wavefront.glsl"
#include "lib/sampler.glsl"
#include "lib/surface.glsl"
#if LUCERNA_DISPERSION
#include "lib/dispersion.glsl"
#endif

struct LightVertex {
  float coverage;  // alpha: the share of light that meets the surface, whether or not this path is scattered
  Surface surface;
  Bsdf bsdf;       // as seen from the arriving light
  mat3 to_world;
  vec3 wo;         // towards the arriving light, local
  vec3 arriving;   // flux
  bool lit;        // reflects or transmits any light
  bool stays;      // ... and this path is scattered
  bool passed;     // the path continues undeflected
};

// Flux is scattered by f(wi, wo) |wo . n_g| / |wo . n_s| over directions wi in projected solid angle about the geometric
// normal; bsdf_sample returns f(wo, wi) |wi . n_s| / pdf (E. Veach 1997, 5.3.2).
float adjoint_correction(vec3 n_g, vec3 n_s, vec3 wo, vec3 wi) {
  float above = abs(dot(wo, n_s) * dot(wi, n_g)), below = abs(dot(wo, n_g) * dot(wi, n_s));
  return below > 0.0 ? above / below : 0.0;
}

// Reflection off a surface with a tilted shading normal. An eye path that leaves along `towards` uses a shading frame bent
// towards that direction (shading_frame()), not towards the light, so f is evaluated as that eye path would. `density`: of
// sampling `towards`; `pick`: of the event.
void reflect_as_seen(LightVertex v, vec3 from, vec3 towards, float density, float pick, out vec3 weight, out uint event) {
  mat3 to_world = shading_frame(v.surface, towards);
  vec3 wo = towards * to_world, wi = from * to_world;
  BsdfValue f = bsdf_eval(surface_bsdf(v.surface, to_world, towards), wo, wi);
  float diffuse = luminance(f.diffuse), glossy = luminance(f.glossy);
  float p_diffuse = diffuse + glossy > 0.0 ? diffuse / (diffuse + glossy) : 1.0;
  bool is_diffuse = pick < p_diffuse;
  event = is_diffuse ? k_event_diffuse : k_event_glossy;
  float p = (is_diffuse ? p_diffuse : 1.0 - p_diffuse) * density;
  float per_cosine = abs(dot(towards, v.surface.normal_g)) / max(abs(dot(from, v.surface.normal_g)), 1e-30);
  weight = wi.z > 0.0 && p > 0.0 ? (is_diffuse ? f.diffuse : f.glossy) * (per_cosine / p) : vec3(0.0);
}

LightVertex light_vertex(inout PathState path, Ray ray, Hit hit, Sampler random) {
  LightVertex v;
  v.surface = make_surface(ray, hit);
#if LUCERNA_DISPERSION
  disperse(v.surface, path, random);
#endif
#if LUCERNA_VOLUMES
  path.throughput *= media_transmittance(path.media, hit.t);
#endif
  v.arriving = path.throughput;
  v.passed = false;
  v.coverage = 1.0;
#if LUCERNA_TRANSPARENT
  Sampler random_null = null_sampler(random, path.nulls);
  vec2 u_null = sample_vertex(random_null, path_depth(path), k_pad_lobe);
#endif
#if LUCERNA_ALPHA
  v.coverage = surface_coverage(v.surface);
  v.passed = u_null.x >= v.coverage;
#endif
  v.passed = v.passed || is_catcher(v.surface);
  vec3 wo_world = -ray.direction;
  v.to_world = shading_frame(v.surface, wo_world);
  v.wo = wo_world * v.to_world;   // transposed
  v.bsdf = surface_bsdf(v.surface, v.to_world, wo_world);
  v.lit = v.coverage > 0.0;
#if LUCERNA_UNLIT
  v.lit = v.lit && (v.surface.flags & k_flag_unlit) == 0u;
#endif
  v.stays = v.lit && !v.passed;
#if LUCERNA_THIN_GLASS
  float p_undeflected = bsdf_undeflected_probability(v.bsdf, v.wo.z);
  if (v.stays && u_null.y < p_undeflected) {
    v.passed = true;
    // The flux that this path carries on. The light reaching the surface's other lobes is already accounted for.
    path.throughput *= bsdf_undeflected(v.bsdf, v.wo.z) / p_undeflected;
  }
#endif
  return v;
}

// Continues the path by an event (at most `most_events` of them) or undeflected, and queues the next ray. Russian roulette
// keeps the flux of surviving paths as constant as their colour allows (J. Arvo and D. Kirk 1990).
void light_continue(uint slot, LightVertex v, PathState path, Ray ray, float travelled, uint most_events, Sampler random) {
  uint depth = path_depth(path);
  vec3 origin, direction = ray.direction;
  bool go_on = false;
  if (v.passed) {
    origin = offset_origin(v.surface, direction);
    go_on = max3(path.throughput) > 0.0;
    path.travelled = travelled;
    ++path.nulls;
  } else if (v.stays) {
    bool ends = depth > most_events;
    if (ends) atomicAdd(counters[k_counter_depth], 1u);
    vec2 u = sample_vertex(random, depth, k_pad_direction);
    vec2 lobe = sample_vertex(random, depth, k_pad_lobe);
    vec3 side = v.surface.front ? v.surface.normal_g : -v.surface.normal_g;
    // Directions above the surface but below the plane of the shading normal: eye paths come from there, but lobes about the
    // shading normal never sample them. Sampled uniformly, with the density of the whole hemisphere.
    vec3 edge = cross(v.to_world[2], side);
    float sine = length(edge), lean = atan(sine, dot(v.to_world[2], side));
    bool leans = sine > 1e-4 && (v.bsdf.p_diffuse > 0.0 || bsdf_glossy(v.bsdf));
#if LUCERNA_PARALLAX
    leans = leans && !v.surface.relief.deep;
#endif
    float below = leans ? lean / k_pi : 0.0;
    BsdfSample b;
    if (lobe.x < below) {
      edge /= sine;
      float z = 2.0 * u.x - 1.0, r = sqrt(max(0.0, 1.0 - z * z)), angle = u.y * lean;
      // From the surface's plane up to the plane of the shading normal.
      direction = normalize(z * edge + r * (sin(angle) * side + cos(angle) * cross(edge, side)));
      b.transmitted = false, b.eta2 = 1.0, b.pdf = 0.5 * k_inv_pi;
      b.event = k_event_glossy, b.weight = vec3(0.0);
    } else {
      lobe.x = min((lobe.x - below) / (1.0 - below), 0.99999994);
      b = bsdf_sample(v.bsdf, v.wo, u, lobe);
      direction = normalize(v.to_world * b.wi);
      b.pdf *= 1.0 - below, b.weight /= 1.0 - below;
    }
    bool sides_agree = can_leave(v.surface, side, direction, b.transmitted);
    // Refraction scales radiance, but not flux.
    vec3 normal = v.to_world[2];
    bool tilted = false;  // a lobe about another normal than the shading frame's
#if LUCERNA_CLEARCOAT
    if (b.mirrored_by_coat) normal = v.to_world * v.bsdf.coat_normal;
    tilted = v.bsdf.p_coat > 0.0 && v.bsdf.coat_normal.z < 0.999999;
#endif
    float correction = adjoint_correction(v.surface.normal_g, normal, ray.direction, direction);
#if LUCERNA_PARALLAX
    // The normals of deep relief are those of its geometry.
    if (v.surface.relief.deep) correction = 1.0;
#endif
    vec3 weight = b.weight * (correction / b.eta2);
    if ((leans || tilted) && sides_agree && !b.transmitted && b.event != k_event_specular)
      reflect_as_seen(v, -ray.direction, direction, b.pdf, lobe.y, weight, b.event);
    uint wavelength = 0u;
#if LUCERNA_DISPERSION
    bool passes = b.transmitted && b.event != k_event_diffuse;
    if (passes) weight *= v.surface.spectrum;
    wavelength = wavelength_bits(v.surface, path, passes);
#endif
    uint next = automaton_after(path_automaton(path), b.event);
    vec3 throughput = path.throughput * weight;
    bool finite = is_finite(throughput);
    go_on = !ends && sides_agree && (!finite || max3(throughput) > 0.0) && automaton_live(next);
    if (go_on && !finite) atomicAdd(counters[k_counter_dropped], 1u);
    float q = clamp(max3(throughput) / max(max3(path.throughput), 1e-37), 0.0, 1.0);
    bool survives = to_unit(sample_vertex_bits(random, depth, k_pad_light_choice)).y < q;
    if (go_on && finite && !survives) atomicAdd(counters[k_counter_roulette], 1u);
    go_on = go_on && finite && survives;
    path.throughput = throughput / max(q, 1e-30);
    // Eye paths do not apply this roulette. Unless the first vertex from the light is specular, light samples contribute f
    // cos flux sampling / distance^2 there, and f cos is about the weight times the sampling density in either direction; by
    // the balance heuristic the harmonic sum of both remains. 0 remains where no eye path finds the light: behind a specular
    // first event of a point or directional light.
    path.pdf /= max(q, 1e-30);
    if (depth == 1u && b.event != k_event_specular)
      path.pdf += max((path.eta_scale < 0.0 ? 1.0 : travelled * travelled) / max(b.pdf * abs(path.eta_scale), 1e-37), 1e-30);
    path.bits = next | (depth + 1u) << k_path_events_shift | wavelength;
    path.travelled = 0.0;
    path.nulls = 0u;
    origin = next_origin(v.surface, b.transmitted, direction);
#if LUCERNA_VOLUMES
    if (b.transmitted) path.media = media_behind(v.surface, path.media);
#endif
  }
  if (go_on) queue_ray(slot, path, origin, direction);
}
#endif
