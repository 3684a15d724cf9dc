#pragma once
// A mix: strength and tint of each group of lights (light_groups.h) in a picture, without changing the scene.
// Light is linear in each light's strength, so a mix can be applied to the groups' light as well as to the
// lights.
#include <map>
#include <string>
#include <vector>

#include "scene/light_groups.h"

namespace lucerna::scene {

struct GroupMix {
  float ev = 0;   ///< strength: a factor of 2 to this power; -k_most_ev to k_most_ev
  vec3 color{1};  ///< linear; multiplies, not negative
  bool mute = false;
  bool solo = false;  ///< if any group is solo, all others are mute
  bool operator==(const GroupMix&) const = default;
  bool neutral() const { return *this == GroupMix(); }
};
inline constexpr float k_most_ev = 30;
/// The largest channel of GroupMix::color.
inline constexpr float k_most_tint = 1000;

/// By name of the group; groups that are not listed are unchanged. May name groups that a scene lacks.
using LightMix = std::map<std::string, GroupMix>;

/// Parses "lamps: ev=-1 color=1,0.8,0.5; sky: mute". Also accepts factor=NUMBER (above 0) for ev, and
/// kelvin=NUMBER for color. Throws Error at `where` that names the invalid part.
LightMix parse_mix(const std::string& text, const std::string& where = "relight.mix");
/// The inverse of parse_mix(), without neutral groups.
std::string mix_text(const LightMix& mix);

/// The factor of a group's light.
vec3 mix_weight(const LightMix& mix, const std::string& group);
std::vector<vec3> mix_weights(const LightMix& mix, const LightGroups& groups);
/// True if the mix changes none of these groups.
bool is_neutral(const LightMix& mix, const LightGroups& groups);
/// Groups that the mix names and `groups` lacks.
std::vector<std::string> unknown_groups(const LightMix& mix, const LightGroups& groups);

/// Interpolates two mixes linearly in light, group by group; t = 0 is `a`, t = 1 `b`. In between no group is
/// solo: silenced groups are mute.
LightMix blend(const LightMix& a, const LightMix& b, float t, const LightGroups& groups);

/// Named mixes: "morning = sky: ev=1 | evening = sky: mute; lamps: ev=2". Names follow group_name(). Throws
/// Error at `where`.
using MixPresets = std::map<std::string, LightMix>;
MixPresets parse_presets(const std::string& text, const std::string& where = "relight.presets");
std::string presets_text(const MixPresets& presets);

/// The scene with the mix applied to its lights. All surfaces of a material get the weight of the first of
/// them; `messages` (may be null) gets a line for each material in groups of different weights.
Scene mixed_scene(const Scene& scene, const LightGroups& groups, const LightMix& mix,
                  std::vector<std::string>* messages = nullptr);

}  // namespace lucerna::scene
