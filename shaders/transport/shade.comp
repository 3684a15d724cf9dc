// One vertex of every live path: emission with its MIS weight, next-event estimation, solver lookups, scattering, Russian
// roulette. The light sample is queued as a shadow ray; the path continues in the next queue.
//
// A hook may branch the diffuse lobe of a vertex. Branches run one after the other, each after the one before has ended (J.
// Arvo and D. Kirk, "Particle Transport and Image Synthesis", 1990); their light is averaged. Everything else at the vertex
// is computed by the first branch alone.
#include "lib/variants.glsl"
#include "lib/wavefront.glsl"
#include "lib/sampler.glsl"
#include "lib/surface.glsl"
#include "lib/lights.glsl"
#if LUCERNA_DISPERSION
#include "lib/dispersion.glsl"
#endif
#if LUCERNA_CATCHER
#include "lib/catcher.glsl"
#endif
#include "transport/vertex_hooks.glsl"
#include "transport/direct_light.glsl"
#include "lib/path_events.glsl"
#include "lib/layers.glsl"

#if LUCERNA_VERTEX_HOOKS
// Stored vertices with further branches: 2 texels for the ray, 1 for the hit, 3 for the path.
const uint k_branching_texels = 6u;
uniform samplerBuffer branching_texels;
layout(scalar) writeonly buffer Branching { vec4 branching[]; };
layout(scalar) writeonly buffer BranchingQueue { uint branching_queue[]; };

void keep_vertex(uint slot) {
  int ray = int(2u * slot), path = int(3u * slot);
  uint at = k_branching_texels * slot;
  branching[at] = texelFetch(ray_texels, ray);
  branching[at + 1u] = texelFetch(ray_texels, ray + 1);
  branching[at + 2u] = texelFetch(hit_texels, int(slot));
  branching[at + 3u] = texelFetch(path_texels, path);
  branching[at + 4u] = texelFetch(path_texels, path + 1);
  branching[at + 5u] = texelFetch(path_texels, path + 2);
}
void load_vertex(uint slot, out Ray ray, out Hit hit, out PathState path) {
  int at = int(k_branching_texels * slot);
  ray = ray_from(texelFetch(branching_texels, at), texelFetch(branching_texels, at + 1));
  hit = hit_from(texelFetch(branching_texels, at + 2));
  path = path_from(texelFetch(branching_texels, at + 3), texelFetch(branching_texels, at + 4), texelFetch(branching_texels, at + 5));
}
#endif

// Features of the first visible surface.
void write_features(uint slot, Surface surface) {
  vec3 n = surface.front ? surface.normal_s : -surface.normal_s;
  features[2u * slot] = vec4(surface.parameters.base, 1.0);
  features[2u * slot + 1u] = vec4(n, camera_depth(surface.position - frame.camera_origin));
}

// Emission of the surface that a path hits.
vec3 emission_met(uint slot, PathState path, Surface surface, Hit hit, float travelled, vec3 direction) {
#if LUCERNA_HITS_EMISSIVE
  if ((surface.flags & k_flag_emissive) != 0u && (surface.front || (surface.flags & k_flag_double_sided) != 0u)) {
    float pdf = emissive_pdf(hit.prim, travelled * travelled, abs(dot(surface.normal_g, direction)));
#if LUCERNA_LEARNED
    uint cluster = emissive_cluster(hit.prim, vec2(hit.u, hit.v));
    pdf *= learned_ratio(path.light_group, cluster);
    for (uint once = 0u; once < frame.learning; ++once) record_light_met(slot, path, surface.emission, pdf, cluster, pdf);
#endif
    return path.throughput * surface.emission * emissive_weight(path, pdf);
  }
#endif
  return vec3(0.0);
}

// Samples a lobe and a direction and updates the path; true if the path continues. `branches`: number of branches, of which
// this is one.
bool scatter(VertexIn v, inout VertexHooks hooks, vec3 wo, bool sky_known, uint branches, inout PathState path, out vec3 origin,
             out vec3 direction) {
  vec2 u = sample_vertex(v.random, v.depth, k_pad_direction);
  vec3 cosine = hooks_cosine(v, hooks, u, sample_cosine(u));
  BsdfSample b = bsdf_sample(v.bsdf, wo, u, cosine, sample_vertex(v.random, v.depth, k_pad_lobe));
  direction = normalize(v.to_world * b.wi);
  hooks_weigh(v, hooks, direction, b);
  bool sides_agree = can_leave(v.surface, v.side, direction, b.transmitted);
  uint next = hooks_state(v, hooks, b, automaton_after(v.state, b.event));
  vec3 throughput = path.throughput * b.weight;
  uint wavelength = 0u;
#if LUCERNA_DISPERSION
  bool passes = b.transmitted && b.event != k_event_diffuse;
  if (passes) throughput *= v.surface.spectrum;
  wavelength = wavelength_bits(v.surface, path, passes);
#endif
#if LUCERNA_PATH_EVENTS
  event_state.by = b.event;
  event_end = automaton_live(next) ? k_end_absorbed : k_end_complete;
#endif
  bool finite = is_finite(throughput);
  bool go_on = sides_agree && (!finite || max3(throughput) > 0.0) && automaton_live(next);
  if (go_on && !finite) atomicAdd(counters[k_counter_dropped], 1u);
  go_on = go_on && finite;
  uint sky = sky_bits(v.bsdf, sky_known, b.event);
#if LUCERNA_SEPARATE_SKY && !LUCERNA_EMISSIVE && !LUCERNA_SUN && !LUCERNA_SHAPES
  // The next ray could hit no light but the sky: it is traced only if the path may continue behind the hit.
  go_on = go_on && ((sky & k_path_sky_known) == 0u || automaton_goes_on(next));
#endif
#if LUCERNA_PATH_EVENTS
  bool wanted = go_on;
#endif
  hooks_leave(v, hooks, Leaving(b, finite), throughput, go_on);
#if LUCERNA_PATH_EVENTS
  if (wanted && !go_on) event_end = k_end_looked_up;
#endif
  path.eta_scale *= b.eta2;
#if LUCERNA_VERTEX_HOOKS
  bool one_of_many = branches > 1u && b.event == k_event_diffuse;
  if (one_of_many) throughput /= float(branches), path.eta_scale /= float(branches);
  go_on = go_on && (one_of_many || push.round == 0u);
#endif
  // Russian roulette on the throughput without the radiance scaling of refraction.
  if (v.depth + 1u >= frame.roulette_depth) {
    float q = clamp(max3(throughput) / path.eta_scale, 0.0, 1.0);
    float u = to_unit(sample_vertex_bits(v.random, v.depth, k_pad_light_choice)).y;
    if (u >= q) {
      if (go_on) count_one(k_counter_roulette);
#if LUCERNA_PATH_EVENTS
      if (go_on) event_end = k_end_roulette;
#endif
      go_on = false;
    }
    throughput /= max(q, 1e-30);
  }
  path.throughput = throughput;
  path.pdf = b.pdf;
  path.bits = next | sky | (v.depth + 1u) << k_path_events_shift | wavelength | (path.bits & k_path_branched);
  path.travelled = 0.0;
#if LUCERNA_WORD_LAYERS
  path.nulls = layer_state_after(path_layer_state(path), b.event) << k_layer_state_shift;
#else
  path.nulls = 0u;
#endif
#if LUCERNA_VOLUMES
  if (b.transmitted) path.media = media_behind(v.surface, path.media);
#endif
  origin = next_origin(v.surface, b.transmitted, direction);
  return go_on;
}

#if LUCERNA_PATH_EVENTS
// The vertex, unless a former branch has written it. `branches`: further branches begin here.
void record_vertex(uint slot, PathEvent vertex, bool again, bool branches) {
  if (!again) write_event(slot, event_vertex, vertex);
  if (event_vertex != k_path_no_event) event_state.last = event_vertex;
  if (branches) event_state.branch = event_state.last;
}

// The end of the path at the vertex.
void record_end(uint slot, PathEvent vertex, Hit hit) {
  PathEvent end = new_event(k_path_end, event_state.last, k_path_by_none, vertex.position);
  end.throughput = vertex.throughput;
  end.bits |= (hit.prim == k_no_hit ? k_end_left : event_end) << k_path_reason_shift;
  write_event(slot, event_place(), end);
}

void record_light(uint slot, PathEvent e, vec3 light, uint component, uint group) {
  if (!event_counts(light, component)) return;
  add_light(e, light, component, group);
  write_event(slot, event_place(), e);
}

// Emission that the path has met, and light that was looked up.
void record_found(uint slot, PathEvent vertex, Hit hit, VertexOut found, uint state, uint group, vec3 gain, vec3 sun) {
  PathEvent e = vertex;
  e.parent = event_state.last;
  e.bits = (hit.prim == k_no_hit ? k_path_background : k_path_emission) | k_path_by_none << k_path_by_shift;
  if (hit.prim != k_no_hit) record_light(slot, e, gain, automaton_component(state), group);
#if LUCERNA_LIGHT_GROUPS > 1 && LUCERNA_SUN
  record_light(slot, e, sun, automaton_component(state), frame.sun_group);
#endif
#if LUCERNA_VERTEX_HOOKS
  for (uint lane = 0u; lane < found.radiance.length(); ++lane) {
    uint component = component_of_lane(lane);
    PathEvent read = vertex;
    read.parent = event_state.last;
    read.pdf = 0.0;
    read.bits = found.reader[component] | k_event_diffuse << k_path_by_shift;
    read.served = found.served[component];
    read.record = found.reader[component] == k_path_records ? found.record : k_path_no_event;
#if LUCERNA_GROUP_SUMS
    record_light(slot, read, found.radiance[lane], component, 255u);
#else
    record_light(slot, read, found.radiance[lane], component, group_of_lane(lane));
#endif
  }
#endif
}
#endif

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  uint slot = push.use_queue != 0u ? queue[push.pixel_count + index] : index;
  Ray ray;
  Hit hit;
  PathState path;
#if LUCERNA_VERTEX_HOOKS
  bool again = push.round > 0u;  // a further branch of a vertex that the first has shaded
  if (again)
    load_vertex(slot, ray, hit, path);
  else
#else
  const bool again = false;
#endif
  {
    ray = load_ray(slot);
    hit = load_hit(slot);
    path = load_path(slot);
  }
  if (path.pixel == 0xffffffffu) return;
  uint state = path_automaton(path), depth = path_depth(path);
#if LUCERNA_WORD_LAYERS
  uint layer_state = path_layer_state(path);
#endif
  Sampler random = make_sampler(path.pixel, frame.width, path.sample_index, frame.seed);
#if LUCERNA_PATH_EVENTS
  event_state = path_event_states[slot];
  // A further branch continues from a vertex that the first one has written.
  event_vertex = again ? event_state.branch : event_place();
  event_end = k_end_absorbed;
  PathEvent vertex = new_event(k_path_background, event_state.last, event_state.by, ray.origin + ray.direction * path_event_frame.far);
  vertex.pdf = path.pdf;
  vertex.throughput = path.throughput;
  bool continues = false;
#endif

  vec3 gain = vec3(0.0);  // light found here, for one lane ...
  uint group = 0u;
  vec3 sun = vec3(0.0);  // ... except an environment's sun in a separate group
  VertexOut found;
  for (uint lane = 0u; lane < found.radiance.length(); ++lane) found.radiance[lane] = vec3(0.0);
#if LUCERNA_GROUP_SUMS
  [[unroll]] for (uint g = 0u; g < k_group_count; ++g) found.by_group[g] = vec3(0.0);
#endif
  found.bias = 0.0;
  found.sky_known = false;
  found.samples_lights = true;
  found.branches = 1u;
#if LUCERNA_SHAPES
  vec3 of_shapes[k_group_count];
  [[unroll]] for (uint g = 0u; g < k_group_count; ++g) of_shapes[g] = vec3(0.0);
  if (!again) shapes_met(slot, path, ray, hit.prim == k_no_hit ? k_infinity : hit.t, of_shapes);
#endif
#if LUCERNA_PATH_EVENTS
  found.served = uvec4(0u);
  found.reader = uvec4(k_path_looked_up);
  found.record = k_path_no_event;
#endif
#if LUCERNA_HITS_SKY
  if (hit.prim == k_no_hit) {
    gain = environment_met(slot, path, ray.origin, ray.direction, sun);
#if LUCERNA_HIDDEN_BACKGROUND
    // Directly visible emission; its reflections, and the light it casts, remain.
    if (depth == 0u && automaton_no_diffuse(state)) gain = sun = vec3(0.0);
#endif
#if LUCERNA_LIGHT_GROUPS > 1
    group = frame.sky_group;
    if (frame.sun_group == group) {
      gain += sun;
      sun = vec3(0.0);
    }
#endif
  }
#endif
#if LUCERNA_HITS_SURFACES
  if (hit.prim != k_no_hit) {
    Surface surface = make_surface(ray, hit);
#if LUCERNA_DISPERSION
    disperse(surface, path, random);
#endif
#if LUCERNA_VOLUMES
    path.throughput *= media_transmittance(path.media, hit.t);
#endif
#if LUCERNA_LIGHT_GROUPS > 1 && (LUCERNA_EMISSIVE || LUCERNA_UNLIT)
    group = emissive_group(hit.prim);
#endif
#if LUCERNA_PATH_EVENTS
    vertex.bits = vertex.bits & ~0xffu | k_path_surface;
    vertex.position = surface.position;
    vertex.normal = dot(surface.normal_s, ray.direction) > 0.0 ? -surface.normal_s : surface.normal_s;
    vertex.throughput = path.throughput;
    vertex.primitive = hit.prim;
    vertex.material = surface.material;
#endif
    float travelled = path.travelled + hit.t;
    bool go_on = false;   // a next ray is traced
    bool passed = false;  // ... undeflected, without an event
    vec3 origin, direction = ray.direction;

#if LUCERNA_TRANSPARENT
    Sampler random_null = null_sampler(random, path.nulls & k_nulls_mask);
    vec2 u_null = sample_vertex(random_null, depth, k_pad_lobe);
#endif
#if LUCERNA_ALPHA
    passed = !again && u_null.x >= surface_coverage(surface);
#endif
#if LUCERNA_CATCHER
    passed = passed || (is_catcher(surface) && !automaton_no_diffuse(state));
    if (is_catcher(surface)) surface.parameters.base = catcher_color(surface, ray.direction);
#endif

    if (!passed) {
      if (depth == 0u && !again) write_features(slot, surface);
      if (!again) gain = emission_met(slot, path, surface, hit, travelled, ray.direction);
      vec3 wo_world = -ray.direction;
      mat3 to_world = shading_frame(surface, wo_world);
      vec3 wo = wo_world * to_world;   // transposed
      Bsdf bsdf = surface_bsdf(surface, to_world, wo_world);
#if LUCERNA_THIN_GLASS
      float p_undeflected = bsdf_undeflected_probability(bsdf, wo.z);
      passed = !again && u_null.y < p_undeflected;
      if (passed) random = random_null;  // the next vertex uses the random numbers of this depth
#endif
      // A null event is not counted; the surface's other lobes are lit as usual.
      bool ends = depth >= frame.max_depth;
      if (ends && !passed && !again) atomicAdd(counters[k_counter_depth], 1u);
#if LUCERNA_PATH_EVENTS
      if (ends) event_end = k_end_depth;
#endif
#if LUCERNA_UNLIT
      if ((surface.flags & k_flag_unlit) != 0u) {
        if (automaton_no_diffuse(state)) gain = path.throughput * surface.base.rgb;
        ends = true;
#if LUCERNA_PATH_EVENTS
        event_end = k_end_unlit;
#endif
      }
#endif
      if (!ends) {
        vec3 side = surface.front ? surface.normal_g : -surface.normal_g;
        VertexIn v = VertexIn(slot, path, state, depth, hit, surface, bsdf, to_world, side, random, again);
        VertexHooks hooks = hooks_read(v, found);
        uint row = 0u;
#if LUCERNA_LEARNED && LUCERNA_HITS_LIT
        row = learned_row(surface.position, to_world[2]);
#endif
#if LUCERNA_HITS_LIT
        if (!again) sample_direct_light(slot, path, surface, bsdf, wo, to_world, random, found.sky_known, found.samples_lights, row);
#endif
#if LUCERNA_VERTEX_HOOKS
        found.branches = passed || (path.bits & k_path_branched) != 0u ? 1u : min(found.branches, frame.most_branches);
        if (found.branches > 1u) {
          if (!again) keep_vertex(slot);
          path.sample_index = branch_sample(path.sample_index, found.branches, push.round);
          path.bits |= k_path_branched;
          v.random = make_sampler(path.pixel, frame.width, path.sample_index, frame.seed);
        }
#endif
        if (!passed) go_on = scatter(v, hooks, wo, found.sky_known, found.branches, path, origin, direction);
#if LUCERNA_LEARNED && LUCERNA_LIGHTS
        if (!passed) path.light_group = row;
#endif
#if LUCERNA_VERTEX_HOOKS
        if (push.round + 1u < found.branches) {
          uint account = automaton_account(path_automaton(path));
          branching_queue[queue_place(k_counter_branching, k_counter_branching_rays, account)] = slot;
        }
#endif
        hooks_end(v, hooks);
      }
#if LUCERNA_THIN_GLASS
      if (passed) path.throughput *= bsdf_undeflected(bsdf, wo.z) / p_undeflected;
#endif
    }
    if (passed) {
      origin = offset_origin(surface, direction);
      go_on = max3(path.throughput) > 0.0;
      path.travelled = travelled;
      ++path.nulls;
    }
    if (go_on) queue_ray(slot, path, origin, direction);
#if LUCERNA_PATH_EVENTS
    continues = go_on;
    if (passed) {
      vertex.bits = vertex.bits & ~0xffu | k_path_passed;
      event_state.by = k_path_by_none;
    }
#endif
  }
#endif
#if LUCERNA_PATH_EVENTS
  // A ray that leaves the scene is one event.
  if (hit.prim == k_no_hit && event_counts(gain, automaton_component(state))) add_light(vertex, gain, automaton_component(state), group);
  record_vertex(slot, vertex, again, found.branches > 1u && push.round == 0u);
  if (!again) record_found(slot, vertex, hit, found, state, group, gain, sun);
#if LUCERNA_SHAPES
  // Lamps with a shape, which the ray has met on its way.
  PathEvent of_lamp = new_event(k_path_emission, event_state.last, k_path_by_none, vertex.position);
  of_lamp.pdf = vertex.pdf;
  of_lamp.throughput = vertex.throughput;
  if (!again)
    for (uint g = 0u; g < k_group_count; ++g) record_light(slot, of_lamp, of_shapes[g], automaton_component(state), g);
#endif
  if (!continues) record_end(slot, vertex, hit);
  path_event_states[slot] = event_state;
#endif
  if (again) return;
#if LUCERNA_WORD_LAYERS
  // Light that the path has met belongs to its own state, stored light to the words that it stands for.
  vec3 of_layers[LUCERNA_WORD_LAYERS];
  vec3 met_here = is_component(automaton_component(state)) ? gain + sun : vec3(0.0);
#if LUCERNA_SHAPES
  if (is_component(automaton_component(state)))
    [[unroll]] for (uint g = 0u; g < k_group_count; ++g) met_here += of_shapes[g];
#endif
  [[unroll]] for (uint l = 0u; l < LUCERNA_WORD_LAYERS; ++l) {
    of_layers[l] = in_layer(l, layer_table.states[layer_state].accept, met_here);
#if LUCERNA_VERTEX_HOOKS
    for (uint lane = 0u; lane < found.radiance.length(); ++lane)
      of_layers[l] += in_layer(l, layers_looked_up(layer_state, component_of_lane(lane)), found.radiance[lane]);
#endif
  }
  add_to_layers(slot, of_layers);
#endif
#if LUCERNA_SHAPES
#if LUCERNA_LIGHT_GROUPS > 1
  uint component = automaton_component(state);
  for (uint g = 0u; g < k_group_count; ++g) {
    if (!is_component(component)) continue;
#if LUCERNA_GROUP_SUMS
    found.radiance[component] += of_shapes[g];
    found.by_group[g] += of_shapes[g];
#else
    found.radiance[lane_of(g, component)] += of_shapes[g];
#endif
  }
#else
  gain += of_shapes[0];
#endif
#endif
  uint met = lane_of(group, automaton_component(state)), met_sun = k_no_lane;
#if LUCERNA_LIGHT_GROUPS > 1 && LUCERNA_SUN
  if (hit.prim == k_no_hit && frame.sun_group != frame.sky_group) met_sun = lane_of(frame.sun_group, automaton_component(state));
#endif
#if LUCERNA_VERTEX_HOOKS || (LUCERNA_SHAPES && LUCERNA_LIGHT_GROUPS > 1)
#if LUCERNA_GROUP_SUMS
  add_radiance_found(slot, met, gain, met_sun, sun, found.radiance, found.by_group);
#else
  for (uint lane = 0u; lane < k_lane_count; ++lane)
    add_radiance(slot, lane, found.radiance[lane] + (met == lane ? gain : vec3(0.0)) + (met_sun == lane ? sun : vec3(0.0)));
#endif
#if LUCERNA_LOOKUP_BIAS
  add_lookup_bias(slot, found.bias);
#endif
#elif LUCERNA_HITS_SKY && LUCERNA_LIGHT_GROUPS > 1 && LUCERNA_SUN
  add_radiance_of_component(slot, met, gain, met_sun, sun);
#elif LUCERNA_HITS_SKY || LUCERNA_HITS_EMISSIVE || LUCERNA_UNLIT || LUCERNA_SHAPES
  add_radiance(slot, met, gain);
#endif
}
