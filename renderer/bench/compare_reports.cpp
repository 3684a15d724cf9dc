#include "bench/compare_reports.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/json_text.h"

namespace lucerna::bench {
namespace {

using Json = nlohmann::ordered_json;

bool within_noise(double ratio, double noise) {
  noise *= 1 + 1e-9;  // bit-identical repeats have no noise
  return ratio <= noise && ratio >= 1 / noise;
}

const Json* find_named(const Json& list, const std::string& name) {
  for (const Json& entry : list)
    if (entry.value("name", "") == name) return &entry;
  return nullptr;
}

std::optional<double> number(const Json& json, const char* pointer) {
  const Json::json_pointer at(pointer);
  if (!json.contains(at) || !json.at(at).is_number()) return std::nullopt;
  return json.at(at).get<double>();
}

/// Noise of a ratio of two figures with noise.
std::optional<double> joint_noise(const Json& a, const Json& b, const char* pointer) {
  const auto x = number(a, pointer), y = number(b, pointer);
  if (!x || !y) return std::nullopt;
  return std::exp(std::hypot(std::log(*x), std::log(*y)));
}

std::string cell(const std::optional<double>& ratio, const std::optional<double>& noise, bool extrapolated) {
  if (!ratio) return fmt::format("{:>11}", "-");
  const bool equal = noise && within_noise(*ratio, *noise);
  return fmt::format("{:>10}{}", fmt::format("{}{:.2f}x", extrapolated ? "~" : "", *ratio),
                     equal    ? "="
                     : !noise ? "?"
                              : " ");
}

std::optional<double> quotient(const std::optional<double>& a, const std::optional<double>& b) {
  if (!a || !b || !(*b > 0)) return std::nullopt;
  return *a / *b;
}

void compare_heads(const Json& a, const Json& b, std::string& text) {
  for (const char* key : {"/version", "/device/name", "/machine/cpu", "/machine/cores"}) {
    const Json::json_pointer at(key);
    const Json x = a.contains(at) ? a.at(at) : Json(), y = b.contains(at) ? b.at(at) : Json();
    if (x != y) text += fmt::format("note: {} differs: {} and {}\n", key + 1, json_text(x), json_text(y));
  }
  for (const Json* report : {&a, &b})
    if (!report->value("complete", false))
      text += fmt::format("note: the {} report is not complete\n", report == &a ? "old" : "new");
}

void compare_scene(const Json& a, const Json& b, std::string& text) {
  const std::string scene = a.at("name").get<std::string>();
  if (a.value("size", "") != b.value("size", ""))
    text += fmt::format("note: {} is {} in the old report and {} in the new one\n", scene,
                        a.value("size", ""), b.value("size", ""));
  const auto time_noise = joint_noise(a, b, "/noise/time"), index_noise = joint_noise(a, b, "/noise/index"),
             rate_noise = joint_noise(a, b, "/noise/rate"),
             seen_noise = joint_noise(a, b, "/noise/seen_index");
  for (const Json& before : a.at("settings")) {
    const std::string name = before.at("name").get<std::string>();
    const Json* after = find_named(b.at("settings"), name);
    if (!after) continue;
    text += fmt::format("{:<12} {:<16}", scene, name);
    for (int i = 0; i < 3; ++i) {
      const std::string place = fmt::format("/time_to/{}", i);
      const auto kind = [&](const Json& j) {
        const Json::json_pointer at(place + "/kind");
        return j.contains(at) ? j.at(at).get<std::string>() : "unknown";
      };
      const std::string seconds = place + "/seconds/median";
      text += cell(quotient(number(before, seconds.c_str()), number(*after, seconds.c_str())), time_noise,
                   kind(before) == "extrapolated" || kind(*after) == "extrapolated");
    }
    text += cell(quotient(number(*after, "/index/pi/median"), number(before, "/index/pi/median")),
                 index_noise, false);
    text += cell(quotient(number(*after, "/rays_per_s/median"), number(before, "/rays_per_s/median")),
                 rate_noise, false);
    text += cell(quotient(number(*after, "/seen_index/pi/median"), number(before, "/seen_index/pi/median")),
                 seen_noise, false);
    text += "\n";
  }
}

void name_missing(const Json& from, const Json& in, const char* which, std::string& text) {
  for (const Json& scene : from.at("scenes")) {
    const std::string name = scene.at("name").get<std::string>();
    const Json* other = find_named(in.at("scenes"), name);
    if (!other) {
      text += fmt::format("missing in the {} report: {}\n", which, name);
      continue;
    }
    for (const Json& setting : scene.at("settings")) {
      const std::string setting_name = setting.at("name").get<std::string>();
      const Json* same = find_named(other->at("settings"), setting_name);
      if (!same) {
        text += fmt::format("missing in the {} report: {}, {}\n", which, name, setting_name);
        continue;
      }
      for (const Json& cell : setting.at("cells")) {
        const std::string budget = cell.at("budget").get<std::string>();
        bool found = false;
        for (const Json& c : same->at("cells")) found |= c.at("budget") == budget;
        if (!found)
          text += fmt::format("missing in the {} report: {}, {}, {}\n", which, name, setting_name, budget);
      }
    }
  }
}

}  // namespace

std::string compare_reports(const Json& before, const Json& after) {
  std::string text;
  compare_heads(before, after, text);
  text += fmt::format("{:<12} {:<16}{:>11}{:>11}{:>11}{:>11}{:>11}{:>11}\n", "scene", "setting", "to 5 % ",
                      "to 2 % ", "to 1 % ", "index ", "rays/s ", "as seen ");
  for (const Json& scene : before.at("scenes"))
    if (const Json* other = find_named(after.at("scenes"), scene.at("name").get<std::string>()))
      compare_scene(scene, *other, text);
  name_missing(before, after, "new", text);
  name_missing(after, before, "old", text);
  text +=
      "Ratios above 1x: the new one is better (sooner, or more). '=' within the noise of the two "
      "measurements, "
      "'~' extrapolated,\n'?' noise not known, '-' not measured.\n";
  return text;
}

}  // namespace lucerna::bench
