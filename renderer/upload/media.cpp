#include "upload/media.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "bvh/tree.h"

namespace lucerna::upload {

using namespace shared;

namespace {

/// By which two places of one vertex may differ, relative to their largest coordinate: by rounding alone, as
/// along the seam of a sphere.
constexpr float k_same_place = 2e-6f;

struct Corner {
  std::array<uint32_t, 4> words;  ///< position, material
  bool operator==(const Corner&) const = default;
};
struct CornerHash {
  size_t operator()(const Corner& c) const {
    uint64_t h = 0;
    for (const uint32_t w : c.words) h = (h ^ w) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
    return size_t(h);
  }
};

/// Solid triangles, their corners numbered by position and material, counter-clockwise from the front.
struct Solids {
  std::vector<uint32_t> prims;
  std::vector<uvec3> corners;
  std::vector<vec3> places;         ///< by corner
  std::vector<uint32_t> materials;  ///< likewise
  uint32_t corner_count() const { return uint32_t(places.size()); }
};

Solids solids_of(const FlatScene& flat, const std::vector<bool>& solid) {
  Solids all;
  std::unordered_map<Corner, uint32_t, CornerHash> numbers;
  for (uint32_t t = 0; t < flat.triangles.size(); ++t) {
    const uint32_t material = flat.triangles[t].w & k_triangle_material_mask;
    if (!solid[material]) continue;
    uvec3 ids;
    for (int k = 0; k < 3; ++k) {
      const vec3 p = flat.positions[3 * size_t{t} + size_t(k)] + vec3(0);  // -0 is 0
      const Corner corner{{std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y),
                           std::bit_cast<uint32_t>(p.z), material}};
      const auto [at, is_new] = numbers.try_emplace(corner, all.corner_count());
      if (is_new) all.places.push_back(p), all.materials.push_back(material);
      ids[k] = at->second;
    }
    if ((flat.triangles[t].w & k_triangle_flipped) != 0) std::swap(ids.y, ids.z);
    all.prims.push_back(t), all.corners.push_back(ids);
  }
  return all;
}

uint32_t root_of(std::vector<uint32_t>& parents, uint32_t i) {
  while (parents[i] != i) i = parents[i] = parents[parents[i]];
  return i;
}

/// By solid triangle: a number of its shell.
struct Shells {
  std::vector<uint32_t> of_triangle;  ///< root corner
  std::vector<bool> open;             ///< by root corner
  std::vector<uint32_t> borders;      ///< corners of edges that are not used as often in either direction
};

Shells shells_of(const Solids& solids) {
  std::vector<uint32_t> parents(solids.corner_count());
  std::iota(parents.begin(), parents.end(), 0u);
  for (const uvec3& c : solids.corners) {
    parents[root_of(parents, c.y)] = root_of(parents, c.x);
    parents[root_of(parents, c.z)] = root_of(parents, c.x);
  }
  Shells shells;
  shells.open.assign(solids.corner_count(), false);
  std::vector<std::pair<uint64_t, int>> edges;
  edges.reserve(3 * solids.corners.size());
  for (const uvec3& c : solids.corners) {
    shells.of_triangle.push_back(root_of(parents, c.x));
    for (int k = 0; k < 3; ++k) {
      const uint64_t a = c[k], b = c[(k + 1) % 3];
      edges.emplace_back(std::min(a, b) << 32 | std::max(a, b), a < b ? 1 : -1);
    }
  }
  std::sort(edges.begin(), edges.end());
  for (size_t from = 0, to = 0; from < edges.size(); from = to) {
    int sum = 0;
    for (; to < edges.size() && edges[to].first == edges[from].first; ++to) sum += edges[to].second;
    if (sum == 0 || edges[from].first >> 32 == (edges[from].first & 0xffffffffu)) continue;
    for (const uint64_t corner : {edges[from].first >> 32, edges[from].first & 0xffffffffu})
      shells.borders.push_back(uint32_t(corner));
    shells.open[root_of(parents, shells.borders.back())] = true;
  }
  return shells;
}

/// Makes those corners along borders one that are at one place but for rounding.
void join_borders(Solids& solids, std::vector<uint32_t> borders) {
  std::sort(borders.begin(), borders.end());
  borders.erase(std::unique(borders.begin(), borders.end()), borders.end());
  // Along a direction in which vertices of grids are distinct.
  std::vector<std::pair<double, uint32_t>> line;
  line.reserve(borders.size());
  for (const uint32_t corner : borders) {
    const glm::dvec3 p(solids.places[corner]);
    line.emplace_back(0.537 * p.x + 0.6183 * p.y + 0.5739 * p.z, corner);
  }
  std::sort(line.begin(), line.end());
  std::vector<uint32_t> parents(solids.corner_count());
  std::iota(parents.begin(), parents.end(), 0u);
  for (size_t i = 0; i < line.size(); ++i) {
    const vec3 p = solids.places[line[i].second], size = glm::abs(p);
    const float reach = k_same_place * std::max({size.x, size.y, size.z});
    for (size_t k = i + 1; k < line.size() && line[k].first - line[i].first <= double(reach); ++k)
      if (solids.materials[line[k].second] == solids.materials[line[i].second] &&
          glm::distance(solids.places[line[k].second], p) <= reach)
        parents[root_of(parents, line[k].second)] = root_of(parents, line[i].second);
  }
  for (uvec3& corners : solids.corners)
    for (int k = 0; k < 3; ++k) corners[k] = root_of(parents, corners[k]);
}

class TreeWriter {
 public:
  explicit TreeWriter(SolidShells& into) : into_(into) {}
  /// `around`: a node is met where the place lies in its box; else where the ray meets its box. A leaf's
  /// references are passed to `leaf`, which returns its word.
  template <class Leaf>
  void write(const bvh::Tree& tree, uint32_t node, bool around, bool around_below, const Leaf& leaf) {
    const bvh::Tree::Node& n = tree.nodes[node];
    const size_t at = into_.nodes.size();
    into_.nodes.emplace_back(n.box.lo, 0), into_.nodes.emplace_back(n.box.hi, 0);
    if (n.leaf()) {
      into_.nodes[at + 1].w = std::bit_cast<float>(leaf(n));
    } else {
      for (const uint32_t child : n.child) write(tree, child, around_below, around_below, leaf);
    }
    const auto next = uint32_t(into_.nodes.size() / 2);
    into_.nodes[at].w = std::bit_cast<float>(next | (around ? k_media_around : 0u));
  }

 private:
  SolidShells& into_;
};

}  // namespace

std::shared_ptr<const SolidShells> make_solid_shells(const FlatScene& flat, std::vector<bool> solid) {
  auto made = std::make_shared<SolidShells>();
  Solids solids = solids_of(flat, solid);
  Shells shells = shells_of(solids);
  if (!shells.borders.empty()) {
    join_borders(solids, std::move(shells.borders));
    shells = shells_of(solids);
  }
  made->solid = std::move(solid);
  std::vector<std::vector<bvh::Reference>> members;
  std::vector<uint32_t> numbers(solids.corner_count(), ~0u);
  for (uint32_t i = 0; i < solids.prims.size(); ++i) {
    const uint32_t root = shells.of_triangle[i];
    const uvec3& c = solids.corners[i];
    if (shells.open[root] || c.x == c.y || c.y == c.z || c.z == c.x) continue;
    if (numbers[root] == ~0u) {
      numbers[root] = uint32_t(members.size());
      members.emplace_back(), made->boxes.emplace_back();
    }
    const vec3* corners = &flat.positions[3 * size_t{solids.prims[i]}];
    Box box;
    for (size_t k = 0; k < 3; ++k) box.grow(corners[k]);
    box = bvh::grown(box, bvh::margin_of(corners));
    members[numbers[root]].push_back({box, solids.prims[i]});
    made->boxes[numbers[root]].grow(box);
  }
  if (members.empty()) return made;
  std::vector<bvh::Reference> roots;
  for (uint32_t s = 0; s < members.size(); ++s) roots.push_back({made->boxes[s], s});
  TreeWriter writer(*made);
  const bvh::Tree upper = bvh::build_median(std::move(roots));
  const auto shell_leaf = [&](const bvh::Tree& tree) {
    return [&](const bvh::Tree::Node& node) {
      const auto first = uint32_t(made->triangles.size() / 3);
      for (uint32_t i = node.first; i < node.first + node.count; ++i) {
        const uint32_t prim = tree.references[i].prim;
        const bool flipped = (flat.triangles[prim].w & k_triangle_flipped) != 0;
        for (const int k : {0, flipped ? 2 : 1, flipped ? 1 : 2})
          made->triangles.emplace_back(flat.positions[3 * size_t{prim} + size_t(k)], 0);
        made->materials.push_back(flat.triangles[prim].w & k_triangle_material_mask);
      }
      return first << 3 | node.count;
    };
  };
  writer.write(upper, 0, true, true, [&](const bvh::Tree::Node& node) {
    for (uint32_t i = node.first; i < node.first + node.count; ++i) {
      const bvh::Tree tree = bvh::build_median(std::move(members[upper.references[i].prim]));
      writer.write(tree, 0, true, false, shell_leaf(tree));
    }
    return 0u;
  });
  return made;
}

void flatten_media(FlatScene& flat) {
  std::vector<vec4> media(1);
  std::vector<bool> solid(flat.materials.size() / k_material_texels);
  flat.media.clear();
  flat.effects.media = 0;
  for (size_t i = 0; i < solid.size(); ++i) {
    const vec4* m = &flat.materials[i * k_material_texels];
    solid[i] = (std::bit_cast<uint32_t>(m[k_material_emission].w) & k_flag_solid) != 0;
  }
  if (!flat.effects.volumes) return flat.shells.reset();
  for (size_t i = 0; i < solid.size(); ++i) {
    if (!solid[i]) continue;
    vec4* m = &flat.materials[i * k_material_texels];
    const vec4 absorption(vec3(m[k_material_volume]), 0);
    auto at = std::find(media.begin() + 1, media.end(), absorption);
    if (at == media.end()) at = media.insert(at, absorption);
    m[k_material_detail].z = float(at - media.begin());
  }
  flat.effects.media = uint32_t(media.size() - 1);
  if (!flat.shells || flat.shells->solid != solid) flat.shells = make_solid_shells(flat, std::move(solid));
  const SolidShells& shells = *flat.shells;
  const auto nodes = uint32_t(media.size()), count = uint32_t(shells.nodes.size() / 2);
  const auto triangles = uint32_t(nodes + shells.nodes.size());
  media[0] =
      vec4(std::bit_cast<float>(nodes), std::bit_cast<float>(count), std::bit_cast<float>(triangles), 0);
  media.insert(media.end(), shells.nodes.begin(), shells.nodes.end());
  media.insert(media.end(), shells.triangles.begin(), shells.triangles.end());
  for (size_t t = 0; t < shells.materials.size(); ++t)
    media[triangles + 3 * t].w =
        flat.materials[shells.materials[t] * k_material_texels + k_material_detail].z;
  flat.media = std::move(media);
}

bool meets_solids(const FlatMaterials& flat, const Box& box) {
  if (flat.media.empty() || !flat.shells) return false;
  return std::any_of(flat.shells->boxes.begin(), flat.shells->boxes.end(), [&](const Box& b) {
    for (int a = 0; a < 3; ++a)
      if (b.lo[a] > box.hi[a] || b.hi[a] < box.lo[a]) return false;
    return true;
  });
}

}  // namespace lucerna::upload
