// links: ui
// Marks over the picture do not cover each other, and legends say in words what they are of.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "scene/lamp.h"
#include "shaders/shared/film.h"
#include "ui/lamp_outline.h"
#include "ui/legend.h"
#include "ui/mark_layout.h"

namespace marks_tests {

using namespace lucerna;

namespace {

const ui::Area k_picture{{10, 20}, {650, 380}};
constexpr float k_apart = 17;

float distance(const ImVec2& a, const ImVec2& b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace

TEST_CASE("marks never cover each other, and stay at their anchors where they can") {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> x(0, 700), y(0, 420), near(-12, 12);
  std::vector<ui::Mark> marks;
  for (int i = 0; i < 60; ++i) marks.push_back({{x(random), y(random)}, -1});
  // A chandelier: many at one place, and a row along the edge.
  for (int i = 0; i < 30; ++i) marks.push_back({{330 + near(random), 200 + near(random)}, -1});
  for (int i = 0; i < 10; ++i) marks.push_back({{12 + 4 * float(i), 21}, -1});
  const std::vector<ui::PlacedMark> placed = ui::place_marks(marks, k_apart, k_picture);
  CHECK(placed.size() > 60);
  for (size_t i = 0; i < placed.size(); ++i) {
    const ui::PlacedMark& p = placed[i];
    CHECK((p.at.x >= k_picture.lo.x && p.at.x < k_picture.hi.x && p.at.y >= k_picture.lo.y &&
           p.at.y < k_picture.hi.y));
    CHECK(distance(p.at, marks[p.mark].anchor) < 2.1f * k_apart);
    bool free = true;
    for (size_t j = 0; j < i; ++j) {
      CHECK(distance(p.at, placed[j].at) >= k_apart);
      free = free && distance(marks[p.mark].anchor, placed[j].at) >= k_apart;
    }
    CHECK((distance(p.at, marks[p.mark].anchor) == 0) == free);
  }
  // The same marks lie at the same places.
  const std::vector<ui::PlacedMark> again = ui::place_marks(marks, k_apart, k_picture);
  REQUIRE(again.size() == placed.size());
  for (size_t i = 0; i < placed.size(); ++i) CHECK(distance(again[i].at, placed[i].at) == 0);
}

TEST_CASE("marks of one group that would cover each other are one; the first has its anchor") {
  const std::vector<ui::Mark> marks{
      {{100, 100}, 3}, {{104, 100}, 3}, {{102, 100}, 4}, {{200, 100}, 3}, {{5, 5}, 9}};
  const std::vector<ui::PlacedMark> placed = ui::place_marks(marks, k_apart, k_picture);
  REQUIRE(placed.size() == 3);
  CHECK(placed[0].mark == 0);
  CHECK(distance(placed[0].at, {100, 100}) == 0);
  CHECK(placed[1].mark == 2);
  CHECK(placed[2].mark == 3);
  CHECK(ui::place_marks(marks, k_apart, {{0, 0}, {0, 0}}).empty());
}

TEST_CASE("layers that are no light and marks of lights have a legend in words") {
  for (const uint32_t layer : {shared::k_layer_albedo, shared::k_layer_normal, shared::k_layer_depth}) {
    const auto legends = ui::window_legends({.layer = layer, .hi = 12.5f}, false);
    REQUIRE(legends.size() == 1);
    CHECK(!legends[0].title.empty());
    CHECK(!legends[0].note.empty());
    if (layer == shared::k_layer_depth) CHECK(legends[0].marks.at(1).text == "12.5 m or farther");
  }
  for (const uint32_t layer : {shared::k_layer_samples, shared::k_layer_error, shared::k_layer_cost}) {
    CHECK(ui::window_legends({.layer = layer}, false).empty());  // it has a scale
    CHECK(std::string(ui::heat_words(layer).note).size() > 10);
  }
  CHECK(ui::window_legends({}, false).empty());
  REQUIRE(ui::window_legends({}, true).size() == 1);
  CHECK(!ui::window_legends({}, true)[0].note.empty());
  REQUIRE(ui::window_legends({}, false, true).size() == 1);
  CHECK(ui::window_legends({}, false, true)[0].marks.size() == 1);
}

TEST_CASE("the handle for a lamp's size lies on its outline, and a ray through it gives the same size") {
  const vec3 eye(1, 1.5f, 6);
  using scene::LightKind;
  for (const LightKind kind :
       {LightKind::spot, LightKind::sphere, LightKind::rectangle, LightKind::disk, LightKind::tube}) {
    scene::Light l{.name = "lamp", .kind = kind};
    l.position = {0.3f, 1, -0.4f};
    l.direction = vec3(glm::normalize(glm::dvec3(0.3, -1, 0.5)));
    l.right = scene::rolled(l.direction, 30);
    l.width = 0.9f, l.height = 0.4f, l.radius = 0.2f, l.outer_cone = 0.5f;
    INFO(scene::kind_name(kind));
    const auto handle = ui::size_handle(l, 1.5f, eye);
    REQUIRE(handle);
    CHECK_FALSE(ui::lamp_outline(l, 1.5f).empty());
    const vec3 ray = glm::normalize(*handle - eye);
    for (const auto& [name, value] : ui::size_by_ray(l, eye, eye, ray)) {
      const float expected = name == "width" || name == "length" ? l.width
                             : name == "height"                  ? l.height
                             : name == "radius"                  ? l.radius
                                                                 : l.outer_cone * 180 / k_pi;
      INFO(name << " " << value);
      CHECK(value == Approx(expected).epsilon(0.02));
    }
    CHECK(ui::size_by_ray(l, eye, eye, ray).size() == (kind == LightKind::rectangle ? 2u : 1u));
    // A ray away from the lamp says nothing.
    CHECK(ui::size_by_ray(l, eye, eye, -ray).empty());
  }
  CHECK(ui::lamp_outline({.name = "point"}, 1).empty());
  CHECK_FALSE(ui::size_handle({.name = "point"}, 1, eye));
}

}  // namespace marks_tests
