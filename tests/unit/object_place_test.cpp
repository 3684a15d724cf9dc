// links: scene
// Places of objects: matrices, angles, and what is refused.
#include "scene/object_place.h"

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "base/error.h"

namespace object_place_tests {

using namespace lucerna;
using namespace lucerna::scene;
using Catch::Contains;

namespace {

Box box() {
  Box b;
  b.grow({1, 0, 2}), b.grow({3, 4, 4});
  return b;
}

mat4 turned_matrix() {
  mat4 m = glm::translate(mat4(1), vec3(5, 6, 7));
  m = glm::rotate(m, 0.7f, glm::normalize(vec3(1, 2, 3)));
  return glm::scale(m, vec3(2, 2, 0.5f));
}

void check_near(const mat4& a, const mat4& b) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) CHECK(a[c][r] == Approx(b[c][r]).margin(2e-5));
}

template <class T>
std::string refusal(const T& check) {
  try {
    check();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("an object that was not moved has its file's matrix, digit by digit") {
  const mat4 m = turned_matrix();
  CHECK(placed(m, box(), {}) == m);
  CHECK(placed(m, box(), {.hidden = true}) == m);
  CHECK(placed(m, Box(), {}) == m);
  const mat4 moved = placed(m, box(), {.moved = {1, 2, 3}});
  for (int c = 0; c < 3; ++c) CHECK(moved[c] == m[c]);
  CHECK(vec3(moved[3]) == vec3(m[3]) + vec3(1, 2, 3));
}

TEST_CASE("turning and scaling leave the middle of the box where it is") {
  const mat4 m = turned_matrix();
  const vec3 middle = middle_of(box(), m);
  for (const ObjectPlace& place :
       {ObjectPlace{.turned = {10, 250, -40}}, ObjectPlace{.scaled = {2, -3, 0.5f}},
        ObjectPlace{.turned = {90, 90, 90}, .scaled = {0.1f, 0.1f, 0.1f}}}) {
    const vec3 now = middle_of(box(), placed(m, box(), place));
    for (int k = 0; k < 3; ++k) CHECK(now[k] == Approx(middle[k]).margin(1e-5));
  }
  // Along its own axes: no shear.
  const mat4 sized = placed(m, box(), {.scaled = {2, 3, 4}});
  for (int k = 0; k < 3; ++k) {
    const vec3 before(m[k]), after(sized[k]);
    CHECK(glm::length(after - before * float(k + 2)) < 1e-5f);
  }
  // About y, counter-clockwise seen from above: x goes to -z.
  const mat4 quarter = placed(mat4(1), Box(), {.turned = {0, 90, 0}});
  check_near(quarter, mat4(0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1));
  CHECK(quarter[0][0] == 0);  // right angles are exact
}

TEST_CASE("angles give back their rotation, the nearest ones to those before") {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> angle(-180, 180);
  for (int i = 0; i < 2000; ++i) {
    vec3 a(angle(random), angle(random), angle(random));
    if (i % 5 == 0) a.x = i % 2 ? 90.f : -90.f;
    const glm::dmat3 r = rotation_of(a);
    const vec3 near(angle(random), angle(random), angle(random));
    const glm::dmat3 back = rotation_of(angles_of(r, near));
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 3; ++k) REQUIRE(back[c][k] == Approx(r[c][k]).margin(2e-6));
  }
  // A long turn about x goes beyond a quarter without a jump.
  CHECK(angles_of(rotation_of({100, 0, 0}), {95, 0, 0}) == vec3(100, 0, 0));
  CHECK(angles_of(rotation_of({0, 170, 0}), {0, 160, 0}) == vec3(0, 170, 0));
}

TEST_CASE("places and matrices that cannot be rendered are refused at the object") {
  const auto place = [](const ObjectPlace& p) { return refusal([&] { check_range(p, "chair"); }); };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(place({}) == "");
  CHECK(place({.scaled = {-1, 2, 0.001f}}) == "");
  CHECK_THAT(place({.moved = {nan, 0, 0}}), Contains("object 'chair': moved by"));
  CHECK_THAT(place({.moved = {1e8f, 0, 0}}), Contains("at most"));
  CHECK_THAT(place({.turned = {0, k_infinity, 0}}), Contains("object 'chair': its angles"));
  for (const float bad : {0.0f, nan, 1e-6f, 1e6f, k_infinity})
    CHECK_THAT(place({.scaled = {1, bad, 1}}), Contains("object 'chair': its scale"));

  Instance instance{.name = "chair", .mesh = 0};
  const auto matrix = [&](const mat4& m) {
    instance.to_world = m;
    return refusal([&] { check_range(instance, box()); });
  };
  CHECK(matrix(turned_matrix()) == "");
  CHECK(matrix(glm::scale(mat4(1), vec3(-1, 1, 1))) == "");
  CHECK_THAT(matrix(mat4(nan)), Contains("object 'chair': its matrix is not finite"));
  CHECK_THAT(matrix(glm::scale(mat4(1), vec3(1, 0, 1))), Contains("cannot be inverted"));
  CHECK_THAT(matrix(mat4(0)), Contains("object 'chair'"));
  CHECK_THAT(matrix(glm::scale(mat4(1), vec3(1e-20f))), Contains("cannot be inverted"));
  CHECK_THAT(matrix(glm::translate(mat4(1), vec3(0, 2e9f, 0))), Contains("beyond 1e+09 m"));
  mat4 projective(1);
  projective[0][3] = 0.1f;
  CHECK_THAT(matrix(projective), Contains("the last row"));
}

TEST_CASE("a hidden instance has no surface") {
  Scene s;
  Primitive p;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.triangles = {{0, 1, 2}};
  s.meshes.push_back({.name = "", .primitives = {p}});
  s.instances.push_back({.name = "a", .mesh = 0});
  s.instances.push_back(
      {.name = "b", .mesh = 0, .to_world = glm::translate(mat4(1), vec3(9, 0, 0)), .hidden = true});
  CHECK(count_triangles(s) == 1);
  CHECK(bounds(s).hi.x == 1);
  CHECK(shown_parts(s, s.instances[1]).empty());
  CHECK(shown_parts(s, Instance{}).empty());
}

}  // namespace object_place_tests
