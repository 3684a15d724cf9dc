// Source `camera`: one path for each (pixel of the batch's tiles, sample). Slots are ordered pixel within tile first (Morton
// order, so that neighbours trace neighbouring rays), then tile, then sample.
#include "lib/wavefront.glsl"
#include "lib/sampler.glsl"

uint compact_bits(uint x) {  // every other bit of a 6-bit Morton code
  return (x & 1u) | ((x >> 1) & 2u) | ((x >> 2) & 4u);
}

void main() {
  uint slot = global_index();
  if (slot >= push.count) return;
  uint in_batch = slot % push.pixel_count;
  uint tile = push.first_pixel + in_batch / 64u, code = in_batch % 64u;
  uint tiles_x = (frame.width + 7u) / 8u;
  uvec2 xy = 8u * uvec2(tile % tiles_x, tile / tiles_x) + uvec2(compact_bits(code), compact_bits(code >> 1));
  bool inside = xy.x < frame.width && xy.y < frame.height;
  uint pixel = xy.y * frame.width + xy.x;
  uint sample_index = push.first_sample + slot / push.pixel_count;
  Sampler s = make_sampler(pixel, sample_index, frame.seed);
  vec2 ndc = (vec2(xy) + sample_2d(s, k_pad_pixel)) / vec2(frame.width, frame.height) * 2.0 - 1.0;
  vec3 shift = ndc.x * frame.camera_right - ndc.y * frame.camera_up;
  Ray ray;
  ray.origin = frame.camera_origin + (frame.orthographic != 0u ? shift : vec3(0.0));
  ray.direction = normalize(frame.camera_forward + (frame.orthographic != 0u ? vec3(0.0) : shift));
  ray.tmax = inside ? k_infinity : -1.0;
  ray.slot = slot;
  rays[slot] = ray;
  PathState p;
  p.throughput = vec3(1.0);
  p.pdf = 0.0;
  p.pixel = inside ? pixel : 0xffffffffu;
  p.sample_index = sample_index;
  p.bits = 0u;
  p.medium = 0u;
  p.travelled = 0.0;
  p.eta_scale = 1.0;
  p.pad0 = 0.0;
  p.pad1 = 0.0;
  paths[slot] = p;
  for (uint c = 0u; c < k_component_count; ++c) radiance[slot * k_component_count + c].rgb = vec3(0.0);
  features[2u * slot] = vec4(0.0);
  features[2u * slot + 1u] = vec4(0.0);
}
