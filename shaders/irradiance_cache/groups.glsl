// Light groups in records, for films with compact groups (LUCERNA_GROUP_SUMS): the share of each group in a record's light,
// all parts except k_part_direct, which belongs to the sky alone. Gradients are not split: shares are constant over a
// record's disc.
#ifndef LUCERNA_IRRADIANCE_CACHE_GROUPS
#define LUCERNA_IRRADIANCE_CACHE_GROUPS
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/group_shares.glsl"

uniform usamplerBuffer record_group_texels;
#endif
