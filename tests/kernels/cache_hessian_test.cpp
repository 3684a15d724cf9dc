// links: irradiance_cache scene_io bvh_embree
// The Hessian metric of the irradiance cache through its kernels: derivatives of form factors and of whole
// hemispheres compared with finite differences of closed forms, and the resulting ellipses.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>

#include "support/cache.h"
#include "support/rooms.h"

namespace cache_hessian_tests {

using namespace lucerna;
using irradiance_cache::Place;
using irradiance_cache::RawRecords;
using irradiance_cache::Record;
using irradiance_cache::Records;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr uint32_t k_direct = 1;
using dvec = std::array<double, 3>;

dvec cross(const dvec& a, const dvec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const dvec& a, const dvec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Lambert's formula for one edge, from (x, y, 0) with normal z.
double edge_value(const dvec& p, const dvec& q, double x, double y) {
  const dvec a{p[0] - x, p[1] - y, p[2]}, b{q[0] - x, q[1] - y, q[2]}, c = cross(a, b);
  const double sine = std::sqrt(dot(c, c));
  return 0.5 * std::atan2(sine, dot(a, b)) * c[2] / sine;
}

/// Value, gradient (2) and Hessian (xx, xy, yy) of a function of the plane at (x, y), by central differences.
template <class Function>
std::array<double, 6> differences(const Function& f, double x, double y, double h) {
  const double o = f(x, y), e = f(x + h, y), w = f(x - h, y), n = f(x, y + h), s = f(x, y - h);
  const double cross_term = f(x + h, y + h) + f(x - h, y - h) - f(x + h, y - h) - f(x - h, y + h);
  return {o,
          (e - w) / (2 * h),
          (n - s) / (2 * h),
          (e + w - 2 * o) / (h * h),
          cross_term / (4 * h * h),
          (n + s - 2 * o) / (h * h)};
}

/// disk_irradiance() with x < 0 hidden 1 m above the floor by a half plane in front of the disk. Midpoint
/// rule over the visible strips of the disk, each in closed form.
double half_hidden_irradiance(double x, double y) {
  constexpr int k_strips = 4000;
  const double lo = std::max(-1.0, -x);  // through the half plane's edge, twice as far
  double sum = 0;
  for (int i = 0; i < k_strips && lo < 1; ++i) {
    const double u = lo + (1 - lo) * (i + 0.5) / k_strips, half = std::sqrt(1 - u * u);
    // Integral of h^2 / (a^2 + v^2)^2 dv, v from -half - y to half - y.
    const double a2 = (u - x) * (u - x) + 4, a = std::sqrt(a2);
    const auto primitive = [&](double v) {
      return v / (2 * a2 * (a2 + v * v)) + std::atan(v / a) / (2 * a2 * a);
    };
    sum += 4 * (primitive(half - y) - primitive(-half - y)) * (1 - lo) / k_strips;
  }
  return 10 * sum;
}

/// Luminance of the disk's light over its red.
constexpr double k_luminance = 0.2126 + 0.5 * 0.7152 + 0.25 * 0.0722;

/// The result of hessian.comp for a place that faces up, in world axes x and z, followed by near.comp.
struct Bent {
  double xx, xz, zz;
  float bound;
};
/// The pilots of all records.
void pilot(test::CacheBed& bed, Records& records, const irradiance_cache::EvaluateOptions& options) {
  std::vector<uint32_t> all(records.size());
  std::iota(all.begin(), all.end(), 0u);
  REQUIRE(bed.evaluator.pilot(bed.wavefront, bed.automaton, records, all, options) == all.size());
}
std::vector<Bent> hessians(test::CacheBed& bed, const std::vector<Place>& places, uint32_t elevations) {
  Records records(bed.device, static_cast<uint32_t>(places.size()));
  records.append(test::CacheBed::on_facets(places));
  const irradiance_cache::EvaluateOptions how{
      .elevations = elevations, .azimuths = 4 * elevations, .parts = k_direct, .near = true};
  pilot(bed, records, how);
  bed.evaluate(records, how);
  const RawRecords raw = records.raw(records.size());
  std::vector<Bent> all;
  for (size_t i = 0; i < places.size(); ++i) {
    const vec4& h = raw.places[i * shared::k_record_texels + 4];
    // make_basis() of (0, 1, 0): tangent x, bitangent (0, 0, -1).
    all.push_back({double(h.x), -double(h.y), double(h.z), raw.places[i * shared::k_record_texels + 5].y});
  }
  return all;
}

/// Mean of many records at one place.
Bent mean_hessian(test::CacheBed& bed, const vec3& at, uint32_t elevations, size_t repeats = 48) {
  Bent mean{0, 0, 0, 0};
  for (const Bent& b : hessians(bed, std::vector<Place>(repeats, Place{at, vec3(0, 1, 0)}), elevations)) {
    mean.xx += b.xx / double(repeats), mean.xz += b.xz / double(repeats), mean.zz += b.zz / double(repeats);
    mean.bound += b.bound / float(repeats);
  }
  return mean;
}

/// Double-sided and black except for its emission.
void add_quad(scene::Scene& s, const vec3& a, const vec3& b, const vec3& c, const vec3& emission) {
  s.materials.push_back(test::diffuse(vec3(0), emission));
  s.materials.back().double_sided = true;
  test::add_quad(s, a, b - a, c - a, uint32_t(s.materials.size() - 1));
}

struct Shape {
  float lesser, greater;
  vec3 along;
};
/// ellipse.comp on records with these Hessians, bounds and irradiances (luminance).
struct Bending {
  vec3 hessian;
  float bound, irradiance;
};
std::vector<Shape> ellipses(test::CacheBed& bed, const std::vector<Bending>& bending,
                            const shared::EllipsePush& how, float least = 0) {
  const auto count = static_cast<uint32_t>(bending.size());
  Records records(bed.device, count);
  records.append(std::vector<Place>(count, Place{vec3(0, 0, 5), vec3(0, 1, 0)}));
  RawRecords raw = records.raw(count);
  for (size_t i = 0; i < count; ++i) {
    raw.places[i * shared::k_record_texels + 4] = vec4(bending[i].hessian, bending[i].irradiance);
    raw.places[i * shared::k_record_texels + 5].y = bending[i].bound;
  }
  records.restore(raw);
  const gpu::Kernel kernel(bed.device, bed.compiler, "irradiance_cache/ellipse.comp");
  gpu::Resources resources;
  records.bind(resources, Records::Use::look_up);
  shared::CacheFrame frame{};
  frame.parallel = 1, frame.least_of_distance = least, frame.least_most = how.most;
  gpu::Buffer block(bed.device, {.name = "frame", .bytes = sizeof frame});
  block.write(&frame, sizeof frame);
  resources.set("CacheBlock", block);
  shared::EllipsePush push = how;
  push.first = 0, push.count = count;
  bed.wavefront.stream().dispatch(kernel, resources, push, gpu::groups_for(count, 64), "test");
  bed.wavefront.stream().run();
  std::vector<Shape> shapes;
  for (const Record& r : records.read()) shapes.push_back({r.lesser_radius, r.radius, r.along});
  const std::vector<float> radii = records.radii(0);
  for (size_t i = 0; i < count; ++i) CHECK(radii[i] == shapes[i].greater);
  return shapes;
}
constexpr shared::EllipsePush k_free{0, 0, 0.3f, 100, 0, 1, 1, 0};

}  // namespace

TEST_CASE("derivatives of an edge's form factor match Lambert's formula") {
  test::CacheBed bed(test::CacheBed::load("furnace-disk"), 1024);
  struct Edge {
    vec3 a;
    float near_a;
    vec3 b;
    float near_b;
  };
  std::mt19937 random(4);
  const auto unit = [&] { return float(random() >> 8) / 16777216.0f; };
  std::vector<Edge> edges;
  for (int i = 0; i < 2000; ++i) {
    // At angles as between the rays of neighbouring cells, at distances with a ratio of up to a hundred.
    const vec3 a = normalize(vec3(unit() - 0.5f, unit() - 0.5f, 0.02f + unit()));
    const vec3 b = normalize(a + 0.25f * vec3(unit() - 0.5f, unit() - 0.5f, unit() - 0.5f));
    if (b.z <= 0) continue;
    edges.push_back({a, std::pow(10.0f, 2 * unit() - 1), b, std::pow(10.0f, 2 * unit() - 1)});
  }
  const gpu::Kernel kernel(bed.device, bed.compiler,
                           std::string(LUCERNA_SOURCE_DIR) + "/tests/kernels/shaders/form_factor_probe.comp");
  gpu::Buffer edge_buffer(bed.device, {.name = "edges", .bytes = edges.size() * sizeof(Edge)});
  edge_buffer.write(std::span<const Edge>(edges));
  const gpu::Buffer terms(bed.device, {.name = "terms", .bytes = edges.size() * 6 * sizeof(float)});
  gpu::Resources resources;
  resources.set("Edges", edge_buffer);
  resources.set("Terms", terms);
  gpu::Stream stream(bed.device);
  stream.dispatch(kernel, resources, uint32_t(edges.size()), gpu::groups_for(edges.size(), 64));
  stream.run();
  const std::vector<float> got = terms.read_all<float>();
  for (size_t i = 0; i < edges.size(); ++i) {
    const Edge& e = edges[i];
    const auto at = [](const vec3& d, float near) {
      return dvec{double(d.x) / double(near), double(d.y) / double(near), double(d.z) / double(near)};
    };
    const dvec p = at(e.a, e.near_a), q = at(e.b, e.near_b);
    const double near = std::max(e.near_a, e.near_b);
    const auto truth =
        differences([&](double x, double y) { return edge_value(p, q, x, y); }, 0, 0, 1e-3 / near);
    const double angle = std::acos(std::clamp(double(glm::dot(e.a, e.b)), -1.0, 1.0));
    for (int k = 0; k < 6; ++k) {
      const double scale = std::pow(near, k == 0 ? 0 : k < 3 ? 1 : 2) * std::max(angle, 0.02);
      INFO("edge " << i << " term " << k << ", angle " << angle << ", " << 1 / e.near_a << " m, "
                   << 1 / e.near_b);
      REQUIRE(double(got[6 * i + size_t(k)]) == Approx(truth[size_t(k)]).margin(2e-3 * scale));
    }
  }
}

TEST_CASE("a hemisphere's Hessian converges to that of the irradiance with the number of rays") {
  // With coarse strata the disk's border is resolved to a cell's width, and light behind the nearer surface
  // counts there: all figures are too small by a share that halves with twice the rows.
  scene::Scene open = test::CacheBed::load("furnace-disk"), hidden = open;
  add_quad(hidden, {-100, 1, -100}, {0, 1, -100}, {-100, 1, 100}, vec3(0));
  for (const bool half : {false, true}) {
    test::CacheBed bed(half ? hidden : open);
    bed.set_frame(k_direct);
    const auto irradiance = [&](double x, double y) {
      return k_luminance * (half ? half_hidden_irradiance(x, y) : test::disk_irradiance(std::hypot(x, y)));
    };
    std::array<double, 3> misses{};
    double strongest = 0;
    for (const vec2 at : {vec2(0, 0), vec2(0.5f, 0.4f), vec2(-0.5f, 0), vec2(0.6f, -0.3f), vec2(1.6f, 0)}) {
      const auto truth = differences(irradiance, double(at.x), double(at.y), 0.05);
      strongest = std::max({strongest, std::abs(truth[3]), std::abs(truth[5])});
      for (uint32_t level = 0; level < 3; ++level) {
        const Bent got = mean_hessian(bed, vec3(at.x, 1e-4f, at.y), 8u << level);
        misses[level] +=
            std::abs(got.xx - truth[3]) + std::abs(got.xz - truth[4]) + std::abs(got.zz - truth[5]);
        INFO((half ? "half hidden" : "open")
             << " at " << at.x << " " << at.y << ", " << (8 << level) << " rows: " << got.xx << " " << got.xz
             << " " << got.zz << ", expected " << truth[3] << " " << truth[4] << " " << truth[5]);
        const double tolerance = (half ? 0.25 : 0.1) * strongest * (level == 2 ? 1 : level == 1 ? 2 : 4);
        CHECK(got.xx == Approx(truth[3]).margin(tolerance));
        CHECK(got.xz == Approx(truth[4]).margin(tolerance));
        CHECK(got.zz == Approx(truth[5]).margin(tolerance));
      }
    }
    INFO(misses[0] << " " << misses[1] << " " << misses[2]);
    CHECK(misses[1] < 0.8 * misses[0]);
    CHECK(misses[2] < 0.8 * misses[1]);
  }
}

TEST_CASE("a hemisphere of constant radiance has no Hessian, whatever the distances") {
  // Open: no surface is hit. In a box of different walls of equal radiance: surfaces at all distances are
  // hit.
  scene::Scene open = test::CacheBed::load("furnace-disk");
  for (scene::Material& m : open.materials) m.emission = vec3(0);
  scene::Scene black = open;
  open.environment.radiance = vec3(1, 0.5f, 2);
  open.environment.given = black.environment.given = true;
  scene::Scene box;
  box.name = "box", box.file = "box.gltf";
  box.environment.given = true;
  const vec3 lo(-1, 0, -0.3f), x(3, 0, 0), y(0, 2, 0), z(0, 0, 5);
  for (const auto& [a, u, v] : {std::array{lo, x, z}, std::array{lo + y, x, z}, std::array{lo, x, y},
                                std::array{lo + z, x, y}, std::array{lo, y, z}, std::array{lo + x, y, z}})
    add_quad(box, a, a + u, a + v, vec3(3));
  const std::vector<Place> above{{vec3(0, 5, 0), vec3(0, 1, 0)}, {vec3(1000, 1, 0), vec3(0, 1, 0)}};
  const std::vector<Place> inside{{vec3(0, 1e-3f, 0), vec3(0, 1, 0)}, {vec3(1.9f, 1e-3f, 2), vec3(0, 1, 0)}};
  for (const scene::Scene* scene : {&open, &black, &box}) {
    test::CacheBed bed(*scene);
    bed.set_frame(k_direct);
    const bool met = scene == &box;
    for (const Bent& b : hessians(bed, met ? inside : above, 8)) {
      INFO((met ? "box" : scene == &open ? "sky" : "black") << ": " << b.xx << " " << b.xz << " " << b.zz);
      // In a box: rounding of the mean, relative to second derivatives of up to radiance over 0.1^2.
      const double most = met ? 1e-3 : 0;
      CHECK(std::abs(b.xx) <= most);
      CHECK(std::abs(b.xz) <= most);
      CHECK(std::abs(b.zz) <= most);
      CHECK((met ? b.bound > 0.09f && b.bound < 2.0f : std::isinf(b.bound)));
    }
    CHECK(bed.device.validation_messages() == 0);
  }
}

TEST_CASE("a record's Hessian depends only on the record and its last evaluation") {
  test::CacheBed bed(test::CacheBed::load("cornell"));
  bed.set_frame(0b1110);
  std::vector<Place> places;
  for (int i = 0; i < 40; ++i)
    places.push_back(
        {vec3(-0.4f + 0.02f * float(i), 1e-4f, 0.3f), vec3(0, 1, 0), shared::facet_pack(vec3(0, 1, 0))});
  const irradiance_cache::EvaluateOptions how{.parts = 0b1110, .near = true};
  Records together(bed.device, 40), apart(bed.device, 40);
  together.append(places), apart.append(places);
  pilot(bed, together, how);
  bed.evaluate(together, how);
  for (uint32_t i = 40; i-- > 0;) {
    CHECK(bed.evaluator.evaluate(bed.wavefront, bed.automaton, apart, std::span(&i, 1), how) == 1);
    const RawRecords before = apart.raw(40);
    CHECK(bed.evaluator.pilot(bed.wavefront, bed.automaton, apart, std::span(&i, 1), how) == 1);
    // A pilot adds no light.
    CHECK(std::memcmp(before.lights.data(), apart.raw(40).lights.data(),
                      before.lights.size() * sizeof(vec4)) == 0);
  }
  const RawRecords a = together.raw(40), b = apart.raw(40);
  constexpr size_t k_pilot = 4;
  size_t bent = 0, other_rays = 0;
  for (size_t i = 0; i < 40; ++i) {
    const size_t at = i * shared::k_record_texels + k_pilot;
    CHECK(a.places[at] == b.places[at]);
    bent += a.places[at].x != 0;
    // Nor does its evaluation change the light.
    float light = 0;
    for (size_t p = 0; p < shared::k_part_count; ++p)
      light += luminance(vec3(a.lights[(i * shared::k_part_count + p) * shared::k_part_texels]));
    other_rays += std::abs(light - a.places[at].w) > 1e-4f * light;
  }
  CHECK(bent == 40);
  CHECK(other_rays >= 39);
  CHECK(std::memcmp(a.lights.data(), b.lights.data(), a.lights.size() * sizeof(vec4)) == 0);
}

TEST_CASE("ellipses have the same error for any Hessian, and rotate with it") {
  test::CacheBed bed(test::CacheBed::load("furnace-disk"), 1024);
  bed.set_frame(k_direct);
  const float none = std::numeric_limits<float>::infinity();
  std::vector<Bending> bending;
  struct Case {
    float l1, l2, angle;
  };
  std::vector<Case> cases;
  for (const auto& [l1, l2] : {std::array{2.0f, 1.0f}, std::array{-5.0f, 2.5f}, std::array{0.3f, -0.1f},
                               std::array{-40.0f, -39.0f}, std::array{7.0f, 7.0f}})
    for (const float angle : {0.0f, 0.3f, 1.2f, 1.5707963f, 2.9f}) {
      const float c = std::cos(angle), s = std::sin(angle);
      cases.push_back({l1, l2, angle});
      bending.push_back(
          {vec3(l1 * c * c + l2 * s * s, (l1 - l2) * c * s, l1 * s * s + l2 * c * c), none, 1.5f});
    }
  const std::vector<Shape> shapes = ellipses(bed, bending, k_free);
  for (size_t i = 0; i < cases.size(); ++i) {
    const auto [l1, l2, angle] = cases[i];
    INFO(l1 << " " << l2 << " at " << angle << ": " << shapes[i].lesser << " x " << shapes[i].greater);
    const double a = std::abs(double(l1)), b = std::abs(double(l2)), reach = 0.3, e = 1.5;
    CHECK(shapes[i].lesser == Approx(reach * std::pow(e / a, 0.25) * std::pow(b / a, 0.125)).epsilon(1e-4));
    CHECK(shapes[i].greater == Approx(reach * std::pow(e / b, 0.25) * std::pow(a / b, 0.125)).epsilon(1e-4));
    // The integral of |l1| x^2 + |l2| y^2 over both, halved and relative to E, is pi/4 reach^4.
    const double r = double(shapes[i].lesser), g = double(shapes[i].greater);
    CHECK(pi / 8 * r * g * (a * r * r + b * g * g) / e == Approx(pi / 4 * std::pow(reach, 4)).epsilon(1e-3));
    if (a == b) continue;
    // The weaker eigenvector; make_basis() of (0, 1, 0).
    const vec3 along(-std::sin(angle), 0, -std::cos(angle));
    CHECK(std::abs(dot(along, shapes[i].along)) == Approx(1).margin(1e-4));
  }
}

TEST_CASE("ellipses are limited: in length, in width, by near surfaces, in the dark") {
  test::CacheBed bed(test::CacheBed::load("furnace-disk"), 1024);
  bed.set_frame(k_direct);
  const float none = std::numeric_limits<float>::infinity();
  const shared::EllipsePush how{0, 0, 0.3f, 2, 0.1f, 1, 1, 0};
  const auto one = [&](const Bending& b, const shared::EllipsePush& push, float least = 0) {
    return ellipses(bed, {b}, push, least)[0];
  };
  // No curvature, black or not: maximum radius, and round.
  for (const Bending& b : {Bending{vec3(0), none, 1}, Bending{vec3(0), none, 0}}) {
    CHECK(one(b, how).lesser == 2);
    CHECK(one(b, how).greater == 2);
    CHECK(one(b, how).along == vec3(0));
  }
  CHECK(one({vec3(0), 0.4f, 1}, how).greater == Approx(0.4f));
  // Curved in one direction only: limited length.
  const Shape flat = one({vec3(9, 0, 0), none, 1}, how);
  CHECK(flat.greater == Approx(flat.lesser * shared::k_record_ratio));
  CHECK(flat.lesser == Approx(0.3 * std::pow(1 / 9.0, 0.25) * std::pow(shared::k_record_ratio, -0.25)));
  // Limited by near surfaces, both axes with the same ratio; then by the maximum and the minimum radius.
  const Shape near = one({vec3(9, 0, 0), 0.05f, 1}, how);
  CHECK(near.lesser == Approx(0.05f));
  CHECK(near.greater == Approx(0.05f * shared::k_record_ratio));
  const Shape slight = one({vec3(1e-6f, 0, 0), none, 1}, how);
  CHECK(slight.greater == 2);
  CHECK(slight.lesser == 2);
  // At least the minimum radius, which is at most the maximum.
  CHECK(one({vec3(9, 0, 0), 0.05f, 1}, how, 0.5f).lesser == 0.5f);
  CHECK(one({vec3(9, 0, 0), none, 1}, how, 1e6f).lesser == 2);
  // Dark places are compared with `darkest`.
  CHECK(one({vec3(9, 0, 0), none, 0}, how).lesser == one({vec3(9, 0, 0), none, 0.1f}, how).lesser);
  CHECK(one({vec3(9, 0, 0), none, 0.2f}, how).lesser > one({vec3(9, 0, 0), none, 0.1f}, how).lesser);
}

}  // namespace cache_hessian_tests
