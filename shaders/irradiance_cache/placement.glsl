// Shared by the kernels that choose among candidates.
#ifndef LUCERNA_IRRADIANCE_CACHE_PLACEMENT
#define LUCERNA_IRRADIANCE_CACHE_PLACEMENT
#include "shaders/shared/irradiance_cache/placement.h"
#include "shaders/shared/sort.h"
#include "lib/invocation.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ChoosePush push; };
layout(scalar) buffer Grid { PlacementGrid grid; };
uniform samplerBuffer place_texels;
uniform samplerBuffer facing_texels;
uniform usamplerBuffer entry_texels;  // sorted: low and high word of the key, candidate

// Exponent of the largest power of two not above a normal x > 0.
int exponent_of(float x) { return int(floatBitsToUint(x) >> 23 & 0xffu) - 127; }
#endif
