// The bounce's photons are among those before.
#include "shaders/shared/photons/photons.h"

layout(local_size_x = 1) in;
layout(scalar) buffer PhotonCounts { uint photon_counts[]; };

void main() { photon_counts[k_photons_stored] += photon_counts[k_photons_added]; }
