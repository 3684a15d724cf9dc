#include "session/setup.h"

#include <fmt/format.h>

namespace lucerna::session {

std::string Setup::view_text() const {
  std::string text = camera.orthographic ? fmt::format("orthographic {:.5g} {:.5g}", camera.xmag, camera.ymag)
                                         : fmt::format("perspective {:.5g}", camera.yfov);
  text += fmt::format(" aspect {:.5g} at", camera.aspect);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) text += fmt::format(" {:.5g}", camera.to_world[column][row] + 0.0f);
  return text;
}

film::SeenRange Setup::seen_range() const {
  return film::seen_range(settings.real("film.ev"), uint32_t(settings.choice("film.tone_curve")));
}

uint32_t Setup::tile_side() const { return uint32_t(std::stoul(settings.text("sampling.tile"))); }

}  // namespace lucerna::session
