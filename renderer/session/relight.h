#pragma once
// Evaluates the settings of light groups: whether groups are separate, their mix, and, if they are not
// separate, the scene with the mix applied to its lights.
#include <memory>
#include <string>
#include <vector>

#include "film/film.h"
#include "plan/plan.h"
#include "scene/light_mix.h"
#include "upload/flatten.h"

namespace lucerna::session {

struct Relight {
  std::shared_ptr<const scene::LightGroups> groups;       ///< null if not needed
  std::shared_ptr<const scene::Scene> scene;              ///< their scene
  bool separate = false;                                  ///< groups are separate: a mix traces no rays
  film::GroupStorage kept = film::GroupStorage::compact;  ///< storage, if separate
  std::string why_not;                                    ///< if not: the reason, for messages
  std::vector<vec3> weights;                              ///< by group
  std::shared_ptr<const scene::Scene> lit;                ///< the traced scene
  std::string traced;                                     ///< plan::traced_scene_key(), as applied to `lit`
  std::string baked;  ///< settings applied to `lit`; "": none, it is the scene itself
  /// By group: strength of the scene's lights over those of `lit`, to which a mix was applied; empty: equal.
  /// Included in the weights.
  std::vector<vec3> written;
  std::vector<std::string> messages;  ///< messages: missing groups, merged lights
};

/// For a picture of that size. `interactive`: in the window. `memory`: of the device [bytes]. `before`: the
/// former one. Throws Error, located at the setting.
Relight make_relight(const plan::Plan& plan, const plan::Settings& settings,
                     std::shared_ptr<const scene::Scene> scene, bool interactive, uint64_t pixels,
                     uint64_t memory, const Relight& before);
/// Applies new light strengths and a new mix that give the same total light as now: the traced scene and its
/// weights stay. `lit`: the traced scene. False, and no change: the light differs, or groups are not
/// separate. Throws Error located at the setting.
bool write_mix(Relight& relight, std::shared_ptr<const scene::Scene> scene, const scene::Scene& lit,
               const plan::Settings& settings, const std::string& mix);
/// Continues tracing the scene of `before`, if scene and groups are the same.
void keep_written(Relight& relight, const Relight& before);
/// Applies another mix to separate groups. Throws Error; then nothing changes.
void remix(Relight& relight, const std::string& text);
/// Messages that the former one did not have.
std::vector<std::string> new_messages(const Relight& relight, const Relight& before);

}  // namespace lucerna::session
