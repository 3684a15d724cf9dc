// Source `camera`: one path for each (pixel of the item's blocks, sample). Slots are ordered pixel within block first
// (Morton order, so that neighbours trace neighbouring rays), then block, then sample.
#include "lib/wavefront.glsl"
#include "lib/sampler.glsl"
#include "lib/blocks.glsl"
#include "lib/media.glsl"
#include "lib/path_events.glsl"
#include "lib/layers.glsl"
#if LUCERNA_THIN_LENS
#include "lib/lens.glsl"
#endif
#if LUCERNA_SPLATS
#include "shaders/shared/splat.h"
layout(scalar) readonly buffer SplatBlock { SplatFrame splat_frame; };
uniform samplerBuffer splat_picture;
#endif
#if LUCERNA_PATH_EVENTS
layout(scalar) readonly buffer PathChoices { PathChoice path_choices[]; };
#endif
#if LUCERNA_DELEGATED_REGIONS
#include "lib/delegated_regions.glsl"
#endif

void main() {
  uint slot = global_index();
  if (slot >= push.count) return;
#if LUCERNA_PATH_EVENTS
  uint pixel = path_choices[slot].pixel, sample_index = path_choices[slot].sample_index;
  uvec2 xy = uvec2(pixel % frame.width, pixel / frame.width);
  const bool inside = true;
#else
  uint in_batch = slot % push.pixel_count;
  WorkBlock block = blocks[in_batch / 64u];
  uvec2 xy = block_pixel(block.index, in_batch % 64u, frame.width);
  bool inside = xy.x < frame.width && xy.y < frame.height;
  uint pixel = xy.y * frame.width + xy.x;
  uint sample_index = block.first_sample + slot / push.pixel_count;
#endif
  Sampler s = make_sampler(pixel, frame.width, sample_index, frame.seed);
  vec2 place = (vec2(xy) + sample_2d(s, k_pad_pixel)) / vec2(frame.width, frame.height);
  vec3 shift = shift_at(place);
  Ray ray;
  ray.origin = camera_start(shift);
  ray.direction = camera_direction(shift);
#if LUCERNA_THIN_LENS
  vec3 from = lens_point(sample_2d(s, k_pad_lens));
  ray.origin += from;
  ray.direction = normalize(frame.camera_forward + shift - from / frame.focus_distance);
#endif
  ray.tmax = inside && camera_covers(shift) ? k_infinity : -1.0;
#if LUCERNA_SECTION
  // The ray starts on the plane. Without a way through it, it ends at once, without a hit.
  float cut = section_distance(ray.origin, ray.direction);
  if (cut >= k_infinity)
    ray.tmax = -1.0;
  else
    ray.origin += cut * ray.direction;
#endif
  ray.slot = slot;
  store_ray(slot, ray);
  PathState p;
  p.throughput = vec3(1.0);
  p.pdf = 0.0;
  p.pixel = inside ? pixel : 0xffffffffu;
  p.sample_index = sample_index;
  p.bits = 0u;
#if LUCERNA_DELEGATED_REGIONS
  // Separate random number: both ways of computing are unbiased whatever else is drawn.
  uint coin = hash_combine(hash_combine(pixel, sample_index), frame.seed ^ 0x2c1b3c6du);
  if (coin_below(coin, delegated_share(place))) p.bits = k_delegated_states;
#endif
  p.media = 0u;
#if LUCERNA_VOLUMES
  for (uint once = 0u; once < frame.camera_in_solids; ++once) p.media = media_at(ray.origin, hash_combine(pixel, sample_index));
#endif
  p.travelled = 0.0;
  p.eta_scale = 1.0;
  p.nulls = 0u;
  p.light_group = 0u;
  store_path(slot, p);
  clear_radiance(slot);
#if LUCERNA_WORD_LAYERS
  [[unroll]] for (uint l = 0u; l < LUCERNA_WORD_LAYERS; ++l) set_layer(slot, l, vec3(0.0));
#endif
#if LUCERNA_PATH_EVENTS
  event_state = PathEventState(0u, 0u, 0u, k_path_by_none, 0u);
  PathEvent start = new_event(k_path_camera, k_path_no_event, k_path_by_none, ray.origin);
  start.normal = ray.direction;
  start.throughput = p.throughput;
  write_event(slot, event_place(), start);
#endif
#if LUCERNA_SPLATS
  // Adds what light paths contributed to the pixel, whatever this path hits. A preview sample of lower resolution reads the
  // pixel that its path goes through.
  if (inside && splat_frame.width > 0u) {
    uvec2 size = uvec2(splat_frame.width, splat_frame.height);
    bool same = size == uvec2(frame.width, frame.height);
    uvec2 at = same ? xy : min(uvec2(place * vec2(size)), size - 1u);
    vec4 splat = texelFetch(splat_picture, int(at.y * size.x + at.x));
    radiance[radiance_texel(slot, lane_of(0u, splat_frame.component))].rgb = splat.rgb;
#if LUCERNA_WORD_LAYERS
    [[unroll]] for (uint l = 0u; l < LUCERNA_WORD_LAYERS; ++l)
      set_layer(slot, l, in_layer(l, layer_table.splat[splat_frame.component], splat.rgb));
#endif
#if LUCERNA_PATH_EVENTS
    if (event_counts(splat.rgb, splat_frame.component)) {
      PathEvent e = new_event(k_path_splat, 0u, k_path_by_none, ray.origin);
      add_light(e, splat.rgb, splat_frame.component, 255u);
      write_event(slot, event_place(), e);
    }
#endif
#if LUCERNA_GROUP_SUMS
    // Each channel's light belongs to its group. If two channels share a group, its texel is written twice with equal
    // values.
    uvec3 groups = uvec3(floatBitsToUint(splat.a)) >> (k_splat_owner_bits * uvec3(0u, 1u, 2u)) &
                   ((1u << k_splat_owner_bits) - 1u);
    uint lit = 0u;
    for (int c = 0; c < 3; ++c) {
      if (splat[c] > 0.0) {
        vec3 of_group = mix(vec3(0.0), splat.rgb, equal(groups, uvec3(groups[c])));
        radiance[group_texel(slot, groups[c])].rgb = of_group;
        lit |= 1u << groups[c];
      }
    }
    radiance[radiance_texel(slot, 0u)].a = uintBitsToFloat(lit);
#endif
  }
#endif
#if LUCERNA_LOOKUP_BIAS
  radiance[radiance_texel(slot, 1u)].a = 0.0;
#endif
  features[2u * slot] = vec4(0.0);
  features[2u * slot + 1u] = vec4(0.0);
#if LUCERNA_PATH_EVENTS
  path_event_states[slot] = event_state;
#endif
}
