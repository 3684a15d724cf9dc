// links: ui
// The histogram of the shown picture, and the frame with the camera's aspect ratio.
#include <catch2/catch.hpp>
#include <numeric>

#include "ui/frame_guide.h"
#include "ui/histogram.h"

namespace histogram_tests {

using namespace lucerna;
using ui::Histogram;

TEST_CASE("every pixel is counted once a curve, and clipped ones by their channels") {
  const std::vector<uint8_t> rgba{0,   0,   0,   255,  // black
                                  255, 0,   0,   255,  // clipped in one channel
                                  255, 255, 255, 255,  // white
                                  10,  20,  30,  0,    // alpha does not count
                                  0,   1,   0,   255,  // not black
                                  7,   7};             // an incomplete pixel
  const Histogram h = ui::histogram_of(rgba);
  CHECK(h.pixels == 5);
  CHECK(h.white == 2);
  CHECK(h.black == 1);
  for (const auto& counts : h.counts) CHECK(std::accumulate(counts.begin(), counts.end(), 0u) == 5);
  CHECK(h.counts[Histogram::red][255] == 2);
  CHECK(h.counts[Histogram::green][20] == 1);
  CHECK(h.counts[Histogram::blue][0] == 3);
  // Greys keep their value; red has the weight 0.2126.
  for (const uint8_t grey : {0, 1, 127, 128, 254, 255}) {
    const std::vector<uint8_t> pixel{grey, grey, grey, 255};
    CHECK(ui::histogram_of(pixel).counts[Histogram::luma][grey] == 1);
  }
  CHECK(h.counts[Histogram::luma][54] == 1);
  CHECK(ui::histogram_of({}).pixels == 0);
}

TEST_CASE("the frame has the ratio by the height of the picture, or there is none") {
  const ui::Area picture{{100, 50}, {1060, 590}};  // 16:9
  const auto frame = ui::guide_area(picture, 1);
  REQUIRE(frame);
  CHECK(frame->lo.x == 310);
  CHECK(frame->hi.x == 850);
  CHECK(frame->lo.y == 50);
  CHECK(frame->hi.y == 590);
  REQUIRE(ui::guide_area(picture, 16.0f / 9));
  CHECK(ui::guide_area(picture, 16.0f / 9)->width() == 960);
  CHECK_FALSE(ui::guide_area(picture, 2.39f));
  CHECK_FALSE(ui::guide_area(picture, 0));
}

}  // namespace histogram_tests
