// Source `record`: a path for each cell of the hemispheres of a batch of records. They begin in the state after ED, so
// that the components of what they gather are the parts of the irradiance. Density cos/pi per solid angle, whose
// weight 1/pdf the sum's pi/(MN) stands for: throughput 1. What the first ray meets gets the full weight (pdf 0), because
// no light sample competes with it here.
#define LUCERNA_PUSH RecordPush
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/wavefront.glsl"
#include "lib/sampler.glsl"
#include "irradiance_cache/hemisphere.glsl"
#include "shaders/shared/facet.h"

void main() {
  uint slot = global_index();
  uint cells = push.elevations * push.azimuths;
  if (slot >= push.records * cells) return;
  uint cell = slot / push.records;
  uint elevation = cell % push.elevations, azimuth = cell / push.elevations;
  uint record = record_list[push.first + slot % push.records];
  vec4 place = texelFetch(record_texels, int(record * k_record_texels));
  vec3 normal = texelFetch(record_texels, int(record * k_record_texels + 1u)).xyz;
  CellRay along = cell_ray(elevation, azimuth, record);
  vec3 tangent, bitangent;
  make_basis(normal, tangent, bitangent);
  Ray ray;
  ray.origin = place.xyz;
  ray.direction = normalize(along.sine * (cos(along.phi) * tangent + sin(along.phi) * bitangent) + along.cosine * normal);
  // Below the facet there is no light, and the facet itself is not what the record sees: as path tracing has it.
  uint flags = floatBitsToUint(texelFetch(record_texels, int(record * k_record_texels + 2u)).w);
  bool above = dot(ray.direction, facet_unpack(flags >> k_record_facet_shift)) > 0.0;
  ray.tmax = above ? k_infinity : -1.0;
  ray.slot = slot;
  store_ray(slot, ray);
  PathState p;
  p.throughput = vec3(above ? 1.0 : 0.0);
  p.pdf = 0.0;
  p.pixel = (push.pilot != 0u ? 0xc0000000u : 0x80000000u) | record;  // sequences apart from the pixels', and from each other
  p.sample_index = push.rays_before + cell;
  p.bits = push.state | k_path_sky_only | 1u << k_path_events_shift;
  p.media = floatBitsToUint(texelFetch(record_texels, int(record * k_record_texels + 5u)).x);
  p.travelled = 0.0;
  p.eta_scale = 1.0;
  p.nulls = 0u;
  p.light_group = 0u;
  store_path(slot, p);
  clear_radiance(slot);
}
