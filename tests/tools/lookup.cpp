#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/math.h"
#include "solvers/lookup/octree.h"
#include "tools/timing.h"
#include "tools/tools.h"

namespace lucerna::tools {
namespace {

using Json = nlohmann::ordered_json;

/// A lookup structure and its parameters.
struct Way {
  std::string name;
  bool single;
  float size;      ///< leaves relative to the mean diameter; single: cells relative to the largest diameter
  int neighbours;  ///< LUCERNA_NEIGHBOURS
  bool copies = false;
};

struct Row {
  std::string spheres_kind, way;
  uint32_t spheres = 0;
  shared::OctreeHeader header{};
  Timing build, gather;
  double listed = 0, found = 0;  ///< spheres per query
  uint64_t bytes = 0;
  bool same = true;  ///< same result as the octree
};

float uniform(std::mt19937& random) { return float(random() >> 8) * (1.0f / 16777216); }

/// Random points on the walls, floor and ceiling of a hall of 20 × 8 × 10 m and on 40 boxes inside.
struct Hall {
  std::vector<std::pair<vec3, vec3>> boxes;  ///< corner, extent; the first is the hall
  std::vector<float> area;                   ///< cumulative sums
  explicit Hall(std::mt19937& random) {
    boxes.push_back({vec3(0), vec3(20, 8, 10)});
    for (int i = 0; i < 40; ++i) {
      const vec3 extent = vec3(0.3f) + 1.5f * vec3(uniform(random), uniform(random), uniform(random));
      boxes.push_back({vec3(18 * uniform(random), 0, 8 * uniform(random)), extent});
    }
    float sum = 0;
    for (const auto& [corner, e] : boxes) area.push_back(sum += 2 * (e.x * e.y + e.y * e.z + e.z * e.x));
  }
  vec3 point(std::mt19937& random) const {
    const float a = uniform(random) * area.back();
    const size_t i = size_t(std::upper_bound(area.begin(), area.end(), a) - area.begin());
    const auto& [corner, e] = boxes[std::min(i, boxes.size() - 1)];
    const float faces[] = {e.y * e.z, e.z * e.x, e.x * e.y};
    float f = uniform(random) * (faces[0] + faces[1] + faces[2]);
    int axis = 0;
    while (axis < 2 && f >= faces[axis]) f -= faces[axis++];
    vec3 p(uniform(random), uniform(random), uniform(random));
    p[axis] = float(random() % 2);
    return corner + e * p;
  }
};

/// `photons`: all of one radius, about 50 around a point. `records`: radii over one decade, about 6 around a
/// point.
std::vector<vec4> make_spheres(const Hall& hall, const std::string& kind, uint32_t n, std::mt19937& random) {
  std::vector<vec4> spheres(n);
  const float density = float(n) / hall.area.back();
  // The mean of r^2 over radii uniform in their logarithm from a to 10 a is 99 / (2 ln 10) a^2.
  const float radius = kind == "photons" ? std::sqrt(50 / (3.14159265f * density))
                                         : std::sqrt(6 / (3.14159265f * density * 21.5f));
  for (vec4& s : spheres)
    s = vec4(hall.point(random), kind == "photons" ? radius : radius * std::pow(10.0f, uniform(random)));
  return spheres;
}

/// Leaves are powers of two. Scales everything until the largest sphere's diameter is just below one, so the
/// grid's cells are as small as possible.
float scale_for(const std::vector<vec4>& spheres) {
  float largest = 0;
  for (const vec4& s : spheres) largest = std::max(largest, 2 * s.w);
  return 0.9999f * std::exp2(std::ceil(std::log2(largest))) / largest;
}

struct Candidate {
  Candidate(gpu::Device& device, gpu::ShaderCompiler& compiler, const Way& way, uint32_t spheres, float scale)
      : name(way.name),
        octree(device, compiler,
               {.spheres = spheres,
                .references = std::min(way.single ? spheres : std::max(64 * spheres, 1u << 20),
                                       lookup::Octree::most_references(device)),
                .leaf_scale = scale,
                .copies = way.copies,
                .single_reference = way.single}),
        gather(device, compiler, LUCERNA_SOURCE_DIR "/tests/tools/gather.comp",
               {{"LUCERNA_NEIGHBOURS", std::to_string(way.neighbours)},
                {"LUCERNA_COPIES", way.copies ? "1" : "0"}}) {}
  std::string name;
  lookup::Octree octree;
  gpu::Kernel gather;
  gpu::Resources resources;
  Timed timed_build, timed_gather;
};

class Bench {
 public:
  Bench(gpu::Device& device, const LookupArguments& a) : device_(device), stream_(device), a_(a) {}

  void run(const std::string& kind, uint32_t n) {
    std::mt19937 random(a_.seed);
    const Hall hall(random);
    std::vector<vec4> list = make_spheres(hall, kind, n, random);
    const float unit = scale_for(list);
    for (vec4& s : list) s *= unit;
    gpu::Buffer spheres = texels(n * sizeof(vec4)), points = texels(a_.queries * sizeof(vec4)),
                found = texels(a_.queries * sizeof(uvec4));
    spheres.write(std::span<const vec4>(list));
    std::vector<vec4> where(a_.queries);
    for (vec4& p : where) p = vec4(unit * hall.point(random), 0);
    points.write(std::span<const vec4>(where));
    float largest = 0, mean = 0;
    for (const vec4& s : list) largest = std::max(largest, s.w), mean += s.w / float(n);

    // All are built before any query, so builds and queries of all can alternate.
    std::vector<std::unique_ptr<Candidate>> candidates;
    for (const Way& way : ways()) {
      // Leaves are powers of two at most as large as requested; a cell must not be smaller.
      const float scale = way.single ? 1.9999f * way.size * largest / mean : way.size;
      candidates.push_back(std::make_unique<Candidate>(device_, compiler_, way, n, scale));
      Candidate& c = *candidates.back();
      c.timed_build.run = [&] { c.octree.build(stream_, spheres, {.most = n}); };
      c.timed_gather.run = [&] {
        stream_.dispatch(c.gather, c.resources, a_.queries, gpu::groups_for(a_.queries, 64));
        stream_.run();
      };
    }
    std::vector<Timed> builds, gathers;
    for (auto& c : candidates) builds.push_back(c->timed_build), gathers.push_back(c->timed_gather);
    const auto build_times = take_turns(builds, a_.repeats);
    for (auto& c : candidates) {
      c->octree.bind(c->resources);
      c->resources.set("spheres", spheres);
      c->resources.set("points", points);
      c->resources.set("Found", found);
    }
    const auto gather_times = take_turns(gathers, a_.repeats);

    std::vector<Row> rows;
    std::vector<uvec4> truth;
    for (size_t i = 0; i < candidates.size(); ++i) {
      Candidate& c = *candidates[i];
      Row row{.spheres_kind = kind, .way = c.name, .spheres = n};
      row.build = build_times[i], row.gather = gather_times[i];
      row.header = c.octree.header();
      row.bytes = c.octree.bytes();
      c.timed_gather.run();
      auto got = found.read_all<uvec4>();
      got.resize(a_.queries);
      for (uvec4& g : got) row.found += g.x, row.listed += g.z, g.z = 0;
      row.found /= a_.queries, row.listed /= a_.queries;
      if (truth.empty()) truth = got;
      row.same = got == truth;
      rows.push_back(row);
    }
    rows_.insert(rows_.end(), rows.begin(), rows.end());
    std::printf("%s", to_text(rows).c_str());
    std::fflush(stdout);
    for (const Row& row : rows)
      if (!row.same) throw Error("lookup", row.way + " disagrees with the octree");
  }

  Json to_json() const {
    Json j{
        {"device", device_.info().name}, {"queries", a_.queries}, {"repeats", a_.repeats}, {"seed", a_.seed}};
    for (const Row& r : rows_)
      j["rows"].push_back(
          {{"spheres", r.spheres},
           {"kind", r.spheres_kind},
           {"way", r.way},
           {"level", r.header.level},
           {"leaf_m", r.header.leaf},
           {"mean_diameter_m", r.header.mean_diameter},
           {"leaves", r.header.leaves},
           {"references_per_sphere", double(r.header.references) / r.spheres},
           {"bytes", r.bytes},
           {"build_s", {{"median", r.build.median}, {"low", r.build.low}, {"high", r.build.high}}},
           {"gather_s", {{"median", r.gather.median}, {"low", r.gather.low}, {"high", r.gather.high}}},
           {"queries_per_s", a_.queries / r.gather.median},
           {"listed_per_query", r.listed},
           {"found_per_query", r.found}});
    return j;
  }

 private:
  static std::vector<Way> ways() {
    return {{"octree", false, 1, 0},
            {"octree, leaves twice", false, 2, 0},
            {"octree, spheres copied", false, 1, 0, true},
            {"grid, 27 cells >= diameter", true, 1, 27},
            {"grid, 27 cells >= radius", true, 0.5f, 27},
            {"grid, 8 cells >= diameter", true, 1, 8}};
  }
  gpu::Buffer texels(uint64_t bytes) {
    return {device_, {.name = "bench", .bytes = (bytes + 15) / 16 * 16, .texel = true}};
  }
  std::string to_text(const std::vector<Row>& rows) const {
    const Row& first = rows.front();
    std::string text =
        fmt::format("{} {}: {:.1f} found per query\n", first.spheres, first.spheres_kind, first.found);
    for (const Row& r : rows) {
      text += fmt::format(
          "  {:<28} build {:>8.2f} ms ({:.2f} to {:.2f})  {:>5.1f} references per sphere  {:>6.1f} listed "
          "per query  gather {:>7.3f} M/s ({:.3f} to {:.3f})  octree is {:.2f} times as fast\n",
          r.way, 1e3 * r.build.median, 1e3 * r.build.low, 1e3 * r.build.high,
          double(r.header.references) / r.spheres, r.listed, 1e-6 * a_.queries / r.gather.median,
          1e-6 * a_.queries / r.gather.high, 1e-6 * a_.queries / r.gather.low,
          r.gather.median / first.gather.median);
      if (r.header.level < r.header.wanted_level)
        text += fmt::format("    (level {} instead of {}: at most {} references fit into a buffer here)\n",
                            r.header.level, r.header.wanted_level, r.header.capacity);
    }
    return text;
  }

  gpu::Device& device_;
  gpu::ShaderCompiler compiler_;
  gpu::Stream stream_;
  const LookupArguments& a_;
  std::vector<Row> rows_;
};

}  // namespace

int measure_lookup(const LookupArguments& a) {
  gpu::Device device({a.device, false});
  std::printf("%u queries, median of %d (range), on %s\n", a.queries, a.repeats, device.info().name.c_str());
  Bench bench(device, a);
  for (const uint32_t n : a.sizes)
    for (const char* kind : {"photons", "records"}) bench.run(kind, n);
  if (!a.json.empty()) write_file(a.json, json_text(bench.to_json(), 2) + "\n");
  return 0;
}

}  // namespace lucerna::tools
