// Layout of the directional-albedo tables (texel buffer `bsdf_table`). Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_BSDF_TABLE_H
#define LUCERNA_SHARED_BSDF_TABLE_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

/// A table has k_table_mu x k_table_rough texels; column i is cos(theta) = (i/(k_table_mu-1))^2, row j is
/// roughness = sqrt(alpha) = j/(k_table_rough-1). Read bilinearly in (sqrt(cos), roughness).
/// Table 0 is of a GGX reflector with F = f0 (1-w) + f90 w, w = (1-cos)^5: its single-scattering albedo is
/// f0*x + f90*y; z, w are the cosine-weighted hemisphere averages of x, y in that row.
/// Each refracting glass adds two tables, seen from outside (1 + 2*row) and from inside (2 + 2*row): x = albedo
/// (reflected + transmitted), y = its average.
LUCERNA_CONST uint k_table_mu = 32u;
LUCERNA_CONST uint k_table_rough = 32u;
LUCERNA_CONST uint k_table_texels = k_table_mu * k_table_rough;

/// Microfacet lobes with alpha below this are treated as deltas (label S).
LUCERNA_CONST float k_delta_alpha = 1e-3f;

LUCERNA_SHARED_END
#endif
