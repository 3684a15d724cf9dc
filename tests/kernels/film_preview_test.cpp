// links: film film_io
// What the window shows of a film with few samples, through the real shaders: noise goes and edges of colour
// stay, what was there before stays until the new light says otherwise, and goes where the camera sees it.
#include "kernels/film_preview_support.h"

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

TEST_CASE("what has little noise is shown as it is, pixel for pixel, also without a filter") {
  Stage stage(60, 44);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> any(0, 1);
  std::vector<float> value(size_t(stage.width) * stage.height);
  for (float& v : value) v = 0.05f + 0.9f * any(random);  // detail of one pixel that surfaces know nothing of
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

TEST_CASE("pixels without samples show the draft, without black ones or seams of blocks") {
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

TEST_CASE("after an edit what was there stays until new light says otherwise") {
  Stage stage(64, 48);
  const auto light = [](uint32_t x, uint32_t y) { return 0.2f + 0.3f * float((x / 8 + y / 8) % 2); };
  stage.sample(stage.film, 8, [&](uint32_t x, uint32_t y) { return Sample{.light = vec3(light(x, y))}; });
  stage.show();
  const std::vector<float> before = stage.shown();

  // Nothing new is known.
  stage.preview.keep();
  stage.film.clear(stage.stream);
  CHECK(stage.show().stale == Approx(1));
  for (size_t i = 0; i < before.size(); ++i) REQUIRE(stage.shown()[i] == Approx(before[i]).margin(0.004));
  // All light is known to be half.
  stage.preview.keep(vec3(0.5f));
  stage.show();
  for (size_t i = 0; i < before.size(); ++i)
    REQUIRE(stage.shown()[i] == Approx(0.5f * before[i]).margin(0.004));

  // Noisy samples of that light, one a pixel: hardly anything is taken from them.
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

  // Clean samples of other light: nothing is left of the old.
  stage.preview.keep();
  stage.film.clear(stage.stream);
  stage.sample(stage.film, 8, [](uint32_t, uint32_t) { return Sample{.light = vec3(0.7f)}; });
  CHECK(stage.show().stale < 0.01);
  for (const float v : stage.shown()) REQUIRE(v == Approx(0.7f).epsilon(0.01));

  // Noisy samples of light five times as dim contradict it at once.
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

TEST_CASE("what was there before is scaled by what few samples of many pixels say of the change") {
  // Shadows too fine to be seen in the new noise, in a room of which one side gets dimmer and the other
  // brighter.
  Stage stage(192, 96);
  const auto pattern = [](uint32_t x, uint32_t y) { return (x / 3 + y / 3) % 2 ? 0.3f : 0.1f; };
  const auto change = [](uint32_t x) { return x < 96 ? 0.25f : 1.8f; };
  stage.sample(stage.film, 8, [&](uint32_t x, uint32_t y) { return Sample{.light = vec3(pattern(x, y))}; });
  stage.show();
  stage.preview.keep();
  stage.film.clear(stage.stream);
  // Of ten paths one finds the light.
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

TEST_CASE(
    "where few samples by chance find nothing what was there before does not go dark, but for lamps' own "
    "light") {
  for (const uint32_t component : {0u, 1u}) {
    Stage stage(192, 96);
    stage.component = component;
    stage.sample(stage.film, 8, [](uint32_t, uint32_t) { return Sample{.light = vec3(0.2f)}; });
    stage.show();
    stage.preview.keep();
    stage.film.clear(stage.stream);
    // A block of 32x32 pixels finds this light once or twice, or not at all.
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
    // Light by way of other surfaces is found by chance; whether a lamp shines on a place any path to it
    // tells.
    if (component == 0)
      CHECK(darkest < 0.1);
    else
      CHECK(darkest > 0.12);
  }
}

TEST_CASE("what was there before is shown in the new colour of a surface at once") {
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

TEST_CASE("what a draft alone has shown stays after an edit, and goes with the camera") {
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

TEST_CASE("a draft of one noisy sample does not put its specks in the place of what was there") {
  Stage stage(96, 64);
  // Narrow surfaces side by side, so that few cells have neighbours of their own kind.
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

TEST_CASE("after a move of the camera what was there is where the camera sees it now") {
  Stage stage(64, 48);
  // A wall 5 m away, and to the right one 2.5 m away.
  const auto wall = [](uint32_t x, uint32_t y) {
    const bool near = x >= 40;
    return Sample{.light = vec3(near ? 0.8f : 0.1f + 0.01f * float((3 * x + 7 * y) % 16)),
                  .depth = near ? 2.5f : 5};
  };
  stage.sample(stage.film, 8, wall);
  stage.show();
  // By four pixels of the far wall's, which are 2 * 5 / 64 m wide, and so by eight of the near one's.
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
  CHECK(hidden == 4);  // it has come into view; nobody knows it
  // A turn by half of the picture's width moves all alike, whatever its distance, also what is far.
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

TEST_CASE("what was there before can be shown at once, as the camera sees it now and without holes") {
  Stage stage(64, 48);
  // Two walls, the right one nearer, so that a step to the right uncovers nothing and one to the left a strip
  // of the far one.
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
  // Any number of moves are shown as one: what went out of the picture on the way is there when it comes
  // back.
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
      else if (x <
               45)  // what has come into view between the walls, and at the border: rather like the far one
        REQUIRE(shown[y * 64 + x] == Approx(0.15f).margin(0.1));
      else if (x >= 50)
        REQUIRE(shown[y * 64 + x] == Approx(0.4f).margin(0.004));
    }
}

TEST_CASE("of what the camera comes close to nothing is left out between the pixels that were there") {
  Stage stage(64, 48);
  const auto wall = [](uint32_t x, uint32_t y) { return 0.2f + 0.3f * float((x / 8 + y / 8) % 2); };
  stage.sample(stage.film, 8, [&](uint32_t x, uint32_t y) { return Sample{.light = vec3(wall(x, y))}; });
  stage.show();
  stage.preview.keep();
  stage.film.clear(stage.stream);
  stage.camera.axes.origin.z = -5 * (1 - 1 / 3.2f);  // three times as large, and a little more
  // Without new light every pixel shows what was there, and the share of what is not known is none.
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

TEST_CASE("where only the camera has moved outliers of the noise are no change of the light") {
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
    // But light that is another one comes through in the end, as what mirrors shows from elsewhere.
    stage.sample(stage.film, 64, [](uint32_t, uint32_t) { return Sample{.light = vec3(0.8f)}; });
    const double left = stage.show().stale;
    if (same) CHECK(left < 0.05);
    CHECK(mean_of(stage.shown()) == Approx(0.79).epsilon(0.05));
  }
  INFO("error " << error[0] << ", where the light is the same " << error[1]);
  CHECK(error[1] < 0.7 * error[0]);
  CHECK(stale[1] > stale[0]);
}

TEST_CASE(
    "where the way in which light is computed changes what was there stays, however often it gets better") {
  for (const bool same : {true, false}) {
    Stage stage(96, 64);
    stage.sample(stage.film, 64, [](uint32_t, uint32_t) { return Sample{.light = vec3(0.4f)}; });
    stage.show();
    stage.preview.keep(vec3(1), false, same);
    double mean = 1;
    for (int better = 0; better < 3; ++better) {
      stage.film.clear(stage.stream);
      // A path each, of which none has brought anything yet.
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

TEST_CASE("few bright paths do not make the picture darker than they are on average, nor show as specks") {
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
        // Of one sample of a lamp's light two that lie together may as well be a patch of it.
        CHECK(mean == Approx(truth).epsilon(component == 1 ? 0.1 : samples == 1 ? 0.4 : 0.2));
        CHECK(*std::max_element(shown.begin(), shown.end()) < 3 * mean);
      }
}

TEST_CASE("a patch of a lamp's light does not glow beyond its border") {
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

TEST_CASE("a narrow surface is shown by its own light, wherever the grid's cells lie") {
  // A post of a pixel's width, before a wall, a column further every 16 rows.
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

TEST_CASE("a pixel that is alone on its surface is not shown by its two paths") {
  // A post of a pixel's width, before a wall.
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
