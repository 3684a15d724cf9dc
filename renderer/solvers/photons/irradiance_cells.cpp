#include "solvers/photons/irradiance_cells.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "shaders/shared/photons/photons.h"

namespace lucerna::photons {

using namespace shared;

namespace {

constexpr int k_morton_bits = 96;
/// A cell is split if each quarter has about as many photons as a cell needs.
constexpr uint32_t k_quarters = 4;
/// If a cell has no deciding photon although this many are expected from its surroundings, its surface is
/// probably hidden below a wall or an object: its area is not counted, and it gets no data. If it is visible
/// after all, this costs noise but no light: the lit half of the photons is independent of the decision.
constexpr double k_hidden = 0.5;

uint64_t spread(uint64_t x) {  // inserts two zeros after each of 21 bits
  x = (x | x << 32) & 0x1f00000000ffffull;
  x = (x | x << 16) & 0x1f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

/// One of 54 sets of directions: faces of a cube, each divided three by three.
uint32_t facing(vec3 n) {
  const vec3 a = glm::abs(n);
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  const auto third = [&](float along) {
    // By angle, so that the sets have similar sizes.
    const float angle = std::atan2(along, a[axis]) * (4 / k_pi);
    return angle < -1.0f / 3 ? 0u : angle < 1.0f / 3 ? 1u : 2u;
  };
  const uint32_t face = 2 * uint32_t(axis) + (n[axis] < 0 ? 1 : 0);
  return 9 * face + 3 * third(n[(axis + 1) % 3]) + third(n[(axis + 2) % 3]);
}

}  // namespace

SideOrder order_sides(const upload::FlatScene& flat, const std::vector<bool>& diffuse) {
  SideOrder order;
  const auto triangles = uint32_t(flat.triangles.size());
  order.areas.resize(triangles), order.longest.resize(triangles);
  order.places.assign(2 * size_t{triangles}, k_no_place);
  const vec3 corner = glm::abs(flat.scene_centre) + vec3(flat.scene_radius);
  int exponent = 0;
  std::frexp(std::max({corner.x, corner.y, corner.z, 1e-30f}), &exponent);
  order.across = std::ldexp(1.0f, exponent + 1);
  std::vector<std::pair<SideOrder::Key, uint32_t>> all;
  for (uint32_t t = 0; t < triangles; ++t) {
    if (!diffuse[flat.triangles[t].w & k_triangle_material_mask] || flat.non_opaque[t] != 0) continue;
    const vec3* p = &flat.positions[3 * size_t{t}];
    const vec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
    const float twice = glm::length(across);
    if (!(twice > 0)) continue;
    order.areas[t] = 0.5f * twice;
    order.longest[t] =
        std::max({glm::distance(p[0], p[1]), glm::distance(p[1], p[2]), glm::distance(p[2], p[0])});
    const glm::dvec3 at = glm::dvec3((p[0] + p[1] + p[2]) / 3.0f) / double(order.across) + 0.5;
    SideOrder::Key code;
    for (int a = 0; a < 3; ++a) {
      const auto cell = uint64_t(std::clamp(std::ldexp(at[a], 32), 0.0, std::ldexp(1.0, 32) - 1));
      code.high |= spread(cell >> 16) << a, code.low |= spread(cell & 0xffffu) << a;
    }
    const bool flipped = (flat.triangles[t].w & k_triangle_flipped) != 0;
    const vec3 front = (flipped ? -across : across) / twice;
    for (uint32_t back = 0; back < 2; ++back)
      all.emplace_back(
          SideOrder::Key{uint64_t{facing(back != 0 ? -front : front)} << (k_morton_bits / 2) | code.high,
                         code.low},
          t << 1 | back);
  }
  std::sort(all.begin(), all.end());
  order.sides.reserve(all.size()), order.keys.reserve(all.size());
  for (const auto& [key, side] : all) {
    order.places[side] = uint32_t(order.sides.size());
    order.keys.push_back(key), order.sides.push_back(side);
  }
  return order;
}

/// Leftovers of a cluster, with too few photons so far.
struct IrradianceCellsBuilder::Rest {
  std::vector<std::pair<uint32_t, uint32_t>> ranges;  ///< of the order
  uint32_t deciding = 0;
};

IrradianceCellsBuilder::IrradianceCellsBuilder(const SideOrder& order, std::vector<PhotonOnSide> photons,
                                               uint32_t groups, uint32_t nearest, float widest)
    : order_(order), photons_(std::move(photons)), groups_(groups), nearest_(nearest), widest_(widest) {
  std::erase_if(photons_, [&](const PhotonOnSide& p) { return order_.places[p.side] == k_no_place; });
  std::sort(photons_.begin(), photons_.end(), [](const PhotonOnSide& a, const PhotonOnSide& b) {
    return std::pair(a.side, a.number) < std::pair(b.side, b.number);
  });
  cells_.roots.assign(order.areas.size(), uvec4(k_irradiance_none));
  cells_.nodes.assign(1 + groups_, vec4(0, 0, 0, std::bit_cast<float>(k_irradiance_none)));
}

uint32_t IrradianceCellsBuilder::half_of(const PhotonOnSide& p) {
  // By hashed path number, not by one of its bits: paths of even number have all random numbers in the same
  // half.
  uint32_t x = p.number >> k_photon_id_events;
  x = (x ^ x >> 16) * 0x7feb352du;
  x = (x ^ x >> 15) * 0x846ca68bu;
  return x >> 31;
}

uint32_t IrradianceCellsBuilder::add_nodes(uint32_t count) {
  const auto first = uint32_t(cells_.nodes.size() / (1 + groups_));
  cells_.nodes.resize(cells_.nodes.size() + size_t{count} * (1 + groups_), vec4(0));
  return first;
}

IrradianceCellsBuilder::Sum IrradianceCellsBuilder::sum_of(std::span<const PhotonOnSide> photons,
                                                           double area) const {
  Sum sum;
  sum.area = area;
  sum.flux.assign(3 * (1 + size_t{groups_}), 0.0);
  for (const PhotonOnSide& p : photons) {
    if (half_of(p) != lit_by_) {
      ++sum.deciding;
      continue;
    }
    for (int c = 0; c < 3; ++c) sum.flux[size_t(c)] += double(p.flux[c]);
    if (p.group < groups_)
      for (int c = 0; c < 3; ++c) sum.flux[3 * (1 + size_t{p.group}) + size_t(c)] += double(p.flux[c]);
  }
  return sum;
}

void IrradianceCellsBuilder::put(uint32_t node, const Sum& sum) {
  vec4* texels = &cells_.nodes[size_t{node} * (1 + groups_)];
  for (uint32_t g = 0; g < 1 + groups_; ++g)
    for (int c = 0; c < 3; ++c) texels[g][c] = float(2 * sum.flux[3 * size_t{g} + size_t(c)] / sum.area);
  texels[0].w = std::bit_cast<float>(k_irradiance_known);
}

void IrradianceCellsBuilder::light(const Sum& sum) {
  for (const uint32_t node : sum.nodes) put(node, sum);
  ++cells_.known;
}

namespace {

template <class Sum>
void add(Sum& into, const Sum& from) {
  if (into.flux.empty()) into.flux.assign(from.flux.size(), 0.0);
  into.deciding += from.deciding, into.area += from.area;
  for (size_t i = 0; i < from.flux.size(); ++i) into.flux[i] += from.flux[i];
  into.nodes.insert(into.nodes.end(), from.nodes.begin(), from.nodes.end());
}

}  // namespace

void IrradianceCellsBuilder::cut(uint32_t node, std::span<PhotonOnSide> photons, const Piece& piece,
                                 std::vector<Sum>& found, Sum& rest) {
  const auto deciding = uint32_t(
      std::count_if(photons.begin(), photons.end(), [&](const auto& p) { return half_of(p) != lit_by_; }));
  if (deciding == 0 || piece.depth == k_irradiance_depth) {
    Sum whole = sum_of(photons, piece.area);
    whole.nodes = {node};
    if (deciding >= nearest_)
      found.push_back(std::move(whole));
    else if (piece.expected < k_hidden)
      add(rest, whole);
    return;
  }
  const uint32_t first = add_nodes(4);
  cells_.nodes[size_t{node} * (1 + groups_)].w = std::bit_cast<float>(first);
  std::array<std::vector<PhotonOnSide>, 4> quarters;
  for (PhotonOnSide& p : photons) {
    const uvec3 q = irradiance_quarter(uvec2(p.barycentric & 0xffffu, p.barycentric >> 16));
    quarters[q.z].push_back(p);
    quarters[q.z].back().barycentric = q.x | q.y << 16;
  }
  if (deciding < k_quarters * nearest_) {
    // One cell of those quarters that have any photons.
    Sum whole;
    for (uint32_t k = 0; k < 4; ++k) {
      Sum part = sum_of(quarters[k], piece.area / 4);
      part.nodes = {first + k};
      if (part.deciding > 0 || deciding / 4.0 < k_hidden) add(whole, part);
    }
    if (whole.deciding >= nearest_)
      found.push_back(std::move(whole));
    else
      add(rest, whole);
    return;
  }
  const Piece quarter{.area = piece.area / 4,
                      .longest = piece.longest / 2,
                      .depth = piece.depth + 1,
                      .expected = deciding / 4.0};
  std::vector<Sum> pieces;
  Sum left;
  for (uint32_t k = 0; k < 4; ++k) cut(first + k, quarters[k], quarter, pieces, left);
  // Quarters with too few photons are merged with each other, or with the cell that has the fewest, unless
  // the result is too large.
  if (!left.nodes.empty() && piece.longest <= widest_) {
    if (left.deciding < nearest_ && !pieces.empty()) {
      const auto least = std::min_element(pieces.begin(), pieces.end(),
                                          [](const Sum& a, const Sum& b) { return a.deciding < b.deciding; });
      add(*least, left);
      left = {};
    } else if (left.deciding >= nearest_) {
      pieces.push_back(std::move(left));
      left = {};
    }
  }
  for (const Sum& p : pieces) light(p);
  if (!left.nodes.empty() && left.deciding < nearest_) add(rest, left);
}

void IrradianceCellsBuilder::cluster(uint32_t first, uint32_t last, int bit, Rest& rest) {
  const auto leave = [&] {
    rest.ranges.emplace_back(first, last), rest.deciding += decided_[last] - decided_[first];
  };
  if (first == last) return;
  const double across = std::ldexp(double(order_.across), -((k_morton_bits - 1 - bit) / 3));
  // The leftovers in here have too few photons together.
  if (decided_[last] - decided_[first] < nearest_ || bit < 0) return leave();
  SideOrder::Key key = order_.keys[first].above(bit);
  (bit >= 48 ? key.high : key.low) |= 1;
  const auto* begin = order_.keys.data();
  const auto middle = uint32_t(
      std::lower_bound(begin + first, begin + last, key,
                       [&](const SideOrder::Key& a, const SideOrder::Key& b) { return a.above(bit) < b; }) -
      begin);
  Rest left;
  cluster(first, middle, bit - 1, left);
  cluster(middle, last, bit - 1, left);
  if (across > widest_) return;  // too large a cell, as everything around it
  if (left.deciding < nearest_) {
    rest.ranges.insert(rest.ranges.end(), left.ranges.begin(), left.ranges.end());
    rest.deciding += left.deciding;
    return;
  }
  // One cell of all of them.
  Sum sum;
  sum.flux.assign(3 * (1 + size_t{groups_}), 0.0);
  const uint32_t own = add_nodes(1);
  sum.nodes = {own};
  const uint32_t map = 2 * lit_by_;
  const auto each = [&](auto&& f) {
    for (const auto& [from, to] : left.ranges)
      for (uint32_t i = from; i < to; ++i) f(i);
  };
  double bare = 0;  // area of sides without photons
  const auto is_bare = [&](uint32_t i) {
    return rests_of_[i] == k_no_place && double(order_.longest[order_.sides[i] >> 1]) <= widest_;
  };
  each([&](uint32_t i) {
    if (rests_of_[i] != k_no_place) add(sum, rests_[rests_of_[i]]);
    if (is_bare(i)) bare += double(order_.areas[order_.sides[i] >> 1]);
  });
  const double density = sum.deciding / (sum.area + bare);
  each([&](uint32_t i) {
    const uint32_t side = order_.sides[i], triangle = side >> 1;
    const auto area = double(order_.areas[triangle]);
    if (!is_bare(i) || area * density >= k_hidden) return;
    sum.area += area;
    cells_.roots[triangle][int(map + (side & 1u))] = own;
  });
  light(sum);
}

void IrradianceCellsBuilder::add_map(uint32_t lit_by) {
  lit_by_ = lit_by;
  rests_of_.assign(order_.sides.size(), k_no_place);
  rests_.clear();
  for (size_t from = 0, to = 0; from < photons_.size(); from = to) {
    const uint32_t side = photons_[from].side, triangle = side >> 1;
    while (to < photons_.size() && photons_[to].side == side) ++to;
    const uint32_t root = add_nodes(1);
    cells_.roots[triangle][int(2 * lit_by + (side & 1u))] = root;
    const Piece whole{.area = double(order_.areas[triangle]), .longest = double(order_.longest[triangle])};
    Sum rest;
    std::vector<Sum> found;
    cut(root, std::span(photons_).subspan(from, to - from), whole, found, rest);
    for (const Sum& p : found) light(p);
    // A complete node has no leftovers and must not be mistaken for a triangle without photons.
    if (rest.nodes.empty() || whole.longest > widest_)
      rest = {.deciding = 0, .area = 0, .flux = std::vector<double>(3 * (1 + size_t{groups_})), .nodes = {}};
    rests_of_[order_.places[side]] = uint32_t(rests_.size());
    rests_.push_back(std::move(rest));
  }
  decided_.assign(order_.sides.size() + 1, 0);
  for (size_t i = 0; i < order_.sides.size(); ++i)
    decided_[i + 1] = decided_[i] + (rests_of_[i] != k_no_place ? rests_[rests_of_[i]].deciding : 0);
  // Sides of similar orientation.
  Rest none;
  for (uint32_t from = 0, to = 0; from < order_.keys.size(); from = to) {
    const SideOrder::Key faces = order_.keys[from].above(k_morton_bits);
    while (to < order_.keys.size() && order_.keys[to].above(k_morton_bits) == faces) ++to;
    cluster(from, to, k_morton_bits - 1, none);
  }
}

}  // namespace lucerna::photons
