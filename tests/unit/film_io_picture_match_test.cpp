// links: film_io
// Comparison of pictures for the display: what another driver does is allowed, what a person sees is not.
#include "film/io/picture_match.h"

#include <catch2/catch.hpp>

namespace film_io_picture_match_tests {

using namespace lucerna;
using namespace lucerna::film;

namespace {

/// A dark panel with bright lines of text-like marks.
std::vector<uint8_t> panel(uint32_t shift = 0, uint8_t noise = 0) {
  std::vector<uint8_t> rgba(size_t{160} * 120 * 4, 255);
  for (uint32_t y = 0; y < 120; ++y)
    for (uint32_t x = 0; x < 160; ++x)
      for (uint32_t k = 0; k < 3; ++k) {
        const bool mark = y % 16 < 8 && (x + shift) % 6 < 2;
        rgba[(size_t{y} * 160 + x) * 4 + k] =
            static_cast<uint8_t>((mark ? 220 : 34) + (noise ? (x * 7 + y * 3) % noise : 0u));
      }
  return rgba;
}

}  // namespace

TEST_CASE("rounding and noise are allowed, a changed mark is not") {
  const FilmImage reference = display_picture(160, 120, panel());
  const auto match = [&](const std::vector<uint8_t>& rgba) {
    return match_pictures(display_picture(160, 120, rgba), reference, {}, "r.png");
  };
  CHECK(match(panel()).matches);
  CHECK(match(panel()).largest == 0);
  CHECK(match(panel(0, 6)).matches);
  std::vector<uint8_t> changed = panel();
  for (uint32_t y = 32; y < 44; ++y)
    for (uint32_t x = 40; x < 52; ++x) changed[(size_t{y} * 160 + x) * 4] = 255;
  const PictureMatch found = match(changed);
  CHECK_FALSE(found.matches);
  CHECK(found.share == Approx(9.0 / 1200));
  CHECK((found.x >= 40 && found.x < 52 && found.y >= 32 && found.y < 44));
  CHECK_THAT(to_text(found), Catch::StartsWith("differs in 0.75 % of its area"));
  // A few cells may differ.
  CHECK(match_pictures(display_picture(160, 120, changed), reference, {.share = 0.01}, "r.png").matches);
}

TEST_CASE("pictures of other sizes and grey ones are refused") {
  const FilmImage reference = display_picture(160, 120, panel());
  CHECK_THROWS_WITH(match_pictures(display_picture(120, 160, panel()), reference, {}, "r.png"),
                    "r.png: is 160x120 pixels; the picture has 120x160");
  FilmImage grey = reference;
  grey.channels.resize(1);
  grey.channels[0].first = "Y";
  CHECK_THROWS_WITH(match_pictures(reference, grey, {}, "r.png"), Catch::Contains("r.png: no channel 'R'"));
}

}  // namespace film_io_picture_match_tests
