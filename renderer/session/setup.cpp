#include "session/setup.h"

namespace lucerna::session {

film::SeenRange Setup::seen_range() const {
  return film::seen_range(settings.real("film.ev"), uint32_t(settings.choice("film.tone_curve")));
}

uint32_t Setup::tile_side() const { return uint32_t(std::stoul(settings.text("sampling.tile"))); }

}  // namespace lucerna::session
