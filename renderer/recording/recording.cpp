#include "recording/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace lucerna::recording {

using namespace shared;

namespace {

constexpr char k_letters[] = {'D', 'G', 'S'};

bool looked_up(uint32_t kind) {
  return kind == k_path_records || kind == k_path_photons || kind == k_path_looked_up;
}

/// Calls f with each event from this one back to the camera.
template <class F>
void walk_back(std::span<const Event> path, uint32_t event, F&& f) {
  // A parent has a lower number, so a damaged file cannot make this endless.
  for (uint32_t at = event; at < path.size();) {
    f(path[at]);
    at = path[at].parent < at ? path[at].parent : k_path_no_event;
  }
}

std::string triple(const vec3& v) { return fmt::format("{:.3g} {:.3g} {:.3g}", v.x, v.y, v.z); }

}  // namespace

const std::array<const char*, k_path_kinds> k_kind_names{"camera",  "surface", "passed",     "emission",
                                                         "light",   "blocked", "background", "records",
                                                         "photons", "splat",   "looked_up",  "end"};
const std::array<const char*, k_end_reasons> k_reason_names{"absorbed",  "roulette", "depth", "complete",
                                                            "looked up", "left",     "unlit"};

uint64_t Recording::lost() const {
  uint64_t sum = 0;
  for (const Path& path : paths) sum += path.lost;
  return sum;
}

bool contributes_light(const Event& e) {
  return shared::is_component(component_of(e)) && kind_of(e) != k_path_blocked;
}

std::string word_of(std::span<const Event> path, uint32_t event) {
  std::string word;
  walk_back(path, event, [&](const Event& e) {
    if (lobe_of(e) < std::size(k_letters)) word += k_letters[lobe_of(e)];
  });
  word += 'E';
  std::reverse(word.begin(), word.end());
  if (event >= path.size()) return word;
  const uint32_t kind = kind_of(path[event]);
  if (looked_up(kind) || kind == k_path_splat) {
    const auto diffuse = uint32_t(std::count(word.begin(), word.end(), 'D'));
    const char* from = kind == k_path_records   ? "records"
                       : kind == k_path_photons ? "photons"
                       : kind == k_path_splat   ? "light paths"
                                                : "stored";
    const std::string rest = rest_of_way(component_of(path[event]), diffuse);
    return fmt::format("{} ({}: {})", word, from, rest.empty() ? ".*L" : rest);
  }
  return shared::is_component(component_of(path[event])) ? word + "L" : word;
}

bool is_open(const std::string& word) { return word.find('(') != std::string::npos; }

std::string rest_of_way(uint32_t component, uint32_t diffuse_events) {
  // Derivatives of paths::k_component_expressions by a word with so many D.
  using Rests = ByComponent<const char*>;
  constexpr std::array<Rests, 3> k_rests{
      Rests{"[SG]*D?L", "[SG]*D[SG]*DL", "[SG]*D[SG]*D.+L", "[SG]*D[SG]+L"},
      Rests{"L", "[SG]*DL", "[SG]*D.+L", "[SG]+L"}, Rests{"", "L", ".+L", ""}};
  if (!shared::is_component(component)) return "";
  if (diffuse_events < k_rests.size()) return k_rests[diffuse_events][component];
  return component == paths::k_tertiary ? ".*L" : "";
}

uint32_t depth_of(std::span<const Event> path, uint32_t event) {
  uint32_t depth = 0;
  walk_back(path, event, [&](const Event& e) { depth += lobe_of(e) < std::size(k_letters) ? 1 : 0; });
  return depth;
}

uint32_t rays_of(std::span<const Event> path) {
  return uint32_t(std::count_if(path.begin(), path.end(), [](const Event& e) {
    const uint32_t kind = kind_of(e);
    return kind == k_path_surface || kind == k_path_passed || kind == k_path_background ||
           kind == k_path_light || kind == k_path_blocked;
  }));
}

double time_of(std::span<const Event> path, const RayTimes& times) {
  const auto lights = std::count_if(path.begin(), path.end(), [](const Event& e) {
    return kind_of(e) == k_path_light || kind_of(e) == k_path_blocked;
  });
  return (rays_of(path) - double(lights)) * times.surface + double(lights) * times.light;
}

Light light_of(std::span<const Event> path) {
  Light light{};
  for (const Event& e : path)
    if (contributes_light(e))
      for (int k = 0; k < 3; ++k) light[component_of(e)][k] += double(e.contribution[k]);
  return light;
}

double luminance_of(std::span<const Event> path) {
  double sum = 0;
  for (const Event& e : path)
    if (contributes_light(e)) sum += double(luminance(e.contribution));
  return sum;
}

uint8_t main_component(std::span<const Event> path) {
  ByComponent<double> light{};
  for (const Event& e : path)
    if (contributes_light(e)) light[component_of(e)] += double(luminance(e.contribution));
  const auto most = std::max_element(light.begin(), light.end());
  return *most > 0 ? uint8_t(most - light.begin()) : paths::k_no_component;
}

void keep_over(Recording& recording, double least) {
  Recording kept;
  for (const Path& path : recording.paths) {
    const std::span<const Event> events = recording.events_of(path);
    if (!(luminance_of(events) > least)) continue;
    kept.paths.push_back(path);
    kept.paths.back().first = uint32_t(kept.events.size());
    kept.events.insert(kept.events.end(), events.begin(), events.end());
  }
  recording.paths = std::move(kept.paths), recording.events = std::move(kept.events);
}

std::vector<uint32_t> by_contribution(const Recording& recording) {
  std::vector<double> light(recording.paths.size());
  for (size_t i = 0; i < light.size(); ++i) light[i] = luminance_of(recording.events_of(recording.paths[i]));
  std::vector<uint32_t> order(light.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return light[a] > light[b]; });
  return order;
}

std::string material_name(const Recording& recording, const Event& event) {
  return event.material < recording.materials.size() ? recording.materials[event.material] : "";
}

std::string light_name(const Recording& recording, const Event& event) {
  const uint32_t kind = kind_of(event);
  if (event.light < recording.lights.size()) return recording.lights[event.light];
  if (kind == k_path_emission) return material_name(recording, event);
  const bool sky = kind == k_path_background || kind == k_path_light || kind == k_path_blocked;
  return sky ? "environment" : "";
}

std::string event_text(const Recording& recording, const Event& event) {
  const auto named = [](const char* what, const std::string& name) {
    return name.empty() ? std::string(what) : fmt::format("{} '{}'", what, name);
  };
  switch (kind_of(event)) {
    case k_path_camera:
      return "camera";
    case k_path_surface:
      return named("surface", material_name(recording, event));
    case k_path_passed:
      return named("passes", material_name(recording, event));
    case k_path_emission:
      return named("emission of", material_name(recording, event));
    case k_path_light:
      return named("light", light_name(recording, event)) + " arrives";
    case k_path_blocked:
      return named("light", light_name(recording, event)) + " is blocked";
    case k_path_background:
      return "background";
    case k_path_records:
      return event.served == 1 ? fmt::format("reads record {}", event.record)
                               : fmt::format("reads record {} of {}", event.record, event.served);
    case k_path_photons:
      return event.served == 0 ? std::string("reads the map of photons' irradiance")
                               : fmt::format("reads {} photons", event.served);
    case k_path_splat:
      return "light tracing's light";
    case k_path_looked_up:
      return "reads stored light";
    case k_path_end:
      return fmt::format("end: {}", k_reason_names[std::min(reason_of(event), k_end_reasons - 1)]);
    default:
      return "unknown";
  }
}

std::string path_text(const Recording& recording, uint32_t path) {
  const std::span<const Event> events = recording.events_of(recording.paths[path]);
  uint32_t brightest = k_path_no_event;
  float most = 0;
  for (uint32_t i = 0; i < events.size(); ++i)
    if (contributes_light(events[i]) && luminance(events[i].contribution) > most)
      most = luminance(events[i].contribution), brightest = i;
  if (brightest == k_path_no_event) return fmt::format("no light, {} events", events.size());
  return fmt::format("{} {} {:.3g}, {} events", word_of(events, brightest),
                     paths::k_component_names[main_component(events)], luminance_of(events), events.size());
}

std::vector<std::string> event_lines(const Recording& recording, uint32_t path) {
  std::vector<std::string> lines;
  const Path& of = recording.paths[path];
  const std::span<const Event> events = recording.events_of(of);
  for (uint32_t i = 0; i < events.size(); ++i) {
    const Event& e = events[i];
    std::string line = fmt::format("{} {}: {}", i, word_of(events, i), event_text(recording, e));
    line += fmt::format(", at {}", triple(e.position));
    if (e.pdf > 0) line += fmt::format(", pdf {:.3g}", e.pdf);
    if (e.throughput != vec3(0)) line += fmt::format(", throughput {}", triple(e.throughput));
    if (shared::is_component(component_of(e)))
      line += fmt::format(", {} {} {}", contributes_light(e) ? "contributes" : "would contribute",
                          paths::k_component_names[component_of(e)], triple(e.contribution));
    lines.push_back(line);
  }
  if (of.lost > 0) lines.push_back(fmt::format("{} events more than there was room for", of.lost));
  return lines;
}

}  // namespace lucerna::recording
