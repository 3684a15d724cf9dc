#pragma once
// What a scene calls for: its effects, each with the objects that prove it. Pure and cheap, without a device.
// Plans, `lucerna info` and the window's section Effects read the same table. A new effect is a row in
// facts.cpp.
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace lucerna::plan {

/// An object of the scene that proves an effect.
struct Evidence {
  enum class Kind { material, mesh, lamp, environment, portal, camera };
  Kind kind = Kind::material;
  scene::Id index = 0;  ///< in the scene's vector of that kind; 0 for the environment
  std::string name;     ///< as displayed
};
/// "material", "lamp" ...
std::string_view kind_name(Evidence::Kind kind);

/// Groups of the table.
enum class EffectGroup { components, lights, surfaces, textures, camera };
std::string_view group_name(EffectGroup group);

struct Effect {
  std::string_view key;    ///< "rough_transmission"
  std::string_view label;  ///< "Frosted glass"
  EffectGroup group = EffectGroup::surfaces;
  std::string_view switches;  ///< what it switches on: code in kernels, tables, a component
  bool can_be_off = false;    ///< may be listed in the setting effects.off
  std::vector<Evidence>
      evidence;                ///< every object that proves it, in the scene's order; empty: not called for
  std::string_view missing{};  ///< if not called for: what the scene lacks
  bool called_for() const { return !evidence.empty(); }
};

/// Facts about a scene. Objects that cannot be met do not count: materials without a surface, lamps that are
/// off or black.
struct SceneFacts {
  std::vector<Effect> effects;  ///< the whole table, in display order
  /// The effect of that key; throws std::out_of_range.
  const Effect& effect(std::string_view key) const;
  bool has(std::string_view key) const { return effect(key).called_for(); }
};
SceneFacts facts_of(const scene::Scene& scene);

/// True if some lobes of a material are so smooth that they count as deltas. Textures count by their factors:
/// they can only make a surface smoother, and seldom polish all of it.
bool polished(const scene::Material& material);

/// The first objects by name, then how many more: "material 'Glass', 'Bottle' and 3 more"; "" without
/// evidence.
std::string evidence_text(const Effect& effect, size_t most = 3);

/// Keys of a list like that of effects.off: separated by commas. Throws Error located at `where` for an
/// unknown key, or one that cannot be off, listing those that can.
std::vector<std::string> parse_effects(const std::string& list, const std::string& where);

/// The scene without these effects (keys that can be off): textures give way to their factors, lobes, lights
/// and layers of materials are removed. The scene itself if it has none of them.
std::shared_ptr<const scene::Scene> without_effects(std::shared_ptr<const scene::Scene> scene,
                                                    const std::vector<std::string>& keys);

}  // namespace lucerna::plan
