#include "script.h"

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "base/file.h"

namespace lucerna::ui {

std::vector<Step> parse_script(const commands::Registry& registry, const std::vector<std::string>& lines,
                               const std::string& name) {
  std::vector<Step> steps;
  for (size_t n = 0; n < lines.size(); ++n) {
    Step step{lines[n], fmt::format("{}: line {}", name, n + 1)};
    if (registry.parse(step.line, step.where).command) steps.push_back(std::move(step));
  }
  return steps;
}

std::vector<std::string> read_script(const std::string& file) {
  if (file.empty()) throw Error("script", "expected a file name, found ''");
  const std::string text = read_file(file);
  if (text.find('\0') != std::string::npos)
    throw Error(file, "is not a text file; expected a script, one command per line");
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
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
