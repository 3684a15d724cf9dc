// links: upload
// Sampling the environment through shaders/lib/lights.glsl: the directions of the sky and of its sun, and
// their densities.
#include "kernels/light_support.h"

namespace environment_sampling_tests {

using namespace lucerna;
using namespace lucerna::test;

TEST_CASE("near the poles of a high map directions follow their stated density") {
  // Rows of 1/8192 of a half circle, with equal power in the eight rows at either pole, dark in between.
  constexpr uint32_t k_width = 4, k_height = 8192, k_rows = 8;
  scene::Scene scene;
  scene::Image image;
  image.width = k_width, image.height = k_height;
  const auto pole_row = [&](uint32_t row) { return std::min(row, k_height - 1 - row); };
  for (uint32_t row = 0; row < k_height; ++row)
    for (uint32_t x = 0; x < k_width; ++x) {
      const float value = pole_row(row) < k_rows ? 1 / float(pole_row(row) + 0.5f) : 0;
      image.floats.insert(image.floats.end(), {value, value, value, 1});
    }
  scene.images.push_back(image);
  scene.environment.image = 0;
  Lights lights(scene);
  const double row_angle = 0.5 * k_tau / k_height;
  // By the row from the nearer pole, and by sin^2 of half the angle to it within the row.
  constexpr int k_grid = 8;
  std::vector<double> within(k_rows * k_grid, 0.0), rows(k_rows, 0.0);
  size_t wrong = 0, count = 0;
  const auto band = [&](uint32_t from_pole) {
    return 2 * std::sin(row_angle * (from_pole + 0.5)) * std::sin(0.5 * row_angle);
  };
  double all = 0;
  for (uint32_t row = 0; row < k_height; ++row) {
    double power = 0;
    for (uint32_t x = 0; x < k_width; ++x)
      for (int d = -1; d <= 1; ++d)
        power += image.floats[4 * (size_t(std::clamp(int(row) + d, 0, int(k_height) - 1)) * k_width + x)] *
                 (d ? 0.25 : 0.5) * band(pole_row(row));
    all += power;
    if (pole_row(row) < k_rows) rows[pole_row(row)] += power;
  }
  constexpr uint32_t k_draws = 1 << 19;
  for (const Draw& d : lights.draw(vec3(0), k_draws, 3)) {
    const double across = std::hypot(double(d.direction.x), double(d.direction.z));
    const double theta = std::atan2(across, std::abs(double(d.direction.y)));
    const auto row = uint32_t(theta / row_angle);
    if (row >= k_rows) continue;
    const auto half_sine = [](double angle) { return std::pow(std::sin(0.5 * angle), 2); };
    const double from = half_sine(row * row_angle), to = half_sine((row + 1) * row_angle);
    within[row * k_grid + std::clamp(int((half_sine(theta) - from) / (to - from) * k_grid), 0, k_grid - 1)] +=
        1;
    const double exact = rows[row] / all / (2 * k_tau * band(row));
    wrong += !(std::abs(d.pdf / exact - 1) < 1e-3), ++count;
  }
  std::vector<double> expected;
  for (const double power : rows) expected.insert(expected.end(), k_grid, power / all * k_draws / k_grid);
  // Rounding can move a direction into the next row, or part of a row.
  INFO(wrong << " of " << count << " densities are off");
  CHECK(double(count) > 0.9 * k_draws);
  CHECK(double(wrong) < 2e-3 * double(count));
  const double p = chi_square(within, expected).p;
  INFO("p " << p);
  CHECK(p > 1e-4);
}

TEST_CASE("directions of the environment map follow its density, which integrates to the map's probability") {
  // Flat texels, which reveal an error of height, and tall ones, in which the solid angle is not uniform.
  for (const uvec2 size : {uvec2(64, 512), uvec2(16, 4)}) {
    const float rotation = size.x == 64 ? 0 : 37;
    scene::Scene scene = sky(size.x, size.y, rotation);
    scene::Light lamp;
    lamp.intensity = vec3(300);
    scene.lights.push_back(lamp);  // takes a share of the draws
    Lights lights(scene);
    const uint32_t width = lights.frame.environment_width, height = lights.frame.environment_height;
    const double turn = rotation * k_tau / 360;
    constexpr int k_probes = 2;
    // Density by texel, at several points of each.
    std::vector<vec3> directions;
    const auto at = [&](double x, double y) {  // in texels; uniform in solid angle within a row
      const uint32_t row = std::min(static_cast<uint32_t>(y), height - 1);
      const double top = std::cos(0.5 * k_tau * row / height),
                   low = std::cos(0.5 * k_tau * (row + 1) / height);
      const double z = top + (low - top) * (y - row), s = std::sqrt(std::max(0.0, 1 - z * z));
      const double phi = (x / width - 0.5) * k_tau - turn;
      return vec3(s * std::cos(phi), z, s * std::sin(phi));
    };
    for (uint32_t y = 0; y < height; ++y)
      for (uint32_t x = 0; x < width; ++x)
        for (int k = 0; k < k_probes * k_probes; ++k)
          directions.push_back(at(x + (k % k_probes + 0.3) / k_probes, y + (k / k_probes + 0.7) / k_probes));
    const auto answers = lights.environment(directions);
    std::vector<double> expected;
    double integral = 0;
    for (uint32_t y = 0; y < height; ++y) {
      const double band = std::cos(0.5 * k_tau * y / height) - std::cos(0.5 * k_tau * (y + 1) / height);
      for (uint32_t x = 0; x < width; ++x) {
        double sum = 0;
        for (int k = 0; k < k_probes * k_probes; ++k)
          sum += answers[(size_t(y) * width + x) * k_probes * k_probes + k].pdf;
        expected.push_back(sum / (k_probes * k_probes) * band * k_tau / width);
        integral += expected.back();
      }
    }
    CHECK(integral == Approx(lights.frame.environment_light_pmf).epsilon(1e-4));
    CHECK(integral > 0.2);
    CHECK(integral < 0.8);
    // Draws into the same texels.
    constexpr uint32_t k_draws = 1 << 19;
    constexpr int k_grid = 8;
    std::vector<double> observed(expected.size(), 0.0), within(k_grid * k_grid, 0.0);
    double drawn = 0;
    size_t bad = 0;
    size_t elsewhere = 0;  // density of a neighbouring texel
    std::vector<vec3> again;
    std::vector<float> pdfs;
    for (const Draw& d : lights.draw(vec3(0), k_draws, 11)) {
      if (d.delta) continue;
      drawn += 1;
      bad += d.primitive != shared::k_no_hit || !std::isinf(d.distance) ||
             std::abs(glm::length(d.direction) - 1) > 1e-5f || !(d.pdf > 0);
      const double turns = std::atan2(double(d.direction.z), double(d.direction.x)) + turn;
      double x = 0.5 + turns / k_tau;
      x = (x - std::floor(x)) * width;
      const double y = std::acos(std::clamp(double(d.direction.y), -1.0, 1.0)) / (0.5 * k_tau) * height;
      const uint32_t column = std::min(static_cast<uint32_t>(x), width - 1),
                     row = std::min(static_cast<uint32_t>(y), height - 1);
      observed[size_t(row) * width + column] += 1;
      const double top = std::cos(0.5 * k_tau * row / height),
                   low = std::cos(0.5 * k_tau * (row + 1) / height);
      const double fx = x - column, fy = (double(d.direction.y) - top) / (low - top);
      within[std::clamp(int(fy * k_grid), 0, k_grid - 1) * k_grid +
             std::clamp(int(fx * k_grid), 0, k_grid - 1)] += 1;
      const double exact =
          lights.flat.environment.density[size_t(row) * width + column] * lights.frame.environment_light_pmf;
      elsewhere += std::abs(d.pdf / exact - 1) > 1e-3;
      again.push_back(d.direction), pdfs.push_back(d.pdf);
    }
    CHECK(bad == 0);
    CHECK(double(elsewhere) < 1e-3 * drawn);
    Jury jury;
    const double share = lights.frame.environment_light_pmf;
    jury.add("chance of the map",
             normal_tail((drawn / k_draws - share) / std::sqrt(share * (1 - share) / k_draws)));
    for (double& e : expected) e *= drawn / integral;
    jury.add("texels", chi_square(observed, expected).p);
    jury.add("within texels",
             chi_square(within, std::vector<double>(within.size(), drawn / double(within.size()))).p);
    CHECK(jury.verdict() == "");
    // The density of a draw equals the density returned for hitting the environment in that direction.
    const auto reported = lights.environment(again);
    size_t different = 0;
    for (size_t i = 0; i < reported.size(); ++i) different += std::abs(reported[i].pdf / pdfs[i] - 1) > 1e-4f;
    CHECK(different == 0);
  }
}

TEST_CASE("the environment's radiance is the bilinear map, rotated counter-clockwise seen from above") {
  const scene::Scene scene = sky(16, 8, 90);
  Lights lights(scene);
  const scene::Image& image = scene.images[0];
  std::mt19937 random(4);
  std::vector<vec3> directions;
  for (int i = 0; i < 20000; ++i) {
    const double z = static_cast<double>(random()) * 0x1p-31 - 1,
                 phi = static_cast<double>(random()) * 0x1p-32 * k_tau;
    const double s = std::sqrt(1 - z * z);
    directions.emplace_back(s * std::cos(phi), z, s * std::sin(phi));
  }
  const auto answers = lights.environment(directions);
  size_t bad = 0, dark = 0;
  for (size_t i = 0; i < answers.size(); ++i) {
    // Rotated by 90 degrees counter-clockwise (seen from above, x to the right, z towards the viewer), the
    // map shows at d the value of d rotated back clockwise: (x, z) -> (-z, x).
    const glm::dvec3 d(-directions[i].z, directions[i].y, directions[i].x);
    const double u = 0.5 + std::atan2(d.z, d.x) / k_tau,
                 v = std::acos(std::clamp(d.y, -1.0, 1.0)) / (0.5 * k_tau);
    const double x = u * image.width - 0.5, y = v * image.height - 0.5;
    const auto texel = [&](int c, int r, int channel) {
      const int w = static_cast<int>(image.width), h = static_cast<int>(image.height);
      return double(image.floats[4 * (size_t(std::clamp(r, 0, h - 1)) * w + ((c % w) + w) % w) + channel]);
    };
    const int c = static_cast<int>(std::floor(x)), r = static_cast<int>(std::floor(y));
    for (int k = 0; k < 3; ++k) {
      const double fx = x - c, fy = y - r;
      const double expected = 2 * ((1 - fy) * ((1 - fx) * texel(c, r, k) + fx * texel(c + 1, r, k)) +
                                   fy * ((1 - fx) * texel(c, r + 1, k) + fx * texel(c + 1, r + 1, k)));
      const double most =
          std::max({texel(c, r, k), texel(c + 1, r, k), texel(c, r + 1, k), texel(c + 1, r + 1, k)});
      bad += !(std::abs(answers[i].value[k] - expected) <= 2e-4 * most);
      // Directions with light also have a positive density.
      dark += expected > 1e-6 && !(answers[i].pdf > 0);
    }
  }
  CHECK(bad == 0);
  CHECK(dark == 0);
}

TEST_CASE("tables of an environment are built once for its texels, whatever else is edited") {
  const scene::Scene scene = sky(48, 24, 37);
  upload::FlatScene flat = upload::flatten(scene, 16);
  const upload::EnvironmentTables before = flat.environment;
  const SharedVector<vec3> texels = flat.environment_texels;
  const auto kept = [&] {
    return flat.environment.alias.shares_with(before.alias) &&
           flat.environment.density.shares_with(before.density) &&
           flat.environment.sun_cells.shares_with(before.sun_cells);
  };
  scene::Scene edited = scene;
  const auto as_rebuilt = [&] {
    const upload::FlatScene rebuilt = upload::flatten(edited, flat.sun_threshold);
    const auto same = [](const auto& a, const auto& b) {
      return std::equal(a.begin(), a.end(), b.begin(), b.end());
    };
    return same(flat.environment.alias, rebuilt.environment.alias) &&
           same(flat.environment.density, rebuilt.environment.density) &&
           same(flat.environment.sun_cells, rebuilt.environment.sun_cells) &&
           same(flat.sun_density, rebuilt.sun_density) && same(flat.light_alias, rebuilt.light_alias) &&
           same(flat.environment_texels, rebuilt.environment_texels);
  };
  edited.environment.rotation = 80, edited.environment.scale = 3;
  edited.lights.emplace_back().intensity = vec3(300);
  upload::flatten_lights(edited, flat);
  CHECK(kept());
  CHECK(flat.environment_texels.shares_with(texels));
  CHECK(as_rebuilt());
  // Other tables for another sun threshold or none, and for a changed texel.
  for (const float threshold : {1.5f, 0.0f, 16.0f}) {
    flat.sun_threshold = threshold;
    upload::flatten_lights(edited, flat);
    CHECK_FALSE(kept());
    CHECK(as_rebuilt());
  }
  scene::Image& image = edited.images[edited.environment.image];
  image.floats[4 * 100] += 50;
  upload::flatten_lights(edited, flat);
  CHECK_FALSE(flat.environment_texels.shares_with(texels));
  CHECK(as_rebuilt());
  edited.environment.image = scene::k_none;
  for (const vec3 colour : {vec3(1), vec3(2, 1, 0)}) {
    edited.environment.radiance = colour;
    upload::flatten_lights(edited, flat);
    CHECK(flat.environment_texels[0] == colour);
    CHECK(as_rebuilt());
  }
}

TEST_CASE("sky and sun as two emitters sum to the environment, each sampled by its own density") {
  scene::Scene scene = sky(48, 24, 37);
  scene::Light lamp;
  lamp.intensity = vec3(300);
  scene.lights.push_back(lamp);
  Lights whole(scene), lights(scene, 16);
  REQUIRE(lights.flat.effects.separate_sky);
  REQUIRE(lights.flat.effects.sun);
  // One texel is the sun; filtering reads it from the eight around it.
  CHECK(lights.flat.environment.sun_cells.size() == 2 * 9);
  std::vector<vec3> directions;
  const uint32_t width = 48, height = 24;
  constexpr int k_grid = 8;
  std::vector<double> angles;
  for (uint32_t y = 0; y < height * k_grid; ++y)
    for (uint32_t x = 0; x < width * k_grid; ++x) {
      const double theta = 0.5 * k_tau * (y + 0.5) / (height * k_grid),
                   phi = k_tau * (x + 0.5) / (width * k_grid);
      directions.emplace_back(std::sin(theta) * std::cos(phi), std::cos(theta),
                              std::sin(theta) * std::sin(phi));
      angles.push_back(std::sin(theta) * 0.5 * k_tau / (height * k_grid) * k_tau / (width * k_grid));
    }
  const auto both = whole.environment(directions), of_sky = lights.environment(directions),
             of_sun = lights.environment(directions, true);
  size_t different = 0, unsampled = 0, bright = 0;
  double sky_light = 0, sun_light = 0, sky_chance = 0, sun_chance = 0;
  for (size_t i = 0; i < directions.size(); ++i) {
    different +=
        glm::length(of_sky[i].value + of_sun[i].value - both[i].value) > 1e-5f * glm::length(both[i].value);
    unsampled += (of_sky[i].value.x > 1e-6f && !(of_sky[i].pdf > 0)) ||
                 (of_sun[i].value.x > 1e-6f && !(of_sun[i].pdf > 0));
    bright += of_sun[i].value.x > 0;
    sky_light += double(of_sky[i].value.x) * angles[i], sun_light += double(of_sun[i].value.x) * angles[i];
    sky_chance += double(of_sky[i].pdf) * angles[i], sun_chance += double(of_sun[i].pdf) * angles[i];
  }
  CHECK(different == 0);
  CHECK(unsampled == 0);
  CHECK(double(bright) == Approx(4 * k_grid * k_grid).epsilon(0.2));  // two texels wide and high
  CHECK(sky_chance == Approx(lights.frame.environment_light_pmf).epsilon(1e-3));
  CHECK(sun_light > 0.2 * sky_light);
  // Draws give the light of each, with its share of the draws and with the densities of hits.
  constexpr uint32_t k_draws = 1 << 18;
  Mean sky_mean, sun_mean;
  double sky_drawn = 0, sun_drawn = 0;
  std::vector<vec3> again[2];
  std::vector<float> pdfs[2];
  for (const Draw& d : lights.draw(vec3(0), k_draws, 12)) {
    const bool is_sky = d.delta == 2, is_sun = d.delta == 0;
    sky_drawn += is_sky, sun_drawn += is_sun;
    sky_mean.add(is_sky ? double(d.radiance.x) / double(d.pdf) : 0);
    sun_mean.add(is_sun ? double(d.radiance.x) / double(d.pdf) : 0);
    if (is_sky || is_sun) again[is_sun].push_back(d.direction), pdfs[is_sun].push_back(d.pdf);
  }
  Jury jury;
  for (const auto& [what, drawn, share] :
       {std::tuple("sky's share", sky_drawn, double(lights.frame.environment_light_pmf)),
        std::tuple("sun's share", sun_drawn, sun_chance)})
    jury.add(what, normal_tail((drawn / k_draws - share) / std::sqrt(share * (1 - share) / k_draws)));
  jury.add(fmt::format("sky {} +- {}, really {}", sky_mean.value(), sky_mean.error(), sky_light),
           mean_tail(sky_mean, sky_light, 1e-3 * sky_light));
  jury.add(fmt::format("sun {} +- {}, really {}", sun_mean.value(), sun_mean.error(), sun_light),
           mean_tail(sun_mean, sun_light, 1e-3 * sun_light));
  CHECK(jury.verdict() == "");
  CHECK(sky_mean.error() < 0.01 * sky_light);
  CHECK(sun_mean.error() < 0.01 * sun_light);
  for (const int sun : {0, 1}) {
    const auto reported = lights.environment(again[sun], sun == 1);
    size_t wrong = 0;
    for (size_t i = 0; i < reported.size(); ++i)
      wrong += std::abs(reported[i].pdf / pdfs[sun][i] - 1) > 1e-3f;
    CHECK(double(wrong) <
          1e-3 * double(reported.size()));  // rounding can move a direction into the next texel
  }
  // An environment without bright texels has no sun, and light samples ignore it.
  scene.lights.clear();
  scene.environment.image = scene::k_none;
  scene.environment.radiance = vec3(1);
  const upload::FlatScene even = upload::flatten(scene, 2);
  CHECK(even.effects.separate_sky);
  CHECK_FALSE(even.effects.sun);
  CHECK(even.environment_light_pmf == 1);
  CHECK(even.effects.lights);
}

TEST_CASE("there were no validation messages: environment sampling") {
  CHECK(device().validation_messages() == 0);
}

}  // namespace environment_sampling_tests
