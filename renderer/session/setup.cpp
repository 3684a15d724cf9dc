#include "session/setup.h"

#include <cmath>

namespace lucerna::session {

film::SeenRange Setup::seen_range() const {
  film::SeenRange range =
      film::seen_range(settings.real("film.ev"), uint32_t(settings.choice("film.tone_curve")));
  if (ocio_white > 0) range.white = float(ocio_white / std::exp2(settings.real("film.ev")));
  return range;
}

uint32_t Setup::tile_side() const { return uint32_t(std::stoul(settings.text("sampling.tile"))); }

}  // namespace lucerna::session
