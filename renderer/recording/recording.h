#pragma once
// Recorded paths of the picture, as plain data: what each met, with what density and throughput, and the
// light that it added to its pixel (shaders/shared/path_events.h). Made by the renderer or read from a file
// (file.h).
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "paths/automaton.h"
#include "shaders/shared/path_events.h"

namespace lucerna::recording {

using Event = shared::PathEvent;

/// A sample of a pixel: events first ... first + count - 1 of the recording. Their `parent` counts from
/// `first`.
struct Path {
  uint32_t pixel = 0;  ///< y * width + x
  uint32_t sample = 0;
  uint32_t first = 0, count = 0;
  uint32_t lost = 0;  ///< events for which there was no room; their light is missing
  bool operator==(const Path&) const = default;
};

/// Mean times of a ray of the picture [us]: a measurement, so no part of what is the same from run to run.
struct RayTimes {
  double surface =
      0;  ///< to a surface or out of the scene, with its shading, and its share of all other stages
  double light = 0;  ///< to a light, with what it adds
  bool measured() const { return surface > 0; }
};

struct Recording {
  uint32_t width = 0, height = 0;  ///< of the picture
  uint32_t seed = 0;
  std::string scene;                   ///< its name
  std::vector<std::string> materials;  ///< by Event::material
  std::vector<std::string> lights;     ///< by Event::light, which the renderer has replaced by this index
  std::vector<std::string> groups;     ///< of lights, by group; empty: not separate
  RayTimes times;
  std::vector<Path> paths;
  std::vector<Event> events;

  std::span<const Event> events_of(const Path& path) const {
    return std::span(events).subspan(path.first, path.count);
  }
  uint64_t lost() const;  ///< events, of all paths
};

// Fields of an event.
inline uint32_t kind_of(const Event& e) { return e.bits & 0xffu; }
inline uint32_t lobe_of(const Event& e) { return e.bits >> shared::k_path_by_shift & 15u; }
inline uint32_t component_of(const Event& e) { return e.bits >> shared::k_path_component_shift & 15u; }
inline uint32_t group_of(const Event& e) { return e.bits >> shared::k_path_group_shift & 255u; }
inline uint32_t reason_of(const Event& e) { return e.bits >> shared::k_path_reason_shift & 15u; }
/// True if its contribution is in the picture; a blocked light sample's is not.
bool contributes_light(const Event& e);

/// "surface", "light", "blocked": names of shared::k_path_*, as files and queries write them.
extern const std::array<const char*, shared::k_path_kinds> k_kind_names;
/// "roulette": names of shared::k_end_*.
extern const std::array<const char*, shared::k_end_reasons> k_reason_names;

/// The word of the way to an event: E, and a letter for each scattering. Of light it ends in L ("EDSL"). Of
/// light that was looked up, or that light tracing brought, the rest is known as a path expression only:
/// "ED (records: [SG]*DL)". `event`: its number in the path.
std::string word_of(std::span<const Event> path, uint32_t event);
/// True if the word of an event has such an expression.
bool is_open(const std::string& word);
/// The ways of a component's light behind a way with so many D, if any the last letter, as a path expression:
/// what stored light of that component can be. "": there is none.
std::string rest_of_way(uint32_t component, uint32_t diffuse_events);
/// Number of scatterings on the way to it.
uint32_t depth_of(std::span<const Event> path, uint32_t event);

/// Rays of a path: one to each surface that it meets or out of the scene, one for each light sample. Of lost
/// events none.
uint32_t rays_of(std::span<const Event> path);
/// Time of the path [us] by the picture's mean times of its rays; 0: not measured.
double time_of(std::span<const Event> path, const RayTimes& times);

/// Radiance that the path adds to its sample, by component, in double precision.
using Light = ByComponent<std::array<double, 3>>;
Light light_of(std::span<const Event> path);
double luminance_of(std::span<const Event> path);
/// Component that most of its light belongs to; k_no_component: it has none.
uint8_t main_component(std::span<const Event> path);

/// Removes the paths whose luminance is at most this.
void keep_over(Recording& recording, double least);

/// Indices of the paths, the brightest first; equal ones in their order.
std::vector<uint32_t> by_contribution(const Recording& recording);

// Texts.
std::string material_name(const Recording& recording, const Event& event);  ///< "" if it is on none
std::string light_name(const Recording& recording, const Event& event);     ///< "" if it is on none
/// What happened, with what: "surface 'glass'", "light 'Lamp' arrived", "read 7 records".
std::string event_text(const Recording& recording, const Event& event);
/// "EDSL caustic 3.2, 6 events"; of the path with that index.
std::string path_text(const Recording& recording, uint32_t path);
/// The events of a path, one line each: text, place, pdf, throughput, contribution with its component.
std::vector<std::string> event_lines(const Recording& recording, uint32_t path);

}  // namespace lucerna::recording
