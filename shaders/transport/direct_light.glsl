// Direct light for shade.comp: emitters hit by the path and emitters sampled at a vertex, combined by MIS.
//
// If records store the sky's light (LUCERNA_SEPARATE_SKY), a vertex whose diffuse lobe has looked it up (sky_known)
// computes it by neither strategy: light samples contribute the sky to the glossy lobe only, and a diffuse ray that hits the
// sky adds nothing. The sun and all other lights are sampled as usual.
#ifndef LUCERNA_TRANSPORT_DIRECT_LIGHT
#define LUCERNA_TRANSPORT_DIRECT_LIGHT
#include "lib/variants.glsl"
#include "lib/path_events.glsl"
#include "lib/layers.glsl"

layout(scalar) buffer ShadowQueue { uint shadow_queue[]; };

// Power heuristic (Veach 1997, exponent 2) as a function of the ratio of the densities, which avoids overflow.
float mis_weight(float mine, float other) {
  float r = other / max(mine, 1e-37);
  return 1.0 / (1.0 + r * r);
}
// MIS weight of an emitter hit that light samples of the path's last vertex would have found with density pdf.
float met_weight(PathState path, float pdf) { return path.pdf > 0.0 ? mis_weight(path.pdf, pdf) : 1.0; }

#if LUCERNA_SEPARATE_SKY
// Probability of the sky among the lights sampled at the path's last vertex.
float sky_share_before(PathState path) { return (path.bits & k_path_sky_not_sampled) != 0u ? 0.0 : frame.environment_light_pmf; }
// ... and at the current vertex: 0 if the diffuse lobe has looked up the sky and there is no glossy lobe.
bool sky_not_sampled(Bsdf bsdf, bool sky_known) { return sky_known && !bsdf_glossy(bsdf); }
#endif

// k_path_sky_* of a path that leaves a vertex by that event.
uint sky_bits(Bsdf bsdf, bool sky_known, uint event) {
#if LUCERNA_SEPARATE_SKY
  return (sky_not_sampled(bsdf, sky_known) ? k_path_sky_not_sampled : 0u) | (sky_known && event == k_event_diffuse ? k_path_sky_known : 0u);
#else
  return 0u;
#endif
}

#if LUCERNA_LEARNED
layout(scalar) writeonly buffer LightRecords { LightRecord light_records[]; };

// The MIS weight against scattered rays uses a fixed probability of the cluster: with its present probability, clusters that
// are rarely chosen would learn to be chosen more rarely.
void record_light_sample(uint slot, PathState path, vec3 position, vec3 normal, LightSample l, BsdfValue f, bool sent, inout ShadowState shadow) {
  uint at = slot * k_learned_vertices + path_depth(path);
  float within = l.pdf / max(l.chosen, 1e-30), alone = within;
#if LUCERNA_SKY_PORTALS
  // Portals and the sky's texels sample the same directions. A cluster's part of a contribution is its share of the density,
  // so that second moments of these parts lead to the mixture of least variance.
  if (l.own > 0.0) alone = l.own;
#endif
  float rate = l.delta ? 0.0 : f.pdf / max(alone, 1e-30);
  float value = l.factor * luminance(l.radiance * (f.diffuse + f.glossy)) / (max(within, 1e-30) * (1.0 + rate * rate));
  float full = luminance(shadow.diffuse + shadow.glossy);
  sent = sent && full > 0.0 && value > 0.0 && value < 1e30;
  light_records[at].position = position;
  light_records[at].cell = learned_facing(normal) << 16 | l.cluster;
  light_records[at].value = sent ? value : 0.0;
#if LUCERNA_SKY_PORTALS
  // Light that scattered rays meet is recorded for the sky's texels.
  if (l.cluster + uint(LUCERNA_PORTALS) - frame.sky_clusters < uint(LUCERNA_PORTALS)) rate = 0.0;
#endif
  light_records[at].rate = min(rate, 1e30);
  light_records[at].full = sent ? full : -1.0;
  light_records[at].before = luminance(path.throughput);
  shadow.tag = at + 1u;
}

// Records an emitter hit that light samples would have found with density `pdf`, of which `part` by its own cluster.
void record_light_met(uint slot, PathState path, vec3 light, float pdf, uint cluster, float part) {
  float chosen = learned_ratio(path.light_group, cluster) * light_cluster(cluster).plain;
  float within = part / max(chosen, 1e-30), rate = path.pdf / max(within, 1e-30);
  float value = luminance(path.throughput * light) * rate / (1.0 + rate * rate);  // times `before`
#if LUCERNA_SKY_PORTALS
  value *= part / max(pdf, 1e-30);
#endif
  uint depth = path_depth(path);
  if (value > 0.0 && value < 1e30 && within > 0.0 && path.pdf > 0.0 && depth > 0u && depth <= k_learned_vertices) {
    uint at = slot * k_learned_vertices + depth - 1u;
    light_records[at].met = cluster + 1u;
    light_records[at].met_value = value;
    light_records[at].met_rate = min(rate, 1e30);
  }
}
#endif

// Light of a path that leaves the scene; with light groups, without the sun's part.
vec3 environment_met(uint slot, PathState path, vec3 origin, vec3 direction, out vec3 sun) {
  sun = vec3(0.0);
#if LUCERNA_SEPARATE_SKY
  Environment e = environment_radiance(direction);
  float sky_share = sky_share_before(path);
  vec3 light = (path.bits & k_path_sky_known) != 0u ? vec3(0.0) : e.sky * met_weight(path, e.pdf_sky * sky_share);
#if LUCERNA_SUN
  vec3 of_sun = (path.bits & k_path_sky_only) != 0u ? vec3(0.0) : e.sun * met_weight(path, e.pdf_sun * (1.0 - sky_share));
#if LUCERNA_LIGHT_GROUPS > 1
  sun = path.throughput * of_sun;
#else
  light += of_sun;
#endif
#endif
  return path.throughput * light;
#else
  float pdf;
#if LUCERNA_LEARNED && LUCERNA_ENVIRONMENT_MAP
  vec3 light = environment_radiance(direction, path.light_group, pdf);
  float part = pdf;
#if LUCERNA_SKY_PORTALS
  part *= 1.0 - k_portal_share;
  // Null events have moved the ray's origin away from the vertex.
  pdf = with_portals(pdf, origin - path.travelled * direction, direction, path.light_group, k_no_portal, 0.0);
#endif
  // A loop instead of a branch: on lavapipe a branch saves no work, and only pilot paths are recorded.
  for (uint once = 0u; once < frame.learning; ++once) {
    EnvironmentTexels t = environment_texels_at(direction);
    record_light_met(slot, path, light, pdf, sky_cluster(direction, uint(t.texel), t.u), part);
  }
#else
  vec3 light = environment_radiance(direction, pdf);
#if LUCERNA_SKY_PORTALS
  pdf = with_portals(pdf, origin - path.travelled * direction, direction, 0u, k_no_portal, 0.0);
#endif
#endif
  return path.throughput * light * met_weight(path, pdf);
#endif
}

// Weighted emission of a surface that light samples find with density pdf.
float emissive_weight(PathState path, float pdf) {
#if LUCERNA_SEPARATE_SKY
  return (path.bits & k_path_sky_only) != 0u ? 0.0 : met_weight(path, pdf * (1.0 - sky_share_before(path)));
#else
  return met_weight(path, pdf);
#endif
}

#if LUCERNA_SHAPES
// Light of lamps with a shape that a ray meets before `tmax`, by light group. `travelled`: from the path's last vertex to the
// ray's origin.
void shapes_met(uint slot, PathState path, Ray ray, float tmax, inout vec3 met[k_group_count]) {
  vec3 vertex = ray.origin - path.travelled * ray.direction;
  bool seen_directly = path_depth(path) == 0u;
  for (uint light = frame.first_shape; light < frame.first_shape + frame.shape_count; ++light) {
    LampShape shape = load_shape(light);
    float t = shape_hit(shape, ray.origin, ray.direction);
    bool hit = t > 0.0 && t * (1.0 - k_shape_gap) <= tmax && !(seen_directly && (shape.bits & k_light_hidden) != 0u);
    // A loop instead of a branch: on lavapipe a branch saves no work, and few rays meet a lamp.
    for (uint once = 0u; once < (hit ? 1u : 0u); ++once) {
      float pdf = texelFetch(light_alias, int(light)).z * shape_pdf(shape, vertex, ray.direction);
#if LUCERNA_LEARNED
      uint cluster = shape_cluster(light);
      pdf *= learned_ratio(path.light_group, cluster);
      if (frame.learning != 0u) record_light_met(slot, path, shape.radiance, pdf, cluster, pdf);
#endif
      vec3 light_here = path.throughput * shape.radiance * emissive_weight(path, pdf);
#if LUCERNA_VOLUMES
      light_here *= media_transmittance(path.media, t);
#endif
      uint group = 0u;
#if LUCERNA_LIGHT_GROUPS > 1
      group = shape.bits >> k_light_group_shift & k_light_group_mask;
#endif
      [[unroll]] for (uint g = 0u; g < k_group_count; ++g) met[g] += g == group ? light_here : vec3(0.0);
    }
  }
}
#endif

#if LUCERNA_LIGHT_SURFACE
// Radiance of a sampled emissive triangle along -direction, including textures and alpha coverage.
vec3 light_radiance(LightSample l) {
  Ray towards;
  towards.origin = l.target - l.direction * l.distance;
  towards.direction = l.direction;
  towards.tmax = k_infinity;
  towards.slot = 0u;
  Hit there;
  there.t = l.distance;
  there.prim = l.primitive;
  there.u = l.uv.x;
  there.v = l.uv.y;
  Surface s = make_surface(towards, there);
  bool lit = s.front || (s.flags & k_flag_double_sided) != 0u;
  return lit ? s.emission * surface_coverage(s) : vec3(0.0);
}
#endif

#if LUCERNA_LIGHTS && LUCERNA_PATH_EVENTS
// Records one lobe's share of a light sample, blocked until its shadow ray arrives. Returns 1 + its number; 0: none.
uint record_light_event(uint slot, PathState path, LightSample l, vec3 light, uint component, uint event, vec3 target) {
  if (!event_counts(light, component)) return 0u;
  PathEvent e = new_event(k_path_blocked, event_vertex, event, target);
  e.pdf = l.pdf;
  e.normal = l.normal;
  e.throughput = path.throughput;
  e.primitive = l.primitive;
  e.light = l.entry;
  add_light(e, light, component, l.group);
  uint at = event_place();
  write_event(slot, at, e);
  return at == k_path_no_event ? 0u : at + 1u;
}
#endif

#if LUCERNA_LIGHTS
// One light sample for all lobes, queued as a shadow ray if it can contribute. `row`: of learned lights.
void sample_direct_light(uint slot, PathState path, Surface surface, Bsdf bsdf, vec3 wo, mat3 to_world, Sampler random, bool sky_known, bool wanted,
                         uint row) {
  uint state = path_automaton(path), depth = path_depth(path);
  uint component_d = automaton_component(automaton_after(state, k_event_diffuse));
  uint component_g = automaton_component(automaton_after(state, k_event_glossy));
  vec3 side = surface.front ? surface.normal_g : -surface.normal_g;
  float sky_share = 0.0;
#if LUCERNA_SEPARATE_SKY
  sky_share = sky_not_sampled(bsdf, sky_known) ? 0.0 : frame.environment_light_pmf;
#endif
  LightSample l = sample_light(surface.position, to_world[2], sample_vertex_bits(random, depth, k_pad_light_choice).x,
                               sample_vertex(random, depth, k_pad_light_uv),
                               sample_vertex_bits(random, depth, k_pad_light_detail),
#if LUCERNA_LEARNED
                               row);
#else
                               sky_share);
#endif
  vec3 wi = l.direction * to_world;
  BsdfValue f = bsdf_eval(bsdf, wo, wi);
#if LUCERNA_DISPERSION
  if (wi.z < 0.0) f.glossy *= surface.spectrum;
#endif
  bool reflected = dot(l.direction, side) > 0.0;
  bool sides_agree = reflected == (wi.z > 0.0);
#if LUCERNA_LIGHT_SURFACE
  if (l.primitive != k_no_hit) l.radiance = light_radiance(l);
#endif
  float weight = l.delta ? 1.0 : mis_weight(l.pdf, f.pdf);
  vec3 arrives = path.throughput * l.radiance * (weight / max(l.pdf, 1e-37));
#if LUCERNA_LEARNED || LUCERNA_SHAPES
  arrives *= l.factor;
#endif
#if LUCERNA_VOLUMES
  arrives *= media_transmittance(reflected ? path.media : media_behind(surface, path.media), min(l.distance, 1e30));
#endif
  ShadowState shadow;
  shadow.diffuse = is_component(component_d) ? arrives * f.diffuse : vec3(0.0);
  shadow.glossy = is_component(component_g) ? arrives * f.glossy : vec3(0.0);
  shadow.lanes = lane_of(l.group, component_d) | lane_of(l.group, component_g) << 8;
#if LUCERNA_WORD_LAYERS
  shadow.lanes |= layer_state_after(path_layer_state(path), k_event_diffuse) << 16 | layer_state_after(path_layer_state(path), k_event_glossy) << 24;
#endif
  shadow.tag = 0u;
#if LUCERNA_SEPARATE_SKY
  if (l.sky && sky_known) shadow.diffuse = vec3(0.0);
#endif
  bool finite = is_finite(shadow.diffuse) && is_finite(shadow.glossy);
  bool contributes = wanted && sides_agree && l.pdf > 0.0 && !hidden_by_relief(surface, l.direction) &&
                     (!finite || max3(shadow.diffuse) + max3(shadow.glossy) > 0.0);
  if (contributes && !finite) atomicAdd(counters[k_counter_dropped], 1u);
#if LUCERNA_LEARNED
  for (uint once = 0u; once < (frame.learning != 0u && wanted && (path.nulls & k_nulls_mask) == 0u && depth < k_learned_vertices ? 1u : 0u); ++once)
    record_light_sample(slot, path, surface.position, to_world[2], l, f, contributes && finite, shadow);
#endif
  if (contributes && finite) {
    Ray shadow_ray;
    shadow_ray.origin = offset_origin(surface, l.direction);
    shadow_ray.direction = l.direction;
    shadow_ray.tmax = k_infinity;
    shadow_ray.slot = slot;
    if (l.primitive != k_no_hit) {
      // The end point is moved off the light by its error bound, so that the light does not shadow itself.
      vec3 to = l.target + l.normal * dot(abs(l.normal), l.offset) - shadow_ray.origin;
      float distance = length(to);
      shadow_ray.direction = distance > 0.0 ? to / distance : l.direction;
      shadow_ray.tmax = distance;
    } else if (l.distance < 1e30) {
      shadow_ray.tmax = l.distance;
    }
#if LUCERNA_PATH_EVENTS
    vec3 target = shadow_ray.origin + shadow_ray.direction * min(shadow_ray.tmax, path_event_frame.far);
    uint of_diffuse = record_light_event(slot, path, l, shadow.diffuse, component_d, k_event_diffuse, target);
    uint of_glossy = record_light_event(slot, path, l, shadow.glossy, component_g, k_event_glossy, target);
    shadow.tag = of_diffuse | of_glossy << 16;
#endif
    uint first = max3(shadow.diffuse) > 0.0 ? component_d : component_g;
    shadow_queue[queue_place(k_counter_shadow, k_counter_shadow_rays, first)] = slot;
    store_shadow_ray(slot, shadow_ray);
    store_shadow_state(slot, shadow);
  }
}
#endif
#endif
