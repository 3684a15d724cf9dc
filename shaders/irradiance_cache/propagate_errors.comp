// Propagates record errors along the two independent paths of each pixel of a batch. Path notes (k_probe_errors) hold the
// throughput of each read; lookup.glsl provides the records and their weights. One invocation a pixel, an 8x8 block a
// workgroup. Sums run in a fixed order.
#include "irradiance_cache/reading.glsl"
#include "shaders/shared/transport.h"
#include "lib/blocks.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PropagatePush push; };
uniform samplerBuffer candidate_texels;  // first lookups of the paths: k_probe_errors
uniform samplerBuffer beyond_texels;     // lookups beyond: k_probe_errors_beyond
uniform samplerBuffer residual_texels;       // leave_one_out.comp
layout(scalar) writeonly buffer FilmLookups { vec2 film_lookups[]; };
layout(scalar) writeonly buffer BlockLookupSums { BlockLookups block_records[]; };

const uint k_groups = k_lookup_lanes / 4u;
const uint k_values = 2u * k_lookup_lanes + 1u;  // per path: noise, noise of the interpolation error, interpolation error
shared float sums[k_values * 64u];

struct ErrorSums {
  vec4 noise[k_groups], interpolation_noise[k_groups];
  float interpolation;
};

// Adds the errors of one noted read, scaled by `share`.
void propagate(inout ErrorSums sum, vec4 note, vec4 facing, float share) {
  uint bits = floatBitsToUint(note.w), state = (bits - 1u) % k_note_media, media = (bits - 1u) / k_note_media;
  bool there = bits != 0u && share > 0.0;
  vec3 throughput = throughput_unpack(floatBitsToUint(facing.w));
  uint routes = cache.routes[there ? state : 0u];
  ErrorSums here;
  for (uint g = 0u; g < k_groups; ++g) here.noise[g] = here.interpolation_noise[g] = vec4(0.0);
  here.interpolation = 0.0;
  float weights = 0.0;
  OctreeRange range = cache_range(note.xyz, there);
  for (uint i = range.first; i < range.last; ++i) {
    float weight = read_weight(note.xyz, facing.xyz, media, i);
    if (weight <= 0.0) continue;
    uint record = octree_sphere(i);
    float light = 0.0;
    for (uint p = 0u; p < k_part_count; ++p)
      light += is_component(routes >> (4u * p) & 15u) ? luminance(throughput * record_light(record, p)) : 0.0;
    weights += weight;
    light *= weight;
    float share_of_error = light / max(record_luminance(record), 1e-30);
    int residual = int(record * k_residual_texels);
    float bent = light * square(1.0 - weight);  // grows with the squared distance, as in leave_one_out.comp
    here.interpolation += bent * texelFetch(residual_texels, residual).x;
    for (uint g = 0u; g < k_groups; ++g) {
      here.noise[g] += share_of_error * record_errors(record, g);
      here.interpolation_noise[g] += bent * texelFetch(residual_texels, residual + 1 + int(g));
    }
  }
  float scale = weights > 0.0 ? share / weights : 0.0;
  sum.interpolation += scale * here.interpolation;
  for (uint g = 0u; g < k_groups; ++g) {
    sum.noise[g] += scale * here.noise[g];
    sum.interpolation_noise[g] += scale * here.interpolation_noise[g];
  }
}

ErrorSums path_errors(uint slot, bool inside) {
  ErrorSums sum;
  for (uint g = 0u; g < k_groups; ++g) sum.noise[g] = sum.interpolation_noise[g] = vec4(0.0);
  sum.interpolation = 0.0;
  int at = int(slot * k_candidate_texels);
  propagate(sum, texelFetch(candidate_texels, at), texelFetch(candidate_texels, at + 1), inside ? 1.0 : 0.0);
  if (push.beyond != 0u)
    propagate(sum, texelFetch(beyond_texels, at), texelFetch(beyond_texels, at + 1), inside ? 1.0 : 0.0);
  return sum;
}

// Stores the squares for a pixel inside the picture.
void keep_pixel(uvec2 xy, vec2 squares) {
  for (uint y = xy.y * push.step; y < min((xy.y + 1u) * push.step, push.height); ++y)
    for (uint x = xy.x * push.step; x < min((xy.x + 1u) * push.step, push.width); ++x)
      film_lookups[y * push.width + x] = squares;
}

// Sums over the pixels of each film block of this workgroup.
void keep_sums(uint block, uint path, uint width) {
  uint side = k_block / push.step, film_across = (push.width + k_block - 1u) / k_block, lane = gl_LocalInvocationIndex;
  uvec2 size = uvec2(width, (push.height + push.step - 1u) / push.step);
  for (uint entry = lane; entry < push.step * push.step * k_values; entry += 64u) {
    uint which = entry / k_values, value = entry % k_values;
    uvec2 within = uvec2(which % push.step, which / push.step);
    uvec2 to = block_pixel(block, 0u, width) * push.step / k_block + within;
    if (any(greaterThanEqual(to * k_block, uvec2(push.width, push.height)))) continue;
    float sum = 0.0, pixels = 0.0;
    for (uint code = 0u; code < 64u; ++code) {
      uvec2 xy = block_pixel(block, code, width);
      bool counts = xy / side == to && all(lessThan(xy, size));
      sum += counts ? sums[value * 64u + code] : 0.0;
      pixels += counts ? 1.0 : 0.0;
    }
    uint film_block = to.y * film_across + to.x;
    if (value < k_lookup_lanes) block_records[film_block].noise[path * k_lookup_lanes + value] = sum;
    else if (value < 2u * k_lookup_lanes)
      block_records[film_block].interpolation_noise[path * k_lookup_lanes + value - k_lookup_lanes] = sum;
    else block_records[film_block].interpolation[path] = sum;
    if (value == 0u) block_records[film_block].pixels = pixels;
  }
}

void keep(ErrorSums c, uint block, uint path, uint width) {
  uint lane = gl_LocalInvocationIndex;
  barrier();
  for (uint g = 0u; g < k_groups; ++g)
    for (uint k = 0u; k < 4u; ++k) {
      sums[(4u * g + k) * 64u + lane] = c.noise[g][k];
      sums[(k_lookup_lanes + 4u * g + k) * 64u + lane] = c.interpolation_noise[g][k];
    }
  sums[2u * k_lookup_lanes * 64u + lane] = c.interpolation;
  barrier();
  keep_sums(block, path, width);
}

void main() {
  uint index = global_index();
  bool working = index < push.pixels;
  uint block = blocks[min(index, push.pixels - 1u) / 64u].index;
  uvec2 size = (uvec2(push.width, push.height) + push.step - 1u) / push.step, xy = block_pixel(block, index % 64u, size.x);
  bool inside = working && all(lessThan(xy, size));
  ErrorSums one = path_errors(min(index, push.pixels - 1u), inside), other = path_errors(push.pixels + min(index, push.pixels - 1u), inside);
  vec2 squares = vec2(0.0, one.interpolation * other.interpolation);
  for (uint g = 0u; g < k_groups; ++g) {
    squares.x += dot(one.noise[g], other.noise[g]) / float(k_lookup_lanes);
    squares.y -= dot(one.interpolation_noise[g], other.interpolation_noise[g]) / float(k_lookup_lanes);
  }
  if (inside) keep_pixel(xy, squares);
  keep(one, block, 0u, size.x);
  keep(other, block, 1u, size.x);
}
