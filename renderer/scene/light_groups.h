#pragma once
// Groups of lights: what a person dims and tints together. Every light of a scene belongs to one group:
// lamps, surfaces that emit, the sky of the environment, and its sun.
#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lucerna::scene {

/// Groups that a picture's light can be kept apart by.
inline constexpr uint32_t k_most_light_groups = 16;
/// Name of the one that lights beyond these are joined in.
inline constexpr const char* k_other_lights = "others";
/// The sun of an environment: its texels of more than so many times the mean radiance. As
/// cache.environment_threshold is by default.
inline constexpr float k_sun_threshold = 16;

struct LightGroup {
  std::string name;
  uint32_t lamps = 0;     ///< on or off
  uint32_t surfaces = 0;  ///< placed pieces of meshes that emit, or are unlit
  bool sky = false, sun = false;
  bool operator==(const LightGroup&) const = default;
};

/// Which light belongs to which group (indices into `groups`).
struct LightGroups {
  std::vector<LightGroup> groups;  ///< at least one, at most k_most_light_groups; names are unique
  std::vector<uint8_t> lamps;      ///< by Scene::lights
  /// By Scene::instances, then by its mesh's primitives; empty where nothing of it emits.
  std::vector<std::vector<uint8_t>> surfaces;
  uint8_t sky = 0, sun = 0;
  bool has_sun = false;               ///< the environment's image has a sun
  std::vector<std::string> messages;  ///< what had to be joined, one line each

  /// Index of a name; groups.size() when there is none such.
  size_t find(const std::string& name) const;
  bool operator==(const LightGroups&) const = default;
};

/// What names go into which group: "PATTERN=GROUP; PATTERN=GROUP". In a pattern * stands for any characters
/// and ? for one (of UTF-8). It is held against names of lamps, of nodes and materials that emit, and against
/// "sky" and "sun"; the last that fits counts.
struct LightGroupRule {
  std::string pattern, group;
  bool operator==(const LightGroupRule&) const = default;
};
/// Throws Error, naming the part that is wrong.
std::vector<LightGroupRule> parse_group_rules(const std::string& text);
bool matches_pattern(const std::string& pattern, const std::string& name);
/// Without blanks at its ends, and with _ for the characters ; : = | that separate words of a mix. "" stays
/// "". Of a name of more than 64 bytes the first characters stay. Where either changes the name, ~ and eight
/// digits of it follow, so that names that differ stay different: at most 64 bytes. Of its own result the
/// function changes nothing.
std::string group_name(const std::string& text);
/// A lamp's or material's name without the number at its end: "Spot.001" and "Spot 2" are both "Spot".
std::string kind_of_light(const std::string& name);

/// Surfaces of it emit, or show their colour as if they did.
bool is_light(const Material& material);

/// Groups of a scene. A light belongs, in this order, to the group of the last rule that fits, that of its
/// node's extras.light_group, that of its lamp's or material's; and where nothing is said, to one with its
/// kind: lamps and materials of one name but for a number, "sky" and "sun". Beyond k_most_light_groups the
/// groups that come last, in the order sky, sun, lamps, surfaces, are joined, and messages say which.
LightGroups group_lights(const Scene& scene, const std::vector<LightGroupRule>& rules = {});
/// The same, where those of an earlier state of the scene are known, which is still there: in the same
/// environment image its sun need not be looked for again.
LightGroups group_lights(const Scene& scene, const std::vector<LightGroupRule>& rules, const Scene& earlier,
                         const LightGroups& known);

/// By texel of the environment's image, whether it is a sun's: of more than `threshold` times the mean
/// radiance. Empty where there is no image.
std::vector<uint8_t> sun_texels(const Scene& scene, float threshold);
/// Some texel is, by k_sun_threshold.
bool has_sun(const Scene& scene);

}  // namespace lucerna::scene
