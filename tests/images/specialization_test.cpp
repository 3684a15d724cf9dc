// links: session
// Features that a scene does not use are compiled out of its kernels, which must not change the picture: a
// surface looks the same whatever else the scene contains. Every kind of surface, in a separate shaft, is
// rendered in scenes that lack other kinds, so each is rendered by every kernel variant that lacks an
// unneeded feature, and in a scene with all of them; likewise every kind of light.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "images/shafts_support.h"
#include "support/render.h"
#include "upload/device_scene.h"

namespace specialization_tests {

using namespace lucerna;
using namespace lucerna::test::shafts;

namespace {

session::Renderer& renderer() {
  static session::Renderer r(test::renderer_options(true));
  return r;
}

film::Image picture(const scene::Scene& s, uint32_t samples, uint32_t size) {
  renderer().set_size(size, size);
  renderer().set_scene(std::make_shared<scene::Scene>(s));
  // What is learned about lights depends on the rest of the scene.
  test::set(renderer(), {{"samples", std::to_string(samples)}, {"lights.sampling", "power"}});
  return test::finish(renderer());
}

/// Names of the #defines that a scene turns on.
std::set<std::string> turned_on(const scene::Scene& s) {
  const upload::DeviceScene scene(renderer().device(), upload::flatten(s), {});
  std::set<std::string> names;
  for (const auto& [name, value] : scene.defines())
    if (value == "1") names.insert(name);
  return names;
}

/// Scenes that show some kinds each, such that every kind is shown in one that lacks each #define that it
/// does not need.
std::vector<std::vector<bool>> selections(const std::vector<std::set<std::string>>& needs) {
  std::set<std::string> all;
  std::set<std::pair<size_t, std::string>> open;
  for (const auto& n : needs) all.insert(n.begin(), n.end());
  for (size_t i = 0; i < needs.size(); ++i)
    for (const std::string& name : all)
      if (!needs[i].contains(name)) open.emplace(i, name);
  std::mt19937 random(1);
  std::vector<std::vector<bool>> chosen;
  while (!open.empty()) {
    std::vector<bool> best;
    std::vector<std::pair<size_t, std::string>> best_met;
    for (int attempt = 0; attempt < 300; ++attempt) {
      std::set<std::string> allowed, on;
      const unsigned chance = 3 + random() % 5;
      for (const std::string& name : all)
        if (random() % 8 < chance) allowed.insert(name);
      std::vector<bool> shown;
      for (const auto& n : needs) {
        shown.push_back(std::includes(allowed.begin(), allowed.end(), n.begin(), n.end()));
        if (shown.back()) on.insert(n.begin(), n.end());
      }
      std::vector<std::pair<size_t, std::string>> met;
      for (const auto& pair : open)
        if (shown[pair.first] && !on.contains(pair.second)) met.push_back(pair);
      if (met.size() > best_met.size()) best = shown, best_met = met;
    }
    REQUIRE(!best.empty());
    for (const auto& pair : best_met) open.erase(pair);
    chosen.push_back(best);
  }
  return chosen;
}

}  // namespace

TEST_CASE("a surface looks the same whatever other kinds of surface the scene has") {
  const std::vector<Kind> all = kinds();
  REQUIRE(all.size() <= k_across * k_across);
  std::set<std::string> ever;
  for (const bool lamps : {false, true}) {
    std::vector<std::set<std::string>> needs;
    for (size_t i = 0; i < all.size(); ++i) {
      std::vector<bool> only(all.size());
      only[i] = true;
      needs.push_back(turned_on(shafts_with(all, only, lamps)));
      ever.insert(needs.back().begin(), needs.back().end());
    }
    const film::Image whole =
        picture(shafts_with(all, std::vector<bool>(all.size(), true), lamps), 4, k_across * k_pixels);
    const auto chosen = selections(needs);
    INFO(chosen.size() << " scenes");
    for (const std::vector<bool>& shown : chosen) {
      const film::Image some = picture(shafts_with(all, shown, lamps), 4, k_across * k_pixels);
      for (size_t i = 0; i < all.size(); ++i) {
        if (!shown[i]) continue;
        double sum = 0, difference = 0, squares = 0;
        for (uint32_t k = 0; k < k_pixels * k_pixels; ++k) {
          const size_t pixel = (i / k_across * k_pixels + k / k_pixels) * k_across * k_pixels +
                               i % k_across * k_pixels + k % k_pixels;
          const double a = luminance(test::sum_at(whole, pixel)),
                       d = luminance(test::sum_at(some, pixel)) - a;
          sum += a, difference += d, squares += d * d;
        }
        // The same random numbers are drawn, so pictures differ by rounding only, which changes one path in a
        // million.
        INFO(all[i].name << (lamps ? ", lamps" : ", sky") << ": off by " << difference / sum);
        // A shadow catcher without a sky is black.
        CHECK(std::sqrt(squares) <= 1e-3 * sum);
        CHECK((sum > 0 || (lamps && all[i].material.shadow_catcher)));
      }
    }
  }
}

TEST_CASE("lights in a closed room give the same light whatever lights are outside") {
  const auto room = [](bool point, int outside) {
    scene::Scene s = test::PanelRoom(vec3(0), !point, 0.1f).s;
    add_pictures(s);
    if (point) s.lights.push_back({.name = "lamp", .intensity = vec3(1), .position = {-0.5f, 0.7f, 0.2f}});
    if (outside == 1) {
      s.materials.push_back(test::diffuse(vec3(0.5f), vec3(3)));
      s.materials.back().emission_texture.texture = k_colors;
      test::add_quad(s, {-1, 3, -1}, {2, 0, 0}, {0, 0, 2}, 2);
    }
    if (outside == 2)
      s.lights.push_back({.name = "spot",
                          .kind = scene::LightKind::spot,
                          .intensity = vec3(5),
                          .position = {0, 3, 0},
                          .direction = {0, -1, 0}});
    if (outside == 3)
      s.lights.push_back({.name = "sun",
                          .kind = scene::LightKind::directional,
                          .intensity = vec3(3),
                          .direction = {0, -1, 0}});
    if (outside == 6)
      s.lights.push_back({.name = "globe",
                          .kind = scene::LightKind::sphere,
                          .intensity = vec3(2),
                          .position = {0, 3, 0},
                          .radius = 0.5f});
    if (outside == 4 || outside == 5) s.environment.radiance = vec3(1);
    if (outside == 5) {
      s.environment.image = scene::Id(s.images.size());
      s.images.push_back(s.images[3]);
    }
    return s;
  };
  constexpr uint32_t k_size = 24;
  for (const bool point : {false, true}) {
    const film::Image alone = picture(room(point, 0), 64, k_size);
    for (int outside = 1; outside <= 6; ++outside) {
      const film::Image both = picture(room(point, outside), 64, k_size);
      // Nine blocks, twelve pairs, two components: a false alarm in a thousand.
      for (const int c : {0, 1})
        for (uint32_t b = 0; b < 9; ++b) {
          const test::Mean x = test::block_mean(alone, c, b % 3, b / 3),
                           y = test::block_mean(both, c, b % 3, b / 3);
          INFO((point ? "lamp" : "panel")
               << " inside, light " << outside << " outside, component " << c << ", block " << b << ": "
               << y.value << " +- " << y.noise << " of " << x.value << " +- " << x.noise);
          CHECK(x.value > 0);
          CHECK(std::abs(x.value - y.value) < 5 * std::hypot(x.noise, y.noise) + 1e-4 * x.value);
        }
    }
  }
}

TEST_CASE("there were no validation messages") { CHECK(renderer().device().validation_messages() == 0); }

}  // namespace specialization_tests
