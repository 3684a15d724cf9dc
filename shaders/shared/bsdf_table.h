// Layout of the directional-albedo tables (texel buffer `bsdf_table`). Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_BSDF_TABLE_H
#define LUCERNA_SHARED_BSDF_TABLE_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

/// A table is a function of (cos, roughness) at k_table_mu x k_table_rough points: column i at cos(theta) =
/// (i/(k_table_mu-1))^2, row j at roughness = sqrt(alpha) = j/(k_table_rough-1); read bilinearly in (sqrt(cos),
/// roughness). It is stored by cells, each with all that its corners say, so that a read is one or two fetches; after
/// the cells comes a texel for each pair of neighbouring rows with their averages over the cosine-weighted hemisphere.
///
/// Table 0 is of a GGX reflector with F = f0 (1-w) + f90 w, w = (1-cos)^5: its single-scattering albedo is f0*a + f90*b.
/// Cell: (a b of column i, a b of column i+1) of row j, then of row j+1. Averages: (a b of row j, a b of row j+1).
/// Each refracting glass adds two tables, seen from outside (1 + 2*row) and from inside (2 + 2*row): the albedo e
/// (reflected + transmitted). Cell: (e at i of row j, at i+1; e at i of row j+1, at i+1). Averages: (row j, row j+1, 0, 0).
/// Then twice the same of what changes where the reflectance is A + B F in place of F, but for total reflection:
///   albedo = e + A e_0 + (B - 1) e_1,  e_k = integral of F^k over facets that reflect, less that over facets that transmit.
/// Between table 0 and those of glass is the albedo of a white sheen, in one such block; zeros without sheen.
LUCERNA_CONST uint k_table_mu = 32u;
LUCERNA_CONST uint k_table_rough = 32u;
LUCERNA_CONST uint k_table_cells = 961u;          ///< (k_table_mu - 1) * (k_table_rough - 1), row by row
LUCERNA_CONST uint k_table_schlick_texels = 1953u;  ///< 2 a cell, and the averages
LUCERNA_CONST uint k_table_glass_block = 992u;      ///< 1 a cell, and the averages
LUCERNA_CONST uint k_table_glass_texels = 2976u;    ///< three blocks: e, e_0, e_1
LUCERNA_CONST uint k_table_first_glass = 2945u;     ///< k_table_schlick_texels and the block of sheen

/// Microfacet lobes with alpha below this are treated as deltas (label S).
LUCERNA_CONST float k_delta_alpha = 1e-3f;
/// Sheen of a lower roughness is that of this one: in the limit only exactly grazing light would be reflected.
LUCERNA_CONST float k_least_sheen_roughness = 0.1f;

LUCERNA_SHARED_END
#endif
