// Lists the photons that count at one pixel's surface. One invocation.
#include "lib/invocation.glsl"
#include "overlay/lookup_place.glsl"
#include "photons/photon.glsl"
const uint k_photons_around = k_photon_most_candidates;
#include "photons/around.glsl"
layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { PhotonInspectPush push; };
layout(scalar) buffer PhotonInspection {
  PhotonInspectHeader header;
  PhotonInspected inspected[];
};

uint listed = 0u;

void photon_met(vec4 a, vec4 b, vec3 wi, float kernel) {
  if (listed < k_photons_inspected)
    inspected[listed] = PhotonInspected(a.xyz, kernel * luminance(b.rgb), wi, floatBitsToUint(b.w), b.rgb, 0.0);
  ++listed;
}

void main() {
  if (global_index() > 0u) return;
  LookupPlace seen = lookup_place(push.pixel, push.width, push.grid, seen_at(push.pixel, push.width, push.height));
  Around around = photons_around(seen.position, seen.normal, seen.diffuse);
  header = PhotonInspectHeader(seen.position, photon_radius(seen.position), seen.normal, around.area, around.irradiance, around.density,
                               seen.diffuse ? 1u : 0u, listed, 0u, 0u);
}
