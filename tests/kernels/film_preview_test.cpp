// links: film film_io
// The window's preview of a film with few samples, through the real shaders: noise is removed and colour
// edges stay; the previous picture stays until new light contradicts it, and moves with the camera.
#include "kernels/film_preview_support.h"

namespace film_preview_tests {

using namespace lucerna;
using namespace lucerna::test;

TEST_CASE("noise of few samples is filtered, and edges of the surfaces' colours stay sharp") {
  for (const uint32_t samples : {1u, 4u}) {
    Stage stage(96, 64);
    std::mt19937 random(3);
    std::exponential_distribution<float> noise(1);
    const auto albedo = [](uint32_t x, uint32_t y) { return (x / 11 + y / 11) % 2 ? 0.8f : 0.2f; };
    stage.sample(stage.film, samples, [&](uint32_t x, uint32_t y) {
      return Sample{.light = vec3(0.5f * albedo(x, y) * noise(random)), .albedo = vec3(albedo(x, y))};
    });
    const auto truth = [&](uint32_t x, uint32_t y) { return 0.5f * albedo(x, y); };
    stage.developer.tone_map(stage.stream, stage.film, stage.view);
    const double before = rms(stage.shown(), truth, stage.width);
    const film::PreviewShares shares = stage.show();
    const double after = rms(stage.shown(), truth, stage.width);
    INFO(samples << " samples: relative noise " << before << ", filtered " << after);
    CHECK(before > 0.35);
    CHECK(after < 0.25 * before);
    CHECK(shares.filtered > 0.9);
    CHECK(shares.stale == 0);
  }
}

TEST_CASE("a picture with little noise is shown unchanged, pixel for pixel, also without a filter") {
  Stage stage(60, 44);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> any(0, 1);
  std::vector<float> value(size_t(stage.width) * stage.height);
  for (float& v : value) v = 0.05f + 0.9f * any(random);  // detail of one pixel, independent of the surfaces
  stage.sample(stage.film, 8, [&](uint32_t x, uint32_t y) {
    return Sample{.light = vec3(x < stage.width && y < stage.height ? value[y * stage.width + x] : 0)};
  });
  stage.developer.tone_map(stage.stream, stage.film, stage.view);
  const std::vector<uint8_t> plain = stage.film.read_picture();
  for (const bool filtered : {true, false}) {
    const film::PreviewShares shares = stage.show(nullptr, filtered);
    const std::vector<uint8_t> shown = stage.film.read_picture();
    int farthest = 0;
    for (size_t i = 0; i < plain.size(); ++i)
      farthest = std::max(farthest, std::abs(int(plain[i]) - int(shown[i])));
    CHECK(farthest <= 1);  // half floats
    CHECK(shares.filtered < 0.01);
  }
}

TEST_CASE("pixels without samples show the coarse film, without black pixels or seams between blocks") {
  Stage stage(96, 64);
  Film draft(stage.device, 24, 16);
  draft.clear(stage.stream);
  stage.sample(draft, 2, [](uint32_t, uint32_t) { return Sample{.light = vec3(0.4f)}; });
  stage.sample(
      stage.film, 2, [](uint32_t, uint32_t) { return Sample{.light = vec3(0.4f)}; },
      [](uint32_t block) { return block % 5 == 1; });
  stage.show(&draft);
  for (const float v : stage.shown()) CHECK(v == Approx(0.4f).epsilon(0.02));
}

TEST_CASE("after an edit the previous picture stays until new light contradicts it") {
  Stage stage(64, 48);
  const auto light = [](uint32_t x, uint32_t y) { return 0.2f + 0.3f * float((x / 8 + y / 8) % 2); };
  stage.sample(stage.film, 8, [&](uint32_t x, uint32_t y) { return Sample{.light = vec3(light(x, y))}; });
  stage.show();
  const std::vector<float> before = stage.shown();

  // No new light.
  stage.preview.keep();
  stage.film.clear(stage.stream);
  CHECK(stage.show().stale == Approx(1));
  for (size_t i = 0; i < before.size(); ++i) REQUIRE(stage.shown()[i] == Approx(before[i]).margin(0.004));
  // All light is known to be halved.
  stage.preview.keep(vec3(0.5f));
  stage.show();
  for (size_t i = 0; i < before.size(); ++i)
    REQUIRE(stage.shown()[i] == Approx(0.5f * before[i]).margin(0.004));

  // Noisy samples of that light, one per pixel: they have almost no influence.
  std::mt19937 random(5);
  std::exponential_distribution<float> noise(1);
  stage.sample(stage.film, 1, [&](uint32_t x, uint32_t y) {
    return Sample{.light = vec3(0.5f * light(x, y) * noise(random))};
  });
  const auto half = [&](uint32_t x, uint32_t y) { return 0.5f * light(x, y); };
  stage.developer.tone_map(stage.stream, stage.film, stage.view);
  const double raw = rms(stage.shown(), half, stage.width);
  CHECK(stage.show().stale > 0.4);
  INFO("noise " << raw << ", shown " << rms(stage.shown(), half, stage.width));
  CHECK(rms(stage.shown(), half, stage.width) < 0.15 * raw);

  // Noise-free samples of other light replace the previous picture.
  stage.preview.keep();
  stage.film.clear(stage.stream);
  stage.sample(stage.film, 8, [](uint32_t, uint32_t) { return Sample{.light = vec3(0.7f)}; });
  CHECK(stage.show().stale < 0.01);
  for (const float v : stage.shown()) REQUIRE(v == Approx(0.7f).epsilon(0.01));

  // Noisy samples of light five times dimmer contradict it immediately.
  stage.preview.keep();
  stage.film.clear(stage.stream);
  stage.sample(stage.film, 4,
               [&](uint32_t, uint32_t) { return Sample{.light = vec3(0.14f * noise(random))}; });
  stage.show();
  CHECK(rms(
            stage.shown(), [](uint32_t, uint32_t) { return 0.14f; }, stage.width) < 0.1);

  stage.preview.forget();
  stage.film.clear(stage.stream);
  CHECK(stage.show().stale == 0);
  for (const float v : stage.shown()) REQUIRE(v == 0);
}

TEST_CASE("light of another colour and equal luminance is replaced where much change is expected") {
  // Luminance cannot show the change, and noisy new light does not contradict the old.
  const vec3 green(0, 0.2f, 0), red(0.2f * luminance(vec3(0, 1, 0)) / luminance(vec3(1, 0, 0)), 0, 0);
  for (const float doubt : {0.0f, 4.0f}) {
    INFO("doubt " << doubt);
    Stage stage(64, 48);
    stage.sample(stage.film, 8, [&](uint32_t, uint32_t) { return Sample{.light = green}; });
    stage.show();
    stage.preview.keep(vec3(1), false, false, doubt);
    stage.film.clear(stage.stream);
    // Without new light the old picture stays in any case.
    CHECK(stage.show().stale == Approx(1));
    std::mt19937 random(5);
    std::exponential_distribution<float> noise(1);
    stage.sample(stage.film, 2, [&](uint32_t, uint32_t) { return Sample{.light = red * noise(random)}; });
    const film::PreviewShares shares = stage.show();
    const double shown = mean_of(stage.shown()) / double(red.x);
    if (doubt > 0) {
      CHECK(shares.stale < 0.05);
      CHECK(shown == Approx(1).margin(0.15));
    } else {
      CHECK(shares.stale > 0.3);
      CHECK(shown < 0.7);
    }
  }
}

TEST_CASE("the previous picture is scaled by the change that few samples of many pixels show") {
  // Shadows too fine for the new noise, in a room where one side gets dimmer and the other brighter.
  Stage stage(192, 96);
  const auto pattern = [](uint32_t x, uint32_t y) { return (x / 3 + y / 3) % 2 ? 0.3f : 0.1f; };
  const auto change = [](uint32_t x) { return x < 96 ? 0.25f : 1.8f; };
  stage.sample(stage.film, 8, [&](uint32_t x, uint32_t y) { return Sample{.light = vec3(pattern(x, y))}; });
  stage.show();
  stage.preview.keep();
  stage.film.clear(stage.stream);
  // One in ten paths finds the light.
  std::mt19937 random(11);
  std::uniform_real_distribution<float> any(0, 1);
  stage.sample(stage.film, 1, [&](uint32_t x, uint32_t y) {
    return Sample{.light = vec3(any(random) < 0.1f ? 10 * pattern(x, y) * change(x) : 0)};
  });
  stage.show();
  const std::vector<float> shown = stage.shown();
  double left = 0, right = 0, fine = 0;
  for (uint32_t y = 0; y < 96; ++y)
    for (uint32_t x = 0; x < 192; ++x) {
      const double v = shown[size_t{y} * 192 + x];
      if (x < 64) left += v / (64.0 * 96), fine += (pattern(x, y) > 0.2f ? v : -v) / (64.0 * 96 / 2);
      if (x >= 128) right += v / (64.0 * 96);
    }
  INFO("left " << left << " (.05), its pattern " << fine << " (.05), right " << right << " (.36)");
  CHECK(left == Approx(0.05).epsilon(0.15));
  CHECK(right == Approx(0.36).epsilon(0.15));
  CHECK(fine > 0.025);
}

TEST_CASE("light that returns after darkness does not wait behind the dark picture") {
  for (const float former : {0.0f, 0.004f}) {
    INFO("former light " << former);
    Stage stage(192, 192);
    stage.sample(stage.film, 8, [&](uint32_t, uint32_t) { return Sample{.light = vec3(former)}; });
    stage.show();
    stage.preview.keep();
    stage.film.clear(stage.stream);
    // One in 200 paths finds it.
    std::mt19937 random(3);
    std::uniform_real_distribution<float> any(0, 1);
    stage.sample(stage.film, 1,
                 [&](uint32_t, uint32_t) { return Sample{.light = vec3(any(random) < 0.005f ? 60.0f : 0)}; });
    const film::PreviewShares shares = stage.show();
    const std::vector<float> shown = stage.shown();
    const double mean = std::accumulate(shown.begin(), shown.end(), 0.0) / double(shown.size());
    const auto dark = std::count_if(shown.begin(), shown.end(), [](float v) { return v < 0.05f; });
    INFO("mean " << mean << " (.3), " << dark << " of " << shown.size() << " pixels dark, former share "
                 << shares.stale);
    CHECK(mean == Approx(0.3).epsilon(0.2));
    CHECK(dark < 100);
    CHECK(shares.stale < 0.1);
  }
}

TEST_CASE("where few samples find no light the previous picture does not go dark, except direct light") {
  for (const uint32_t component : {0u, 1u}) {
    Stage stage(192, 96);
    stage.component = component;
    stage.sample(stage.film, 8, [](uint32_t, uint32_t) { return Sample{.light = vec3(0.2f)}; });
    stage.show();
    stage.preview.keep();
    stage.film.clear(stage.stream);
    // A block of 32x32 pixels finds this light once, twice, or not at all.
    std::mt19937 random(17);
    stage.sample(stage.film, 1,
                 [&](uint32_t, uint32_t) { return Sample{.light = vec3(random() % 700 == 0 ? 140.0f : 0)}; });
    stage.show();
    const std::vector<float> shown = stage.shown();
    double darkest = 1;
    for (uint32_t block = 0; block < 18; ++block) {
      double sum = 0;
      for (uint32_t i = 0; i < 1024; ++i)
        sum += shown[size_t{block / 6 * 32 + i / 32} * 192 + block % 6 * 32 + i % 32];
      darkest = std::min(darkest, sum / 1024);
    }
    INFO("component " << component << ": " << darkest);
    // Indirect light is found by chance; every path shows whether a lamp lights a point.
    if (component == 0)
      CHECK(darkest < 0.1);
    else
      CHECK(darkest > 0.12);
  }
}

TEST_CASE("the previous picture is shown in a surface's new colour immediately") {
  Stage stage(96, 64);
  std::mt19937 random(5);
  std::exponential_distribution<float> noise(1);
  const vec3 before(0.8f), after(0.2f, 0.4f, 0.4f);
  stage.sample(stage.film, 8,
               [&](uint32_t, uint32_t) { return Sample{.light = 0.5f * before, .albedo = before}; });
  stage.show();
  stage.preview.keep(vec3(1), true);
  stage.film.clear(stage.stream);
  for (int round = 0; round < 3; ++round) {
    stage.sample(stage.film, 1, [&](uint32_t, uint32_t) {
      return Sample{.light = 0.5f * after * noise(random), .albedo = after};
    });
    stage.preview.develop(stage.stream, stage.film, nullptr, stage.view, stage.camera, true,
                          film::Sampled::all);
    INFO("sample " << round);
    CHECK(mean_of(stage.shown()) == Approx(0.1).epsilon(0.05));
    CHECK(rms(
              stage.shown(), [](uint32_t, uint32_t) { return 0.1f; }, stage.width) < 0.15);
  }
}

TEST_CASE("a picture of the coarse film only stays after an edit, and moves with the camera") {
  Stage stage(64, 48);
  Film draft(stage.device, 16, 12);
  draft.clear(stage.stream);
  stage.sample(draft, 4, [](uint32_t x, uint32_t) { return Sample{.light = vec3(x < 8 ? 0.2f : 0.6f)}; });
  stage.show(&draft);
  const std::vector<float> before = stage.shown();
  CHECK(before[24 * 64 + 8] == Approx(0.2f).epsilon(0.03));
  CHECK(before[24 * 64 + 56] == Approx(0.6f).epsilon(0.03));
  stage.preview.keep();
  CHECK(stage.show().stale == Approx(1));
  for (size_t i = 0; i < before.size(); ++i) REQUIRE(stage.shown()[i] == Approx(before[i]).margin(0.004));
  stage.preview.keep();
  stage.camera.axes.origin.x = 8 * 2 * 5 / 64.0f;  // eight pixels
  stage.show();
  for (uint32_t x = 1; x < 54; ++x)
    REQUIRE(stage.shown()[24 * 64 + x] == Approx(before[24 * 64 + x + 8]).margin(0.02));
}

TEST_CASE("a coarse film of one noisy sample does not replace the previous picture by specks") {
  Stage stage(96, 64);
  // Narrow surfaces side by side, so few cells have similar neighbours.
  const auto surface = [](uint32_t x, float scale) {
    const float turn = 1.5f * float(uint32_t(float(x) * scale) / 4 % 2);
    return vec3(std::sin(turn), 0, std::cos(turn));
  };
  stage.sample(stage.film, 8,
               [&](uint32_t x, uint32_t) { return Sample{.light = vec3(0.4f), .normal = surface(x, 1)}; });
  stage.show();
  stage.preview.keep();
  stage.film.clear(stage.stream);
  Film draft(stage.device, 24, 16);
  draft.clear(stage.stream);
  std::mt19937 random(6);
  stage.sample(draft, 1, [&](uint32_t x, uint32_t) {
    return Sample{.light = vec3(random() % 4 == 0 ? 1.6f : 0), .normal = surface(x, 4)};
  });
  stage.show(&draft);
  const double error = rms(
      stage.shown(), [](uint32_t, uint32_t) { return 0.4f; }, stage.width);
  INFO("error " << error);
  CHECK(error < 0.5);
}

TEST_CASE("after a camera move the previous picture is reprojected") {
  Stage stage(64, 48);
  // A wall at 5 m, and on the right one at 2.5 m.
  const auto wall = [](uint32_t x, uint32_t y) {
    const bool near = x >= 40;
    return Sample{.light = vec3(near ? 0.8f : 0.1f + 0.01f * float((3 * x + 7 * y) % 16)),
                  .depth = near ? 2.5f : 5};
  };
  stage.sample(stage.film, 8, wall);
  stage.show();
  // By four pixels of the far wall, which are 2 * 5 / 64 m wide, and so by eight of the near one.
  stage.preview.keep();
  stage.film.clear(stage.stream);
  stage.camera.axes.origin.x = 4 * 2 * 5 / 64.0f;
  stage.show();
  const std::vector<float> shown = stage.shown();
  size_t hidden = 0;
  for (uint32_t y = 2; y < 46; ++y)
    for (uint32_t x = 0; x < 56; ++x) {
      INFO(x << ", " << y);
      const float expected = wall(x < 32 ? x + 4 : x + 8, y).light.x;
      REQUIRE(shown[y * 64 + x] == Approx(expected).margin(0.01));
    }
  for (uint32_t x = 60; x < 64; ++x) hidden += shown[24 * 64 + x] == 0;
  CHECK(hidden == 4);  // newly visible; unknown
  // A rotation by half of the picture's width moves every pixel alike, whatever its distance, also at
  // infinity.
  stage.preview.forget();
  stage.camera.axes = {vec3(0), vec3(1, 0, 0), vec3(0, 0.75f, 0), vec3(0, 0, -1)};
  stage.sample(stage.film, 8,
               [](uint32_t x, uint32_t) { return Sample{.light = vec3(x < 32 ? 0.2f : 0.6f), .depth = 0}; });
  stage.show();
  stage.preview.keep();
  stage.film.clear(stage.stream);
  stage.camera.axes.right = vec3(0.70710678f, 0, 0.70710678f);
  stage.camera.axes.forward = vec3(0.70710678f, 0, -0.70710678f);
  stage.show();
  CHECK(stage.shown()[24 * 64 + 4] == Approx(0.6f).epsilon(0.02));
  CHECK(stage.shown()[24 * 64 + 40] == 0);
}

TEST_CASE("the previous picture can be recalled immediately, reprojected and without holes") {
  Stage stage(64, 48);
  // Two walls, the right one nearer: a step to the right uncovers nothing, a step to the left a strip of the
  // far wall.
  const auto wall = [](uint32_t x, uint32_t y) {
    const bool near = x >= 40;
    return Sample{.light = vec3(near ? 0.8f : 0.2f + 0.01f * float((3 * x + 7 * y) % 8)),
                  .depth = near ? 2.5f : 5};
  };
  CHECK_FALSE(stage.preview.has_history());
  stage.sample(stage.film, 8, wall);
  stage.show();
  stage.preview.keep(vec3(0.5f));
  REQUIRE(stage.preview.has_history());
  stage.film.clear(stage.stream);
  stage.preview.recall(stage.stream, stage.film, stage.view, stage.camera);
  for (uint32_t i = 0; i < 64 * 48; ++i) {
    INFO(i % 64 << ", " << i / 64);
    REQUIRE(stage.shown()[i] == Approx(0.5f * wall(i % 64, i / 64).light.x).margin(0.004));
  }
  // Any number of moves count as one: parts that left the picture in between are there when they return.
  for (const float pixels : {30.0f, 12.0f, -4.0f}) {
    stage.preview.keep();
    stage.camera.axes.origin.x = pixels * 2 * 5 / 64.0f;
    stage.preview.recall(stage.stream, stage.film, stage.view, stage.camera);
  }
  const std::vector<float> shown = stage.shown();
  for (uint32_t y = 1; y < 47; ++y)
    for (uint32_t x = 0; x < 64; ++x) {
      INFO(x << ", " << y);
      if (x >= 5 && x < 44)  // the far wall, four pixels to the right
        REQUIRE(shown[y * 64 + x] == Approx(0.5f * wall(x - 4, y).light.x).margin(0.004));
      else if (x < 45)  // newly visible between the walls, and at the border: similar to the far one
        REQUIRE(shown[y * 64 + x] == Approx(0.15f).margin(0.1));
      else if (x >= 50)
        REQUIRE(shown[y * 64 + x] == Approx(0.4f).margin(0.004));
    }
}

TEST_CASE("light from before an edit can be tinted, new light is not") {
  Stage stage(64, 48);
  stage.sample(stage.film, 8, [](uint32_t, uint32_t) { return Sample{.light = vec3(0.5f)}; });
  stage.show();
  const auto blue = [&] {
    const std::vector<uint8_t> rgba = stage.film.read_picture();
    return int(rgba[2]) - int(rgba[0]);
  };
  stage.view.tint_former = true;
  stage.show();
  CHECK(blue() == 0);
  stage.preview.keep();
  stage.film.clear(stage.stream);
  stage.preview.recall(stage.stream, stage.film, stage.view, stage.camera);
  CHECK(blue() > 50);
  CHECK(stage.show().stale == Approx(1));
  CHECK(blue() > 50);
  stage.view.tint_former = false;
  stage.show();
  CHECK(blue() == 0);
  // Twice as bright without noise: nothing of before stays.
  stage.view.tint_former = true;
  stage.sample(stage.film, 8, [](uint32_t, uint32_t) { return Sample{.light = vec3(0.9f)}; });
  stage.show();
  CHECK(blue() == 0);
}

TEST_CASE("when the camera comes close the enlarged previous picture has no holes") {
  Stage stage(64, 48);
  const auto wall = [](uint32_t x, uint32_t y) { return 0.2f + 0.3f * float((x / 8 + y / 8) % 2); };
  stage.sample(stage.film, 8, [&](uint32_t x, uint32_t y) { return Sample{.light = vec3(wall(x, y))}; });
  stage.show();
  stage.preview.keep();
  stage.film.clear(stage.stream);
  stage.camera.axes.origin.z = -5 * (1 - 1 / 3.2f);  // slightly more than three times as large
  // Without new light every pixel shows the previous picture, and no share is unknown.
  CHECK(stage.show().stale == Approx(1));
  const std::vector<float> shown = stage.shown();
  for (uint32_t y = 4; y < 44; ++y)
    for (uint32_t x = 4; x < 60; ++x) {
      const float u = 32 + (float(x) + 0.5f - 32) / 3.2f, v = 24 + (float(y) + 0.5f - 24) / 3.2f;
      INFO(x << ", " << y << ": " << u << ", " << v);
      const auto off = [](float p) { return std::abs(p - 8 * std::round(p / 8)); };
      if (off(u) > 1 && off(v) > 1)
        REQUIRE(shown[y * 64 + x] == Approx(wall(uint32_t(u), uint32_t(v))).margin(0.01));
      REQUIRE(shown[y * 64 + x] > 0.19f);
    }
}

TEST_CASE("after a camera move outliers of the noise are no change of the light") {
  double error[2], stale[2];
  for (const bool same : {false, true}) {
    Stage stage(96, 64);
    stage.sample(stage.film, 16, [](uint32_t, uint32_t) { return Sample{.light = vec3(0.4f)}; });
    stage.show();
    stage.preview.keep(vec3(1), false, same);
    stage.film.clear(stage.stream);
    std::mt19937 random(8);
    stage.sample(stage.film, 2,
                 [&](uint32_t, uint32_t) { return Sample{.light = vec3(random() % 40 == 0 ? 16.0f : 0)}; });
    stale[same] = stage.show().stale;
    error[same] = rms(
        stage.shown(), [](uint32_t, uint32_t) { return 0.4f; }, stage.width);
    // Light that did change appears in the end, like a reflection from another direction.
    stage.sample(stage.film, 64, [](uint32_t, uint32_t) { return Sample{.light = vec3(0.8f)}; });
    const double left = stage.show().stale;
    if (same) CHECK(left < 0.05);
    CHECK(mean_of(stage.shown()) == Approx(0.79).epsilon(0.05));
  }
  INFO("error " << error[0] << ", where the light is the same " << error[1]);
  CHECK(error[1] < 0.7 * error[0]);
  CHECK(stale[1] > stale[0]);
}

TEST_CASE("when the computation of light changes the previous picture stays, however often it improves") {
  for (const bool same : {true, false}) {
    Stage stage(96, 64);
    stage.sample(stage.film, 64, [](uint32_t, uint32_t) { return Sample{.light = vec3(0.4f)}; });
    stage.show();
    stage.preview.keep(vec3(1), false, same);
    double mean = 1;
    for (int better = 0; better < 3; ++better) {
      stage.film.clear(stage.stream);
      // One path per pixel; none has found light yet.
      stage.sample(stage.film, 1, [&](uint32_t, uint32_t) { return Sample{.light = vec3(0)}; });
      stage.show();
      stage.preview.better();
      mean = mean_of(stage.shown());
      INFO("better " << better << " times, mean " << mean);
      if (same) CHECK(mean == Approx(0.4).epsilon(0.05));
    }
    if (!same) CHECK(mean < 0.3);
  }
}

TEST_CASE("few bright paths give the right average brightness, without specks") {
  for (const uint32_t component : {0u, 1u})
    for (const uint32_t samples : {1u, 2u})
      for (const float albedo : {1.0f, 0.1f}) {
        Stage stage(96, 64);
        stage.component = component;
        std::mt19937 random(8);
        double truth = 0;
        stage.sample(stage.film, samples, [&](uint32_t, uint32_t) {
          const float light = random() % 40 == 0 ? 16.0f : 0;
          truth += double(light) / (96 * 64 * samples);
          return Sample{.light = vec3(light), .albedo = vec3(albedo)};
        });
        stage.show();
        const std::vector<float> shown = stage.shown();
        const double mean = mean_of(shown);
        INFO("component " << component << ", " << samples << " samples, albedo " << albedo << ": true "
                          << truth << ", shown " << mean);
        // With one sample of direct light two adjacent bright pixels can be a real patch.
        CHECK(mean == Approx(truth).epsilon(component == 1 ? 0.1 : samples == 1 ? 0.4 : 0.2));
        CHECK(*std::max_element(shown.begin(), shown.end()) < 3 * mean);
      }
}

TEST_CASE("a patch of direct light does not glow beyond its border") {
  Stage stage(96, 64);
  stage.component = 0;
  std::mt19937 random(3);
  for (const uint32_t samples : {1u, 3u}) {
    // The border runs through a column of pixels.
    stage.sample(stage.film, samples, [&](uint32_t x, uint32_t) {
      return Sample{.light = vec3(x < 41 || (x == 41 && random() % 2 == 0) ? 6.0f : 0.1f)};
    });
    stage.show();
    const std::vector<float> shown = stage.shown();
    for (uint32_t x = 53; x < 96; x += 6) {
      INFO(samples << " samples, column " << x);
      CHECK(shown[20 * 96 + x] < 0.13f);
    }
  }
}

TEST_CASE("a narrow surface shows its own light, wherever the grid's cells are") {
  // A post one pixel wide in front of a wall, one column further every 16 rows.
  Stage stage(96, 64);
  std::mt19937 random(8);
  stage.sample(stage.film, 2, [&](uint32_t x, uint32_t y) {
    const float light = random() % 2 == 0 ? 1 : 0;
    return x == 30 + y / 16 ? Sample{.light = vec3(1.6f * light), .normal = {1, 0, 0}, .depth = 2}
                            : Sample{.light = vec3(0.1f * light)};
  });
  stage.show();
  const std::vector<float> shown = stage.shown();
  // Where another column is near.
  for (const uint32_t y : {14u, 15u, 16u, 17u, 30u, 31u, 32u, 33u, 46u, 47u, 48u, 49u}) {
    INFO("row " << y);
    CHECK(shown[y * 96 + 30 + y / 16] > 0.3f);
  }
}

TEST_CASE("a pixel that is alone on its surface does not show its two paths") {
  // A post one pixel wide in front of a wall.
  Stage stage(96, 64);
  std::mt19937 random(8);
  const auto post = [](uint32_t x) { return x == 41; };
  stage.sample(stage.film, 2, [&](uint32_t x, uint32_t) {
    const bool found = random() % 4 == 0;
    return post(x) ? Sample{.light = vec3(found ? 1.6f : 0), .normal = {1, 0, 0}, .depth = 2}
                   : Sample{.light = vec3(found ? 1.6f : 0)};
  });
  stage.show();
  const std::vector<float> shown = stage.shown();
  for (uint32_t y = 0; y < 64; ++y) {
    INFO("row " << y);
    CHECK(shown[y * 96 + 41] > 0.1f);
    CHECK(shown[y * 96 + 41] < 1.0f);
  }
}

}  // namespace film_preview_tests
