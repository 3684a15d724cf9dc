#pragma once
// Recorded paths as strokes over the picture: lines from event to event, points where light was found.
#include <string>
#include <vector>

#include "recording/recording.h"
#include "shaders/shared/overlay.h"

namespace lucerna::overlay {

enum class PathColor { event, component, contribution, word, time };

struct PathLinesStyle {
  PathColor color = PathColor::event;
  int path = -1;    ///< index of the path that is followed, the others are faint; -1: none
  int vertex = -1;  ///< its marked event
  float slack = 0;  ///< OverlaySegment::slack [m]
};

struct PathStrokes {
  std::vector<shared::OverlayPoint> points;
  std::vector<shared::OverlaySegment> segments;
  std::vector<std::string> words;  ///< by word: brightest_words()
  double slowest = 0;              ///< by time: that of the slowest path [us]
};

/// Draws at most the brightest k_most_drawn_paths paths. Blocked light samples are dark.
inline constexpr size_t k_most_drawn_paths = 4096;
PathStrokes path_strokes(const recording::Recording& recording, const PathLinesStyle& style);

/// Encoded colours, for legends.
vec3 event_ink(const recording::Event& event);
vec3 lobe_ink(uint32_t lobe);  ///< k_event_* or shared::k_path_by_none
vec3 component_ink(uint32_t component);
/// `share`: the light of the path over that of the brightest one; the ramp ends at k_least_path_share.
inline constexpr float k_least_path_share = 1e-3f;
vec3 contribution_ink(double share);
/// Words of the light of paths, those with most light first, at most as many as there are colours for.
std::vector<std::string> brightest_words(const recording::Recording& recording);
vec3 word_ink(size_t rank);  ///< in that list; the others are grey
/// `share`: time of the path over that of the slowest.
vec3 time_ink(double share);
inline constexpr vec3 k_arrived_ink{1.0f, 0.86f, 0.35f}, k_blocked_ink{0.13f, 0.11f, 0.13f},
    k_background_ink{0.45f, 0.62f, 1.0f}, k_emission_ink{1.0f, 0.55f, 0.2f}, k_read_ink{0.75f, 0.45f, 1.0f};

}  // namespace lucerna::overlay
