#include "bench/matrix.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/json_text.h"
#include "plan/settings.h"

namespace lucerna::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A JSON value with its location.
class Node {
 public:
  Node(const Json& json, std::string where) : json_(json), where_(std::move(where)) {}
  const std::string& where() const { return where_; }

  void only(std::initializer_list<const char*> keys) const {
    if (!json_.is_object()) throw_error(where_, "expected an object {{...}}, found {}", json_.type_name());
    std::vector<std::string> known(keys.begin(), keys.end());
    for (const auto& [key, value] : json_.items())
      if (std::find(known.begin(), known.end(), key) == known.end())
        throw_error(where_, "unknown key '{}'; known are {}", key, fmt::join(known, ", "));
  }
  bool has(const char* key) const { return json_.contains(key); }
  Node at(const char* key) const {
    if (!has(key)) throw_error(where_, "'{}' is missing", key);
    const bool top = where_.empty() || where_.ends_with(": ");
    return {json_.at(key), where_ + (top ? "" : ".") + key};
  }
  std::vector<Node> list(bool may_be_empty = false) const {
    if (!json_.is_array() || (json_.empty() && !may_be_empty))
      throw_error(where_, "expected a list [...]{}, found {}", may_be_empty ? "" : " with at least one entry",
                  json_.is_array() ? "an empty one" : json_.type_name());
    std::vector<Node> nodes;
    for (size_t i = 0; i < json_.size(); ++i) nodes.emplace_back(json_[i], fmt::format("{}[{}]", where_, i));
    return nodes;
  }
  std::string text() const {
    if (!json_.is_string()) throw_error(where_, "expected a text, found {}", json_text(json_));
    return json_.get<std::string>();
  }
  bool truth() const {
    if (!json_.is_boolean()) throw_error(where_, "expected true or false, found {}", json_text(json_));
    return json_.get<bool>();
  }
  double number(double lo, double hi, bool whole) const {
    const double x = json_.is_number() ? json_.get<double>() : NAN;
    if (!(x >= lo && x <= hi) || (whole && x != std::floor(x)))
      throw_error(where_, "expected a {}number from {} to {}, found {}", whole ? "whole " : "", lo, hi,
                  json_text(json_));
    return x;
  }
  uint32_t count(double lo, double hi) const { return uint32_t(number(lo, hi, true)); }
  /// Options as {"key": value}; values may be texts, numbers and booleans.
  SettingValues settings() const {
    if (!json_.is_object()) throw_error(where_, "expected an object {{...}}, found {}", json_.type_name());
    SettingValues values;
    plan::Settings probe;
    for (const auto& [key, value] : json_.items()) {
      if (!value.is_primitive() || value.is_null())
        throw_error(where_, "'{}': expected a text, a number or true or false, found {}", key,
                    json_text(value));
      const std::string word = value.is_string() ? value.get<std::string>() : json_text(value);
      if (key == "samples" || key == "seed")
        throw_error(where_, "'{}' is the bench's own affair; use budgets.samples and seed", key);
      probe.set(key, word, where_);
      values[key] = word;
    }
    return values;
  }

 private:
  const Json& json_;
  std::string where_;
};

/// A name suitable as part of a file name.
std::string read_name(const Node& node) {
  const std::string name = node.text();
  const bool good = !name.empty() && name.size() <= 40 && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
  if (!good) throw_error(node.where(), "'{}': expected up to 40 letters, digits, '-' and '_'", name);
  return name;
}

std::string read_curve(const Node& node) {
  const std::string curve = node.text();
  if (curve.empty() || curve.size() > 40)
    throw_error(node.where(), "'{}': expected a text of 1 to 40 characters", curve);
  return curve;
}

/// An executable file, as an absolute path.
std::string read_program(const Node& node) {
  const std::string file = absolute_path(node.text()).string();
  if (!is_plain_file(file) || access(file.c_str(), X_OK) != 0)
    throw_error(node.where(), "'{}': expected a program, such as build/release/bin/lucerna", node.text());
  return file;
}

void read_budgets(const Node& node, std::array<std::vector<double>, 3>& budgets) {
  node.only({"samples", "errors", "seconds"});
  for (size_t kind = 0; kind < budgets.size(); ++kind) {
    if (!node.has(k_budget_names[kind])) continue;
    const Node list = node.at(k_budget_names[kind]);
    std::vector<double>& values = budgets[kind];
    values.clear();
    for (const Node& entry : list.list())
      values.push_back(kind == 0   ? entry.number(1, 1 << 20, true)
                       : kind == 1 ? entry.number(0.0001, 10, false)
                                   : entry.number(0.01, 1e6, false));
    // Smallest effort first: few samples, a large error.
    std::sort(values.begin(), values.end());
    if (kind == 1) std::reverse(values.begin(), values.end());
    if (std::adjacent_find(values.begin(), values.end()) != values.end())
      throw_error(list.where(), "a value stands there twice");
  }
}

std::string effective(const SettingValues& outer, const SettingValues& inner, const char* key) {
  if (const auto at = inner.find(key); at != inner.end()) return at->second;
  if (const auto at = outer.find(key); at != outer.end()) return at->second;
  return plan::Settings().text(key);
}

Json parse_json(const std::string& text, const std::string& where) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& e) {
    const size_t end = std::min(e.byte ? e.byte - 1 : 0, text.size());
    const std::string before = text.substr(0, end);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const size_t start = before.rfind('\n');
    throw_error(where, "line {}, column {}: not JSON", line,
                before.size() - (start == std::string::npos ? 0 : start + 1) + 1);
  }
}

/// One entry of "settings"; `m` holds those before it.
Setting read_setting(const Node& node, const Matrix& m) {
  node.only({"name", "about", "set", "curve", "budget", "program", "beside"});
  Setting s;
  s.name = read_name(node.at("name"));
  if (std::any_of(m.settings.begin(), m.settings.end(), [&](const Setting& o) { return o.name == s.name; }))
    throw_error(node.where() + ".name", "there are two settings '{}'", s.name);
  if (node.has("about")) s.about = node.at("about").text();
  if (node.has("set")) s.set = node.at("set").settings();
  if (node.has("curve")) s.curve = read_curve(node.at("curve"));
  if (node.has("program")) s.program = read_program(node.at("program"));
  if (node.has("beside")) s.beside = node.at("beside").text();
  const bool adaptive = effective(m.set, s.set, "sampling.mode") == "adaptive";
  s.budget = adaptive ? BudgetKind::errors : BudgetKind::samples;
  if (node.has("budget")) {
    const std::string kind = node.at("budget").text();
    const auto at = std::find(k_budget_names.begin(), k_budget_names.end(), kind);
    if (at == k_budget_names.end())
      throw_error(node.where() + ".budget", "'{}': expected samples, errors or seconds", kind);
    s.budget = BudgetKind(at - k_budget_names.begin());
  }
  if (adaptive ? s.budget == BudgetKind::samples : s.budget == BudgetKind::errors)
    throw_error(node.where() + ".budget", "{} sampling takes {} or seconds",
                adaptive ? "adaptive" : "uniform", adaptive ? "errors" : "samples");
  return s;
}

void read_size(const Node& size, SceneEntry& scene) {
  unsigned w = 0, h = 0;
  char rest = 0;
  const std::string words = size.text();
  if (words.find('-') != std::string::npos || std::sscanf(words.c_str(), "%ux%u%c", &w, &h, &rest) != 2 ||
      w < 8 || h < 8 || w > 4096 || h > 4096)
    throw_error(size.where(), "'{}': expected WIDTHxHEIGHT, each from 8 to 4096, such as 160x120", words);
  scene.width = w, scene.height = h;
}

/// One entry of "scenes"; `m` contains the former ones and all settings. `budgets` and `reference_samples`:
/// defaults.
SceneEntry read_scene(const Node& node, const Matrix& m, const fs::path& folder,
                      const std::array<std::vector<double>, 3>& budgets, uint32_t reference_samples) {
  node.only({"name", "file", "size", "camera", "set", "reference_samples", "budgets"});
  SceneEntry s;
  const Node file = node.at("file");
  const fs::path path = file.text();
  s.file = (path.is_absolute() ? path : folder / path).lexically_normal();
  std::error_code error;
  if (!fs::is_regular_file(s.file, error))
    throw_error(file.where(), "there is no file '{}'", s.file.string());
  s.name =
      node.has("name") ? read_name(node.at("name")) : read_name({Json(path.stem().string()), file.where()});
  if (std::any_of(m.scenes.begin(), m.scenes.end(), [&](const SceneEntry& o) { return o.name == s.name; }))
    throw_error(node.where() + ".name", "there are two scenes '{}'; give one another name", s.name);
  read_size(node.at("size"), s);
  if (node.has("camera")) s.camera = node.at("camera").text();
  if (node.has("set")) {
    s.set = node.at("set").settings();
    // This would change the kind of budget of a setting.
    if (s.set.contains("sampling.mode"))
      throw_error(node.where() + ".set", "'sampling.mode' belongs into settings, not into a scene");
  }
  s.reference_samples =
      node.has("reference_samples") ? node.at("reference_samples").count(2, 1 << 20) : reference_samples;
  s.budgets = budgets;
  if (node.has("budgets")) read_budgets(node.at("budgets"), s.budgets);
  for (const Setting& setting : m.settings)
    if (s.budgets[size_t(setting.budget)].empty())
      throw_error(node.where(), "no budgets.{} for the setting '{}'; give them here or for all",
                  k_budget_names[size_t(setting.budget)], setting.name);
  return s;
}

}  // namespace

std::string Budget::text() const {
  switch (kind) {
    case BudgetKind::samples:
      return fmt::format("{} samples", value);
    case BudgetKind::errors:
      return fmt::format("error {:.4g} %", 100 * value);
    default:
      return fmt::format("{:.4g} s", value);
  }
}

std::optional<size_t> find_setting(const Matrix& m, const std::string& name) {
  for (size_t k = 0; k < m.settings.size(); ++k)
    if (m.settings[k].name == name) return k;
  return std::nullopt;
}

std::vector<Cell> Matrix::cells() const {
  std::vector<Cell> all;
  for (size_t s = 0; s < scenes.size(); ++s) {
    for (int repeat = 0; repeat < repeats; ++repeat) {
      std::vector<Cell> round;
      for (size_t k = 0; k < settings.size(); ++k)
        for (size_t b = 0; b < budgets(s, k).size(); ++b) round.push_back({s, k, b, repeat});
      if (repeat % 2) std::reverse(round.begin(), round.end());
      all.insert(all.end(), round.begin(), round.end());
    }
  }
  return all;
}

std::string Matrix::id(const Cell& c) const {
  return fmt::format("{}.{}.{}.{}", scenes[c.scene].name, settings[c.setting].name, c.budget, c.repeat);
}

Matrix parse_matrix(const std::string& text, const std::string& where, const fs::path& folder) {
  const Json json = parse_json(text, where);
  const Node top(json, where + ": ");
  if (!json.is_object()) throw_error(where, "expected an object {{...}}, found {}", json.type_name());
  top.only({"name", "about", "repeats", "warmup", "seed", "reference", "set", "as_seen", "budgets", "scenes",
            "settings"});
  Matrix m;
  m.name = top.has("name") ? top.at("name").text() : fs::path(where).stem().string();
  if (top.has("about")) top.at("about").text();
  if (top.has("repeats")) m.repeats = int(top.at("repeats").count(1, 100));
  if (top.has("warmup")) m.warmup = top.at("warmup").count(1, 4096);
  if (top.has("seed")) m.seed = top.at("seed").count(0, 4e9);
  uint32_t reference_samples = 4096;
  if (top.has("reference")) {
    const Node reference = top.at("reference");
    reference.only({"samples", "seed"});
    if (reference.has("samples")) reference_samples = reference.at("samples").count(2, 1 << 20);
    if (reference.has("seed")) m.reference_seed = reference.at("seed").count(0, 4e9);
  }
  if (m.reference_seed >= m.seed && m.reference_seed < m.seed + uint32_t(m.repeats))
    throw_error(top.where() + "reference.seed",
                "{} is also the seed of a repeat; a reference must not share samples with what it judges",
                m.reference_seed);
  if (top.has("set")) m.set = top.at("set").settings();
  if (top.has("as_seen")) m.as_seen = top.at("as_seen").truth();
  std::array<std::vector<double>, 3> budgets;
  if (top.has("budgets")) read_budgets(top.at("budgets"), budgets);

  for (const Node& node : top.at("settings").list()) m.settings.push_back(read_setting(node, m));
  for (const Setting& s : m.settings)
    if (!s.beside.empty() && (s.beside == s.name || !find_setting(m, s.beside)))
      throw_error(top.where() + "settings", "'{}' is compared with '{}', but no other setting has that name",
                  s.name, s.beside);
  for (const Node& node : top.at("scenes").list())
    m.scenes.push_back(read_scene(node, m, folder, budgets, reference_samples));
  return m;
}

Matrix read_matrix(const fs::path& file) {
  if (!file_exists(file) || is_folder(file))
    throw_error(file.string(), "cannot be read; expected a matrix file");
  return parse_matrix(read_file(file), file.string(), file.parent_path());
}

nlohmann::ordered_json to_json(const Matrix& m) {
  Json j;
  j["name"] = m.name;
  j["repeats"] = m.repeats;
  j["warmup"] = m.warmup;
  j["seed"] = m.seed;
  j["reference"] = {{"seed", m.reference_seed}};
  j["set"] = Json::object();
  for (const auto& [key, value] : m.set) j["set"][key] = value;
  if (m.as_seen) j["as_seen"] = true;
  for (const SceneEntry& s : m.scenes) {
    Json scene{
        {"name", s.name},     {"file", s.file.string()}, {"size", fmt::format("{}x{}", s.width, s.height)},
        {"camera", s.camera}, {"set", Json::object()},   {"reference_samples", s.reference_samples}};
    for (const auto& [key, value] : s.set) scene["set"][key] = value;
    for (size_t k = 0; k < 3; ++k)
      if (!s.budgets[k].empty()) scene["budgets"][k_budget_names[k]] = s.budgets[k];
    j["scenes"].push_back(std::move(scene));
  }
  for (const Setting& s : m.settings) {
    Json setting{{"name", s.name}, {"about", s.about}, {"set", Json::object()}};
    for (const auto& [key, value] : s.set) setting["set"][key] = value;
    if (!s.curve.empty()) setting["curve"] = s.curve;
    if (!s.program.empty()) setting["program"] = s.program;
    if (!s.beside.empty()) setting["beside"] = s.beside;
    setting["budget"] = k_budget_names[size_t(s.budget)];
    j["settings"].push_back(std::move(setting));
  }
  return j;
}

}  // namespace lucerna::bench
