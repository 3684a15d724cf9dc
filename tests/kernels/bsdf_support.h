#pragma once
// The surface model of shaders/lib/bsdf.glsl for tests: evaluated by a kernel, integrated over directions by
// adaptive quadrature, and sampled.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "gpu/stream.h"
#include "upload/bsdf_table.h"

namespace lucerna::test::bsdf {

/// SurfaceParameters of the shader, with the layout of the kernel's buffer.
struct Material {
  vec3 base{0.8f, 0.6f, 0.3f};
  float metallic = 0, roughness = 0.5f, ior = 1.5f, specular = 1;
  vec3 specular_color{1};
  float transmission = 0, diffuse_transmission = 0;
  vec3 diffuse_transmission_color{0.3f, 0.7f, 0.5f};
  uint32_t solid = 0, inside = 0;
  int32_t glass_row = -1;
  float clearcoat = 0, clearcoat_roughness = 0.3f;
  vec3 clearcoat_normal{0, 0, 1};
  vec3 sheen{0};
  float sheen_roughness = 0.4f;
  float anisotropy = 0;
  vec2 grain{0.6f, 0.8f};
  float film = 0, film_ior = 1.3f, film_thickness = 400;
  float diffuse_roughness = 0;

  float alpha() const { return roughness * roughness; }
  /// Index of refraction on the other side over that on wo's side.
  float eta() const { return solid && inside ? 1 / ior : ior; }
};

/// The glasses that have tables; glass_row is the index in this list.
inline constexpr float k_glasses[] = {1.5f, 2.4f};

struct Question {
  uint32_t material;
  vec3 wo, wi;
};
struct Value {
  vec3 diffuse, glossy;  ///< f |cos|
  float pdf;
};
struct Draw {
  vec3 wi;
  float pdf;
  vec3 weight;
  float eta2;
  uint32_t event, transmitted;
};
enum Event : uint32_t { k_diffuse, k_glossy, k_specular, k_null };
enum class Subject { bsdf, visible_normals, cosine };

/// #defines with every effect of the surface model on, or off except for those named.
inline gpu::Defines surface_effects(bool all, std::initializer_list<const char*> on = {}) {
  gpu::Defines defines;
  for (const char* name :
       {"LUCERNA_SPECULAR", "LUCERNA_SOLID_GLASS", "LUCERNA_THIN_GLASS", "LUCERNA_GLASS_SPECULAR",
        "LUCERNA_DIFFUSE_TRANSMISSION", "LUCERNA_CLEARCOAT", "LUCERNA_SHEEN", "LUCERNA_ANISOTROPY",
        "LUCERNA_IRIDESCENCE", "LUCERNA_ROUGH_DIFFUSE"})
    defines[name] = all ? "1" : "0";
  for (const char* name : on) defines[name] = "1";
  return defines;
}

inline gpu::Device& device() {
  static gpu::Device instance({"", true});
  return instance;
}

/// Evaluates a list of materials with one variant of the shader.
class Probe {
 public:
  explicit Probe(std::vector<Material> materials, gpu::Defines defines = surface_effects(true),
                 Subject subject = Subject::bsdf)
      : defines_(std::move(defines)),
        materials_(device(), {"materials", materials.size() * sizeof(Material)}) {
    defines_["TEST_SUBJECT"] = std::to_string(static_cast<int>(subject));
    materials_.write(std::span<const Material>(materials));
    resources_.set("Materials", materials_);
    resources_.set("bsdf_table", tables());
  }

  std::vector<Value> evaluate(const std::vector<Question>& questions) {
    if (!evaluate_) evaluate_ = kernel("0");
    std::vector<Value> values;
    values.reserve(questions.size());
    for (size_t first = 0; first < questions.size(); first += k_batch) {
      const size_t n = std::min(k_batch, questions.size() - first);
      reserve(questions_, "Questions", n * sizeof(Question));
      reserve(answers_, "Values", n * sizeof(Value));
      questions_.write(std::span(questions).subspan(first, n));
      run(evaluate_, {static_cast<uint32_t>(n), 0, 0, vec3(0)});
      values.resize(first + n);
      answers_.read(&values[first], n * sizeof(Value));
    }
    return values;
  }

  std::vector<Draw> draw(uint32_t material, const vec3& wo, uint32_t count, uint32_t seed) {
    if (!draw_) draw_ = kernel("1");
    reserve(draws_, "Draws", count * sizeof(Draw));
    run(draw_, {count, material, seed, wo});
    std::vector<Draw> draws(count);
    draws_.read(draws.data(), count * sizeof(Draw));
    return draws;
  }

 private:
  struct Push {
    uint32_t count, material, seed;
    vec3 wo;
  };
  static constexpr size_t k_batch = 1 << 20;

  static const gpu::Buffer& tables() {
    static const gpu::Buffer buffer = [] {
      const std::vector<vec4> values = upload::build_bsdf_tables(k_glasses, true);
      gpu::Buffer b(device(), {"albedo tables", values.size() * sizeof(vec4), gpu::Memory::device, true});
      b.write(std::span<const vec4>(values));
      return b;
    }();
    return buffer;
  }
  gpu::Kernel kernel(const char* draws) {
    static gpu::ShaderCompiler compiler;
    defines_["TEST_DRAW"] = draws;
    return {device(), compiler, std::string(LUCERNA_SOURCE_DIR) + "/tests/kernels/shaders/bsdf_probe.comp",
            defines_};
  }
  void reserve(gpu::Buffer& buffer, const char* name, uint64_t bytes) {
    if (buffer && buffer.bytes() >= bytes) return;
    buffer = gpu::Buffer(device(), {name, bytes});
    resources_.set(name, buffer);
  }
  void run(const gpu::Kernel& kernel, const Push& push) {
    stream_.dispatch(kernel, resources_, push, gpu::groups_for(push.count, 64));
    stream_.run();
  }

  gpu::Defines defines_;
  gpu::Buffer materials_, questions_, answers_, draws_;
  gpu::Resources resources_;
  gpu::Kernel evaluate_, draw_;
  gpu::Stream stream_{device()};
};

inline vec3 direction(double cosine, double phi) {
  const double s = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
  return vec3(s * std::cos(phi), s * std::sin(phi), cosine);
}

/// Integrals over directions: density, diffuse rgb, glossy rgb.
using Integrals = std::array<double, 7>;

/// All directions as a tree of cells: rectangles in (height, azimuth), height = 1 - z from 0 at the upper
/// pole to 2 at the lower. Cells are as small as the integrals and the histogram require.
class Sphere {
 public:
  struct Cell {
    double h0, h1, p0, p1;
    Integrals value{};
    int parent = -1, children = -1;  ///< the first of four
  };
  static constexpr double k_tau = 6.283185307179586;
  static constexpr int k_sectors = 4;
  /// The roots' rings, mirrored below the equator. They become narrower towards the poles, where lobes can be
  /// as narrow as alpha^2.
  static constexpr std::array<double, 13> k_edges{0,      0x1p-18, 0x1p-16, 0x1p-14, 0x1p-12, 0x1p-10, 0x1p-8,
                                                  0x1p-6, 0x1p-4,  0.25,    0.5,     0.75,    1};
  static constexpr int k_rings = 12, k_roots = 2 * k_rings * k_sectors;

  Sphere() {
    for (const bool below : {false, true})
      for (int r = 0; r < k_rings; ++r)
        for (int s = 0; s < k_sectors; ++s)
          add(below ? 2 - k_edges[r + 1] : k_edges[r], below ? 2 - k_edges[r] : k_edges[r + 1],
              k_tau * s / k_sectors, k_tau * (s + 1) / k_sectors, -1);
  }

  /// Over the upper hemisphere (the side of wo) or the lower.
  Integrals over(bool upper) const {
    Integrals sum{};
    for (int i = 0; i < k_roots; ++i)
      if (upper == (i < k_roots / 2))
        for (size_t k = 0; k < sum.size(); ++k) sum[k] += cells[i].value[k];
    return sum;
  }
  double pdf() const { return over(true)[0] + over(false)[0]; }

  /// Number of the histogram's bins, once the tree is complete: cells of at most `most` probability, larger
  /// only where the tree ends.
  int number_bins(double most) {
    bins_.assign(cells.size(), -1);
    count_ = 0;
    expected_.clear();
    for (int i = 0; i < k_roots; ++i) number(i, most);
    return count_;
  }
  const std::vector<double>& probabilities() const { return expected_; }
  struct Point {
    double h, p;
  };
  static Point point(const vec3& d) {
    const double length = std::sqrt(double(d.x) * d.x + double(d.y) * d.y + double(d.z) * d.z);
    const double x = d.x / length, y = d.y / length, z = std::abs(d.z / length);
    const double cap = (x * x + y * y) / (1 + z);  // 1 - |z| without cancellation
    const double p = std::atan2(y, x);
    return {d.z < 0 ? 2 - cap : cap, p < 0 ? p + k_tau : p};
  }
  static int root_of(const vec3& d) {
    const Point at = point(d);
    const double cap = d.z < 0 ? 2 - at.h : at.h;
    int ring = d.z < 0 ? k_rings : 0;
    for (int r = 1; r < k_rings && cap >= k_edges[r]; ++r) ++ring;
    return ring * k_sectors + std::min(int(at.p / k_tau * k_sectors), k_sectors - 1);
  }
  /// The child of the cell that contains the point.
  int quarter(int cell, const Point& at) const {
    const Cell& c = cells[cell];
    return (at.h >= 0.5 * (c.h0 + c.h1) ? 2 : 0) + (at.p >= 0.5 * (c.p0 + c.p1) ? 1 : 0);
  }
  int bin_of(const vec3& d) const {
    const Point p = point(d);
    int at = root_of(d);
    while (bins_[at] < 0) at = cells[at].children + quarter(at, p);
    return bins_[at];
  }

  void split(int at) {
    const Cell c = cells[at];
    const double h = 0.5 * (c.h0 + c.h1), p = 0.5 * (c.p0 + c.p1);
    cells[at].children = static_cast<int>(cells.size());
    for (int k = 0; k < 4; ++k)
      add(k & 2 ? h : c.h0, k & 2 ? c.h1 : h, k & 1 ? p : c.p0, k & 1 ? c.p1 : p, at);
  }
  /// Values of the leaves, summed up to the roots.
  void sum_up() {
    for (int i = static_cast<int>(cells.size()) - 1; i >= 0; --i)
      if (const int c = cells[i].children; c >= 0)
        for (size_t k = 0; k < cells[i].value.size(); ++k)
          cells[i].value[k] =
              cells[c].value[k] + cells[c + 1].value[k] + cells[c + 2].value[k] + cells[c + 3].value[k];
  }

  std::vector<Cell> cells;

 private:
  void add(double h0, double h1, double p0, double p1, int parent) {
    Cell c;
    c.h0 = h0, c.h1 = h1, c.p0 = p0, c.p1 = p1, c.parent = parent;
    cells.push_back(c);
  }
  void number(int at, double most) {
    const Cell& c = cells[at];
    if (c.children < 0 || c.value[0] <= most) {
      bins_[at] = count_++;
      expected_.push_back(c.value[0]);
      return;
    }
    for (int k = 0; k < 4; ++k) number(c.children + k, most);
  }

  std::vector<int> bins_;
  std::vector<double> expected_;
  int count_ = 0;
};

struct View {
  uint32_t material;
  vec3 wo;
};

/// Integrates for all views at once, level by level: each cell by 3x3 Gauss points is compared with the sum
/// of its four quarters, which are subdivided until the difference is below `tolerance` (absolute, for each
/// integral and cell; the sum of the quarters is two orders of magnitude more accurate) and no cell contains
/// more than `most` of the density. A few draws locate narrow lobes that coarse points would miss; they only
/// decide where cells are subdivided.
inline std::vector<Sphere> integrate(Probe& probe, const std::vector<View>& views, double tolerance = 4e-6,
                                     double most = 1) {
  constexpr double k_node[] = {-0.7745966692414834, 0, 0.7745966692414834};
  constexpr double k_weight[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  constexpr int k_most_levels = 16;
  constexpr uint32_t k_guides = 1024, k_most_guides = 8;  // maximum per group of quarters
  struct Place {
    uint32_t view;
    int cell;
    std::vector<Sphere::Point> guides;
  };
  std::vector<Sphere> spheres(views.size());
  std::vector<Place> open;
  for (uint32_t v = 0; v < views.size(); ++v) {
    const size_t first = open.size();
    for (size_t c = 0; c < spheres[v].cells.size(); ++c) open.push_back({v, static_cast<int>(c), {}});
    for (const Draw& d : probe.draw(views[v].material, views[v].wo, k_guides, 12345 + v))
      if (d.pdf > 0) open[first + Sphere::root_of(d.wi)].guides.push_back(Sphere::point(d.wi));
  }
  std::vector<Question> questions;
  for (int level = 0; !open.empty(); ++level) {
    questions.clear();
    for (const Place& place : open) {
      const Sphere::Cell& c = spheres[place.view].cells[place.cell];
      for (const double y : k_node)
        for (const double x : k_node) {
          const double h = 0.5 * (c.h0 + c.h1 + y * (c.h1 - c.h0)),
                       p = 0.5 * (c.p0 + c.p1 + x * (c.p1 - c.p0));
          const double s = std::sqrt(h * (2 - h));
          questions.push_back({views[place.view].material, views[place.view].wo,
                               vec3(s * std::cos(p), s * std::sin(p), 1 - h)});
        }
    }
    const std::vector<Value> values = probe.evaluate(questions);
    for (size_t i = 0; i < open.size(); ++i) {
      Sphere::Cell& c = spheres[open[i].view].cells[open[i].cell];
      const double area = (c.h1 - c.h0) * (c.p1 - c.p0);
      for (int k = 0; k < 9; ++k) {
        const Value& v = values[9 * i + k];
        const double w = area * k_weight[k / 3] * k_weight[k % 3];
        c.value[0] += w * v.pdf;
        for (int a = 0; a < 3; ++a) c.value[1 + a] += w * v.diffuse[a], c.value[4 + a] += w * v.glossy[a];
      }
    }
    // Groups of four quarters (at first four roots) are contiguous.
    std::vector<Place> next;
    for (size_t i = 0; i < open.size(); i += 4) {
      Sphere& sphere = spheres[open[i].view];
      // Wide cells are subdivided at least three times, so no lobe is missed between the points.
      const Sphere::Cell& first = sphere.cells[open[i].cell];
      bool refine = level < (first.h0 >= 0.25 && first.h1 <= 1.75 ? 3 : 2);
      size_t guides = 0;
      for (int q = 0; q < 4; ++q) guides += open[i + q].guides.size();
      refine = refine || (level < k_most_levels && guides > k_most_guides);
      if (!refine && level < k_most_levels) {
        const int parent = sphere.cells[open[i].cell].parent;
        for (size_t k = 0; k < 7; ++k) {
          double sum = 0;
          for (int q = 0; q < 4; ++q) sum += sphere.cells[open[i + q].cell].value[k];
          refine = refine || std::abs(sum - sphere.cells[parent].value[k]) > tolerance;
        }
      }
      for (int q = 0; q < 4; ++q) {
        const int at = open[i + q].cell;
        if (!refine && (level >= k_most_levels || sphere.cells[at].value[0] <= most)) continue;
        sphere.split(at);
        const int children = sphere.cells[at].children;
        for (int k = 0; k < 4; ++k) next.push_back({open[i].view, children + k, {}});
        for (const Sphere::Point& guide : open[i + q].guides)
          next[next.size() - 4 + sphere.quarter(at, guide)].guides.push_back(guide);
      }
    }
    open.swap(next);
  }
  for (Sphere& sphere : spheres) sphere.sum_up();
  return spheres;
}

}  // namespace lucerna::test::bsdf
