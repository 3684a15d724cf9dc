#include "upload/light_clusters.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <queue>

#include "base/alias_table.h"
#include "shaders/shared/facet.h"
#include "shaders/shared/learned_lights.h"
#include "shaders/shared/portals.h"

namespace lucerna::upload {
namespace {

constexpr uint32_t k_sky_clusters = 256;  // their numbers are bytes
constexpr uint32_t k_sky_side = 16;       // squares of a constant sky along a side
constexpr uint32_t k_triangle_clusters = 128, k_lamp_clusters = 64, k_distant_clusters = 16;
constexpr uint32_t k_most_squares = 8;  // squares along a side of a triangle
/// With at least this many emissive triangles, one is resampled from this many candidates of its cluster.
constexpr size_t k_many_triangles = 64, k_triangle_candidates = 8;

float as_float(uint32_t bits) { return std::bit_cast<float>(bits); }

class Builder {
 public:
  explicit Builder(LightClusters& to) : to_(to) {}
  /// `squares`: along a side; the cluster is that of column and row. `kind`: k_cluster_of_triangles, or 0.
  void add(const std::vector<uint32_t>& members, const std::vector<double>& weights, uint32_t squares = 1,
           uint32_t column = 0, uint32_t row = 0, uint32_t kind = 0) {
    const std::vector<vec4> table = build_alias_table(weights);  // none: the cluster is never chosen
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0) / (squares * squares);
    to_.clusters.emplace_back(as_float(uint32_t(to_.members.size())),
                              as_float(uint32_t(std::max<size_t>(1, table.size()))),
                              as_float(column | row << 8 | squares << 16 | kind), float(sum));
    to_.plain.push_back(float(sum));
    if (table.empty()) to_.members.emplace_back(1, 0, as_float(members[0]), as_float(members[0]));
    for (size_t i = 0; i < table.size(); ++i)
      to_.members.emplace_back(table[i].x, 0, as_float(members[i]),
                               as_float(members[std::bit_cast<uint32_t>(table[i].y)]));
  }
  void add_squares(uint32_t member, double weight, uint32_t squares) {
    for (uint32_t row = 0; row < squares; ++row)
      for (uint32_t column = 0; column < squares; ++column) add({member}, {weight}, squares, column, row);
  }

 private:
  LightClusters& to_;
};

struct Rectangle {
  uint32_t x0, x1, y0, y1;  // texels
  double weight, solid_angle, priority;
  bool operator<(const Rectangle& o) const { return priority < o.priority; }
};

/// Divides the map of a sky into rectangles. The next one to divide has the largest product of weight and
/// solid angle: by weight alone most rectangles would be in a sun, which is visible completely or not at all.
class SkyCut {
 public:
  SkyCut(const std::vector<double>& weights, uint32_t w, uint32_t h)
      : w_(w), h_(h), sums_(size_t(w + 1) * (h + 1)) {
    for (uint32_t y = 0; y < h; ++y) {
      double row = 0;
      for (uint32_t x = 0; x < w; ++x) {
        row += weights[size_t(y) * w + x];
        sums_[at(x + 1, y + 1)] = sums_[at(x + 1, y)] + row;
      }
    }
  }
  std::vector<Rectangle> cut(uint32_t count) const {
    std::priority_queue<Rectangle> open;
    std::vector<Rectangle> done;
    open.push(make(0, w_, 0, h_));
    while (!open.empty() && open.size() + done.size() < count) {
      const Rectangle r = open.top();
      open.pop();
      if ((r.x1 - r.x0 == 1 && r.y1 - r.y0 == 1) || !(r.weight > 0)) {
        done.push_back(r);
        continue;
      }
      const auto [a, b] = split(r);
      open.push(a), open.push(b);
    }
    for (; !open.empty(); open.pop()) done.push_back(open.top());
    // The order does not depend on equal priorities.
    std::sort(done.begin(), done.end(), [](const Rectangle& a, const Rectangle& b) {
      return std::pair(a.y0, a.x0) < std::pair(b.y0, b.x0);
    });
    return done;
  }

 private:
  size_t at(uint32_t x, uint32_t y) const { return size_t(y) * (w_ + 1) + x; }
  double cosine(uint32_t y) const { return std::cos(std::numbers::pi * y / h_); }
  Rectangle make(uint32_t x0, uint32_t x1, uint32_t y0, uint32_t y1) const {
    Rectangle r{x0, x1, y0, y1, 0, 0, 0};
    r.weight = std::max(0.0, sums_[at(x1, y1)] - sums_[at(x0, y1)] - sums_[at(x1, y0)] + sums_[at(x0, y0)]);
    r.solid_angle = 2 * std::numbers::pi * (x1 - x0) / w_ * (cosine(y0) - cosine(y1));
    r.priority = r.weight * r.solid_angle;
    return r;
  }
  /// Divides the longer side (at the middle) into halves of equal weight.
  std::pair<Rectangle, Rectangle> split(const Rectangle& r) const {
    const double wide =
        2 * std::numbers::pi * (r.x1 - r.x0) / w_ * std::sin(std::numbers::pi * 0.5 * (r.y0 + r.y1) / h_);
    const double high = std::numbers::pi * (r.y1 - r.y0) / h_;
    const bool across = r.y1 - r.y0 == 1 || (r.x1 - r.x0 > 1 && wide > high);
    const auto halves = [&](uint32_t middle) {
      return across ? std::pair(make(r.x0, middle, r.y0, r.y1), make(middle, r.x1, r.y0, r.y1))
                    : std::pair(make(r.x0, r.x1, r.y0, middle), make(r.x0, r.x1, middle, r.y1));
    };
    uint32_t low = (across ? r.x0 : r.y0) + 1, high_end = (across ? r.x1 : r.y1) - 1;
    while (low < high_end) {
      const uint32_t middle = (low + high_end) / 2;
      if (2 * halves(middle).first.weight < r.weight)
        low = middle + 1;
      else
        high_end = middle;
    }
    return halves(low);
  }
  uint32_t w_, h_;
  std::vector<double> sums_;
};

void add_whole_sky(const FlatScene& flat, double pmf, LightClusters& to) {
  const uint32_t w = flat.environment_width, h = flat.environment_height;
  Builder builder(to);
  if (w * h == 1) {
    to.sky_squares = k_sky_side;
    builder.add_squares(0, pmf, k_sky_side);
    return;
  }
  std::vector<double> weights(size_t(w) * h);
  for (size_t i = 0; i < weights.size(); ++i) weights[i] = double(flat.environment.alias[i].z) * pmf;
  to.tiles.resize((weights.size() + 15) / 16 * 16);
  for (const Rectangle& r : SkyCut(weights, w, h).cut(k_sky_clusters)) {
    std::vector<uint32_t> members;
    std::vector<double> of;
    for (uint32_t y = r.y0; y < r.y1; ++y)
      for (uint32_t x = r.x0; x < r.x1; ++x) {
        const uint32_t texel = y * w + x;
        members.push_back(texel), of.push_back(weights[texel]);
        to.tiles[texel] = uint8_t(to.count());
      }
    builder.add(members, of);
  }
}

void add_sky(const FlatScene& flat, LightClusters& to) {
  const double pmf{flat.environment_light_pmf};
  to.portals = flat.portals.count();
  const double share = to.portals > 0 ? double{shared::k_portal_share} : 0;
  add_whole_sky(flat, pmf * (1 - share), to);
  for (uint32_t i = 0; i < to.portals; ++i) Builder(to).add({i}, {pmf * share * flat.portals.shares[i]});
  to.sky = to.count();
}

/// Order along the Morton curve, so that neighbours in space are neighbours in the order.
uint64_t morton(vec3 p, const Box& box) {
  const vec3 size = glm::max(box.size(), vec3(1e-30f));
  uint64_t code = 0;
  const uvec3 at(glm::clamp((p - box.lo) / size * 1023.f, vec3(0), vec3(1023)));
  for (int bit = 9; bit >= 0; --bit)
    for (int axis = 2; axis >= 0; --axis) code = code << 1 | (at[axis] >> bit & 1u);
  return code;
}

/// Runs of neighbouring lights, each of about 1 / `count` of their total weight.
void add_runs(const std::vector<uint32_t>& lights, const std::vector<vec3>& places, const FlatScene& flat,
              uint32_t count, LightClusters& to, std::vector<uint32_t>* cluster_of) {
  if (lights.empty()) return;
  Box box;
  for (const vec3& p : places) box.grow(p);
  std::vector<std::pair<uint64_t, uint32_t>> order;
  double all = 0;
  for (size_t i = 0; i < lights.size(); ++i) {
    order.emplace_back(morton(places[i], box), uint32_t(i));
    all += flat.light_alias[lights[i]].z;
  }
  std::sort(order.begin(), order.end());
  std::vector<uint32_t> members;
  std::vector<double> weights;
  double sum = 0;
  const auto finish = [&] {
    if (members.empty()) return;
    if (cluster_of)
      for (const uint32_t m : members) (*cluster_of)[m] = to.count();
    Builder(to).add(members, weights, 1, 0, 0, cluster_of ? shared::k_cluster_of_triangles : 0);
    members.clear(), weights.clear(), sum = 0;
  };
  for (const auto& [code, i] : order) {
    const double weight = flat.light_alias[lights[i]].z;
    if (sum > 0 && sum + weight > all / count) finish();
    members.push_back(lights[i]), weights.push_back(weight), sum += weight;
  }
  finish();
}

/// Texel of light_facets.
vec4 facet_of(const FlatScene& flat, uint32_t light) {
  const vec4* t = &flat.lights[size_t(light) * shared::k_light_texels];
  const glm::dvec3 a{vec3(t[0])}, b{vec3(t[1])}, c{vec3(t[2])};
  glm::dvec3 n = glm::cross(b - a, c - a);
  const auto sides = std::bit_cast<uint32_t>(t[3].w);
  const double twice_area = glm::length(n);
  if ((sides & shared::k_light_flipped) != 0) n = -n;
  const vec2 map = twice_area > 0 ? shared::facet_flatten(vec3(n / twice_area)) : vec2(0);
  const auto twelve = [](float v) {
    return uint32_t(std::clamp(std::round((0.5 + 0.5 * double(v)) * 4095), 0.0, 4095.0));
  };
  const double exponent = std::log2(std::max(0.5 * twice_area, 1e-300)) + 64;
  const uint32_t bits = twelve(map.x) | twelve(map.y) << 12 |
                        uint32_t(std::clamp(std::round(exponent), 0.0, 127.0)) << 24 |
                        ((sides & shared::k_light_both_sides) != 0 ? 1u << 31 : 0u);
  return {vec3((a + b + c) / 3.0), as_float(bits)};
}

vec3 place_of(const FlatScene& flat, uint32_t light) {
  return vec3(flat.lights[size_t(light) * shared::k_light_texels]);
}

void add_triangles(const FlatScene& flat, uint32_t count, LightClusters& to) {
  double all = 0;
  for (uint32_t i = 0; i < count; ++i) all += flat.light_alias[i].z;
  std::vector<uint32_t> small, cluster_of(count, 0), squares_of(count, 1);
  std::vector<vec3> places;
  for (uint32_t i = 0; i < count; ++i) {
    const double weight = flat.light_alias[i].z;
    const auto squares = uint32_t(
        std::min<double>(k_most_squares, std::sqrt(all > 0 ? weight / all * k_triangle_clusters : 0)));
    if (squares > 1) {
      cluster_of[i] = to.count(), squares_of[i] = squares;
      Builder(to).add_squares(i, weight, squares);
    } else {
      const vec4* t = &flat.lights[size_t(i) * shared::k_light_texels];
      small.push_back(i), places.push_back((vec3(t[0]) + vec3(t[1]) + vec3(t[2])) / 3.f);
    }
  }
  add_runs(small, places, flat, k_triangle_clusters, to, &cluster_of);
  if (count >= k_many_triangles)
    for (uint32_t i = 0; i < count; ++i) to.facets.push_back(facet_of(flat, i));
  to.primitives.assign((flat.triangles.size() + 3) / 4 * 4, 1u << 24);
  for (uint32_t i = 0; i < count; ++i)
    to.primitives[flat.entries[i].index] = cluster_of[i] | squares_of[i] << 24;
}

void add_lamps(const FlatScene& flat, uint32_t first, uint32_t end, LightClusters& to) {
  std::vector<uint32_t> local, distant;
  std::vector<vec3> places, directions;
  for (uint32_t i = first; i < end; ++i) {
    if (flat.entries[i].kind == shared::k_light_directional)
      distant.push_back(i), directions.emplace_back(flat.lights[size_t(i) * shared::k_light_texels + 2]);
    else
      local.push_back(i), places.push_back(place_of(flat, i));
  }
  if (distant.size() > k_distant_clusters) {
    add_runs(distant, directions, flat, k_distant_clusters, to, nullptr);
  } else {
    for (const uint32_t i : distant) Builder(to).add({i}, {flat.light_alias[i].z});
  }
  if (local.size() > k_lamp_clusters) {
    add_runs(local, places, flat, k_lamp_clusters, to, nullptr);
  } else {
    for (const uint32_t i : local) Builder(to).add({i}, {flat.light_alias[i].z});
  }
}

/// Clusters of the lamps with a shape, which rays may meet.
void find_shapes(const FlatScene& flat, LightClusters& to) {
  to.shapes.assign(flat.shape_count, vec4(0));
  for (uint32_t c = to.sky; c < to.count(); ++c) {
    const auto first = std::bit_cast<uint32_t>(to.clusters[c].x),
               count = std::bit_cast<uint32_t>(to.clusters[c].y);
    for (uint32_t i = first; i < first + count; ++i)
      if (const uint32_t shape = std::bit_cast<uint32_t>(to.members[i].z) - flat.first_shape;
          shape < flat.shape_count)
        to.shapes[shape].x = as_float(c);
  }
}

/// Direction of a position in the map of the sky, 0..1 to the right and down.
vec3 sky_direction(const FlatScene& flat, double u, double v) {
  const double phi = (u - 0.5) * 2 * std::numbers::pi - flat.environment_rotation;
  const double theta = v * std::numbers::pi;
  return vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
}

/// Position of a member of the cluster with that square.
vec3 place_in(const FlatScene& flat, uint32_t light, uint32_t square) {
  const vec4* t = &flat.lights[size_t(light) * shared::k_light_texels];
  if (flat.entries[light].kind == shared::k_light_directional) return -vec3(t[2]);
  if (flat.entries[light].kind != shared::k_light_triangle) return vec3(t[0]);
  const uint32_t side = square >> 16 & 0xffu;
  if (side == 1) return (vec3(t[0]) + vec3(t[1]) + vec3(t[2])) / 3.f;
  // Like points of sample_light() of shaders/lib/lights.glsl.
  vec2 m = 0.5f * (vec2(square & 0xffu, square >> 8 & 0xffu) + 0.5f) / float(side);
  const float offset = m.y - m.x;
  m += offset > 0 ? vec2(0, offset) : vec2(-offset, 0);
  return m.x * vec3(t[0]) + m.y * vec3(t[1]) + (1 - m.x - m.y) * vec3(t[2]);
}

void find_places(const FlatScene& flat, LightClusters& to) {
  const uint32_t w = flat.environment_width, h = flat.environment_height;
  for (uint32_t c = 0; c < to.count(); ++c) {
    const auto first = std::bit_cast<uint32_t>(to.clusters[c].x),
               count = std::bit_cast<uint32_t>(to.clusters[c].y),
               square = std::bit_cast<uint32_t>(to.clusters[c].z);
    ClusterPlace place{.is_sky = c < to.sky, .count = count};
    if (place.is_sky && c + to.portals >= to.sky) {
      place.portal = c + to.portals - to.sky;
      place.at = flat.portals.of[place.portal].centre;
      place.light = uint32_t(flat.entries.size()) - 1;
      to.places.push_back(place);
      continue;
    }
    for (uint32_t i = first; i < first + count; ++i) {
      const auto member = std::bit_cast<uint32_t>(to.members[i].z);
      if (!place.is_sky) {
        if (i == first)
          place.light = member, place.is_far = flat.entries[member].kind == shared::k_light_directional;
        place.at += place_in(flat, member, square);
      } else if (const uint32_t side = to.sky_squares; side > 0) {
        // Squares are even in height, not in angle.
        const double y = 1 - 2 * ((square >> 8 & 0xffu) + 0.5) / side;
        place.at += sky_direction(flat, ((square & 0xffu) + 0.5) / side, std::acos(y) / std::numbers::pi);
      } else {
        place.at += sky_direction(flat, (member % w + 0.5) / w, (member / w + 0.5) / h);
      }
    }
    if (place.is_sky) place.is_far = true, place.light = uint32_t(flat.entries.size()) - 1;
    if (place.is_far)
      place.at = glm::length(place.at) > 1e-6f ? glm::normalize(place.at) : vec3(0, 1, 0);
    else
      place.at /= float(std::max(1u, count));
    to.places.push_back(place);
  }
}

bool has_sky(const FlatScene& flat) {
  return flat.environment_light_pmf > 0 && !flat.entries.empty() &&
         flat.entries.back().kind == shared::k_light_environment;
}

}  // namespace

bool has_light_clusters(const FlatScene& flat) {
  if (flat.effects.separate_sky || flat.entries.empty()) return false;
  return flat.entries.size() > 1 || has_sky(flat) || flat.entries[0].kind == shared::k_light_triangle;
}

LightClusters make_light_clusters(const FlatScene& flat) {
  LightClusters to;
  if (has_sky(flat)) add_sky(flat, to);
  uint32_t triangles = 0;
  while (triangles < flat.entries.size() && flat.entries[triangles].kind == shared::k_light_triangle)
    ++triangles;
  if (triangles > 0) add_triangles(flat, triangles, to);
  add_lamps(flat, triangles, uint32_t(flat.entries.size()) - (has_sky(flat) ? 1 : 0), to);
  find_shapes(flat, to);
  find_places(flat, to);
  return to;
}

gpu::Defines learned_defines(const FlatScene& flat) {
  if (!has_light_clusters(flat)) return {};
  gpu::Defines defines{{"LUCERNA_LEARNED", "1"}};
  if (has_sky(flat) && flat.environment_width * flat.environment_height == 1)
    defines["LUCERNA_SKY_SQUARES"] = std::to_string(k_sky_side);
  if (flat.entries.size() >= k_many_triangles &&
      flat.entries[k_many_triangles - 1].kind == shared::k_light_triangle)
    defines["LUCERNA_TRIANGLE_CANDIDATES"] = std::to_string(k_triangle_candidates);
  return defines;
}

}  // namespace lucerna::upload
