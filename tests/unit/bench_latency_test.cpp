// links: bench
// The distance between a displayed picture and a reference, and the figures of a series of them.
#include <catch2/catch.hpp>

#include "bench/latency.h"

namespace bench_latency_tests {

using namespace lucerna;
using namespace lucerna::bench;
using Catch::Contains;

TEST_CASE("the distance of a picture is its mean relative error, averaged over 3x3 pixels") {
  constexpr uint32_t k_width = 12, k_height = 9;
  const std::vector<float> grey(k_width * k_height, 0.5f);
  CHECK(picture_distance(grey, grey, k_width).error == 0);
  CHECK(picture_distance(grey, grey, k_width).black == 0);

  std::vector<float> brighter(grey.size(), 0.6f);
  CHECK(picture_distance(brighter, grey, k_width).error == Approx(0.2).epsilon(1e-5));

  // Noise of one pixel in nine counts as its ninth; at a border there are fewer neighbours.
  std::vector<float> speck = grey;
  speck[4 * k_width + 5] = 1.4f;
  CHECK(picture_distance(speck, grey, k_width).error ==
        Approx(9 * (0.9 / 9) / 0.5 / double(grey.size())).epsilon(1e-4));

  // Values darker than k_dark are compared with k_dark.
  const std::vector<float> dark(grey.size(), 0.001f), lighter(grey.size(), 0.003f);
  CHECK(picture_distance(lighter, dark, k_width).error == Approx(0.002 / k_dark).epsilon(1e-4));
}

TEST_CASE("a reference's noise does not count as the picture's error") {
  // Halves with independent errors of 40 % each; the mean is off by 28 %, and 3x3 pixels by a third of that.
  constexpr uint32_t k_width = 128, k_height = 128;
  std::vector<float> reference, half;
  uint32_t state = 1;
  const auto noise = [&] {
    float sum = 0;  // of twelve uniform numbers: variance 1
    for (int i = 0; i < 12; ++i) state = state * 1664525u + 1013904223u, sum += float(state >> 8) * 0x1p-24f;
    return 0.4f * 0.3f * (sum - 6);
  };
  for (uint32_t i = 0; i < k_width * k_height; ++i) {
    const float a = 0.3f + noise(), b = 0.3f + noise();
    reference.push_back(0.5f * (a + b)), half.push_back(0.5f * (a - b));
  }
  const std::vector<float> right(reference.size(), 0.3f), off(reference.size(), 0.36f);
  const double seen = picture_distance(right, reference, k_width).error;
  CHECK(seen > 0.06);
  CHECK(picture_distance(right, reference, k_width, half).error < 0.1 * seen);
  CHECK(picture_distance(off, reference, k_width, half).error == Approx(0.2).epsilon(0.05));
}

TEST_CASE("black pixels show no light where the reference has some") {
  constexpr uint32_t k_width = 10;
  std::vector<float> reference(100, 0.4f), shown(100, 0.3f);
  for (size_t i = 0; i < 50; ++i) shown[i] = 0;  // the upper half; its last row has lit neighbours
  CHECK(picture_distance(shown, reference, k_width).black == Approx(0.4));
  for (float& r : reference) r = 0.5f * k_dark;
  CHECK(picture_distance(shown, reference, k_width).black == 0);
}

TEST_CASE("published bytes are decoded as sRGB") {
  const std::vector<uint8_t> rgba{255, 255, 255, 255, 0, 0, 0, 255, 188, 188, 188, 255, 0, 255, 0, 255};
  const std::vector<float> y = shown_luminance(rgba);
  REQUIRE(y.size() == 4);
  CHECK(y[0] == Approx(1).epsilon(1e-4));
  CHECK(y[1] == 0);
  CHECK(y[2] == Approx(0.5029).epsilon(1e-3));
  CHECK(y[3] == Approx(0.7152).epsilon(1e-3));
}

TEST_CASE("a picture counts as usable once it stays usable, and every step back is reported") {
  const auto moment = [](double seconds, double median, double worst, double black) {
    return Moment{
        seconds, {.error = median, .black = black, .tile_median = median, .worst_tenth = worst}, {}};
  };
  std::vector<Moment> moments{moment(0, 0.9, 1, 0.2),     moment(0.2, 0.12, 0.2, 0.01),
                              moment(0.5, 0.3, 0.5, 0),   moment(0.7, 0.14, 0.31, 0),
                              moment(0.8, 0.14, 0.29, 0), moment(2, 0.05, 0.1, 0),
                              moment(4, 0.06, 0.1, 0)};
  moments[5].reported = film::ShownError{0.04, 0.2};
  const LatencyResult r = latency_of(moments, 5);
  REQUIRE(r.usable_s);
  CHECK(*r.usable_s == 0.8);
  REQUIRE(r.lit_s);
  CHECK(*r.lit_s == 0.5);
  CHECK(r.rise == Approx(0.18));
  CHECK(*r.error[0] == 0.12);  // at 0.3 s
  CHECK(*r.error[1] == 0.14);
  CHECK(*r.error[2] == 0.05);
  CHECK(*r.worst[2] == 0.1);
  CHECK(*r.reported[2] == 0.04);
  CHECK(*r.reported_worst[2] == 0.2);
  CHECK_FALSE(r.reported[1]);
  CHECK_FALSE(r.error[3]);  // the run is shorter than ten seconds

  const std::vector<Moment> worse{moment(0, 0.1, 0.1, 0), moment(1, 0.5, 0.6, 0.5)};
  CHECK_FALSE(latency_of(worse, 5).usable_s);
  CHECK_FALSE(latency_of(worse, 5).lit_s);
  CHECK(latency_row(latency_of(worse, 5)).size() >= latency_heading().size());
}

TEST_CASE("of several runs the median of each figure is reported; unreached targets come last") {
  LatencyResult a, b, c;
  a.scene = "hall", a.usable_s = 0.4, a.error[1] = 0.2, a.rise = 0.3;
  b.usable_s = 2, b.error[1] = 0.1, b.rise = 0.1, b.lit_s = 1;
  c.error[1] = 0.5, c.rise = 0.2;
  const LatencyResult m = median_of(std::vector{a, b, c});
  CHECK(m.scene == "hall");
  CHECK(m.usable_s == 2.0);
  CHECK_FALSE(m.lit_s);  // two of three runs never reached it
  CHECK(m.error[1] == 0.2);
  CHECK_FALSE(m.error[2]);
  CHECK(m.rise == 0.2);
  CHECK(median_of(std::vector{a, c}).rise == 0.3);
}

TEST_CASE("the error of tiles: their median, and the value that a tenth of them exceed") {
  // Nine tiles in ten have an error of a tenth or less, the others more.
  constexpr uint32_t k_width = 160, k_height = 32;
  std::vector<float> reference(k_width * k_height, 0.5f), shown = reference;
  for (size_t i = 0; i < shown.size(); ++i) {
    const uint32_t column = uint32_t(i % k_width) / 16;
    shown[i] *= column == 9 ? 1.8f : column < 6 ? 1.1f : 1.05f;
  }
  const PictureDistance d = picture_distance(shown, reference, k_width);
  CHECK(d.tile_median == Approx(0.1).epsilon(0.05));
  CHECK(d.worst_tenth > 0.7);
}

TEST_CASE("reported errors are compared with the true ones of the same pictures") {
  LatencyResult right, wrong, unknown;
  right.error[1] = 0.1, right.worst[1] = 0.2, right.reported[1] = 0.12, right.reported_worst[1] = 0.21;
  wrong.error[2] = 0.3, wrong.worst[2] = 0.9, wrong.reported[2] = 0.1, wrong.reported_worst[2] = 0.2;
  unknown.error[1] = 0.3, unknown.worst[1] = 0.9;
  const ReportedErrors e = reported_errors(std::vector{right, wrong, unknown});
  CHECK(e.known == 2);
  CHECK(e.median_right == 1);
  CHECK(e.worst_right == 1);
  CHECK(e.said_usable == 2);
  CHECK(e.not_usable == 1);
  CHECK(e.ratio[2] == Approx(3));
}

TEST_CASE("an edit is undone to the previous values, and seeds give other amounts") {
  scene::Scene s;
  scene::Light lamp;
  lamp.intensity = vec3(3);
  s.lights.push_back(lamp);
  const scene::Camera camera;
  const std::optional<Change> change = change_of(Edit::strength, s, camera);
  REQUIRE(change);
  REQUIRE(change->light);
  CHECK(change->light->second.intensity.x == Approx(1));
  const Change back = reverse_of(*change, s, camera);
  REQUIRE(back.light);
  CHECK(back.light->second.intensity == lamp.intensity);
  CHECK_FALSE(back.material);
  const std::optional<Change> drawn = change_of(Edit::strength, s, camera, 1),
                              again = change_of(Edit::strength, s, camera, 1);
  CHECK(drawn->light->second.intensity != change->light->second.intensity);
  CHECK(drawn->light->second.intensity == again->light->second.intensity);
}

TEST_CASE("pictures per second count cameras, not pictures") {
  const std::vector<double> sent{0, 0.1, 0.2, 0.3, 0.4};
  // Two pictures of the same camera are one.
  const std::vector<OrbitFrame> frames{{0.05, 0}, {0.25, 1}, {0.35, 1}, {0.85, 4}};
  const Orbit o = orbit_of(frames, sent, 1);
  CHECK(o.frames_s == Approx(3));
  CHECK(o.gap_s == Approx(0.6));
  CHECK(o.behind_s == Approx(0.15));
  CHECK(orbit_of({}, sent, 2).frames_s == 0);
  CHECK(orbit_of({}, sent, 2).gap_s == 2);
  const scene::Camera camera;
  CHECK(orbit_camera(camera, 0.5f, 0).to_world == camera.to_world);
  // A quarter of the swing: 20 degrees around a point half a metre ahead.
  const vec3 eye(orbit_camera(camera, 0.5f, 1).to_world[3]);
  CHECK(glm::length(eye - vec3(0, 0, -0.5f)) == Approx(0.5));
  CHECK(std::abs(eye.x) == Approx(0.5 * std::sin(glm::radians(20.0))));
}

TEST_CASE("edits are identified by their names") {
  for (size_t i = 0; i < k_edit_names.size(); ++i) CHECK(size_t(edit_of(k_edit_names[i])) == i);
  CHECK_THROWS_WITH(edit_of("lamp"), Contains("'lamp'") && Contains("strength") && Contains("solver"));
}

}  // namespace bench_latency_tests
