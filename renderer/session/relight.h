#pragma once
// What settings make of a scene's groups of lights: whether their light is kept apart, how they are mixed,
// and where it is not kept apart the scene with its lights so.
#include <memory>
#include <string>
#include <vector>

#include "film/film.h"
#include "plan/plan.h"
#include "scene/light_mix.h"
#include "upload/flatten.h"

namespace lucerna::session {

struct Relight {
  std::shared_ptr<const scene::LightGroups> groups;       ///< null where nobody asks for them
  std::shared_ptr<const scene::Scene> scene;              ///< that they are of
  bool separate = false;                                  ///< a mix costs no ray
  film::GroupStorage kept = film::GroupStorage::compact;  ///< how, where it is
  std::string why_not;                                    ///< where it is not: the reason, for people
  std::vector<vec3> weights;                              ///< by group
  std::shared_ptr<const scene::Scene> lit;                ///< what is to be traced
  std::string baked;  ///< what of the settings `lit` was made with; "": it is the scene itself
  /// By group, what the scene's lights are of those of `lit`, which a mix was written into; none: the same.
  /// Part of the weights.
  std::vector<vec3> written;
  std::vector<std::string> messages;  ///< lines for people: groups that are gone, lights that were joined
};

/// For a picture of that size. `interactive`: in the window. `memory`: of the device [bytes]. `before`: of
/// what was there until now. Throws Error, located at the setting.
Relight make_relight(const plan::Plan& plan, const plan::Settings& settings,
                     std::shared_ptr<const scene::Scene> scene, bool interactive, uint64_t pixels,
                     uint64_t memory, const Relight& before);
/// Takes up a scene with other strengths of lights, and another mix, that together give the same light as
/// now: what is traced and how it is weighed stays. `lit`: what is traced. False, and nothing has changed:
/// the light is another, or is not kept apart. Throws Error located at the setting.
bool write_mix(Relight& relight, std::shared_ptr<const scene::Scene> scene, const scene::Scene& lit,
               const plan::Settings& settings, const std::string& mix);
/// Goes on tracing what `before` had traced, where both are of the same scene and groups.
void keep_written(Relight& relight, const Relight& before);
/// Takes up another mix, where light is kept apart. Throws Error; then nothing has changed.
void remix(Relight& relight, const std::string& text);

}  // namespace lucerna::session
