// Puts the photons of a bounce behind those before, in the order of their slots.
#include "shaders/shared/photons/photons.h"
#include "lib/invocation.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PhotonListPush push; };
layout(scalar) readonly buffer PhotonPending { Photon photon_pending[]; };
layout(scalar) buffer PhotonFlags { uint photon_flags[]; };
layout(scalar) readonly buffer PhotonPlaces { uint photon_places[]; };
layout(scalar) readonly buffer PhotonCounts { uint photon_counts[]; };
layout(scalar) writeonly buffer PhotonList { Photon photon_list[]; };

void main() {
  uint slot = global_index();
  if (slot >= push.count || photon_flags[slot] == 0u) return;
  photon_flags[slot] = 0u;
  uint at = photon_counts[k_photons_stored] + photon_places[slot];
  if (at < push.capacity) photon_list[at] = photon_pending[slot];
}
