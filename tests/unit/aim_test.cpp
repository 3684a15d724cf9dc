// links: transport
// Aim targets of light paths, and their shares.
#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <set>

#include "support/rooms.h"
#include "transport/aim.h"
#include "transport/casters.h"
#include "transport/first_hits.h"
#include "transport/light_source.h"

namespace aim_tests {

using namespace lucerna;

TEST_CASE("separate objects form separate clusters, and one object forms one") {
  std::vector<Box> things;
  for (int i = 0; i < 300; ++i) {
    const vec3 at(i % 3 * 10, i / 3 % 10 * 0.1f, i / 30 * 0.1f);
    things.push_back({at, at + vec3(0.1f)});
  }
  const std::vector<uint32_t> of = transport::cluster(things, 8);
  for (size_t i = 0; i < things.size(); ++i) CHECK(of[i] == of[i % 3]);
  CHECK(std::set<uint32_t>(of.begin(), of.end()).size() == 3);
  const std::vector<uint32_t> two = transport::cluster(things, 2);
  CHECK(std::set<uint32_t>(two.begin(), two.end()) == std::set<uint32_t>{0, 1});
  CHECK(transport::cluster({}, 8).empty());
  // All in one place: one cluster.
  const std::vector<Box> same(100, Box{vec3(0), vec3(1)});
  for (const uint32_t c : transport::cluster(same, 8)) CHECK(c == 0);
}

TEST_CASE("smooth metals and solid glass are casters; walls, panes and varnish are not") {
  scene::Scene s;
  s.materials.assign(7, test::diffuse(vec3(0.5f)));
  s.materials[1].metallic = 1, s.materials[1].roughness = 0.1f;
  s.materials[2].metallic = 1, s.materials[2].roughness = 0.9f;
  s.materials[3].transmission = 1, s.materials[3].thickness = 1, s.materials[3].roughness = 0;
  s.materials[4].transmission = 1, s.materials[4].roughness = 0;  // a pane
  s.materials[5].specular = 1, s.materials[5].roughness = 0;      // varnish
  s.materials[6] = s.materials[1];
  for (uint32_t m = 0; m < 7; ++m) test::add_ball(s, {float(m), 0, 0}, 0.3f, m, 4);
  const upload::FlatScene flat = upload::flatten(s);
  CHECK(transport::casting_materials(flat) ==
        std::vector<bool>{false, true, false, true, false, false, true});
  const std::vector<Box> found = transport::find_casters(flat);
  REQUIRE(found.size() == 3);
  for (const Box& b : found) {
    const vec3 size = b.size(), centre = b.centre();
    CHECK(glm::length(centre - vec3(std::round(centre.x), 0, 0)) < 1e-3f);
    CHECK(size.x > 0.6f);
    CHECK(size.x < 0.61f);
  }
}

TEST_CASE("boxes enclose the areas where light arrives first, without sparse outliers far away") {
  std::vector<transport::FirstHit> hits;
  for (int i = 0; i < 400; ++i) {
    const vec3 patch = i % 2 == 0 ? vec3(0) : vec3(5, 1, 0);
    hits.push_back({patch + vec3(i / 2 % 10 * 0.1f, 0, i / 20 * 0.05f), 1});
  }
  const auto check = [&] {
    const std::vector<Box> boxes = transport::first_hit_boxes(hits);
    CHECK(boxes.size() >= 2);
    CHECK(boxes.size() <= transport::k_most_first_hit_boxes);
    size_t within = 0;
    for (size_t i = 0; i < 400; ++i)
      within += std::any_of(boxes.begin(), boxes.end(), [&](const Box& b) {
        return glm::all(glm::lessThan(b.lo, hits[i].place)) &&
               glm::all(glm::greaterThan(b.hi, hits[i].place));
      });
    CHECK(within >= 380);
    for (const Box& b : boxes) {
      CHECK(b.size().y > 0);
      CHECK(b.size().x < 1.2f);  // neither across both patches nor out to the outliers
      CHECK(b.lo.x > -1);
    }
  };
  check();
  for (int i = 0; i < 20; ++i) hits.push_back({vec3(-100, 50, float(i)), 0.01});
  check();
  CHECK(transport::first_hit_boxes({}).empty());
  CHECK(transport::first_hit_boxes({{vec3(1), 0}}).empty());
  const std::vector<Box> one = transport::first_hit_boxes({{vec3(1), 2}});
  REQUIRE(one.size() == 1);
  CHECK(one[0].size().x > 0);
}

TEST_CASE("lamps form separate groups, triangles are clustered, and many lamps share a group") {
  scene::Scene s;
  s.materials = {test::diffuse(vec3(0.5f), vec3(1))};
  test::add_quad(s, {0, 0, 0}, {1, 0, 0}, {0, 0, -1});
  test::add_quad(s, {10, 0, 0}, {1, 0, 0}, {0, 0, -1});
  for (int i = 0; i < 5; ++i)
    s.lights.push_back({.name = "lamp", .intensity = vec3(1), .position = {float(i), 1, 0}});
  s.lights[2].enabled = false;
  const upload::FlatScene flat = upload::flatten(s);
  std::vector<double> power = flat.light_power;
  const auto sizes = [&](uint32_t most) {
    std::vector<size_t> n;
    std::set<uint32_t> every;
    for (const auto& members : transport::group_lights(flat, power, most).members) {
      n.push_back(members.size());
      every.insert(members.begin(), members.end());
    }
    CHECK(every.size() == 8);  // each emissive light is in one group
    return n;
  };
  CHECK(sizes(64) == std::vector<size_t>{2, 2, 1, 1, 1, 1});
  const std::vector<size_t> three = sizes(3);
  CHECK(std::accumulate(three.begin(), three.end(), size_t{0}) == 8);
  CHECK(three.size() <= 3);
  CHECK(sizes(1) == std::vector<size_t>{8});
}

TEST_CASE("shares follow the square root of a pair's contribution, and none is zero") {
  const std::vector<double> contribution{1, 1e12, 4, 0, 1};
  const std::vector<double> s = transport::aim_shares(contribution, transport::k_least_unaimed_of_caustics);
  CHECK(std::accumulate(s.begin(), s.end(), 0.0) == Approx(1));
  CHECK(s[0] == Approx(1.0 / 7));
  CHECK(s[1] > s[2]);
  CHECK(s[2] > s[3]);
  CHECK(s[4] > 0.1 * (1 - s[0]) / 1.5);  // the minimum for pairs with a contribution
  CHECK(s[3] > 0.02 * (1 - s[0]));       // the minimum for pairs without
  CHECK(transport::aim_shares(contribution, transport::k_least_unaimed_of_all)[0] == Approx(0.5));
  const std::vector<double> nothing =
      transport::aim_shares(std::vector<double>{5, 0, 0}, transport::k_least_unaimed_of_caustics);
  CHECK(nothing[0] == Approx(0.9));
  CHECK(nothing[1] == Approx(0.05));
  CHECK(transport::aim_shares(std::vector<double>{0}, transport::k_least_unaimed_of_caustics) ==
        std::vector<double>{1});
}

TEST_CASE("nested boxes reach the farthest of a few places far away") {
  std::vector<transport::FirstHit> places;
  for (int i = 0; i < 1000; ++i) {
    const auto at = [&](int step) { return float(i * step % 101) / 100 - 0.5f; };
    places.push_back({vec3(at(7), at(13), at(29)), 1.0});
  }
  const auto widest = [](const Box& box) { return box.size().x; };
  const auto near = transport::nested_boxes(places, 2);
  CHECK(widest(near.back()) < 10);
  places.push_back({vec3(200, 0, 0), 0.01});
  const auto boxes = transport::nested_boxes(places, 2);
  REQUIRE(boxes.size() > 4);
  CHECK(boxes.back().lo.x < -200);
  CHECK(boxes.back().hi.x > 200);
  for (size_t i = 1; i < boxes.size(); ++i) CHECK(widest(boxes[i]) >= widest(boxes[i - 1]));
}

TEST_CASE("lights are chosen by contribution, and a strong light starves no other") {
  const std::vector<std::vector<uint32_t>> groups{{0, 1}, {2}, {3}};
  const std::vector<double> power{1, 3, 1e9, 2};
  const std::vector<double> pilot = transport::light_weights(groups, power, {});
  CHECK(std::accumulate(pilot.begin(), pilot.end(), 0.0) == Approx(1));
  CHECK(pilot[1] == Approx(3 * pilot[0]));  // by power within a group
  CHECK(pilot[0] + pilot[1] == Approx(0.5 / 3).epsilon(1e-6));
  CHECK(pilot[2] == Approx(0.5 + 0.5 / 3).epsilon(1e-6));
  // The strong light contributed nothing, the last one four times as much as both of the first group.
  const std::vector<double> found = transport::light_weights(groups, power, std::vector<double>{1, 0, 0, 4});
  CHECK(std::accumulate(found.begin(), found.end(), 0.0) == Approx(1));
  CHECK(found[2] == Approx(0.2 + 0.1 / 3).epsilon(1e-6));
  CHECK(found[0] + found[1] == Approx(0.1 / 3 + 0.1 + 0.5 / 3).epsilon(1e-6));
  CHECK(found[3] == Approx(0.1 / 3 + 0.1 + 1.0 / 3).epsilon(1e-6));
  CHECK(found[1] == Approx(3 * found[0]));
  // No contribution at all: as in the pilot.
  CHECK(transport::light_weights(groups, power, std::vector<double>(4, 0.0)) == pilot);
}

}  // namespace aim_tests
