// Path source `record`: one path for each hemisphere cell of a batch of records. Paths start in the state after ED, so the
// components of their light are the parts of the irradiance. Directions have density cos/pi; the factor pi/(MN) is applied
// when the paths are summed, so the throughput is 1. The first hit has full MIS weight (pdf 0): no light sample competes
// with it.
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
  // No light comes from below the facet, and the record does not see the facet itself: as in path tracing.
  uint flags = floatBitsToUint(texelFetch(record_texels, int(record * k_record_texels + 2u)).w);
  bool above = dot(ray.direction, facet_unpack(flags >> k_record_facet_shift)) > 0.0;
  ray.tmax = above ? k_infinity : -1.0;
  ray.slot = slot;
  store_ray(slot, ray);
  PathState p;
  p.throughput = vec3(above ? 1.0 : 0.0);
  p.pdf = 0.0;
  p.pixel = (push.pilot != 0u ? 0xc0000000u : 0x80000000u) | record;  // random sequences separate from those of pixels, and of the pilot from the others
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
