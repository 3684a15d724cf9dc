// links: lookup
// The octree's lists compared with brute force.
#include <cmath>
#include <random>
#include <set>

#include "base/math.h"
#include "kernels/gpu_support.h"
#include "solvers/lookup/octree.h"

namespace lookup_octree_tests {

using namespace lucerna;
using lookup::Octree;

namespace {

using Spheres = std::vector<vec4>;
using Points = std::vector<vec4>;

/// The output of shaders/octree_probe.comp.
struct Found {
  uint32_t count, checksum, list, unordered;
};

bool contains(const vec4& s, const vec4& x) {
  const float a = x.x - s.x, b = x.y - s.y, c = x.z - s.z;
  const float aa = a * a, bb = b * b, cc = c * c;
  return (aa + bb) + cc <= s.w * s.w && s.w >= 0 && std::isfinite(s.w);
}

void add(Found& f, uint32_t sphere) { ++f.count, f.checksum += (sphere + 1) * 2654435761u; }

Found brute_force(const Spheres& spheres, const vec4& x) {
  Found f{};
  for (uint32_t i = 0; i < spheres.size(); ++i)
    if (contains(spheres[i], x)) add(f, i);
  return f;
}

/// The host's own grid: every cell lists the spheres whose boxes, slightly enlarged, touch it.
class HostGrid {
 public:
  explicit HostGrid(const Spheres& spheres) : spheres_(spheres) {
    for (const vec4& s : spheres)
      for (int a = 0; a < 3; ++a) {
        low_[a] = std::min(low_[a], double(s[a]) - 1.01 * s.w - 1e-6);
        high_[a] = std::max(high_[a], double(s[a]) + 1.01 * s.w + 1e-6);
      }
    cells_.resize(k_side * k_side * k_side);
    for (uint32_t i = 0; i < spheres.size(); ++i) {
      const double r = 1.01 * spheres[i].w + 1e-9;
      int from[3], to[3];
      for (int a = 0; a < 3; ++a) {
        const double margin = r + 1e-6 * std::abs(double(spheres[i][a]));
        from[a] = cell(a, spheres[i][a] - margin), to[a] = cell(a, spheres[i][a] + margin);
      }
      for (int z = from[2]; z <= to[2]; ++z)
        for (int y = from[1]; y <= to[1]; ++y)
          for (int x = from[0]; x <= to[0]; ++x) cells_[size_t((z * k_side + y) * k_side + x)].push_back(i);
    }
  }
  Found find(const vec4& x) const {
    Found f{};
    for (const uint32_t i : cells_[size_t((cell(2, x.z) * k_side + cell(1, x.y)) * k_side + cell(0, x.x))])
      if (contains(spheres_[i], x)) add(f, i);
    return f;
  }

 private:
  static constexpr int k_side = 48;
  int cell(int axis, double x) const {
    return std::clamp(int(std::floor((x - low_[axis]) / (high_[axis] - low_[axis]) * k_side)), 0, k_side - 1);
  }
  const Spheres& spheres_;
  double low_[3] = {1e30, 1e30, 1e30}, high_[3] = {-1e30, -1e30, -1e30};
  std::vector<std::vector<uint32_t>> cells_;
};

struct Bench {
  test::SilentDevice silent;
  gpu::Device& device = silent.device;
  gpu::ShaderCompiler compiler;
  gpu::Stream stream{device};
  gpu::Kernel probe{device, compiler, test::shader("octree_probe.comp")};
  gpu::Kernel probe_copies{device, compiler, test::shader("octree_probe.comp"), {{"LUCERNA_COPIES", "1"}}};
  gpu::Buffer spheres;
  uint32_t crowd = 0;  ///< of the octrees: 0, or the size from which leaves are split

  explicit Bench(uint32_t c = 0) : crowd(c) {}
  gpu::Buffer texels(const char* name, uint64_t bytes) {
    return {device, {.name = name, .bytes = std::max<uint64_t>(bytes, 16), .texel = true}};
  }
  void upload(const Spheres& list) {
    spheres = texels("spheres", list.size() * sizeof(vec4));
    spheres.write(std::span<const vec4>(list));
  }
  Octree build(const Spheres& list, uint32_t references, float leaf_scale = 1) {
    upload(list);
    Octree octree(device, compiler,
                  {.spheres = uint32_t(list.size()),
                   .references = references,
                   .leaf_scale = leaf_scale,
                   .crowd = crowd});
    octree.build(stream, spheres, {.most = uint32_t(list.size())});
    return octree;
  }
  std::vector<Found> query(const Octree& octree, const Points& points, bool copies = false) {
    return query(copies ? probe_copies : probe, octree, points, {});
  }
  /// For spheres that are only queried near planes with these normals.
  std::vector<Found> query_discs(const Octree& octree, const Points& points, const gpu::Buffer& normals) {
    gpu::Resources r;
    r.set("normals", normals);
    return query({device, compiler, test::shader("octree_probe.comp"), {{"LUCERNA_DISCS", "1"}}}, octree,
                 points, std::move(r));
  }

 private:
  std::vector<Found> query(const gpu::Kernel& kernel, const Octree& octree, const Points& points,
                           gpu::Resources r) {
    gpu::Buffer in = texels("points", points.size() * sizeof(vec4)),
                out = texels("found", points.size() * sizeof(Found));
    in.write(std::span<const vec4>(points));
    octree.bind(r);
    r.set("spheres", spheres);
    r.set("points", in);
    r.set("Found", out);
    stream.dispatch(kernel, r, uint32_t(points.size()), gpu::groups_for(points.size(), 64));
    stream.run();
    return out.read_all<Found>();
  }
};

struct Differences {
  size_t wrong = 0, unordered = 0, found = 0, listed = 0;
};
template <class Truth>
Differences compare(const std::vector<Found>& got, const Points& points, const Truth& truth) {
  Differences d;
  for (size_t i = 0; i < points.size(); ++i) {
    const Found expected = truth(points[i]);
    d.wrong += got[i].count != expected.count || got[i].checksum != expected.checksum;
    d.unordered += got[i].unordered;
    d.found += expected.count;
    d.listed += got[i].list;
  }
  return d;
}

float uniform(std::mt19937& random) { return float(random() >> 8) * (1.0f / 16777216); }

/// Radii over three decades, uniform in their logarithm, most of them on the faces of a room, like records.
Spheres mixed_spheres(uint32_t n, vec3 centre, float extent, uint32_t seed) {
  std::mt19937 random(seed);
  Spheres list(n);
  for (vec4& s : list) {
    vec3 p(uniform(random), uniform(random), uniform(random));
    if (random() % 4) p[random() % 3] = float(random() % 2);
    s = vec4(centre + extent * (p - 0.5f), extent * 0.0002f * std::pow(1000.0f, uniform(random)));
  }
  return list;
}

/// Points near the spheres' centres, on their surfaces to float precision, and anywhere in the box.
Points points_for(const Spheres& spheres, uint32_t n, vec3 centre, float extent, uint32_t seed) {
  std::mt19937 random(seed);
  Points points(n);
  for (uint32_t i = 0; i < n; ++i) {
    vec3 p = centre + extent * 1.1f * (vec3(uniform(random), uniform(random), uniform(random)) - 0.5f);
    if (i % 4 != 0 && !spheres.empty()) {
      const vec4& s = spheres[random() % spheres.size()];
      vec3 d = vec3(uniform(random), uniform(random), uniform(random)) - 0.5f;
      if (i % 8 == 1) d = vec3(0), d[random() % 3] = 1;  // the ends of its axes
      d *= s.w / std::max(glm::length(d), 1e-6f) * (i % 4 == 3 ? uniform(random) : 1.0f);
      p = vec3(s) + (i % 2 ? d : -d);
    }
    points[i] = vec4(p, 0);
  }
  return points;
}

}  // namespace

TEST_CASE("a million queries among spheres of radii over three decades equal brute force") {
  Bench bench(GENERATE(0u, 4u));
  INFO("crowd " << bench.crowd);
  const vec3 centre(1, 2, 3);
  const Spheres spheres = mixed_spheres(20000, centre, 10, 1);
  const Points points = points_for(spheres, 1000000, centre, 10, 2);
  const HostGrid grid(spheres);
  size_t grid_wrong = 0;
  for (uint32_t i = 0; i < 3000; ++i) {
    const Found a = brute_force(spheres, points[i * 300]), b = grid.find(points[i * 300]);
    grid_wrong += a.count != b.count || a.checksum != b.checksum;
  }
  REQUIRE(grid_wrong == 0);
  const Octree octree = bench.build(spheres, 2000000);
  CHECK(octree.header().level == octree.header().wanted_level);
  CHECK(octree.header().spheres == 20000);
  CHECK(octree.header().leaf <= octree.header().mean_diameter);
  CHECK((bench.crowd > 0 || octree.header().references <= octree.header().needed));
  CHECK((octree.header().split > 0) == (bench.crowd > 0));
  const Differences d =
      compare(bench.query(octree, points), points, [&](const vec4& x) { return grid.find(x); });
  CHECK(d.wrong == 0);
  CHECK(d.unordered == 0);
  CHECK(d.found > 1000000);  // otherwise this test proves little
  CHECK(d.listed < 3 * d.found);
}

TEST_CASE("copies of the spheres are stored in the order of the lists") {
  Bench bench(GENERATE(0u, 4u));
  INFO("crowd " << bench.crowd);
  const Spheres spheres = mixed_spheres(5000, vec3(0), 10, 12);
  const Points points = points_for(spheres, 50000, vec3(0), 10, 13);
  const HostGrid grid(spheres);
  bench.upload(spheres);
  Octree octree(bench.device, bench.compiler,
                {.spheres = 5000, .references = 500000, .copies = true, .crowd = bench.crowd});
  octree.build(bench.stream, bench.spheres, {.most = 5000});
  const Differences d =
      compare(bench.query(octree, points, true), points, [&](const vec4& x) { return grid.find(x); });
  CHECK(d.wrong == 0);
  CHECK(d.found > 20000);
}

TEST_CASE("discs are found near their planes, in fewer leaves than their spheres") {
  Bench bench(GENERATE(0u, 4u));
  INFO("crowd " << bench.crowd);
  constexpr uint32_t k_discs = 3000, k_points = 40000;
  std::mt19937 random(20);
  for (const vec3 centre : {vec3(0), vec3(10000, -9000, 12000)}) {
    const Spheres spheres = mixed_spheres(k_discs, centre, 10, 21);
    // Along the axes and the cells' diagonals, close to them, and anywhere; two texels per disc, because
    // records have more than one.
    std::vector<vec4> normals(2 * k_discs, vec4(9));
    for (uint32_t i = 0; i < k_discs; ++i) {
      vec3 n(uniform(random) - 0.5f, uniform(random) - 0.5f, uniform(random) - 0.5f);
      if (i % 4 == 1) n[i / 4 % 3] = 0;
      if (i % 4 == 2) n = vec3(i & 4 ? 1 : -1, i & 8 ? 1 : -1, i & 16 ? 1 : 0);
      if (i % 4 == 3) n = 1e-3f * n, n[i / 4 % 3] = 1;
      normals[2 * i + 1] = vec4(glm::normalize(n), 0);
    }
    Points points(k_points);
    for (uint32_t k = 0; k < k_points; ++k) {
      // In the slab, on its borders, or anywhere around the disc.
      const uint32_t i = random() % k_discs;
      const vec3 n(normals[2 * i + 1]), d = vec3(uniform(random), uniform(random), uniform(random)) - 0.5f;
      const float height = k % 3 == 0 ? 2 * uniform(random) - 1 : k % 3 == 1 ? 0.2f : -0.2f;
      const vec3 flat = d - glm::dot(d, n) * n;
      points[k] = vec4(vec3(spheres[i]) + spheres[i].w * (1.9f * flat + height * n), 0);
    }
    gpu::Buffer texels = bench.texels("normals", normals.size() * sizeof(vec4));
    texels.write(std::span<const vec4>(normals));
    std::vector<vec4> plain;  // as the probe reads them
    for (uint32_t i = 0; i < k_discs; ++i) plain.push_back(normals[2 * i + 1]);
    gpu::Buffer probed = bench.texels("normals", plain.size() * sizeof(vec4));
    probed.write(std::span<const vec4>(plain));
    bench.upload(spheres);
    const lookup::Discs discs{.normals = texels, .stride = 2, .at = 1, .thickness = 0.2f};
    Octree octree(
        bench.device, bench.compiler,
        {.spheres = k_discs, .references = 4000000, .leaf_scale = 0.5f, .discs = true, .crowd = bench.crowd});
    octree.build(bench.stream, bench.spheres, {.most = k_discs}, &discs);
    const Octree whole = bench.build(spheres, 4000000, 0.5f);
    REQUIRE(octree.header().level == whole.header().level);
    CHECK(octree.header().references < whole.header().references * 6 / 10);
    CHECK((bench.crowd > 0 || octree.header().references <= octree.header().needed));
    const Differences d = compare(bench.query_discs(octree, points, probed), points, [&](const vec4& x) {
      Found f{};
      for (uint32_t i = 0; i < k_discs; ++i) {
        if (!contains(spheres[i], x)) continue;
        const vec3 off = (vec3(x) - vec3(spheres[i])) * vec3(plain[i]);
        if (std::abs(off.x + off.y + off.z) <= 0.2f * spheres[i].w) add(f, i);
      }
      return f;
    });
    CHECK(d.wrong == 0);
    CHECK(d.unordered == 0);
    CHECK(d.found > 20000);
  }
}

TEST_CASE("far spheres make no leaf larger, and are found") {
  Bench bench(GENERATE(0u, 4u));
  INFO("crowd " << bench.crowd);
  const bool discs = GENERATE(false, true);
  INFO("discs " << discs);
  constexpr uint32_t k_near = 3000, k_far = 200, k_points = 30000;
  const vec3 centre(1, 2, 3);
  Box core;
  core.grow(centre - 8.0f), core.grow(centre + 8.0f);
  float alone = 0;
  for (const float far : {0.0f, 2e4f, 1e5f, 1e7f}) {
    INFO("spheres " << far << " m away");
    std::mt19937 random(31);
    Spheres spheres = mixed_spheres(k_near, centre, 10, 32);
    Points points = points_for(spheres, k_points, centre, 10, 33);
    for (uint32_t i = 0; far > 0 && i < k_far; ++i) {
      // Beyond one face or several, some large enough to reach back.
      vec3 p(uniform(random), uniform(random), uniform(random));
      p = centre + 10.0f * (p - 0.5f);
      for (int axis = 0; axis < 3; ++axis)
        if (i % 7 & (1 << axis)) p[axis] = (i & 8 ? -far : far) * uniform(random);
      spheres.insert(spheres.begin() + random() % spheres.size(),
                     vec4(p, i % 5 == 0 ? 1.01f * glm::distance(p, centre) : 1e-3f + 2 * uniform(random)));
    }
    std::vector<vec4> normals;
    for (size_t i = 0; i < spheres.size(); ++i) {
      vec3 n(uniform(random) - 0.5f, uniform(random) - 0.5f, uniform(random) - 0.5f);
      if (i % 2 == 0) n = 1e-3f * n, n[int(i / 2 % 3)] = 1;
      normals.emplace_back(glm::normalize(n), 0);
    }
    Points beyond = points_for(spheres, k_points, centre, far, 34);
    for (uint32_t i = 0; far > 0 && i < k_points / 3; ++i) {  // in the planes of discs
      const uint32_t of = random() % uint32_t(spheres.size());
      const vec3 n(normals[of]), d = vec3(uniform(random), uniform(random), uniform(random)) - 0.5f;
      beyond[3 * i] = vec4(vec3(spheres[of]) + spheres[of].w * (d - glm::dot(d, n) * n), 0);
    }
    if (far > 0) points.insert(points.end(), beyond.begin(), beyond.end());
    gpu::Buffer texels = bench.texels("normals", normals.size() * sizeof(vec4));
    texels.write(std::span<const vec4>(normals));
    bench.upload(spheres);
    const lookup::Discs planes{.normals = texels, .stride = 1, .at = 0, .thickness = 0.2f};
    const auto count = uint32_t(spheres.size());
    Octree octree(
        bench.device, bench.compiler,
        {.spheres = count, .references = 1000000, .leaf_scale = 0.5f, .discs = discs, .crowd = bench.crowd});
    octree.set_core(core);
    octree.build(bench.stream, bench.spheres, {.most = count}, discs ? &planes : nullptr);
    CHECK(octree.header().open == (far > 0 ? 1u : 0u));
    const std::vector<Found> found =
        discs ? bench.query_discs(octree, points, texels) : bench.query(octree, points);
    const Differences d = compare(found, points, [&](const vec4& x) {
      Found f{};
      for (uint32_t i = 0; i < count; ++i) {
        if (!contains(spheres[i], x)) continue;
        const vec3 off = (vec3(x) - vec3(spheres[i])) * vec3(normals[i]);
        if (!discs || std::abs(off.x + off.y + off.z) <= 0.2f * spheres[i].w) add(f, i);
      }
      return f;
    });
    CHECK(d.wrong == 0);
    CHECK(d.unordered == 0);
    // Far spheres enter near lists only if they are large enough.
    double listed = 0;
    for (uint32_t i = 0; i < k_points; ++i) listed += found[i].list;
    if (far == 0) alone = float(listed);
    CHECK(listed < 1.5 * double(alone) + double(k_far) * k_points);
    CHECK(octree.header().leaf <= 2);
  }
}

TEST_CASE("an octree beyond every buffer is refused") {
  Bench bench;
  const uint32_t most = Octree::most_references(bench.device);
  CHECK_THAT(
      test::error_of([&] { Octree(bench.device, bench.compiler, {.spheres = 1, .references = most + 1}); }),
      Catch::Matchers::Contains(std::to_string(most)));
  CHECK_THAT(test::error_of([&] {
               Octree(bench.device, bench.compiler, {.spheres = lookup::k_most_spheres + 1, .references = 1});
             }),
             Catch::Matchers::Contains("16777217 spheres"));
  Octree octree(bench.device, bench.compiler, {.spheres = 10, .references = 10});
  bench.upload(Spheres(11, vec4(0)));
  CHECK_THAT(test::error_of([&] { octree.build(bench.stream, bench.spheres, {.most = 11}); }),
             Catch::Matchers::Contains("11 spheres"));
}

TEST_CASE("coordinates around ten kilometres, where floats have steps of a millimetre") {
  Bench bench(GENERATE(0u, 4u));
  INFO("crowd " << bench.crowd);
  for (const float extent : {0.05f, 2.0f, 50.0f}) {
    const vec3 centre(10000, -9000, 12000);
    const Spheres spheres = mixed_spheres(3000, centre, extent, 3);
    const Points points = points_for(spheres, 60000, centre, extent, 4);
    const HostGrid grid(spheres);
    for (const float scale : {1.0f, 0.25f}) {
      const Octree octree = bench.build(spheres, 4000000, scale);
      INFO("extent " << extent << " level " << octree.header().level);
      const Differences d =
          compare(bench.query(octree, points), points, [&](const vec4& x) { return grid.find(x); });
      CHECK(d.wrong == 0);
      CHECK(d.unordered == 0);
      CHECK(d.found > 20000);
    }
  }
}

TEST_CASE("points on the borders of cells and spheres that touch them") {
  Bench bench(GENERATE(0u, 4u));
  INFO("crowd " << bench.crowd);
  // Everything at multiples of a power of two, so borders are met exactly.
  std::mt19937 random(5);
  Spheres spheres;
  for (int i = 0; i < 2000; ++i)
    spheres.push_back(0.25f * vec4(random() % 64, random() % 64, random() % 64, 1 + random() % 6));
  Bench* const b = &bench;
  const Octree octree = b->build(spheres, 1000000);
  const float leaf = octree.header().leaf;
  const vec3 origin = octree.header().origin;
  Points points;
  for (int i = 0; i < 40000; ++i) {
    vec3 p = 0.25f * vec3(random() % 66, random() % 66, random() % 66);
    if (i % 2) p = origin + leaf * vec3(random() % 20, random() % 20, random() % 20);
    if (i % 3 == 1) p[random() % 3] = std::nextafter(p[random() % 3], 1000.0f);
    if (i % 3 == 2) p[random() % 3] = std::nextafter(p[random() % 3], -1000.0f);
    points.push_back(vec4(p, 0));
  }
  const Differences d =
      compare(bench.query(octree, points), points, [&](const vec4& x) { return brute_force(spheres, x); });
  CHECK(d.wrong == 0);
  CHECK(d.unordered == 0);
  CHECK(d.found > 10000);
}

TEST_CASE("no sphere, one, equal ones, and invalid ones") {
  Bench bench(GENERATE(0u, 4u));
  INFO("crowd " << bench.crowd);
  Points points{{0, 0, 0, 0},       {1, 0, 0, 0},          {1.0001f, 0, 0, 0},
                {-5, 3, 100, 0},    {1e30f, -1e30f, 0, 0}, {std::nanf(""), 0, 0, 0},
                {INFINITY, 0, 0, 0}};
  const auto check = [&](const Spheres& spheres, uint32_t references) {
    const Octree octree = bench.build(spheres, references);
    const Differences d =
        compare(bench.query(octree, points), points, [&](const vec4& x) { return brute_force(spheres, x); });
    CHECK(d.wrong == 0);
    CHECK(octree.header().overflow == 0);
    return octree.header();
  };
  CHECK(check({}, 10).leaves == 0);
  CHECK(check({{0, 0, 0, 1}}, 100).spheres == 1);
  CHECK(check({{1, 0, 0, 0}}, 100).spheres == 1);
  CHECK(check(Spheres(100, vec4(0.5f, 0, 0, 0.5f)), 10000).spheres == 100);
  const float nan = std::nanf("");
  const auto header = check({{0, 0, 0, -1},
                             {nan, 0, 0, 1},
                             {0, INFINITY, 0, 1},
                             {0, 0, 0, nan},
                             {0, 0, 0, INFINITY},
                             {0.5f, 0, 0, 1}},
                            100);
  CHECK(header.spheres == 1);
  CHECK(header.leaf <= 2);
  CHECK(check({{0, 0, 0, -1}, {0, 0, 0, -2}}, 100).cells == 0);
  // Before the first build.
  const Octree empty(bench.device, bench.compiler, {.spheres = 1, .references = 1});
  for (const Found& f : bench.query(empty, points)) CHECK(f.list == 0);
}

TEST_CASE("with little memory the leaves are larger and the result is the same") {
  Bench bench(GENERATE(0u, 4u));
  INFO("crowd " << bench.crowd);
  const Spheres spheres = mixed_spheres(4000, vec3(0), 8, 6);
  const Points points = points_for(spheres, 40000, vec3(0), 8, 7);
  const HostGrid grid(spheres);
  const auto truth = [&](const vec4& x) { return grid.find(x); };
  const uint32_t full = bench.build(spheres, 1000000).header().needed;
  for (const uint32_t references : {full, full - 1, full / 3, 8000u, 4001u, 4000u}) {
    const Octree octree = bench.build(spheres, references);
    const shared::OctreeHeader& h = octree.header();
    INFO(references << " references, level " << h.level << " of " << h.wanted_level);
    CHECK(h.needed == full);
    CHECK(h.capacity == references);
    // Half of it is reserved for split leaves.
    if (bench.crowd == 0) CHECK((h.level < h.wanted_level) == (references < full));
    CHECK(h.references <= references);
    CHECK(h.overflow == 0);
    const Differences d = compare(bench.query(octree, points), points, truth);
    CHECK(d.wrong == 0);
    CHECK(d.unordered == 0);
  }
  // Less than one reference per sphere: reported, and the first spheres are stored.
  const Octree octree = bench.build(spheres, 1500);
  CHECK(octree.header().level == 0);
  CHECK(octree.header().overflow == 2500);
  CHECK(octree.header().references == 1500);
  const Spheres first(spheres.begin(), spheres.begin() + 1500);
  const Differences d =
      compare(bench.query(octree, points), points, [&](const vec4& x) { return brute_force(first, x); });
  CHECK(d.wrong == 0);
}

TEST_CASE("one huge sphere among small ones costs a coarser level, no endless loop") {
  Bench bench(GENERATE(0u, 4u));
  INFO("crowd " << bench.crowd);
  std::mt19937 random(8);
  Spheres spheres{{0, 0, 0, 50}};
  for (int i = 0; i < 3000; ++i)
    spheres.push_back({100 * uniform(random) - 50, 100 * uniform(random) - 50, 100 * uniform(random) - 50,
                       0.05f + 0.1f * uniform(random)});
  const Points points = points_for(spheres, 30000, vec3(0), 100, 9);
  const Octree octree = bench.build(spheres, 100000);
  CHECK(octree.header().level < octree.header().wanted_level);
  CHECK(octree.header().needed > 100000000);
  const Differences d =
      compare(bench.query(octree, points), points, [&](const vec4& x) { return brute_force(spheres, x); });
  CHECK(d.wrong == 0);
}

TEST_CASE("no sphere overlaps more leaves than an invocation may visit on lavapipe, whatever the memory") {
  Bench bench(GENERATE(0u, 4u));
  INFO("crowd " << bench.crowd);
  std::mt19937 random(14);
  Spheres spheres{{32, 32, 32, 24}};  // 49^3 leaves of 1 m
  for (int i = 0; i < 2000; ++i)
    spheres.push_back({64 * uniform(random), 64 * uniform(random), 64 * uniform(random), 0.51f});
  const Points points = points_for(spheres, 30000, vec3(32), 64, 15);
  const Octree octree = bench.build(spheres, 1000000);
  CHECK(octree.header().level < octree.header().wanted_level);
  CHECK(octree.header().overflow == 0);
  const Differences d =
      compare(bench.query(octree, points), points, [&](const vec4& x) { return brute_force(spheres, x); });
  CHECK(d.wrong == 0);
}

TEST_CASE("two builds are identical byte for byte, and an octree can be rebuilt from other spheres") {
  Bench bench(GENERATE(0u, 4u));
  INFO("crowd " << bench.crowd);
  const Spheres spheres = mixed_spheres(30000, vec3(0), 20, 10), others = mixed_spheres(500, vec3(9), 3, 11);
  gpu::Buffer count(bench.device, {.name = "count", .bytes = 16});
  count.write(std::span<const uint32_t>({0u, 30000u, 500u, 0u}));
  std::vector<std::vector<uint32_t>> first;
  Octree octree(bench.device, bench.compiler,
                {.spheres = 40000, .references = 3000000, .crowd = bench.crowd});
  for (int round = 0; round < 3; ++round) {
    bench.upload(round == 1 ? others : spheres);
    // The count is in a buffer; `most` is the capacity of the buffer of spheres.
    const uint32_t n = round == 1 ? 500 : 30000;
    octree.build(bench.stream, bench.spheres, {.most = n, .buffer = &count, .offset = round == 1 ? 8u : 4u});
    const shared::OctreeHeader& h = octree.header();
    CHECK(h.spheres == n);
    gpu::Resources r;
    octree.bind(r);
    std::vector<std::vector<uint32_t>> now;
    for (const auto& [name, words] : {std::pair<const char*, size_t>{"octree_slots", h.slots * 4ull},
                                      {"octree_references", h.references * 2ull},
                                      {"OctreeHeaders", sizeof(h) / 4}}) {
      now.push_back(std::get<const gpu::Buffer*>(*r.find(name))->read_all<uint32_t>());
      now.back().resize(words);
    }
    if (round == 0) first = now;
    if (round == 1) CHECK(first != now);
    if (round == 2) CHECK(first == now);
  }
}

TEST_CASE("lists are short in a crowd of small spheres among large ones once its leaves are split") {
  // In the second case far spheres make leaves the finest possible without splitting.
  const float far = GENERATE(0.0f, 500.0f);
  const vec3 corner(0.3f, 0.2f, 7);
  Spheres spheres = mixed_spheres(2000, vec3(0), 20, 16);
  for (vec4& s : spheres) s.w = 0.6f;
  if (far > 0) spheres.push_back(vec4(far, 0, far, 0.6f));
  std::mt19937 random(17);
  for (int i = 0; i < 20000; ++i)
    spheres.push_back(vec4(corner + vec3(uniform(random), uniform(random), uniform(random)), 0.03f));
  Points points;
  for (int i = 0; i < 30000; ++i)
    points.push_back(vec4(corner + vec3(uniform(random), uniform(random), uniform(random)), 0));
  const HostGrid grid(spheres);
  size_t listed[2];
  for (const uint32_t crowd : {0u, 16u}) {
    Bench bench(crowd);
    // With the memory of the plain octree; with half of it.
    for (const uint32_t references : {2000000u, 200000u}) {
      const Octree octree = bench.build(spheres, references);
      CHECK(octree.header().references <= references);
      const Differences d =
          compare(bench.query(octree, points), points, [&](const vec4& x) { return grid.find(x); });
      CHECK(d.wrong == 0);
      CHECK(d.unordered == 0);
      if (references == 2000000u) listed[crowd > 0] = d.listed;
    }
  }
  INFO("listed: " << listed[0] << ", split " << listed[1]);
  CHECK(10 * listed[1] < listed[0]);
}

}  // namespace lookup_octree_tests
