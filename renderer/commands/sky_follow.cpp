#include "commands/sky_follow.h"

namespace lucerna::commands {

void follow_sun(OpenScene& open, const scene::Light& before, const scene::Light& after) {
  if (after.kind != scene::LightKind::directional || before.direction == after.direction) return;
  // That of the edited document, which may be from before a drag; else the scene's own.
  std::optional<scene::SkyModel> sky = open.edit().sky;
  if (!sky && open.edit().environment_file.empty() && open.loaded) sky = open.loaded->environment.sky;
  if (!sky || glm::distance(sky->to_sun, -before.direction) > 1e-4f) return;
  sky->to_sun = -after.direction;
  open.edit().sky = sky;
}

}  // namespace lucerna::commands
