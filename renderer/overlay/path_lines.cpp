#include "overlay/path_lines.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "shaders/shared/ramp.h"

namespace lucerna::overlay {

using namespace shared;
using recording::Event;

namespace {

/// The event whose light is the brightest that is reached over each event; its own number if none is.
std::vector<uint32_t> brightest_beyond(std::span<const Event> events) {
  std::vector<uint32_t> of(events.size());
  std::vector<float> most(events.size(), 0);
  std::iota(of.begin(), of.end(), 0u);
  for (size_t i = events.size(); i-- > 0;) {
    const Event& e = events[i];
    if (recording::contributes_light(e) && luminance(e.contribution) > most[i])
      most[i] = luminance(e.contribution), of[i] = uint32_t(i);
    if (e.parent < i && most[i] > most[e.parent]) most[e.parent] = most[i], of[e.parent] = of[i];
  }
  return of;
}

constexpr vec3 k_word_inks[] = {{0.92f, 0.66f, 0.26f}, {0.25f, 0.72f, 0.67f}, {0.58f, 0.47f, 0.86f},
                                {0.94f, 0.42f, 0.38f}, {0.55f, 0.78f, 0.35f}, {0.35f, 0.60f, 0.92f},
                                {0.90f, 0.50f, 0.75f}, {0.72f, 0.62f, 0.48f}};

bool is_point(uint32_t kind) {
  return kind == k_path_emission || kind == k_path_records || kind == k_path_photons ||
         kind == k_path_looked_up || kind == k_path_splat;
}

class Strokes {
 public:
  Strokes(const recording::Recording& recording, const PathLinesStyle& style, double brightest)
      : recording_(recording), style_(style), brightest_(brightest) {
    if (style.color == PathColor::word) all_.words = brightest_words(recording);
    if (style.color == PathColor::time)
      for (const recording::Path& path : recording.paths)
        all_.slowest = std::max(all_.slowest, recording::time_of(recording.events_of(path), recording.times));
  }

  void add(uint32_t path) {
    const std::span<const Event> events = recording_.events_of(recording_.paths[path]);
    const std::vector<uint32_t> beyond = brightest_beyond(events);
    const vec3 by_light = contribution_ink(brightest_ > 0 ? recording::luminance_of(events) / brightest_ : 0);
    const double time = style_.color == PathColor::time ? recording::time_of(events, recording_.times) : 0;
    const vec3 by_time = time_ink(all_.slowest > 0 ? time / all_.slowest : 0);
    const bool followed = style_.path == int(path), faint = style_.path >= 0 && !followed;
    for (uint32_t i = 0; i < events.size(); ++i) {
      const Event& e = events[i];
      const uint32_t kind = recording::kind_of(e);
      const bool marked = followed && style_.vertex == int(i);
      if (kind == k_path_end && !marked) continue;
      const bool blocked = kind == k_path_blocked;
      vec3 ink = event_ink(e);
      if (style_.color == PathColor::component && !blocked) ink = ink_of_component(events[beyond[i]]);
      if (style_.color == PathColor::contribution && !blocked) ink = by_light;
      if (style_.color == PathColor::time && !blocked) ink = by_time;
      if (style_.color == PathColor::word && !blocked) ink = ink_of_word(events, beyond[i]);
      if (marked || (followed && kind != k_path_camera))
        point(e.position, ink, marked ? 4.5f : 2.2f, 1);
      else if (is_point(kind))
        point(e.position, ink, 1.6f, faint ? 0.25f : 0.9f);
      if (e.parent >= i || is_point(kind) || kind == k_path_end) continue;
      const bool light = blocked || kind == k_path_light || kind == k_path_background;
      OverlaySegment s{};
      s.from = events[e.parent].position, s.to = e.position;
      s.half_width = followed ? 1.2f : light ? 0.45f : 0.65f;
      s.edge_width = followed ? 0.8f : 0;
      s.color = ink;
      s.alpha = faint ? 0.12f : followed ? 1.0f : blocked ? 0.55f : light ? 0.6f : 0.75f;
      s.strength = 1;
      s.slack = style_.slack;
      s.rank = followed ? k_rank_most : blocked ? k_rank_low : light ? k_rank_least : k_rank_least + 1;
      if (marked) s.half_width = 2;
      all_.segments.push_back(s);
    }
  }
  PathStrokes take() { return std::move(all_); }

 private:
  static vec3 ink_of_component(const Event& light) {
    const bool lit = recording::contributes_light(light) && luminance(light.contribution) > 0;
    return component_ink(lit ? recording::component_of(light) : paths::k_no_component);
  }

  vec3 ink_of_word(std::span<const Event> events, uint32_t event) const {
    if (!recording::contributes_light(events[event])) return word_ink(std::size(k_word_inks));
    const auto found = std::find(all_.words.begin(), all_.words.end(), recording::word_of(events, event));
    return found == all_.words.end() ? word_ink(std::size(k_word_inks))
                                     : word_ink(size_t(found - all_.words.begin()));
  }

  void point(const vec3& at, const vec3& ink, float half_width, float alpha) {
    all_.points.push_back({.position = at,
                           .half_width = half_width,
                           .color = ink,
                           .alpha = alpha,
                           .edge_width = half_width > 2 ? 1.0f : 0.5f,
                           .rank = half_width > 2 ? k_rank_most : k_rank_least + 2});
  }

  const recording::Recording& recording_;
  const PathLinesStyle& style_;
  double brightest_;
  PathStrokes all_;
};

}  // namespace

vec3 lobe_ink(uint32_t lobe) {
  switch (lobe) {
    case 0:
      return {0.30f, 0.75f, 0.62f};
    case 1:
      return {0.85f, 0.50f, 0.80f};
    case 2:
      return {0.95f, 0.95f, 1.0f};
    default:
      return {0.62f, 0.66f, 0.72f};
  }
}

vec3 component_ink(uint32_t component) {
  constexpr vec3 k_inks[] = {
      {0.92f, 0.66f, 0.26f}, {0.25f, 0.72f, 0.67f}, {0.58f, 0.47f, 0.86f}, {0.94f, 0.42f, 0.38f}};
  return component < std::size(k_inks) ? k_inks[component] : vec3(0.4f);
}

vec3 contribution_ink(double share) {
  return ramp_color(k_ramp_viridis, ramp_position(float(share), k_least_path_share, 1, 1));
}

std::vector<std::string> brightest_words(const recording::Recording& recording) {
  std::map<std::string, double> light;
  for (const recording::Path& path : recording.paths) {
    const std::span<const Event> events = recording.events_of(path);
    for (uint32_t i = 0; i < events.size(); ++i)
      if (recording::contributes_light(events[i]))
        light[recording::word_of(events, i)] += double(luminance(events[i].contribution));
  }
  std::vector<std::pair<double, std::string>> order;
  for (const auto& [word, sum] : light) order.emplace_back(-sum, word);
  std::sort(order.begin(), order.end());
  if (order.size() > std::size(k_word_inks)) order.resize(std::size(k_word_inks));
  std::vector<std::string> words;
  for (auto& [sum, word] : order) words.push_back(std::move(word));
  return words;
}

vec3 word_ink(size_t rank) { return rank < std::size(k_word_inks) ? k_word_inks[rank] : vec3(0.4f); }

vec3 time_ink(double share) { return ramp_color(k_ramp_viridis, float(std::clamp(share, 0.0, 1.0))); }

vec3 event_ink(const Event& event) {
  switch (recording::kind_of(event)) {
    case k_path_light:
      return k_arrived_ink;
    case k_path_blocked:
      return k_blocked_ink;
    case k_path_background:
      return k_background_ink;
    case k_path_emission:
      return k_emission_ink;
    case k_path_records:
    case k_path_photons:
    case k_path_splat:
    case k_path_looked_up:
      return k_read_ink;
    default:
      return lobe_ink(recording::lobe_of(event));
  }
}

PathStrokes path_strokes(const recording::Recording& recording, const PathLinesStyle& style) {
  std::vector<uint32_t> order = recording::by_contribution(recording);
  const double brightest =
      order.empty() ? 0 : recording::luminance_of(recording.events_of(recording.paths[order[0]]));
  if (order.size() > k_most_drawn_paths) {
    if (style.path >= 0 && size_t(style.path) < recording.paths.size())
      order[k_most_drawn_paths - 1] = uint32_t(style.path);
    order.resize(k_most_drawn_paths);
  }
  Strokes strokes(recording, style, brightest);
  for (const uint32_t path : order) strokes.add(path);
  return strokes.take();
}

}  // namespace lucerna::overlay
