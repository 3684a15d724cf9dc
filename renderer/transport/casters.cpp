#include "transport/casters.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "shaders/shared/emission.h"

namespace lucerna::transport {

using namespace shared;

namespace {

constexpr int k_bins = 16;
constexpr float k_most_surface = 0.95f;  ///< of the surface of a box its parts' may have together
constexpr float k_least_metal = 0.05f, k_least_transmission = 0.05f, k_most_roughness = 0.5f;

float surface(const Box& b) {
  const vec3 s = b.size();
  return s.x * s.y + s.y * s.z + s.z * s.x;
}

struct Cut {
  int axis = 0, bin = 0;
  float gain = 0;  ///< surface that it takes away
};

struct Cluster {
  std::vector<uint32_t> things;
  Box box, centres;
  std::optional<Cut> cut;
};

int bin_of(const Cluster& c, const Box& thing, int axis) {
  const float width = c.centres.size()[axis];
  return std::clamp(int(float(k_bins) * (thing.centre()[axis] - c.centres.lo[axis]) / width), 0, k_bins - 1);
}

Cluster make_cluster(std::span<const Box> all, std::vector<uint32_t> things) {
  Cluster c{.things = std::move(things), .box = {}, .centres = {}, .cut = {}};
  for (const uint32_t i : c.things) c.box.grow(all[i]), c.centres.grow(all[i].centre());
  float best = k_most_surface * surface(c.box);
  for (int axis = 0; axis < 3; ++axis) {
    if (c.centres.size()[axis] <= 0) continue;
    std::array<Box, k_bins> bins;
    for (const uint32_t i : c.things) bins[size_t(bin_of(c, all[i], axis))].grow(all[i]);
    std::array<float, k_bins> above{};  // of what lies in this bin and beyond
    Box sum;
    for (size_t b = k_bins; b-- > 1;) sum.grow(bins[b]), above[b] = sum.empty() ? 0 : surface(sum);
    Box below;
    for (int b = 1; b < k_bins; ++b) {
      below.grow(bins[size_t(b) - 1]);
      if (below.empty()) continue;
      const float both = surface(below) + above[size_t(b)];
      if (both >= best) continue;
      best = both;
      c.cut = Cut{.axis = axis, .bin = b, .gain = surface(c.box) - both};
    }
  }
  return c;
}

bool textured(const std::vector<vec4>& m, size_t material, uint32_t use) {
  const vec4& bits = m[material + k_material_textures + k_texture_texels * use + 1];
  return (std::bit_cast<uint32_t>(bits.x) & k_texture_present) != 0;
}

}  // namespace

std::vector<uint32_t> cluster(std::span<const Box> things, uint32_t most) {
  std::vector<uint32_t> of(things.size());
  if (things.empty()) return of;
  std::vector<uint32_t> every(things.size());
  for (uint32_t i = 0; i < every.size(); ++i) every[i] = i;
  std::vector<Cluster> clusters{make_cluster(things, std::move(every))};
  while (clusters.size() < most) {
    size_t best = clusters.size();
    for (size_t i = 0; i < clusters.size(); ++i)
      if (clusters[i].cut && (best == clusters.size() || clusters[i].cut->gain > clusters[best].cut->gain))
        best = i;
    if (best == clusters.size()) break;
    const Cluster whole = std::move(clusters[best]);
    std::vector<uint32_t> low, high;
    for (const uint32_t i : whole.things)
      (bin_of(whole, things[i], whole.cut->axis) < whole.cut->bin ? low : high).push_back(i);
    clusters[best] = make_cluster(things, std::move(low));
    clusters.push_back(make_cluster(things, std::move(high)));
  }
  for (uint32_t c = 0; c < clusters.size(); ++c)
    for (const uint32_t i : clusters[c].things) of[i] = c;
  return of;
}

std::vector<Box> cluster_boxes(std::span<const Box> things, uint32_t most) {
  const std::vector<uint32_t> of = cluster(things, most);
  std::vector<Box> boxes(of.empty() ? 0 : *std::max_element(of.begin(), of.end()) + 1);
  for (size_t i = 0; i < of.size(); ++i) boxes[of[i]].grow(things[i]);
  return boxes;
}

std::vector<bool> casting_materials(const upload::FlatMaterials& flat) {
  const std::vector<vec4>& m = flat.materials;
  std::vector<bool> casts(m.size() / k_material_texels);
  for (size_t i = 0; i < casts.size(); ++i) {
    const size_t at = i * k_material_texels;
    const vec4 &surface = m[at + k_material_surface], &specular = m[at + k_material_specular];
    const uint32_t flags = std::bit_cast<uint32_t>(m[at + k_material_emission].w);
    const bool smooth = surface.y <= k_most_roughness || textured(m, at, k_use_metallic_roughness);
    // A thin smooth wall transmits light undeflected; its reflection is as weak as that of varnish.
    const bool glass = specular.w >= k_least_transmission && (flags & k_flag_solid) != 0;
    casts[i] = smooth && (flags & k_flag_unlit) == 0 && (surface.x >= k_least_metal || glass);
  }
  return casts;
}

std::vector<Box> find_casters(const upload::FlatScene& flat) {
  const std::vector<bool> casts = casting_materials(flat);
  std::vector<Box> triangles;
  for (size_t prim = 0; prim < flat.triangles.size(); ++prim) {
    if (!casts[flat.triangles[prim].w & k_triangle_material_mask]) continue;
    Box box;
    for (size_t k = 0; k < 3; ++k) box.grow(flat.positions[3 * prim + k]);
    triangles.push_back(box);
  }
  std::vector<Box> boxes = cluster_boxes(triangles, k_most_casters);
  for (Box& b : boxes) {
    const vec3 size = b.size(), reach = glm::max(glm::abs(b.lo), glm::abs(b.hi));
    const float wider =
        1e-3f * std::max({size.x, size.y, size.z}) + 1e-6f * std::max({reach.x, reach.y, reach.z});
    b.lo -= vec3(wider), b.hi += vec3(wider);
  }
  return boxes;
}

}  // namespace lucerna::transport
