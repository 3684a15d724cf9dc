// One vertex of every live path: emission with its MIS weight, direct light by next-event estimation, scattering, roulette.
// What can arrive later (the light sample) is queued as a shadow ray; the path goes on in the next queue.
#include "lib/variants.glsl"
#include "lib/wavefront.glsl"
#include "lib/sampler.glsl"
#include "lib/surface.glsl"
#include "lib/lights.glsl"
#if LUCERNA_CACHE
#include "irradiance_cache/lookup.glsl"
#include "irradiance_cache/guide.glsl"
#include "irradiance_cache/carried.glsl"
#endif

#include "transport/direct_light.glsl"

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  uint slot = push.use_queue != 0u ? queue[index] : index;
  Ray ray = load_ray(slot);
  Hit hit = load_hit(slot);
  PathState path = load_path(slot);
  if (path.pixel == 0xffffffffu) return;
  uint state = path_automaton(path), depth = path_depth(path);
  Sampler random = make_sampler(path.pixel, frame.width, path.sample_index, frame.seed);

  vec3 gain = vec3(0.0);  // what the path meets here, all of one component
#if LUCERNA_CACHE
  vec3 cached[k_component_count];
  for (uint c = 0u; c < k_component_count; ++c) cached[c] = vec3(0.0);
#endif
  if (hit.prim == k_no_hit) {
    gain = environment_met(path, ray.direction);
  }
  if (hit.prim != k_no_hit) {
    Surface surface = make_surface(ray, hit);
#if LUCERNA_VOLUMES
    if (path.medium != 0u) path.throughput *= exp(-material_absorption(path.medium - 1u) * hit.t);
#endif
    float travelled = path.travelled + hit.t;
    bool go_on = false;   // a next ray is to be traced
    bool passed = false;  // ... straight on, without an event
    vec3 direction = ray.direction;

#if LUCERNA_TRANSPARENT
    Sampler random_null = null_sampler(random, path.nulls);
    vec2 u_null = sample_vertex(random_null, depth, k_pad_lobe);
#endif
#if LUCERNA_ALPHA
    passed = u_null.x >= surface_coverage(surface);
#endif

    if (!passed) {
      if (depth == 0u) {
        vec3 n = surface.front ? surface.normal_s : -surface.normal_s;
        features[2u * slot] = vec4(surface.parameters.base, 1.0);
        features[2u * slot + 1u] = vec4(n, dot(surface.position - frame.camera_origin, frame.camera_forward));
      }
#if LUCERNA_EMISSIVE
      if ((surface.flags & k_flag_emissive) != 0u && (surface.front || (surface.flags & k_flag_double_sided) != 0u)) {
        gain = path.throughput * surface.emission *
               emissive_weight(path, emissive_pdf(hit.prim, travelled * travelled, abs(dot(surface.normal_g, ray.direction))));
      }
#endif
      vec3 wo_world = -ray.direction;
      mat3 to_world = shading_frame(surface, wo_world);
      vec3 wo = wo_world * to_world;   // transposed
      Bsdf bsdf = make_bsdf(surface.parameters, wo.z);
#if LUCERNA_THIN_GLASS
      float p_straight = bsdf_straight_probability(bsdf, wo.z);
      passed = u_null.y < p_straight;
      if (passed) random = random_null;  // the vertex behind has the numbers of this depth
#endif
      // What passes is no event and not counted; the surface's other lobes are lit all the same.
      bool ends = depth >= frame.max_depth;
      if (ends && !passed) atomicAdd(counters[k_counter_depth], 1u);
#if LUCERNA_UNLIT
      if ((surface.flags & k_flag_unlit) != 0u) {
        if (automaton_no_diffuse(state)) gain = path.throughput * surface.base.rgb;
        ends = true;
      }
#endif
      if (!ends) {
        vec3 side = surface.front ? surface.normal_g : -surface.normal_g;

        bool sky_known = false;  // what the sky sends to the diffuse lobe has been looked up
#if LUCERNA_CACHE
        // What lies behind this vertex's diffuse lobe: from the records, or where there are none by going on in the
        // states that leave nothing out.
        uint routes = cache.routes[state];
        bool beyond = cache.probing == k_probe_beyond && state >= k_fallback_state;
        bool screen = cache.probing == k_probe_screen && depth == 0u;
        bool next_read = cache.probing == k_probe_next && state >= k_fallback_state;
        bool carries = cache.probing == k_probe_carry || cache.probing == k_probe_carry_on;
        bool looks = (routes != k_no_routes || beyond || next_read || screen) && bsdf.p_diffuse + bsdf.p_transmitted > 0.0;
        // What is noted here, k_candidate_texels of it.
        bool noted = false;
        vec4 note = vec4(0.0), note_facing = vec4(0.0);
        // A side asks and finds nothing; all that do so are to gather.
        bool alone = false, gathers = true;
        uint guiding = k_no_guide;
        bool notes_all = cache.probing == k_probe_screen || cache.probing == k_probe_reads || next_read;
        // Records stand on the smooth surface, not on its facets nor its normal map.
        vec3 smooth_side = dot(surface.normal_v, side) < 0.0 ? -surface.normal_v : surface.normal_v;
        for (int facing = 0; facing < k_cache_sides; ++facing) {
          vec3 albedo = path.throughput * (facing == 0 ? bsdf.diffuse_albedo : bsdf.transmitted_albedo) * k_inv_pi;
          bool asks = looks && max3(albedo) > 0.0;
          // What lies on that side of the surface.
          uint medium = 0u;
#if LUCERNA_VOLUMES
          medium = facing == 0 || !surface.parameters.solid ? path.medium : surface.front ? surface.material + 1u : 0u;
#endif
          float sign = facing == 0 ? 1.0 : -1.0;
          Cached found = cache_lookup(surface.position, sign * smooth_side, sign * to_world[2], medium, asks);
          bool missing = asks && found.weight <= 0.0;
          // Of those beyond the lookup the last for which a coin says so: each as likely as all after it together.
          bool notes = ((missing && found.guide == k_no_guide) || (asks && notes_all)) && cache.probing != k_probe_none && !carries &&
                       (cache.probing != k_probe_next || next_read) &&
                       !(beyond && (sample_vertex_bits(random, depth, k_pad_light_choice).x & 1u) != 0u);
          bool servable = cache_can_serve(sign * smooth_side, sign * to_world[2]);
          if (notes && (servable || screen)) {
            uint origin = beyond ? k_origin_recursive : depth == 0u ? k_origin_screen : k_origin_world;
            noted = true;
            note = vec4(offset_origin(surface, sign * side), (servable ? 1.0 : -1.0) * float(1u + origin + k_candidate_medium * medium));
            note_facing = vec4(sign * smooth_side, uintBitsToFloat(facet_pack(sign * side)));
          }
          alone = alone || missing;
          gathers = gathers && (!missing || found.guide != k_no_guide);
          if (facing == 0) guiding = missing ? found.guide : k_no_guide;
          for (uint p = 0u; p < k_part_count; ++p)
            for (uint c = 0u; c < k_component_count; ++c)
              if (found.weight > 0.0 && ((routes >> (4u * p)) & 15u) == c) cached[c] += albedo * found.part[p];
        }
        if (alone)
          for (uint c = 0u; c < k_component_count; ++c) cached[c] = vec3(0.0);
        sky_known = looks && !alone && (routes & 15u) < k_component_count;  // part 0: k_part_direct
#endif

#if LUCERNA_LIGHTS
        sample_direct_light(slot, path, surface, bsdf, wo, to_world, random, sky_known);
#endif

        if (!passed) {
          vec2 u = sample_vertex(random, depth, k_pad_direction);
          vec3 cosine = sample_cosine(u);
#if LUCERNA_CACHE
          // Not while places are looked for: these are not to hang on the light.
          bool guided = alone && gathers && (cache.probing == k_probe_none || carries);
          Guide guide = make_guide(guided ? guiding : k_no_guide, to_world[2]);
          if (guide.total > 0.0) cosine = guide_sample(guide, u) * to_world;
#endif
          BsdfSample b = bsdf_sample(bsdf, wo, u, cosine, sample_vertex(random, depth, k_pad_lobe));
          direction = normalize(to_world * b.wi);
#if LUCERNA_CACHE
          // What is met is weighed against light samples by the density without the guide: these weights need but add up to 1.
          if (guide.total > 0.0 && !b.transmitted && b.pdf > 0.0)
            b.weight *= b.pdf / (b.pdf + bsdf.p_diffuse * k_inv_pi * b.wi.z * (guide_density(guide, direction) - 1.0));
#endif
          bool sides_agree = (dot(direction, side) > 0.0) == !b.transmitted;
#if LUCERNA_CACHE
          // In states that pass this lookup over, or all, or that have done with them.
          bool passes_all = (alone && !gathers) || cache.probing == k_probe_beyond || cache.probing == k_probe_next ||
                            (cache.probing == k_probe_carry_on && !alone);
          uint from = passes_all ? k_fallback_state : alone ? k_gather_state : k_known_state;
          bool another = looks && b.event == k_event_diffuse && state < k_fallback_state &&
                         (alone || passes_all || state >= k_gather_state);
          uint next = automaton_after(another ? state % k_gather_state + from : state, b.event);
#else
          uint next = automaton_after(state, b.event);
#endif
          vec3 throughput = path.throughput * b.weight;
          bool finite = is_finite(throughput);
          go_on = sides_agree && (!finite || max3(throughput) > 0.0) && automaton_live(next);
          if (go_on && !finite) atomicAdd(counters[k_counter_dropped], 1u);
          go_on = go_on && finite;
          uint sky = sky_bits(bsdf, sky_known, b.event);
#if LUCERNA_SKY_APART && !LUCERNA_EMISSIVE && !LUCERNA_SUN
          // The ray could meet no light but the sky's: only where it may go on to another is it worth tracing.
          go_on = go_on && ((sky & k_path_sky_known) == 0u || automaton_goes_on(next));
#endif
#if LUCERNA_CACHE
          bool ends_here = cache.probing == k_probe_lookups || cache.probing == k_probe_reads || next_read;
          go_on = go_on && cache.probing != k_probe_screen && !(ends_here && looks && b.event == k_event_diffuse);
          // Of the lookups beyond the first a coin chooses one, and what it brings counts for those it passes over.
          bool reads = carries && looks && !alone && b.event == k_event_diffuse, later = reads && state >= k_fallback_state;
          bool coin = (sample_vertex_bits(random, depth, k_pad_light_choice).x & 1u) != 0u;
          if (later) throughput *= 2.0;
          if (reads && finite && (later ? coin : cache.probing == k_probe_carry)) {
            uint medium = 0u;
#if LUCERNA_VOLUMES
            medium = !b.transmitted || !surface.parameters.solid ? path.medium : surface.front ? surface.material + 1u : 0u;
#endif
            noted = true;
            note = vec4(surface.position, uintBitsToFloat(1u + state + k_carried_medium * medium));
            note_facing = vec4(b.transmitted ? -smooth_side : smooth_side, uintBitsToFloat(carried_pack(throughput * k_inv_pi)));
            go_on = false;
          }
          // What no record serves is path traced: nothing of it is read.
          go_on = go_on && !(carries && looks && b.event == k_event_diffuse && alone && !gathers);
#endif
          path.eta_scale *= b.eta2;
          // Roulette on what the path carries without the radiance scale of refraction.
          if (depth + 1u >= frame.roulette_depth) {
            float q = clamp(max3(throughput) / path.eta_scale, 0.0, 1.0);
            float u = to_unit(sample_vertex_bits(random, depth, k_pad_light_choice)).y;
            if (u >= q) {
              if (go_on) atomicAdd(counters[k_counter_roulette], 1u);
              go_on = false;
            }
            throughput /= max(q, 1e-30);
          }
          path.throughput = throughput;
          path.pdf = b.pdf;
          path.bits = next | sky | (depth + 1u) << 8;
          path.travelled = 0.0;
          path.nulls = 0u;
#if LUCERNA_VOLUMES
          if (b.transmitted && surface.parameters.solid) path.medium = surface.front ? surface.material + 1u : 0u;
#endif
        }
#if LUCERNA_CACHE
        if (noted) {
          candidates[slot * k_candidate_texels] = note;
          candidates[slot * k_candidate_texels + 1u] = note_facing;
        }
#endif
      }
#if LUCERNA_THIN_GLASS
      if (passed) path.throughput *= bsdf_straight(bsdf, wo.z) / p_straight;
#endif
    }
    if (passed) {
      go_on = max3(path.throughput) > 0.0;
      path.travelled = travelled;
      ++path.nulls;
    }
    if (go_on) {
      Ray next_ray;
      next_ray.origin = offset_origin(surface, direction);
      next_ray.direction = direction;
      next_ray.tmax = k_infinity;
      next_ray.slot = slot;
      rays[slot].origin = next_ray.origin;
      rays[slot].direction = next_ray.direction;
      store_path(slot, path);
      next_queue[atomicAdd(counters[k_counter_next], 1u)] = slot;
      atomicAdd(counters[k_counter_rays + automaton_account(path_automaton(path))], 1u);
    }
  }
#if LUCERNA_CACHE
  for (uint c = 0u; c < k_component_count; ++c)
    add_radiance(slot, c, cached[c] + (automaton_component(state) == c ? gain : vec3(0.0)));
#else
  add_radiance(slot, automaton_component(state), gain);
#endif
}
