#include "mark_layout.h"

#include <cmath>

#include "base/math.h"

namespace lucerna::ui {
namespace {

constexpr int k_rings = 2;

/// Marks placed so far, in cells as wide as the distance between two of them.
class Placed {
 public:
  Placed(float apart, const Area& within)
      : apart_(apart),
        within_(within),
        across_(static_cast<int>(within.width() / apart) + 1),
        cells_(static_cast<size_t>(across_) * (static_cast<size_t>(within.height() / apart) + 1)) {}

  bool inside(const ImVec2& at) const {
    return at.x >= within_.lo.x && at.x < within_.hi.x && at.y >= within_.lo.y && at.y < within_.hi.y;
  }
  /// Calls f(mark) for each placed mark that one at `at` would cover.
  template <class F>
  void covered(const ImVec2& at, const F& f) const {
    const auto [x, y] = cell(at);
    const int down = static_cast<int>(cells_.size()) / across_;
    for (int j = std::max(0, y - 1); j <= std::min(down - 1, y + 1); ++j)
      for (int i = std::max(0, x - 1); i <= std::min(across_ - 1, x + 1); ++i)
        for (const PlacedMark& p : cells_[static_cast<size_t>(j * across_ + i)])
          if (std::hypot(p.at.x - at.x, p.at.y - at.y) < apart_) f(p);
  }
  bool free(const ImVec2& at) const {
    bool any = false;
    covered(at, [&](const PlacedMark&) { any = true; });
    return !any;
  }
  void add(const PlacedMark& p) {
    const auto [x, y] = cell(p.at);
    cells_[static_cast<size_t>(y * across_ + x)].push_back(p);
  }

 private:
  std::pair<int, int> cell(const ImVec2& at) const {
    return {static_cast<int>((at.x - within_.lo.x) / apart_),
            static_cast<int>((at.y - within_.lo.y) / apart_)};
  }

  float apart_;
  Area within_;
  int across_;
  std::vector<std::vector<PlacedMark>> cells_;
};

}  // namespace

std::vector<PlacedMark> place_marks(std::span<const Mark> marks, float apart, const Area& within) {
  std::vector<PlacedMark> all;
  if (!(apart > 0) || !(within.width() > 0) || !(within.height() > 0)) return all;
  Placed placed(apart, within);
  const auto put = [&](size_t mark, const ImVec2& at) {
    placed.add({mark, at});
    all.push_back({mark, at});
  };
  for (size_t m = 0; m < marks.size(); ++m) {
    const ImVec2& anchor = marks[m].anchor;
    if (!placed.inside(anchor)) continue;
    bool same = false;
    placed.covered(anchor, [&](const PlacedMark& p) {
      same = same || (marks[m].group >= 0 && marks[p.mark].group == marks[m].group);
    });
    if (same) continue;
    if (placed.free(anchor)) {
      put(m, anchor);
      continue;
    }
    bool found = false;
    for (int ring = 1; ring <= k_rings && !found; ++ring)
      for (int step = 0; step < 8 * ring && !found; ++step) {
        // Upwards first, then to either side by turns.
        const int turn = step % 2 ? (step + 1) / 2 : -step / 2;
        const float angle = 2 * k_pi * static_cast<float>(turn) / static_cast<float>(8 * ring);
        // A little more than asked for, so that rounding does not move two marks closer.
        const float away = 1.001f * apart * static_cast<float>(ring);
        const ImVec2 at(anchor.x + away * std::sin(angle), anchor.y - away * std::cos(angle));
        found = placed.inside(at) && placed.free(at);
        if (found) put(m, at);
      }
  }
  return all;
}

}  // namespace lucerna::ui
