// links: film film_io
// The window's preview of a film whose primary visibility is known, through the real shaders.
#include "kernels/film_preview_support.h"

namespace film_preview_seen_tests {

using namespace lucerna;
using namespace lucerna::test;

TEST_CASE("with primary visibility a preview has edges and colours of single pixels") {
  // Stripes three pixels wide, bright and dark, and a depth step with other light behind it.
  Stage stage(96, 64);
  const auto albedo = [](uint32_t x) { return x / 3 % 2 ? 0.8f : 0.2f; };
  const auto light = [](uint32_t y) { return y < 30 ? 0.9f : 0.3f; };
  const auto depth = [](uint32_t y) { return y < 30 ? 5.0f : 9.0f; };
  Film draft(stage.device, 24, 16);
  draft.clear(stage.stream);
  stage.sample(draft, 1, [&](uint32_t x, uint32_t y) {
    const uint32_t px = 4 * x + 1, py = 4 * y + 2;
    return Sample{.light = vec3(light(py) * albedo(px)), .albedo = vec3(albedo(px)), .depth = depth(py)};
  });
  const gpu::Buffer surfaces = surfaces_of(
      stage, [&](uint32_t x, uint32_t y) { return Seen{.albedo = albedo(x), .depth = depth(y)}; });
  const auto truth = [&](uint32_t x, uint32_t y) { return light(y) * albedo(x); };
  stage.show(&draft);
  const double without = rms(stage.shown(), truth, stage.width);
  stage.preview.forget();
  stage.preview.develop(stage.stream, stage.film, &draft, stage.view, stage.camera, true, film::Sampled::none,
                        &surfaces);
  const double with = rms(stage.shown(), truth, stage.width);
  INFO("relative error " << without << ", with visibility " << with);
  CHECK(without > 0.6);
  CHECK(with < 0.05);
}

TEST_CASE("a lamp flush with a ceiling neither glows onto the ceiling nor gets dark spots") {
  // One plane and one colour; the lamp's border runs through pixels of the coarse film.
  Stage stage(96, 64);
  stage.component = 0;
  const auto lamp = [](uint32_t x, uint32_t y) { return x >= 37 && x < 59 && y >= 22 && y < 43; };
  const auto light = [&](uint32_t x, uint32_t y) { return lamp(x, y) ? 20.0f : 0.3f; };
  const gpu::Buffer surfaces =
      surfaces_of(stage, [&](uint32_t x, uint32_t y) { return Seen{.emits = lamp(x, y)}; });
  std::mt19937 random(5);
  Film draft(stage.device, 24, 16);
  draft.clear(stage.stream);
  stage.sample(draft, 2, [&](uint32_t x, uint32_t y) {
    return Sample{.light = vec3(light(4 * x + random() % 4, 4 * y + random() % 4))};
  });
  // First the coarse film only; then each pixel has its own sample.
  for (const film::Sampled sampled : {film::Sampled::none, film::Sampled::all}) {
    if (sampled == film::Sampled::all)
      stage.sample(stage.film, 1, [&](uint32_t x, uint32_t y) { return Sample{.light = vec3(light(x, y))}; });
    stage.preview.forget();
    stage.preview.develop(stage.stream, stage.film, &draft, stage.view, stage.camera, true, sampled,
                          &surfaces);
    const std::vector<float> shown = stage.shown();
    float brightest = 0, darkest = 1;  // of the ceiling, of the lamp
    for (uint32_t y = 0; y < stage.height; ++y)
      for (uint32_t x = 0; x < stage.width; ++x) {
        const float is = shown[y * stage.width + x];
        if (lamp(x, y))
          darkest = std::min(darkest, is);
        else
          brightest = std::max(brightest, is);
      }
    INFO((sampled == film::Sampled::all ? "with samples" : "coarse film only"));
    CHECK(brightest < 0.33f);
    CHECK(darkest > 0.9f);
  }
}

TEST_CASE("a lamp's edge stays smooth after an edit of other light, and goes dark with the lamp") {
  // The pixels beside a bright lamp show 15 % of it: of four samples, half find nothing of it.
  constexpr float k_lamp = 3, k_wall = 0.2f, k_share = 0.15f;
  const auto lamp = [](uint32_t x) { return x >= 40 && x < 56; };
  const auto beside = [](uint32_t x) { return x == 39 || x == 56; };
  for (const bool off : {false, true}) {
    Stage stage(96, 64);
    stage.component = 0;
    const gpu::Buffer surfaces =
        surfaces_of(stage, [&](uint32_t x, uint32_t) { return Seen{.emits = lamp(x)}; });
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform;
    const auto light = [&](uint32_t x, float of_lamp) {
      return Sample{.light = vec3(lamp(x) || (beside(x) && uniform(random) < k_share) ? of_lamp : k_wall)};
    };
    stage.sample(stage.film, 1024, [&](uint32_t x, uint32_t) { return light(x, k_lamp); });
    show_seen(stage, surfaces);
    stage.preview.keep(vec3(1), false, false);
    stage.film.clear(stage.stream);
    stage.sample(stage.film, 4, [&](uint32_t x, uint32_t) { return light(x, off ? k_wall : k_lamp); });
    show_seen(stage, surfaces);
    const std::vector<float> shown = stage.shown();
    const float truth = off ? k_wall : k_share * k_lamp + (1 - k_share) * k_wall;
    double squares = 0;
    float most = 0;
    for (uint32_t y = 0; y < stage.height; ++y)
      for (const uint32_t x : {39u, 56u}) {
        const float is = shown[y * stage.width + x];
        squares += (is / truth - 1) * (is / truth - 1), most = std::max(most, is);
      }
    INFO((off ? "lamp off" : "lamp as before") << ", brightest " << most);
    CHECK(std::sqrt(squares / 128) < 0.12);
  }
}

TEST_CASE("the error that a preview reports is close to its true error") {
  for (const uint32_t samples : {2u, 4u, 16u}) {
    for (const bool filtered : {true, false}) {
      Stage stage(128, 96);
      std::mt19937 random(7);
      std::exponential_distribution<float> noise(1);
      const auto light = [](uint32_t x, uint32_t y) {
        return 0.3f + 0.1f * std::sin(0.05f * float(x + 2 * y));
      };
      stage.sample(stage.film, samples, [&](uint32_t x, uint32_t y) {
        return Sample{.light = vec3(light(x, y) * noise(random))};
      });
      const std::optional<film::ShownError> reported = stage.show(nullptr, filtered).error;
      REQUIRE(reported);
      const std::vector<float> shown = stage.shown();
      double sum = 0;
      uint32_t count = 0;
      for (uint32_t y = 1; y + 1 < stage.height; ++y)
        for (uint32_t x = 1; x + 1 < stage.width; ++x, ++count) {
          float is = 0, truth = 0;
          for (uint32_t k = 0; k < 9; ++k) {
            const uint32_t at_x = x + k % 3 - 1, at_y = y + k / 3 - 1;
            is += shown[at_y * stage.width + at_x], truth += light(at_x, at_y);
          }
          sum += std::abs(is / truth - 1);
        }
      const double error = sum / count;
      INFO(samples << " samples" << (filtered ? ", filtered" : "") << ": off by " << error << ", reported "
                   << reported->median);
      CHECK(reported->median > 0.6 * error);
      CHECK(reported->median < 2.5 * error);
    }
  }
}

TEST_CASE("the error that a preview reports is corrected by samples that the preview has not used") {
  // The light of the left half has doubled, which the preview does not know: the previous picture stays until
  // samples contradict it.
  Stage stage(160, 96);
  std::mt19937 random(11);
  std::exponential_distribution<float> noise(1);
  float left = 0.2f;
  const auto source = [&](uint32_t x, uint32_t) {
    return Sample{.light = vec3((x < 80 ? left : 0.2f) * noise(random))};
  };
  stage.sample(stage.film, 256, source);
  stage.show();
  stage.preview.keep(vec3(1), false, true);
  left = 0.4f;
  stage.film.clear(stage.stream);
  stage.sample(stage.film, 2, source);
  const auto off = [&] {
    const std::vector<float> shown = stage.shown();
    double sum = 0;
    for (uint32_t y = 0; y < stage.height; ++y)
      for (uint32_t x = 0; x < 80; ++x) sum += 0.4 - double(shown[y * stage.width + x]);
    return sum / (80.0 * stage.height * 0.4);
  };
  const std::optional<film::ShownError> first = stage.show().error;
  REQUIRE(first);
  const double off_first = off();
  film::ShownError later;
  for (int k = 0; k < 3; ++k) {
    stage.sample(stage.film, 1, source);
    later = stage.show().error.value();
  }
  const double off_later = off();
  INFO("the left half is off by " << off_first << ", later by " << off_later << "; reported "
                                  << first->worst_tenth << ", later " << later.worst_tenth);
  CHECK(off_later > 0.1);
  CHECK(first->worst_tenth < 0.6 * off_first);
  // The measurement is of the previous picture, relative to the mean of old and new light.
  CHECK(later.worst_tenth > 0.7 * off_later);
  CHECK(later.worst_tenth < 2.2 * off_first);
}

TEST_CASE("measuring a filtered picture leaves the shown preview as the history of the next edit") {
  Stage stage(96, 64);
  std::mt19937 random(3);
  std::exponential_distribution<float> noise(1);
  stage.sample(stage.film, 2,
               [&](uint32_t, uint32_t) { return Sample{.light = vec3(0.3f * noise(random))}; });
  stage.show();
  const std::vector<float> shown = stage.shown();
  const std::vector<float> luminances(shown.size(), 0.3f), errors(shown.size(), 0.01f);
  stage.preview.show_filtered(stage.stream, stage.film, luminances, errors, stage.view);
  REQUIRE(stage.preview.judge_filtered(stage.stream, stage.film));
  stage.preview.keep(vec3(1), false, true);
  stage.film.clear(stage.stream);
  stage.preview.recall(stage.stream, stage.film, stage.view, stage.camera);
  const std::vector<float> recalled = stage.shown();
  float most = 0;
  for (size_t i = 0; i < shown.size(); ++i) most = std::max(most, std::abs(recalled[i] - shown[i]));
  CHECK(most < 0.01f);
}

TEST_CASE("closer up, the previous picture gets the detail of the visible surfaces, and no other light") {
  // A grey wall that shows stripes of single pixels from half the distance; and a dark bar in front of it,
  // before a bright part of the wall.
  Stage stage(96, 64);
  const auto bar = [](uint32_t x) { return x >= 40 && x < 43; };
  stage.sample(stage.film, 8, [&](uint32_t x, uint32_t) {
    return bar(x) ? Sample{.light = vec3(0.01f), .depth = 5}
                  : Sample{.light = vec3(0.4f), .albedo = vec3(0.5f), .depth = 20};
  });
  stage.show();
  stage.preview.keep({1, 1, 1}, false, true);
  stage.film.clear(stage.stream);
  stage.camera.axes.origin = {-10 * 2.5f / 48, 0,
                              -2.5f};  // the bar moves by ten pixels, the wall by one or two
  // Recalled immediately, without holes in the bar, which is then twice as wide.
  stage.preview.recall(stage.stream, stage.film, stage.view, stage.camera);
  const std::vector<float> at_once = stage.shown();
  for (uint32_t y = 0; y < 64; ++y)
    for (uint32_t x = 42; x < 48; ++x) CHECK(at_once[y * 96 + x] < 0.05f);
  // The bar is wider than in the previous picture, and the wall a seventh nearer.
  const auto bar_now = [](uint32_t x) { return x >= 42 && x < 50; };
  const auto albedo = [&](uint32_t x) { return bar_now(x) ? 1.0f : x % 2 ? 0.8f : 0.2f; };
  const gpu::Buffer surfaces = surfaces_of(stage, [&](uint32_t x, uint32_t) {
    return Seen{.albedo = albedo(x), .depth = bar_now(x) ? 2.5f : 17.5f};
  });
  // New light is almost unknown: one noisy sample for sixteen pixels.
  Film draft(stage.device, 24, 16);
  draft.clear(stage.stream);
  std::mt19937 random(8);
  stage.sample(draft, 1, [&](uint32_t x, uint32_t) {
    const uint32_t px = 4 * x + 2;
    const float found = random() % 8 == 0 ? 8.0f : 0;
    return Sample{.light = vec3((bar_now(px) ? 0.01f : 0.8f * albedo(px)) * found),
                  .albedo = vec3(albedo(px)),
                  .depth = bar_now(px) ? 2.5f : 17.5f};
  });
  stage.preview.develop(stage.stream, stage.film, &draft, stage.view, stage.camera, true, film::Sampled::none,
                        &surfaces);
  const std::vector<float> shown = stage.shown();
  double light = 0, dark = 0, wall = 0;
  uint32_t count = 0;
  for (uint32_t y = 8; y < 56; ++y)
    for (uint32_t x = 8; x < 88; ++x) {
      if (bar_now(x)) {
        CHECK(shown[y * 96 + x] < 0.1f);
      } else if (x < 34 || x > 58) {
        (x % 2 ? light : dark) += shown[y * 96 + x], wall += shown[y * 96 + x], ++count;
      }
    }
  CHECK(wall / count == Approx(0.4).epsilon(0.1));
  CHECK(light / dark > 3);
}

TEST_CASE("while the camera moves, visible surfaces show the previous picture's light in their colours") {
  // A near wall on the right, and a far one with stripes. The camera steps to the left: the near wall moves
  // by eight pixels, the far one by four, and a strip between them becomes visible.
  Stage stage(96, 64);
  constexpr float k_near_light = 0.8f, k_far_light = 0.5f;
  const auto stripe = [](float x) { return int(std::floor(x / 8)) % 2 == 0 ? 0.2f : 0.8f; };
  stage.sample(stage.film, 8, [&](uint32_t x, uint32_t) {
    const bool near = x >= 48;
    const float albedo = near ? 0.5f : stripe(float(x));
    return Sample{.light = vec3(albedo * (near ? k_near_light : k_far_light)),
                  .albedo = vec3(albedo),
                  .depth = near ? 2.5f : 5};
  });
  CHECK_FALSE(stage.preview.recalls_on(stage.camera));
  stage.preview.take(stage.stream, stage.film, stage.view, stage.camera);
  stage.preview.keep(vec3(0.5f), false, true);
  CHECK_FALSE(stage.preview.recalls_on(stage.camera));  // it is there as it was
  stage.film.clear(stage.stream);
  stage.camera.axes.origin.x = -8 * 2 * 5 / 96.0f;
  REQUIRE(stage.preview.recalls_on(stage.camera));
  const auto near_now = [](float x) { return x >= 64; };
  const auto albedo_now = [&](float x) { return near_now(x) ? 0.5f : stripe(x - 8); };
  const gpu::Buffer seen = surfaces_of(stage, 48, 32, [&](uint32_t x, uint32_t) {
    const float at = 2 * float(x) + 1;
    return Seen{.albedo = albedo_now(at), .depth = near_now(at) ? 2.5f : 5};
  });
  stage.preview.recall_on(stage.stream, stage.film, stage.view, stage.camera, seen, 48, 32);
  const std::vector<float> shown = stage.shown();
  const auto border = [&](float x) {
    return albedo_now(x - 2) != albedo_now(x + 2) || near_now(x - 2) != near_now(x + 2);
  };
  for (uint32_t y = 0; y < 64; ++y)
    for (uint32_t x = 0; x < 96; ++x) {
      const float at = float(x) + 0.5f, light = near_now(at) ? k_near_light : k_far_light;
      const float found = shown[y * 96 + x] / (0.5f * albedo_now(at));
      INFO(x << ", " << y << ": " << found);
      if (at < 8 || border(at)) continue;
      if (at >= 56 && at < 64)  // newly visible: the light around it, rather of the far wall
        REQUIRE(found == Approx(k_far_light + 0.05f).margin(0.1));
      else
        REQUIRE(found == Approx(light).margin(0.02));
    }
}

namespace {

/// Shows a wall at 5 m whose picture is taken from the origin, then from a camera four pixels to the right,
/// with the noise-free or noisy new light of a half-size film.
std::vector<float> shown_aside(Stage& stage, const Source& former,
                               const std::function<Seen(uint32_t x)>& then,
                               const std::function<Seen(uint32_t x)>& now, const Source& light) {
  stage.sample(stage.film, 8, former);
  const gpu::Buffer seen = surfaces_of(stage, [&](uint32_t x, uint32_t) { return then(x); });
  stage.preview.take(stage.stream, stage.film, stage.view, stage.camera, 1, &seen);
  stage.preview.keep({1, 1, 1}, false, true);
  stage.film.clear(stage.stream);
  stage.camera.axes.origin.x = 4 * 2 * 5 / float(stage.width);
  const gpu::Buffer surfaces = surfaces_of(stage, [&](uint32_t x, uint32_t) { return now(x); });
  Film draft(stage.device, stage.width / 2, stage.height / 2);
  draft.clear(stage.stream);
  stage.sample(draft, 4, light);
  stage.preview.develop(stage.stream, stage.film, &draft, stage.view, stage.camera, true, film::Sampled::none,
                        &surfaces);
  return stage.shown();
}

double mean_of(const std::vector<float>& shown, uint32_t width, uint32_t from, uint32_t to) {
  double sum = 0;
  for (size_t i = 0; i < shown.size(); ++i)
    if (i % width >= from && i % width < to) sum += shown[i];
  return sum / (double(shown.size()) * (to - from) / width);
}

}  // namespace

TEST_CASE("what a pane or a mirror has shown of a wall is not taken for the wall's own light") {
  Stage stage(96, 64);
  const auto pane = [](uint32_t x) { return x >= 40 && x < 56; };
  const std::vector<float> shown = shown_aside(
      stage, [&](uint32_t x, uint32_t) { return Sample{.light = vec3(pane(x) ? 0.9f : 0.3f)}; },
      [&](uint32_t x) { return Seen{.beyond = pane(x)}; }, [](uint32_t) { return Seen{}; },
      [](uint32_t, uint32_t) { return Sample{.light = vec3(0.3f)}; });
  for (size_t i = 0; i < shown.size(); ++i) {
    INFO(i % 96 << ": " << shown[i]);
    REQUIRE(shown[i] == Approx(0.3f).margin(0.03));
  }
}

TEST_CASE("from another place, polished surfaces soon show new light, others keep theirs until it differs") {
  Stage stage(96, 64);
  std::mt19937 random(5);
  const std::vector<float> shown = shown_aside(
      stage, [](uint32_t, uint32_t) { return Sample{.light = vec3(0.6f)}; },
      [](uint32_t x) { return Seen{.mirrors = x < 48 ? 1.0f : 0.0f}; },
      [](uint32_t x) { return Seen{.mirrors = x < 48 ? 1.0f : 0.0f}; },
      [&](uint32_t, uint32_t) { return Sample{.light = vec3(random() % 4 == 0 ? 1.6f : 0)}; });
  const double polished = mean_of(shown, 96, 8, 40), dull = mean_of(shown, 96, 56, 88);
  INFO("new .4, before .6; polished " << polished << ", dull " << dull);
  CHECK(polished < 0.5);
  CHECK(dull > 0.55);
}

}  // namespace film_preview_seen_tests
