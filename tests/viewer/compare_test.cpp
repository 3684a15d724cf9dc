// links: ui film_io
// The Compare panel and the comparison over the picture: its plot and texts; the wipe dragged, the flip by a
// key.
#include <catch2/catch.hpp>

#include "support.h"
#include "ui/compare_pictures.h"
#include "ui/compare_plot.h"

namespace compare_tests {

using namespace lucerna;
using namespace lucerna::ui;

namespace {

std::shared_ptr<session::HeldPicture> held(const char* method, double seconds, double error) {
  auto picture = std::make_shared<session::HeldPicture>();
  picture->width = 2, picture->height = 1, picture->light.assign(2, vec3(1));
  picture->methods.fill(method);
  picture->seconds = seconds, picture->samples = 10 * seconds, picture->error = error;
  for (const double part : {0.25, 0.5}) {
    stats::Entry e;
    e.paths = uint64_t(1000 * part), e.has_error = true, e.wall_s = part * seconds,
    e.error[0] = error / std::sqrt(part);
    picture->ledger.add(e);
  }
  return picture;
}

}  // namespace

TEST_CASE("the plot has a line for each result with a time and an error, up to when it was held") {
  commands::HeldResults results;
  results.add("", "", "", held("path", 12, 0.02));
  results.add("file", "", "", std::make_shared<session::HeldPicture>());
  results.add("", "", "", held("cache", 3, 0.01));
  results.compare_with("cache");
  const std::vector<CompareLine> lines = compare_lines(results, nullptr);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].mark == "A");
  CHECK(lines[1].mark == "C");
  CHECK(lines[1].compared);
  CHECK_FALSE(lines[0].compared);
  REQUIRE(lines[0].points.size() == 3);
  CHECK(lines[0].points.back() == std::pair(12.0, 0.02));
  CHECK(lines[0].points[0].second == Approx(0.04));
  const PlotRange range = compare_range(lines);
  CHECK(range.t_lo <= 0.75);
  CHECK(range.t_hi >= 12);
  CHECK(range.e_lo <= 0.01);
  CHECK(range.e_hi >= 0.04);
  CHECK(compare_range({}).t_hi > 0);
}

TEST_CASE("a result in words: name, methods, what it shows, time, error, filter") {
  commands::HeldResults results;
  auto picture = held("path", 12, 0.021);
  results.add("", "", "", picture);
  CHECK(held_text(results.list()[0]) == "path, 12 s, 2.10 %");
  picture->file = "/pictures/before.exr";
  CHECK(held_text(results.list()[0]) == "path, 12 s, 2.10 %");
  picture->shows = "caustic", picture->filtered = true, picture->shown_error = 0.05;
  results.rename("path", "before");
  CHECK(held_text(results.list()[0]) == "before: path, caustic only, 12 s, 5.00 % off, filtered");
  results.add("file", "", "", std::make_shared<session::HeldPicture>());
  CHECK(held_text(results.list()[1]) == "file");
}

TEST_CASE("thumbnails are means of squares of pixels") {
  session::HeldPicture picture{.width = 5, .height = 2, .light = {}};
  for (int i = 0; i < 10; ++i) picture.light.emplace_back(float(i));
  const session::HeldPicture small = reduced(picture, 3);
  CHECK(small.width == 2);
  CHECK(small.height == 1);
  CHECK(small.light[0] == vec3(3));
  CHECK(small.light[1] == vec3(5));
  CHECK(reduced(picture, 100).light == picture.light);
}

TEST_CASE("the wipe's line is dragged in the picture without a selection or a camera move; Y flips") {
  if (test::no_display()) return;
  const auto outcome = test::window(
      "wait_scene\nwindow.size 1440 900\nset samples 4\nwait samples 4\nkey ctrl+h\nwait until compare.held "
      "is 1\n"
      "window.section \"Accuracy in time\" true\nexpect text \"HELD RESULTS\" in right\ncompare.view "
      "wipe\nwait 0.3\n"
      "expect text \"Now\" in picture\n"
      // The picture is between the panels: 280 to 1144; the line is in its middle.
      "mouse.move 712 300\nmouse.down\nmouse.move 722 300\nmouse.move 812 300\nmouse.up\n"
      "expect compare.at > 0.58\nexpect compare.at < 0.65\nexpect selection is \"\"\n"
      // A click on the line moves nothing.
      "mouse.down\nmouse.up\nexpect compare.at < 0.65\nexpect selection is \"\"\n"
      "compare.view off\nwait 0.2\nexpect text not \"Held\" in picture\n"
      "key.hold y on\nwait 0.2\nexpect text \"Held\" in picture\nkey.hold y off\nwait 0.2\n"
      "expect text not \"Held\" in picture\nquit\n");
  INFO(outcome.output);
  CHECK(outcome.status == 0);
}

}  // namespace compare_tests
