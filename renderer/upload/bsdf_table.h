#pragma once
// Directional albedos of the microfacet lobes, computed on the host in double precision; layout and reading
// are described in shaders/shared/bsdf_table.h.
#include <span>
#include <vector>

#include "base/math.h"

namespace lucerna::upload {

/// Table 0 (Schlick reflector), that of sheen (zeros without `sheen`), then two tables for each index of
/// refraction. The averages are integrals of the bilinearly interpolated table, so that the complement
/// returns exactly the energy missing in the table.
std::vector<vec4> build_bsdf_tables(std::span<const float> glass_iors, bool sheen);

}  // namespace lucerna::upload
