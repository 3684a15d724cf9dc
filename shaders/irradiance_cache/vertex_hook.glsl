// The irradiance cache at path vertices: reads records, selects the automaton state in which the path continues after a
// lookup or a miss, and writes what building the cache needs (k_probe_*).
#ifndef LUCERNA_IRRADIANCE_CACHE_VERTEX_HOOK
#define LUCERNA_IRRADIANCE_CACHE_VERTEX_HOOK
#include "transport/vertex_hook.glsl"
#include "irradiance_cache/lookup.glsl"
#include "irradiance_cache/guide.glsl"
#include "irradiance_cache/error_propagation.glsl"
#if LUCERNA_GROUP_SUMS
#include "shaders/shared/group_sums.h"
#endif

struct cache_Vertex {
  bool looks;             // records are looked up here
  bool alone;             // ... and at least one side finds none
  bool gathers;           // every side without records gathers
  uint guiding;           // record that guides directions; k_no_guide: none
  Guide guide;
  vec3 smooth_side;
  bool noted;             // a note was taken; k_candidate_texels texels
  vec4 note, note_facing;
};

// Recorded paths are the picture's, whatever is being built.
uint cache_probing() { return LUCERNA_PATH_EVENTS != 0 ? k_probe_none : cache.probing; }
bool cache_propagates() { return cache_probing() == k_probe_errors || cache_probing() == k_probe_errors_beyond; }
// State of the eye path. The delegated states repeat the same table: record light never depends on delegation.
uint cache_state_of(VertexIn v) { return without_delegation(v.state); }
bool cache_next_read(uint state) { return cache_probing() == k_probe_next && is_behind_lookup(state); }
// Random number that selects one of the records.
float record_lot(VertexIn v) { return sample_2d(v.random, k_pad_record + v.depth).x; }
bool cache_coin(VertexIn v) { return (sample_vertex_bits(v.random, v.depth, k_pad_light_choice).x & 1u) != 0u; }

// Light behind this vertex's diffuse lobe: from records; where there are none, the path continues in states that trace all
// of it.
cache_Vertex cache_read(VertexIn v, inout VertexOut o) {
  cache_Vertex x;
  uint own_state = cache_state_of(v), routes = cache.routes[own_state];
  bool beyond = cache_probing() == k_probe_beyond && is_behind_lookup(v.state);
  bool screen = cache_probing() == k_probe_screen && v.depth == 0u;
  bool next_read = cache_next_read(own_state);
  // Learned light sampling must not depend on which solver computes a component.
  x.looks = frame.learning == 0u && (routes != k_no_routes || beyond || next_read || screen) && v.bsdf.p_diffuse + v.bsdf.p_transmitted > 0.0;
  x.noted = false;
  x.note = vec4(0.0);
  x.note_facing = vec4(0.0);
  x.alone = false;
  x.gathers = true;
  x.guiding = k_no_guide;
  bool notes_all = cache_probing() == k_probe_screen || cache_probing() == k_probe_reads || next_read;
  // Records lie on the smooth surface: neither facets nor the normal map matter.
  x.smooth_side = dot(v.surface.normal_v, v.side) < 0.0 ? -v.surface.normal_v : v.surface.normal_v;
  vec3 cached[k_component_count];
  for (uint c = 0u; c < k_component_count; ++c) cached[c] = vec3(0.0);
#if LUCERNA_GROUP_SUMS
  vec3 by_group[k_group_count];
  [[unroll]] for (uint g = 0u; g < k_group_count; ++g) by_group[g] = vec3(0.0);
#endif
  for (int facing = 0; facing < k_cache_sides; ++facing) {
    vec3 albedo = v.path.throughput * (facing == 0 ? v.bsdf.diffuse_albedo : v.bsdf.transmitted_albedo) * k_inv_pi;
    bool looks_up = x.looks && max3(albedo) > 0.0;
    // Media on that side of the surface.
    uint media = 0u;
#if LUCERNA_VOLUMES
    media = facing == 0 ? v.path.media : media_behind(v.surface, v.path.media);
#endif
    float sign = facing == 0 ? 1.0 : -1.0;
    // Records hold light of paths that start at the record: with few events left that light is too long.
    bool too_long = v.depth > 0u && frame.max_depth < k_deep_paths;
    Cached found = cache_draw(v.surface.position, sign * x.smooth_side, sign * v.to_world[2], media, looks_up && !too_long, record_lot(v));
    bool missing = looks_up && found.weight <= 0.0;
    // Beyond the lookup, the last note that a coin accepts stays: each is as likely as all later ones together.
    bool notes = !too_long && ((missing && found.guide == k_no_guide) || (looks_up && notes_all)) && cache_probing() != k_probe_none && !cache_propagates() &&
                 (cache_probing() != k_probe_next || next_read) && !(beyond && cache_coin(v));
    bool servable = cache_can_serve(sign * x.smooth_side, sign * v.to_world[2]);
    if (notes && (servable || screen)) {
      uint origin = beyond ? k_origin_recursive : v.depth == 0u ? k_origin_screen : k_origin_world;
      x.noted = true;
      x.note = vec4(offset_origin(v.surface, sign * v.side), (servable ? 1.0 : -1.0) * float(1u + origin + k_candidate_media * media));
      x.note_facing = vec4(sign * x.smooth_side, uintBitsToFloat(facet_pack(sign * v.side)));
    }
    x.alone = x.alone || missing;
    x.gathers = x.gathers && (!missing || found.guide != k_no_guide);
    if (facing == 0) x.guiding = missing ? found.guide : k_no_guide;
#if LUCERNA_PATH_EVENTS
    for (uint p = 0u; p < k_part_count; ++p) {
      uint c = (routes >> (4u * p)) & 15u;
      if (found.weight > 0.0 && is_component(c)) o.served[c] = found.records, o.reader[c] = k_path_records, o.record = found.record;
    }
#endif
    for (uint p = 0u; p < k_part_count; ++p)
      for (uint c = 0u; c < k_component_count; ++c)
        if (found.weight > 0.0 && ((routes >> (4u * p)) & 15u) == c) cached[c] += albedo * found.part[p];
#if LUCERNA_GROUP_SUMS
    // The parts read here have the same group shares as all parts together.
    vec3 all = vec3(0.0), read = vec3(0.0), sky = vec3(0.0);
    for (uint p = 0u; p < k_part_count; ++p) {
      vec3 part = found.weight > 0.0 && is_component((routes >> (4u * p)) & 15u) ? albedo * found.part[p] : vec3(0.0);
      if (p == k_part_direct) {
        sky = part;
      } else {
        read += part;
        all += albedo * found.part[p];
      }
    }
    vec3 share = albedo * group_ratio(read, all);
    [[unroll]] for (uint g = 0u; g < k_group_count; ++g) by_group[g] += share * found.group[g] + (g == frame.sky_group ? sky : vec3(0.0));
#endif
  }
  for (uint c = 0u; c < k_component_count; ++c) o.radiance[lane_of(0u, c)] += x.alone ? vec3(0.0) : cached[c];
#if LUCERNA_GROUP_SUMS
  [[unroll]] for (uint g = 0u; g < k_group_count; ++g) o.by_group[g] += x.alone ? vec3(0.0) : by_group[g];
#endif
  o.sky_known = o.sky_known || (x.looks && !x.alone && is_component(routes & 15u));  // part 0: k_part_direct
  o.samples_lights = o.samples_lights && cache_probing() == k_probe_none;
  if (x.alone && x.gathers && phase_of(v.state) == k_phase_start) o.branches = max(o.branches, cache.branches);
  return x;
}

#define cache_HAS_COSINE
vec3 cache_cosine(VertexIn v, inout cache_Vertex x, vec2 u, vec3 cosine) {
#if LUCERNA_CACHE_GATHERS
  // No guiding while places are chosen: places must not depend on the light.
  bool guided = x.alone && x.gathers && (cache_probing() == k_probe_none || cache_propagates());
  x.guide = make_guide(guided ? x.guiding : k_no_guide, v.to_world[2]);
  return x.guide.total > 0.0 ? guide_sample(x.guide, u) * v.to_world : cosine;
#else
  return cosine;
#endif
}

// MIS weight of a hit against light samples, from the unguided density. Any weights that sum to 1 are unbiased.
#define cache_HAS_WEIGH
void cache_weigh(VertexIn v, cache_Vertex x, vec3 direction, inout BsdfSample b) {
#if LUCERNA_CACHE_GATHERS
  if (x.guide.total > 0.0 && !b.transmitted && b.pdf > 0.0)
    b.weight *= b.pdf / (b.pdf + (v.bsdf.p_diffuse - bsdf_drawn_rough(v.bsdf)) * k_inv_pi * b.wi.z * (guide_density(x.guide, direction) - 1.0));
#endif
}

// State behind the vertex: this lookup passed, all lookups passed, or all lookups done.
#define cache_HAS_STATE
uint cache_state(VertexIn v, cache_Vertex x, BsdfSample b, uint state) {
  bool passes_all = (x.alone && !x.gathers) || cache_probing() == k_probe_beyond || cache_probing() == k_probe_next ||
                    (cache_probing() == k_probe_errors_beyond && !x.alone);
  uint next = passes_all ? k_phase_fallback : x.alone ? k_phase_gather : k_phase_known, phase = phase_of(v.state);
  bool another = x.looks && b.event == k_event_diffuse && !is_behind_lookup(v.state) && (x.alone || passes_all || phase == k_phase_gather);
  return another ? in_phase(state, next) : state;
}

#define cache_HAS_LEAVE
void cache_leave(VertexIn v, inout cache_Vertex x, Leaving l, inout vec3 throughput, inout bool go_on) {
  bool diffuse = l.b.event == k_event_diffuse, propagates = cache_propagates();
  bool ends_here = cache_probing() == k_probe_lookups || cache_probing() == k_probe_reads || cache_next_read(cache_state_of(v));
  go_on = go_on && cache_probing() != k_probe_screen && !(ends_here && x.looks && diffuse);
  // Of the lookups beyond the first, a coin selects one; its light also counts for the lookups that it skips.
  bool reads = propagates && x.looks && !x.alone && diffuse, later = reads && is_behind_lookup(v.state);
  if (later) throughput *= 2.0;
  if (reads && l.finite && (later ? cache_coin(v) : cache_probing() == k_probe_errors)) {
    uint media = 0u;
#if LUCERNA_VOLUMES
    media = l.b.transmitted ? media_behind(v.surface, v.path.media) : v.path.media;
#endif
    x.noted = true;
    x.note = vec4(v.surface.position, uintBitsToFloat(1u + cache_state_of(v) + k_note_media * media));
    x.note_facing = vec4(l.b.transmitted ? -x.smooth_side : x.smooth_side, uintBitsToFloat(throughput_pack(throughput * k_inv_pi)));
    go_on = false;
  }
  // A side without records is path traced and reads none: nothing to propagate.
  go_on = go_on && !(propagates && x.looks && diffuse && x.alone && !x.gathers);
}

#define cache_HAS_END
void cache_end(VertexIn v, cache_Vertex x) {
  if (!x.noted) return;
  candidates[v.slot * k_candidate_texels] = x.note;
  candidates[v.slot * k_candidate_texels + 1u] = x.note_facing;
}
#endif
