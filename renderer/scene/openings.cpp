#include "scene/openings.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace lucerna::scene {
namespace {

constexpr int k_cells = 40;                 // along the longer side of a plane
constexpr int k_heights = 64;               // planes of one direction
constexpr int k_finer = 16;                 // steps between two of them, for a chosen opening
constexpr float k_grazing = 0.05f;          // least cosine between a ray and the plane's normal
constexpr float k_margin = 0.1f;            // planes and cells beyond the rays' origins, over the room's size
constexpr double k_least_dense = 0.2;       // part of a cell's rays that escape, for a cell of an opening
constexpr double k_least_clear = 0.25;      // the same for an opening
constexpr double k_least_share = 0.01;      // of all escaping rays
constexpr double k_least_of_largest = 0.2;  // each portal costs time at every light sample
constexpr double k_enough = 0.95;
constexpr double k_stray = 0.005;  // part of an opening's rays that may lie beyond each side
constexpr float k_widening = 0.01f;
constexpr size_t k_least_rays = 16;
constexpr size_t k_least_points = 8;  // a point near a gap in a wall is no room

/// Lower and upper bound of nearly all numbers, which are reordered.
vec2 range_of(std::vector<float>& numbers, double stray) {
  const auto at = [&](double share) {
    const auto i = std::ptrdiff_t(share * double(numbers.size() - 1) + 0.5);
    std::nth_element(numbers.begin(), numbers.begin() + i, numbers.end());
    return numbers[size_t(i)];
  };
  return {at(stray), at(1 - stray)};
}

/// A rectangle in the plane at `height` along a wall's normal.
struct Candidate {
  size_t wall = 0;
  float height = 0;
  vec2 low{0}, high{0};
  double escaping = 0, all = 0;  // rays through it
  /// The part that escapes counts more than their number, so that two windows of one wall stay two.
  double score() const { return all > 0 ? escaping * (escaping / all) * (escaping / all) : 0; }
  bool holds(const vec2& p) const { return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y; }
};

/// The planes along one wall, and the rays that go towards them.
class Planes {
 public:
  Planes(std::span<const RoomRay> rays, std::span<const vec3> walls, size_t wall)
      : wall_(wall), out_(walls[wall]) {
    t_ = vec3(0);
    for (const vec3& other : walls)
      if (t_ == vec3(0) && std::abs(glm::dot(other, out_)) < 0.02f) t_ = other;
    if (t_ == vec3(0)) t_ = std::abs(out_.y) < 0.7f ? vec3(0, 1, 0) : vec3(1, 0, 0);
    t_ = glm::normalize(t_ - glm::dot(t_, out_) * out_);
    s_ = glm::cross(t_, -out_);
    std::vector<float> s, t, n;
    for (const RoomRay& ray : rays) {
      s.push_back(glm::dot(ray.origin, s_)), t.push_back(glm::dot(ray.origin, t_)),
          n.push_back(glm::dot(ray.origin, out_));
      const float towards = glm::dot(ray.direction, out_);
      if (towards < k_grazing) continue;
      rays_.push_back({{s.back(), t.back()},
                       n.back(),
                       vec2(glm::dot(ray.direction, s_), glm::dot(ray.direction, t_)) / towards,
                       ray.escapes ? uint32_t(&ray - rays.data()) : k_none});
    }
    const vec2 across = range_of(s, k_stray), up = range_of(t, k_stray), deep = range_of(n, k_stray);
    const vec2 size(across.y - across.x, up.y - up.x);
    cell_ = (1 + 2 * k_margin) * std::max(size.x, size.y) / k_cells;
    low_ = vec2(across.x, up.x) - k_margin * size;
    cells_ = cell_ > 0 ? glm::ivec2(glm::ceil((1 + 2 * k_margin) * size / cell_)) : glm::ivec2(0);
    first_ = deep.x, step_ = (1 + k_margin) * (deep.y - deep.x) / k_heights;
  }

  /// Candidates of all heights.
  void search(const std::vector<bool>& covered, size_t least, std::vector<Candidate>& to) const {
    for (int i = 1; i <= k_heights; ++i) look(first_ + float(i) * step_, covered, least, to);
  }
  /// The best candidate at heights near one.
  Candidate refine(const Candidate& found, const std::vector<bool>& covered, size_t least) const {
    Candidate best = found;
    for (int i = -k_finer; i <= k_finer; ++i) {
      std::vector<Candidate> near;
      look(found.height + float(i) * step_ / k_finer, covered, least, near);
      for (const Candidate& c : near)
        if (found.holds(0.5f * (c.low + c.high)) && c.score() > best.score()) best = c;
    }
    return best;
  }
  /// Calls `each` for every escaping ray through the candidate.
  template <class Each>
  void each_escaping(const Candidate& c, Each&& each) const {
    for (const Ray& ray : rays_)
      if (ray.escaping != k_none && c.height > ray.height && c.holds(at(ray, c.height))) each(ray.escaping);
  }
  Portal portal(const Candidate& c) const {
    const vec2 middle = 0.5f * (c.low + c.high), half = (0.5f + k_widening) * (c.high - c.low);
    return {"", middle.x * s_ + middle.y * t_ + c.height * out_, half.x * s_, half.y * t_};
  }

 private:
  struct Ray {
    vec2 from;
    float height;
    vec2 slope;
    uint32_t escaping;  // its index, if it escapes
  };
  static vec2 at(const Ray& ray, float height) { return ray.from + (height - ray.height) * ray.slope; }
  /// The cell's index, or -1.
  int cell_at(const vec2& p) const {
    const vec2 q = (p - low_) / cell_;
    if (!(q.x >= 0 && q.y >= 0 && q.x < float(cells_.x) && q.y < float(cells_.y))) return -1;
    return int(q.y) * cells_.x + int(q.x);
  }

  /// Connected cells where rays escape become rectangles around their escaping rays.
  void look(float height, const std::vector<bool>& covered, size_t least, std::vector<Candidate>& to) const {
    const auto n = size_t(cells_.x) * size_t(cells_.y);
    std::vector<uint32_t> all(n, 0), escaping(n, 0);
    struct Crossing {
      vec2 at;
      bool escapes;
    };
    std::vector<Crossing> crossings;
    for (const Ray& ray : rays_) {
      if (!(height > ray.height)) continue;
      const vec2 p = at(ray, height);
      const int cell = cell_at(p);
      if (cell < 0) continue;
      const bool escapes = ray.escaping != k_none && !covered[ray.escaping];
      ++all[size_t(cell)], escaping[size_t(cell)] += escapes;
      crossings.push_back({p, escapes});
    }
    std::vector<int> label(n, -1);
    std::vector<size_t> sums;
    std::vector<int> stack;
    for (size_t first = 0; first < n; ++first) {
      const auto dense = [&](size_t i) {
        return escaping[i] >= 2 && double(escaping[i]) >= k_least_dense * double(all[i]);
      };
      if (label[first] >= 0 || !dense(first)) continue;
      sums.push_back(0);
      label[first] = int(sums.size()) - 1;
      for (stack = {int(first)}; !stack.empty();) {
        const int cell = stack.back();
        stack.pop_back();
        sums.back() += escaping[size_t(cell)];
        around(cell, [&](size_t i) {
          if (label[i] < 0 && dense(i)) label[i] = label[first], stack.push_back(int(i));
        });
      }
    }
    if (std::none_of(sums.begin(), sums.end(), [&](size_t sum) { return sum >= least; })) return;
    // The cells around, of which an opening contains a part.
    const std::vector<int> inner = label;
    for (size_t cell = 0; cell < n; ++cell)
      if (inner[cell] < 0)
        around(int(cell), [&](size_t i) { label[cell] = std::max(label[cell], inner[i]); });
    std::vector<std::vector<float>> s(sums.size()), t(sums.size());
    for (const Crossing& c : crossings)
      if (const int own = c.escapes ? label[size_t(cell_at(c.at))] : -1; own >= 0)
        s[size_t(own)].push_back(c.at.x), t[size_t(own)].push_back(c.at.y);
    for (size_t i = 0; i < sums.size(); ++i) {
      if (sums[i] < least) continue;
      const vec2 across = range_of(s[i], k_stray), up = range_of(t[i], k_stray);
      Candidate c{.wall = wall_, .height = height, .low = {across.x, up.x}, .high = {across.y, up.y}};
      if (!(c.high.x > c.low.x && c.high.y > c.low.y)) continue;
      for (const Crossing& crossing : crossings)
        if (c.holds(crossing.at)) ++c.all, c.escaping += crossing.escapes;
      if (c.escaping >= k_least_clear * c.all && c.escaping >= double(least)) to.push_back(c);
    }
  }
  template <class Each>
  void around(int cell, Each&& each) const {
    const int x = cell % cells_.x, y = cell / cells_.x;
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, cells_.y - 1); ++j)
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, cells_.x - 1); ++i)
        each(size_t(j) * size_t(cells_.x) + size_t(i));
  }

  size_t wall_;
  vec3 out_, s_, t_;
  std::vector<Ray> rays_;
  vec2 low_{0};
  float cell_ = 0, first_ = 0, step_ = 0;
  glm::ivec2 cells_{0};
};

}  // namespace

std::vector<Opening> find_openings(std::span<const RoomRay> rays, std::span<const vec3> walls) {
  const auto escaping =
      size_t(std::count_if(rays.begin(), rays.end(), [](const RoomRay& ray) { return ray.escapes; }));
  const size_t least = std::max(k_least_rays, size_t(k_least_share * double(escaping)));
  if (escaping < least || 2 * escaping >= rays.size()) return {};
  std::vector<Planes> planes;
  std::vector<Candidate> candidates;
  std::vector<bool> covered(rays.size(), false);
  for (size_t wall = 0; wall < walls.size(); ++wall) {
    planes.emplace_back(rays, walls, wall);
    planes.back().search(covered, least, candidates);
  }
  // Scores only decrease as rays are covered, so the best is known once its own is up to date.
  const auto worse = [&](size_t a, size_t b) {
    const double x = candidates[a].score(), y = candidates[b].score();
    return x < y || (x == y && a > b);
  };
  std::priority_queue<size_t, std::vector<size_t>, decltype(worse)> queue(worse);
  for (size_t i = 0; i < candidates.size(); ++i)
    if (2 * candidates[i].all < double(rays.size())) queue.push(i);
  std::vector<Opening> found;
  size_t all_covered = 0;
  while (!queue.empty() && found.size() < k_max_portals &&
         double(all_covered) < k_enough * double(escaping)) {
    const size_t i = queue.top();
    queue.pop();
    Candidate c = candidates[i];
    c.escaping = 0;
    size_t points = 0;
    const vec3* last = nullptr;
    planes[c.wall].each_escaping(c, [&](uint32_t ray) {
      if (covered[ray]) return;
      ++c.escaping;
      points += !last || *last != rays[ray].origin;
      last = &rays[ray].origin;
    });
    if (points < k_least_points || c.escaping < double(least) || c.escaping < k_least_clear * c.all) continue;
    const double before = candidates[i].score();
    candidates[i] = c;
    if (c.score() < before) {
      queue.push(i);
      continue;
    }
    c = planes[c.wall].refine(c, covered, least);
    size_t more = 0;
    planes[c.wall].each_escaping(c, [&](uint32_t ray) {
      more += !covered[ray];
      covered[ray] = true;
    });
    all_covered += more;
    found.push_back({planes[c.wall].portal(c), double(more) / double(escaping)});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Opening& a, const Opening& b) { return a.share > b.share; });
  std::erase_if(found, [&](const Opening& o) { return o.share < k_least_of_largest * found[0].share; });
  return found;
}

}  // namespace lucerna::scene
