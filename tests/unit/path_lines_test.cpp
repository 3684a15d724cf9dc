// links: overlay
// Recorded paths as strokes: a line for every event behind the camera, points for light without a way, faint
// lines beside a followed path, dark ones for blocked light.
#include <catch2/catch.hpp>

#include "overlay/path_lines.h"

namespace path_lines_tests {

using namespace lucerna;
using namespace lucerna::overlay;
using recording::Event;

namespace {

Event event(uint32_t kind, uint32_t parent, const vec3& at, uint32_t lobe = shared::k_path_by_none,
            uint32_t component = 15, float light = 0) {
  Event e{};
  e.position = at, e.parent = parent;
  e.bits = kind | lobe << shared::k_path_by_shift | component << shared::k_path_component_shift;
  e.contribution = vec3(light);
  return e;
}

/// Camera, wall with a blocked lamp, a mirror, records; and a dark path that leaves the scene.
recording::Recording two_paths() {
  recording::Recording all;
  all.width = all.height = 1;
  all.events = {event(shared::k_path_camera, shared::k_path_no_event, {0, 0, 0}),
                event(shared::k_path_surface, 0, {0, 0, 1}),
                event(shared::k_path_blocked, 1, {5, 0, 1}, 0, 0, 7),
                event(shared::k_path_surface, 1, {0, 2, 1}, 2),
                event(shared::k_path_records, 3, {0, 2, 1}, 0, 1, 3),
                event(shared::k_path_end, 3, {0, 2, 1}),
                event(shared::k_path_camera, shared::k_path_no_event, {0, 0, 0}),
                event(shared::k_path_background, 0, {9, 0, 0})};
  all.paths = {{0, 0, 0, 6, 0}, {0, 1, 6, 2, 0}};
  return all;
}

}  // namespace

TEST_CASE("paths are drawn from event to event") {
  const PathStrokes strokes = path_strokes(two_paths(), {});
  REQUIRE(strokes.segments.size() == 4);
  CHECK(strokes.segments[0].to == vec3(0, 0, 1));
  CHECK(strokes.segments[1].color == k_blocked_ink);
  CHECK(strokes.segments[2].from == vec3(0, 0, 1));
  CHECK(strokes.segments[2].color == lobe_ink(2));
  CHECK(strokes.segments[3].color == k_background_ink);
  REQUIRE(strokes.points.size() == 1);
  CHECK(strokes.points[0].position == vec3(0, 2, 1));
  CHECK(strokes.points[0].color == k_read_ink);
}

TEST_CASE("by component a ray has the colour of the light that it leads to; blocked light stays dark") {
  const PathStrokes strokes = path_strokes(two_paths(), {.color = PathColor::component});
  CHECK(strokes.segments[0].color == component_ink(1));
  CHECK(strokes.segments[1].color == k_blocked_ink);
  CHECK(strokes.segments[2].color == component_ink(1));
  CHECK(strokes.segments[3].color == component_ink(15));
  const PathStrokes light = path_strokes(two_paths(), {.color = PathColor::contribution});
  CHECK(light.segments[0].color == contribution_ink(1));
  CHECK(light.segments[3].color == contribution_ink(0));
}

TEST_CASE("by word the brightest ways have colours, by time the slowest path ends the ramp") {
  recording::Recording paths = two_paths();
  paths.events[2] =
      event(shared::k_path_light, 1, {5, 0, 1}, 0, 0, 2);  // dimmer than the records behind the mirror
  const std::vector<std::string> words = brightest_words(paths);
  REQUIRE(words.size() == 2);
  CHECK(words[0] == recording::word_of(paths.events_of(paths.paths[0]), 4));
  CHECK(words[1] == recording::word_of(paths.events_of(paths.paths[0]), 2));
  const PathStrokes strokes = path_strokes(paths, {.color = PathColor::word});
  CHECK(strokes.segments[0].color == word_ink(0));  // to the wall, over which both are reached
  CHECK(strokes.segments[1].color == word_ink(1));
  CHECK(strokes.segments[2].color == word_ink(0));
  CHECK(strokes.segments[3].color == word_ink(99));
  paths.times = {.surface = 1, .light = 1};
  const PathStrokes slow = path_strokes(paths, {.color = PathColor::time});
  CHECK(slow.segments[0].color == time_ink(1));
  CHECK(slow.segments[3].color == time_ink(1.0 / 3));
}

TEST_CASE("a followed path stands out, with its marked event") {
  const PathStrokes strokes = path_strokes(two_paths(), {.path = 0, .vertex = 5});
  CHECK(strokes.segments[0].alpha == 1);
  CHECK(strokes.segments[3].alpha < 0.2f);
  // All its events but the camera are points; the end only if it is marked.
  CHECK(strokes.points.size() == 5);
  CHECK(strokes.points.back().half_width > strokes.points.front().half_width);
  CHECK(path_strokes(two_paths(), {.path = 0}).points.size() == 4);
  CHECK(path_strokes({}, {.path = 3}).segments.empty());
}

}  // namespace path_lines_tests
