// Groups of lights in records, where films keep them in short (LUCERNA_GROUP_SUMS): for every record what share each group
// has in the light of its parts but k_part_direct, which is the sky's alone. Gradients are those of the light as a whole: a
// share is taken to be the same all over the record's disc.
#ifndef LUCERNA_IRRADIANCE_CACHE_GROUPS
#define LUCERNA_IRRADIANCE_CACHE_GROUPS
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/group_shares.glsl"

uniform usamplerBuffer record_group_texels;
#endif
