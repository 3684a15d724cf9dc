// Of the photons in their order every so-manyth, at random among as many: where irradiance is to be known.
#include "photons/photon.glsl"
#include "lib/invocation.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PhotonListPush push; };  // places
uniform samplerBuffer photon_texels;
layout(scalar) writeonly buffer PhotonList { vec4 photon_list[]; };
layout(scalar) writeonly buffer PhotonIds { uint photon_ids[]; };

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  uint from = photon_of_place(i);
  for (uint t = 0u; t < k_photon_texels; ++t)
    photon_list[k_photon_texels * i + t] = texelFetch(photon_texels, int(k_photon_texels * from + t));
  photon_ids[i] = i;
}
