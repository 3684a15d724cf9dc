#pragma once
// A mix of light: how strong and of which tint every group of lights (light_groups.h) is in a picture,
// without the scene being another. Light is linear in each light's strength, so that a mix can be applied to
// what groups have brought as well as to the lights themselves.
#include <map>
#include <string>
#include <vector>

#include "scene/light_groups.h"

namespace lucerna::scene {

struct GroupMix {
  float ev = 0;   ///< strength: a factor of 2 to this power; -k_most_ev to k_most_ev
  vec3 color{1};  ///< linear; multiplies, not negative
  bool mute = false;
  bool solo = false;  ///< where some group is, all that are not are mute
  bool operator==(const GroupMix&) const = default;
  bool neutral() const { return *this == GroupMix(); }
};
inline constexpr float k_most_ev = 30;
/// The largest part of a colour.
inline constexpr float k_most_tint = 1000;

/// By the groups' names; of groups that are not in it nothing is changed. May name groups that a scene lacks.
using LightMix = std::map<std::string, GroupMix>;

/// "lamps: ev=-1 color=1,0.8,0.5; sky: mute", as mix_text() writes it. Besides ev there may be factor=NUMBER
/// (a strength above 0), and kelvin=NUMBER in place of color. Throws Error at `where`, naming the part.
LightMix parse_mix(const std::string& text, const std::string& where = "relight.mix");
/// Without what is neutral.
std::string mix_text(const LightMix& mix);

/// What a group's light is multiplied by.
vec3 mix_weight(const LightMix& mix, const std::string& group);
std::vector<vec3> mix_weights(const LightMix& mix, const LightGroups& groups);
/// Nothing is changed of these groups.
bool is_neutral(const LightMix& mix, const LightGroups& groups);
/// Groups that the mix names and that there are not.
std::vector<std::string> unknown_groups(const LightMix& mix, const LightGroups& groups);

/// Between two mixes: the weights of all groups, linearly in light; t = 0 is `a` itself, t = 1 `b`. In
/// between nothing is solo: what is silent by that is mute.
LightMix blend(const LightMix& a, const LightMix& b, float t, const LightGroups& groups);

/// Mixes with names: "morning = sky: ev=1 | evening = sky: mute; lamps: ev=2". Names are as group_name() has
/// them. Throws Error at `where`.
using MixPresets = std::map<std::string, LightMix>;
MixPresets parse_presets(const std::string& text, const std::string& where = "relight.presets");
std::string presets_text(const MixPresets& presets);

/// The scene with lights as the mix has them. All surfaces of one material take the weight of the first of
/// them; `messages` (may be null) gets a line for each material that is in groups of different weights.
Scene mixed_scene(const Scene& scene, const LightGroups& groups, const LightMix& mix,
                  std::vector<std::string>* messages = nullptr);

}  // namespace lucerna::scene
