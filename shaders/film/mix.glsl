// The mix of light groups (GroupMix), in texels, which lavapipe reads much faster than words of a storage buffer.
#ifndef LUCERNA_FILM_MIX
#define LUCERNA_FILM_MIX
#include "shaders/shared/group_sums.h"

uniform samplerBuffer light_mix;
uniform usamplerBuffer group_sums;  // GroupSums of compact light groups

// GroupMix.groups and GroupMix.pixels.
uvec2 light_mix_size() { return floatBitsToUint(texelFetch(light_mix, 0)).xy; }
vec3 light_mix_whole() { return texelFetch(light_mix, 1).rgb; }
vec3 light_weight(uint group) { return texelFetch(light_mix, int(2u + group)).rgb; }
#endif
