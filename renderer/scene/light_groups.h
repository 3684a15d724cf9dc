#pragma once
// Groups of lights, which users dim and tint together. Each light of a scene belongs to one group: lamps,
// emitting surfaces, the sky of the environment, and its sun.
#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lucerna::scene {

/// Most groups whose light a picture can keep separately.
inline constexpr uint32_t k_most_light_groups = 16;
/// Name of the group that collects lights beyond these.
inline constexpr const char* k_other_lights = "others";
/// Texels of an environment above this multiple of its mean radiance are a sun. The default of
/// cache.environment_threshold.
inline constexpr float k_sun_threshold = 16;

struct LightGroup {
  std::string name;
  uint32_t lamps = 0;     ///< on or off
  uint32_t surfaces = 0;  ///< placed primitives that emit or are unlit
  bool sky = false, sun = false;
  bool operator==(const LightGroup&) const = default;
};

/// The group of each light (indices into `groups`).
struct LightGroups {
  std::vector<LightGroup> groups;  ///< at least one, at most k_most_light_groups; names are unique
  std::vector<uint8_t> lamps;      ///< by Scene::lights
  /// By Scene::instances, then by the mesh's primitives; empty if none of them emits.
  std::vector<std::vector<uint8_t>> surfaces;
  uint8_t sky = 0, sun = 0;
  bool has_sun = false;               ///< the environment's image has a sun
  std::vector<std::string> messages;  ///< which groups were joined, one line each

  /// Index of a name; groups.size() if there is none.
  size_t find(const std::string& name) const;
  bool operator==(const LightGroups&) const = default;
};

/// Assigns names to groups: "PATTERN=GROUP; PATTERN=GROUP". In a pattern * matches any characters, ? one
/// character (UTF-8). It is matched with names of lamps, with names of emitting nodes and materials, and with
/// "sky" and "sun". The last match counts.
struct LightGroupRule {
  std::string pattern, group;
  bool operator==(const LightGroupRule&) const = default;
};
/// Throws Error that names the invalid part.
std::vector<LightGroupRule> parse_group_rules(const std::string& text);
bool matches_pattern(const std::string& pattern, const std::string& name);
/// Makes a valid group name of at most 64 bytes: blanks at the ends are removed, and the separators of a mix
/// ; : = | become _. Longer names keep their first characters. If either changes the name, ~ and eight hash
/// digits follow, so that different names stay different. Idempotent; "" stays "".
std::string group_name(const std::string& text);
/// A lamp's or material's name without its final number: "Spot.001" and "Spot 2" become "Spot".
std::string kind_of_light(const std::string& name);

/// True if its surfaces emit, or are unlit (shown with their colour as radiance).
bool is_light(const Material& material);

/// The groups of a scene. A light's group is, in this order: that of the last matching rule, its node's
/// extras.light_group, that of its lamp or material, or one with its kind (lamps and materials whose names
/// differ only in a number, "sky", "sun"). Beyond k_most_light_groups the last groups, in the order sky, sun,
/// lamps, surfaces, are joined; messages name them.
LightGroups group_lights(const Scene& scene, const std::vector<LightGroupRule>& rules = {});
/// The same, given the groups of an earlier state of the scene: the sun of an unchanged environment image is
/// not searched again.
LightGroups group_lights(const Scene& scene, const std::vector<LightGroupRule>& rules, const Scene& earlier,
                         const LightGroups& known);

/// Per texel of the environment's image, whether it belongs to a sun: its radiance is above `threshold` times
/// the mean. Empty without an image.
std::vector<uint8_t> sun_texels(const Scene& scene, float threshold);
/// True if a texel is above k_sun_threshold.
bool has_sun(const Scene& scene);

}  // namespace lucerna::scene
