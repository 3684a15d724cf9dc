#include "script.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include "base/error.h"

namespace lucerna::ui {
namespace {

/// Arguments of a verb, one letter each: n a number, t a text; after | they may be left out.
const std::map<std::string, std::string>& verbs() {
  static const std::map<std::string, std::string> list{
      {"wait", "n"},       {"wait_scene", ""},  {"wait_samples", "n"}, {"load", "t"},   {"set", "tt"},
      {"camera", "t"},     {"orbit", "nn"},     {"look", "nn"},        {"pan", "nn"},   {"dolly", "n"},
      {"fly", "nnn"},      {"frame", ""},       {"select", "tn"},      {"solo", "n"},   {"size", "nn"},
      {"tab", ""},         {"open_dialog", ""}, {"save_dialog", ""},   {"dismiss", ""}, {"pause", ""},
      {"resume", ""},      {"restart", ""},     {"reload", ""},        {"cancel", ""},  {"save", "t"},
      {"screenshot", "t"}, {"measure", "n"},    {"quit", "|n"}};
  return list;
}

std::vector<std::string> split(const std::string& line, const std::string& where) {
  std::vector<std::string> words;
  for (size_t i = 0; i < line.size();) {
    if (line[i] == ' ' || line[i] == '\t' || line[i] == '\r') {
      ++i;
    } else if (line[i] == '#') {
      break;
    } else if (line[i] == '"') {
      const size_t end = line.find('"', i + 1);
      if (end == std::string::npos) throw_error(where, "a quotation mark is not closed");
      words.push_back(line.substr(i + 1, end - i - 1));
      i = end + 1;
    } else {
      const size_t end = std::min(line.find_first_of(" \t\r", i), line.size());
      words.push_back(line.substr(i, end - i));
      i = end;
    }
  }
  return words;
}

double to_number(const std::string& text) {
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size() || !std::isfinite(value))
    return std::numeric_limits<double>::quiet_NaN();
  return value;
}

}  // namespace

std::vector<Step> parse_script(const std::vector<std::string>& lines, const std::string& name) {
  std::vector<Step> steps;
  for (size_t n = 0; n < lines.size(); ++n) {
    Step step;
    step.where = fmt::format("{}: line {}", name, n + 1);
    const std::vector<std::string> words = split(lines[n], step.where);
    if (words.empty()) continue;
    step.verb = words[0];
    const auto found = verbs().find(step.verb);
    if (found == verbs().end()) {
      std::vector<std::string> known;
      for (const auto& [verb, form] : verbs()) known.push_back(verb);
      throw_error(step.where, "unknown step '{}'; known are {}", step.verb, fmt::join(known, ", "));
    }
    std::string form = found->second;
    size_t least = std::min(form.find('|'), form.size());
    form.erase(std::remove(form.begin(), form.end(), '|'), form.end());
    if (words.size() - 1 < least || words.size() - 1 > form.size())
      throw_error(step.where, "'{}' takes {} argument{}, found {}", step.verb, form.size(),
                  form.size() == 1 ? "" : "s", words.size() - 1);
    for (size_t i = 1; i < words.size(); ++i) {
      step.text.push_back(words[i]);
      step.number.push_back(to_number(words[i]));
      if (form[i - 1] == 'n' && std::isnan(step.number.back()))
        throw_error(step.where, "'{}' expects a number, found '{}'", step.verb, words[i]);
    }
    steps.push_back(std::move(step));
  }
  return steps;
}

double percentile(std::vector<double> values, double p) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double at = std::clamp(p, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto below = static_cast<size_t>(at);
  const size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace lucerna::ui
