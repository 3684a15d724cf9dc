#include "commands/view_transform.h"

#include <algorithm>

namespace lucerna::commands {

film::ViewTransform view_transform(const OpenScene& open) {
  const std::vector<std::string>& curves = plan::find_option("film.tone_curve")->choices;
  const auto curve = std::find(curves.begin(), curves.end(), open.setting("film.tone_curve"));
  return {.ev = static_cast<float>(open.setting_real("film.ev")),
          .curve = static_cast<uint32_t>(curve - curves.begin()),
          .ocio = open.setting("film.ocio")};
}

}  // namespace lucerna::commands
