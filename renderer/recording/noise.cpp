#include "recording/noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace lucerna::recording {

using namespace shared;

namespace {

/// The surface that sent the light of an event on its way to the camera; "": the camera sees it directly.
std::string scatterer(const Recording& recording, std::span<const Event> path, uint32_t event) {
  const uint32_t kind = kind_of(path[event]);
  uint32_t at = path[event].parent;
  // Emission hangs on the emitter's own surface.
  if (kind == k_path_emission && at < event) at = path[at].parent;
  for (; at < event; at = path[at].parent)
    if (kind_of(path[at]) == k_path_surface) return material_name(recording, path[at]);
  return "";
}

/// Luminance by class, of one kind of classes.
class Classes {
 public:
  /// Adds light to the present path.
  void add(const std::string& name, double light) {
    const auto [at, is_new] = index_.try_emplace(name, names_.size());
    if (is_new) names_.push_back(name), noise_.push_back(0), light_.push_back(0);
    of_path_.emplace_back(at->second, light);
  }
  void end_path() { paths_.push_back(std::exchange(of_path_, {})); }
  /// Adds the covariances of the classes with the paths' sums, times `weight`; and their light.
  void end_pixel(const std::vector<double>& sums, double mean, double weight, double light_weight) {
    const auto n = double(sums.size());
    for (size_t i = 0; i < paths_.size(); ++i)
      for (const auto& [which, light] : paths_[i]) {
        // sum (x - mean x) (s - mean s) = sum x (s - mean s)
        noise_[which] += weight * light * (sums[i] - mean) / (n - 1);
        light_[which] += light_weight * light / n;
      }
    paths_.clear();
  }
  void drop_pixel() { paths_.clear(); }
  std::vector<NoiseShare> shares(double noise, double light) const {
    std::vector<NoiseShare> all;
    for (size_t i = 0; i < names_.size(); ++i)
      all.push_back({names_[i], noise > 0 ? noise_[i] / noise : 0, light > 0 ? light_[i] / light : 0});
    std::stable_sort(all.begin(), all.end(),
                     [](const NoiseShare& a, const NoiseShare& b) { return a.noise > b.noise; });
    return all;
  }

 private:
  std::map<std::string, size_t> index_;
  std::vector<std::string> names_;
  std::vector<double> noise_, light_;
  std::vector<std::pair<size_t, double>> of_path_;
  std::vector<std::vector<std::pair<size_t, double>>> paths_;
};

std::string quoted(const std::vector<NoiseShare>& shares) {
  return shares.empty() || shares[0].name.empty() ? "" : fmt::format("'{}'", shares[0].name);
}

}  // namespace

NoiseReport analyse_noise(const Recording& recording, const std::vector<double>& around, double most) {
  NoiseReport report;
  Classes components, words, lights, materials;
  const std::array<Classes*, 4> all{&components, &words, &lights, &materials};
  double noise = 0, light = 0;
  size_t first = 0;
  while (first < recording.paths.size()) {
    size_t end = first;
    std::vector<double> sums;
    std::vector<ByComponent<double>> by_component;
    for (; end < recording.paths.size() && recording.paths[end].pixel == recording.paths[first].pixel;
         ++end) {
      const std::span<const Event> events = recording.events_of(recording.paths[end]);
      double sum = 0;
      by_component.emplace_back();
      for (uint32_t i = 0; i < events.size(); ++i) {
        if (!contributes_light(events[i])) continue;
        const double y = double(luminance(events[i].contribution));
        sum += y;
        by_component.back()[component_of(events[i])] += y;
        components.add(paths::k_component_names[component_of(events[i])], y);
        words.add(word_of(events, i), y);
        lights.add(light_name(recording, events[i]), y);
        materials.add(scatterer(recording, events, i), y);
      }
      sums.push_back(sum);
      for (Classes* c : all) c->end_path();
    }
    const size_t n = end - first;
    const double near = around[first];
    first = end;
    if (n < 2 || !(near > 0)) {
      for (Classes* c : all) c->drop_pixel();
      continue;
    }
    double mean = 0, variance = 0;
    for (const double s : sums) mean += s / double(n);
    for (const double s : sums) variance += (s - mean) * (s - mean) / double(n - 1);
    double weight = 1 / (near * near);
    if (variance * weight > most) weight = most / variance;
    noise += weight * variance, light += mean / near;
    ++report.pixels, report.paths += uint32_t(n);
    for (Classes* c : all) c->end_pixel(sums, mean, weight, 1 / near);
    for (size_t c = 0; c < report.light.size(); ++c) {
      double m = 0, v = 0;
      for (const auto& path : by_component) m += path[c] / double(n);
      for (const auto& path : by_component) v += (path[c] - m) * (path[c] - m) / double(n - 1);
      report.light[c] += m / near;
      report.variance[c] += std::min(weight * v, most);
    }
  }
  const double pixels = std::max(1u, report.pixels);
  report.of_sample = std::sqrt(std::max(0.0, noise / pixels));
  for (size_t c = 0; c < report.light.size(); ++c) {
    report.light[c] = light > 0 ? report.light[c] / light : 0;
    report.variance[c] /= pixels;
  }
  report.components = components.shares(noise, light);
  report.words = words.shares(noise, light);
  report.lights = lights.shares(noise, light);
  report.materials = materials.shares(noise, light);
  return report;
}

std::string noise_sentence(const NoiseReport& report, bool whole_picture) {
  if (report.components.empty() || report.of_sample <= 0) return "";
  const NoiseShare& component = report.components[0];
  std::string name = component.name;
  name[0] = char(std::toupper(static_cast<unsigned char>(name[0])));
  std::string text =
      fmt::format("{} light makes {:.0f} % of the noise {} and {:.0f} % of the light", name,
                  100 * component.noise, whole_picture ? "of the picture" : "here", 100 * component.light);
  std::vector<std::string> by;
  if (!report.words.empty())
    by.push_back(fmt::format("most of it on the way {} ({:.0f} %)", report.words[0].name,
                             100 * report.words[0].noise));
  if (const std::string light = quoted(report.lights); !light.empty())
    by.push_back(fmt::format("from {} ({:.0f} %)", light, 100 * report.lights[0].noise));
  if (const std::string material = quoted(report.materials); !material.empty())
    by.push_back(fmt::format("by way of {} ({:.0f} %)", material, 100 * report.materials[0].noise));
  for (size_t i = 0; i < by.size(); ++i) text += (i == 0 ? ": " : ", ") + by[i];
  return text + ".";
}

std::vector<std::string> noise_lines(const NoiseReport& report) {
  std::vector<std::string> lines;
  if (report.sentence.empty()) return {"no noise: the recorded paths of each pixel have the same light"};
  lines.push_back(report.sentence);
  lines.push_back(fmt::format("error as seen of one sample: {:.0f} %, from {} paths of {} pixels",
                              100 * report.of_sample, report.paths, report.pixels));
  const auto list = [&](const char* title, const std::vector<NoiseShare>& shares) {
    constexpr size_t k_most = 6;
    for (size_t i = 0; i < std::min(shares.size(), k_most); ++i)
      lines.push_back(fmt::format("{}: {} {:.1f} % of the noise, {:.1f} % of the light", title,
                                  shares[i].name.empty() ? "directly visible" : shares[i].name,
                                  100 * shares[i].noise, 100 * shares[i].light));
  };
  list("component", report.components);
  list("word", report.words);
  list("light", report.lights);
  list("material", report.materials);
  std::string cure;
  for (const auto& [key, value] : report.cure.settings)
    cure += fmt::format("{}{} = {}", cure.empty() ? "" : ", ", key, value);
  if (!report.cure.reason.empty())
    lines.push_back(cure.empty() ? report.cure.reason : fmt::format("{}: {}", cure, report.cure.reason));
  return lines;
}

}  // namespace lucerna::recording
