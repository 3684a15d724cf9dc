// Chooses candidates of a cluster, one by one in a random order from the seed. Each chosen one removes the candidates that
// it covers, until none remains. One invocation a cluster.
#include "irradiance_cache/placement.glsl"
#include "lib/sampler.glsl"
layout(scalar) readonly buffer Starts { uint starts[]; };
layout(scalar) writeonly buffer Ranks { uint ranks[]; };  // by sorted candidate: rank among the chosen ones, from 1; 0: not chosen
layout(scalar) readonly buffer Total { uint total; };     // candidates

uint priority(uint candidate) { return hash_combine(push.seed, candidate); }

void main() {
  uint cluster = global_index();
  if (cluster >= push.count) return;
  uint first = starts[cluster], end = cluster + 1u < push.count ? starts[cluster + 1u] : total;
  uint left[(k_cluster_most + 31u) / 32u];
  uint pick = 0u, most = 0u;
  bool any = false;
  for (uint i = 0u; i < end - first; ++i) {
    uint candidate = texelFetch(entry_texels, int(first + i)).z, drawn = priority(candidate);
    ranks[first + i] = 0u;
    if ((i & 31u) == 0u) left[i >> 5] = 0u;
    left[i >> 5] |= 1u << (i & 31u);
    bool better = !any || drawn > most;
    pick = better ? i : pick;
    most = better ? drawn : most;
    any = true;
  }
  for (uint rank = 1u; any; ++rank) {
    ranks[first + pick] = rank;
    uint chosen = texelFetch(entry_texels, int(first + pick)).z;
    vec4 place = texelFetch(place_texels, int(chosen));
    vec3 normal = texelFetch(facing_texels, int(chosen)).xyz;
    left[pick >> 5] &= ~(1u << (pick & 31u));
    any = false;
    most = 0u;
    for (uint i = 0u; i < end - first; ++i) {
      uint candidate = texelFetch(entry_texels, int(first + i)).z, drawn = priority(candidate);
      vec4 other = texelFetch(place_texels, int(candidate));
      vec3 facing = texelFetch(facing_texels, int(candidate)).xyz;
      precise vec3 away = other.xyz - place.xyz, squares = away * away, along = facing * normal;
      precise float distance2 = squares.x + squares.y + squares.z, reach = min(place.w, other.w), reach2 = reach * reach;
      precise float turned = 1.0 - (along.x + along.y + along.z);
      bool is_left = (left[i >> 5] & 1u << (i & 31u)) != 0u;
      bool covered = distance2 <= reach2 && turned <= push.normal_tolerance;
      if (is_left && covered) left[i >> 5] &= ~(1u << (i & 31u));
      is_left = is_left && !covered;
      bool better = is_left && (!any || drawn > most);
      pick = better ? i : pick;
      most = better ? drawn : most;
      any = any || is_left;
    }
  }
}
