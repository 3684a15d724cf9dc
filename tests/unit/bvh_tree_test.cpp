// links: bvh_embree
// Building and layout: every guarantee of layout.h, for usual and for pathological input; the oracle itself.
#include <catch2/catch.hpp>
#include <sstream>

#include "base/error.h"
#include "bvh/embree/build.h"
#include "unit/bvh_support.h"

namespace bvh_tree_tests {

using namespace lucerna;
using namespace lucerna::bvh;
using namespace lucerna::bvh::test;

namespace {

/// Triangles at 1, q, q^2, ... along one axis or all three, as large as their distance.
Mesh progression(size_t count, double ratio, bool diagonal, double x = 1e-15) {
  Mesh mesh;
  for (size_t i = 0; i < count; ++i, x *= ratio) {
    const auto f = static_cast<float>(x);
    const vec3 p = diagonal ? vec3(f) : vec3(f, 0, 0);
    mesh.add(p, p + vec3(0, 0.01f * f, 0), p + vec3(0, 0, 0.01f * f));
  }
  return mesh;
}

void holds(const Mesh& mesh, bool splits) {
  BuildOptions options;
  options.spatial_splits = splits;
  const BvhData data = build(mesh.view(), options);
  CHECK(check(data, mesh.view()) == "");
  CHECK(data.stack <= k_stack);
  CHECK(data.primitive_count == mesh.count());
}

}  // namespace

TEST_CASE("layout keeps its guarantees") {
  Random random(1);
  for (const bool splits : {false, true}) {
    CAPTURE(splits);
    for (const size_t count : {0, 1, 2, 3, 4, 5, 9, 100, 5000}) {
      CAPTURE(count);
      holds(soup(random, count, 10, 2, vec3(0), 0.3f), splits);
    }
    holds(soup(random, 3000, 10, 8), splits);  // long, overlapping: many splits
    holds(soup(random, 1000, 1, 0.1f, vec3(1e4f, -1e4f, 1e4f)), splits);
    holds(icosphere(4, 1), splits);
  }
}

TEST_CASE("spatial splits add references within their budget") {
  Random random(2);
  const Mesh mesh = soup(random, 4000, 10, 8);
  BuildOptions options;
  options.spatial_splits = true;
  options.split_budget = 0.2f;
  const BvhData with = build(mesh.view(), options);
  options.spatial_splits = false;
  const BvhData without = build(mesh.view(), options);
  CHECK(with.triangle_count > without.triangle_count);
  CHECK(with.triangle_count <= 1.2 * 4000);
  CHECK(without.triangle_count == 4000);
  CHECK(with.sah_cost < without.sah_cost);
}

TEST_CASE("depth is limited for any input") {
  for (const bool diagonal : {false, true}) {
    const Mesh mesh = progression(100000, 1.0004, diagonal);  // 1e-15 .. 200
    const Tree tree = build_tree(mesh.view(), {});
    INFO("depth before limiting " << depth(tree));
    holds(mesh, false);
  }
  const Mesh steep = progression(400, 1.4, true, 1e-30);
  CHECK(depth(build_tree(steep.view(), {})) > k_max_depth);  // otherwise the next check proves nothing
  holds(steep, false);
  Mesh same;  // no plane separates these
  for (int i = 0; i < 20000; ++i) same.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  holds(same, false);
  holds(same, true);
  Mesh points;  // boxes without size
  for (int i = 0; i < 1000; ++i) points.add(vec3(1, 2, 3), vec3(1, 2, 3), vec3(1, 2, 3));
  holds(points, false);
  Mesh flat;
  for (int i = 0; i < 1000; ++i)
    flat.add(vec3(float(i), 0, 0), vec3(float(i) + 1, 0, 0), vec3(float(i) + 2, 0, 0));
  holds(flat, false);
}

TEST_CASE("limit_depth: a list becomes a tree of the requested depth") {
  // The worst possible tree: every inner node splits off one triangle.
  Tree list;
  constexpr uint32_t k_count = 3000;
  for (uint32_t i = 0; i < k_count; ++i) {
    const auto x = static_cast<float>(i);
    list.references.push_back({{vec3(x, 0, 0), vec3(x + 1, 1, 1)}, i});
  }
  for (uint32_t i = 0; i < k_count; ++i) {
    const auto first = static_cast<uint32_t>(list.nodes.size());
    const Box box{vec3(float(i), 0, 0), vec3(float(k_count), 1, 1)};
    if (i + 1 == k_count)
      list.nodes.push_back({box, {Tree::k_leaf, Tree::k_leaf}, i, 1});
    else {
      list.nodes.push_back({box, {first + 1, first + 2}, i, k_count - i});
      list.nodes.push_back({list.references[i].box, {Tree::k_leaf, Tree::k_leaf}, i, 1});
    }
  }
  CHECK(depth(list) == k_count - 1);
  CHECK(least_depth(k_count) == 10);
  for (const uint32_t limit : {10u, 11u, 20u, 32u}) {
    const Tree limited = limit_depth(list, limit);
    CHECK(depth(limited) <= limit);
    uint32_t found = 0;
    uint32_t largest = 0;
    for (const Tree::Node& node : limited.nodes)
      if (node.leaf()) found += node.count, largest = std::max(largest, node.count);
    CHECK(largest <= k_max_leaf);
    CHECK(found == k_count);
  }
  CHECK(depth(limit_depth(list, 5000)) == k_count - 1);
}

TEST_CASE("least depth") {
  CHECK(least_depth(0) == 0);
  CHECK(least_depth(4) == 0);
  CHECK(least_depth(5) == 1);
  CHECK(least_depth(8) == 1);
  CHECK(least_depth(9) == 2);
  CHECK(least_depth(16) == 2);
  CHECK(least_depth(17) == 3);
  Random random(3);
  for (const uint32_t n : {1u, 4u, 5u, 8u, 9u, 12u, 13u, 16u, 17u, 33u, 1000u, 4097u}) {
    const Mesh mesh = soup(random, n, 1, 0.1f);
    CHECK(depth(build_median(references_of(mesh.view()))) == least_depth(n));
  }
}

TEST_CASE("words are preserved as floats") {
  for (const uint32_t value : {0u, 1u, 2u, 1234567u, k_word_limit - 1})
    for (const bool flag : {false, true}) {
      const float f = encode(Word{flag, value});
      CHECK(std::isnormal(f));
      CHECK(decode(f).flag == flag);
      CHECK(decode(f).value == value);
    }
}

TEST_CASE("check() detects damage") {
  Random random(4);
  const Mesh mesh = soup(random, 200, 10, 1);
  const BvhData good = build(mesh.view());
  REQUIRE(check(good, mesh.view()) == "");
  BvhData bad = good;
  bad.nodes[1].x |= 0x80808080u;  // the root's boxes start in its upper half
  CHECK(check(bad, mesh.view()) != "");
  bad = good, bad.triangles[3].y += 1e-3f;
  CHECK(check(bad, mesh.view()) != "");
  bad = good, bad.triangles[0].w = encode(Word{true, decode(bad.triangles[0].w).value});
  CHECK(check(bad, mesh.view()) != "");
  bad = good, std::swap(bad.nodes[7], bad.nodes[11]);
  CHECK(check(bad, mesh.view()) != "");
}

TEST_CASE("errors and cancelling") {
  Random random(5);
  Mesh mesh = soup(random, 1000, 10, 1);
  int calls = 0;
  float last = 0;
  BuildOptions options;
  options.progress = [&](float done) { return ++calls, last = done, true; };
  build(mesh.view(), options);
  CHECK(calls > 0);
  CHECK(last <= 1.0f);
  options.progress = [](float) { return false; };
  CHECK_THROWS_WITH(build(mesh.view(), options), Catch::Contains("cancelled"));
  mesh.vertices[3 * 17 + 1].y = std::nanf("");
  CHECK_THROWS_WITH(build(mesh.view()), Catch::Contains("triangle 17"));
}

TEST_CASE("write and read") {
  Random random(6);
  const Mesh mesh = soup(random, 500, 10, 1, vec3(0), 0.5f);
  const BvhData data = build(mesh.view());
  std::stringstream stream;
  write(stream, data);
  const std::string bytes = stream.str();
  const BvhData back = read(stream, "test");
  CHECK(back.nodes == data.nodes);
  CHECK(check(back, mesh.view()) == "");
  CHECK(back.has_non_opaque == data.has_non_opaque);
  for (const size_t cut : {size_t{0}, size_t{10}, size_t{60}, bytes.size() / 2, bytes.size() - 1}) {
    std::stringstream cut_short(bytes.substr(0, cut));
    CHECK_THROWS_AS(read(cut_short, "test"), Error);
  }
  std::stringstream wrong(
      "P6 640 480 255 and so on, which is no tree at all, whatever its length may be, is it?");
  CHECK_THROWS_WITH(read(wrong, "x.bvh"), Catch::Contains("x.bvh"));
}

TEST_CASE("the oracle") {
  Mesh mesh;
  mesh.add({0, 0, 2}, {1, 0, 2}, {0, 1, 2});
  mesh.add({0, 0, 1}, {1, 0, 1}, {0, 1, 1}, true);
  mesh.add({0, 0, 2}, {1, 0, 2}, {0, 1, 2});
  const Ray ray = make_ray({0.25f, 0.5f, 0}, {0, 0, 1});
  Hit hit = oracle(mesh.view(), Query::closest, ray);
  CHECK(hit.prim == 1);
  CHECK(hit.t == 1);
  CHECK(hit.u == Approx(0.25));
  CHECK(hit.v == Approx(0.5));
  CHECK(oracle(mesh.view(), Query::any_opaque, ray).prim == 0);
  CHECK(oracle(mesh.view(), Query::any_opaque, make_ray(ray.origin, ray.direction, 2)).prim ==
        shared::k_no_hit);
  CHECK(oracle(mesh.view(), Query::closest_non_opaque, ray).prim == 1);
  CHECK(oracle(mesh.view(), Query::closest, make_ray({0.25f, 0.5f, 1.5f}, {0, 0, 1})).prim ==
        0);  // lower id of two
  CHECK(oracle(mesh.view(), Query::closest, make_ray({0.6f, 0.5f, 0}, {0, 0, 1})).prim == shared::k_no_hit);
  CHECK(oracle(mesh.view(), Query::closest, make_ray({0, 0, 0}, {0, 0, 1})).prim == 1);  // vertices belong
  const Crossing x = cross(ray, mesh.vertices[0], mesh.vertices[1], mesh.vertices[2]);
  CHECK(x.margin == Approx(0.25 / std::sqrt(2.0)));
}

}  // namespace bvh_tree_tests
