// The verb paths: searches files of recorded paths, without a renderer.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "app/verbs.h"
#include "base/error.h"
#include "base/json_text.h"
#include "recording/file.h"
#include "recording/query.h"

namespace lucerna::app {
namespace {

using recording::Field;
using recording::Row;

/// Columns of a list of rows.
constexpr const char* k_columns[] = {"x",    "y",     "sample", "component", "event",
                                     "word", "depth", "light",  "material",  "contribution",
                                     "red",  "green", "blue"};

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

void print_line(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) line += (line.empty() ? "" : ",") + csv_cell(cell);
  std::fputs((line + "\n").c_str(), stdout);
}

std::vector<std::string> cells_of(const Row& row) {
  std::vector<std::string> cells;
  for (const char* name : k_columns) cells.push_back(recording::text_of(*recording::find_field(name), row));
  return cells;
}

nlohmann::ordered_json json_of(const Row& row) {
  nlohmann::ordered_json object;
  for (const char* name : k_columns) {
    const Field& field = *recording::find_field(name);
    if (field.number)
      object[name] = field.number(row);
    else
      object[name] = recording::text_of(field, row);
  }
  return object;
}

struct Sum {
  uint64_t rows = 0;
  double light = 0;
};

/// What was found, as the arguments ask for it.
class Findings {
 public:
  explicit Findings(const PathsArguments& a)
      : arguments_(a), group_(a.group_by.empty() ? nullptr : recording::find_field(a.group_by)) {
    if (group_ || a.group_by.empty()) return;
    std::vector<std::string> known;
    for (const Field& f : recording::fields()) known.push_back(f.name);
    throw Error("--group-by", fmt::format("'{}': expected one of {}", a.group_by, fmt::join(known, ", ")));
  }

  void begin() const {
    if (arguments_.csv && !group_) print_line({std::begin(k_columns), std::end(k_columns)});
  }
  void add(const Row& row) {
    const double light =
        recording::contributes_light(row.at()) ? double(luminance(row.at().contribution)) : 0;
    ++found_.rows, found_.light += light;
    if (group_) {
      Sum& sum = groups_[recording::text_of(*group_, row)];
      ++sum.rows, sum.light += light;
    } else if (arguments_.csv) {
      print_line(cells_of(row));
    } else if (arguments_.json) {
      rows_.push_back(json_of(row));
    } else {
      keep(row);
    }
  }
  void end(const Sum& all, uint64_t paths) {
    if (group_)
      print_groups();
    else if (arguments_.json)
      std::puts(json_text(nlohmann::ordered_json(rows_), 2).c_str());
    else if (!arguments_.csv)
      print_table();
    if (arguments_.csv || arguments_.json) return;
    std::printf("%llu of %llu rows, %.3g %% of the recorded light, %llu paths\n",
                static_cast<unsigned long long>(found_.rows), static_cast<unsigned long long>(all.rows),
                all.light > 0 ? 100 * found_.light / all.light : 0.0, static_cast<unsigned long long>(paths));
  }

 private:
  /// Keeps the brightest rows.
  void keep(const Row& row) {
    const auto less = [](const auto& a, const auto& b) { return a.first > b.first; };
    const double light = double(luminance(row.at().contribution));
    if (brightest_.size() >= arguments_.most && (arguments_.most == 0 || brightest_.front().first >= light))
      return;
    if (brightest_.size() >= arguments_.most) {
      std::pop_heap(brightest_.begin(), brightest_.end(), less);
      brightest_.pop_back();
    }
    brightest_.emplace_back(light, cells_of(row));
    std::push_heap(brightest_.begin(), brightest_.end(), less);
  }

  void print_table() {
    std::stable_sort(brightest_.begin(), brightest_.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<std::vector<std::string>> lines{{std::begin(k_columns), std::end(k_columns)}};
    for (auto& [light, cells] : brightest_) lines.push_back(std::move(cells));
    print_aligned(lines);
  }

  void print_groups() const {
    std::vector<std::pair<std::string, Sum>> order(groups_.begin(), groups_.end());
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return a.second.light > b.second.light; });
    const auto share = [&](const Sum& s) { return found_.light > 0 ? s.light / found_.light : 0; };
    if (arguments_.json) {
      nlohmann::ordered_json all = nlohmann::ordered_json::array();
      for (const auto& [name, sum] : order)
        all.push_back(
            {{arguments_.group_by, name}, {"rows", sum.rows}, {"light", sum.light}, {"share", share(sum)}});
      std::puts(json_text(all, 2).c_str());
      return;
    }
    std::vector<std::vector<std::string>> lines{{arguments_.group_by, "rows", "light", "share"}};
    for (const auto& [name, sum] : order)
      lines.push_back(
          {name, std::to_string(sum.rows), fmt::format("{:.6g}", sum.light),
           arguments_.csv ? fmt::format("{:.6g}", share(sum)) : fmt::format("{:.2f} %", 100 * share(sum))});
    if (arguments_.csv)
      for (const auto& cells : lines) print_line(cells);
    else
      print_aligned(lines);
  }

  static void print_aligned(const std::vector<std::vector<std::string>>& lines) {
    std::vector<size_t> width(lines[0].size(), 0);
    for (const auto& cells : lines)
      for (size_t i = 0; i < cells.size(); ++i) width[i] = std::max(width[i], cells[i].size());
    for (const auto& cells : lines) {
      std::string line;
      for (size_t i = 0; i < cells.size(); ++i) line += fmt::format("{:<{}}  ", cells[i], width[i]);
      line.erase(line.find_last_not_of(' ') + 1);
      std::puts(line.c_str());
    }
  }

  const PathsArguments& arguments_;
  const Field* group_;
  Sum found_;
  std::map<std::string, Sum> groups_;
  std::vector<nlohmann::ordered_json> rows_;
  std::vector<std::pair<double, std::vector<std::string>>> brightest_;
};

}  // namespace

std::string describe_path_fields() {
  std::string text =
      "\nFields for --where and --group-by; each row is an event that contributes light, or a blocked light "
      "sample:\n";
  for (const Field& f : recording::fields()) text += fmt::format("  {:<14}{}\n", f.name, f.help);
  return text;
}

int search_paths(const PathsArguments& a) {
  if (a.csv && a.json) throw Error("--csv", "give --csv or --json, not both");
  const recording::Query query(a.where);
  Findings findings(a);
  recording::Reader reader(a.file);
  findings.begin();
  // With a bound on places, only the paths there are read.
  const std::optional<Box> places = query.places();
  while (const auto chunk = reader.next(places))
    recording::visit_rows(*chunk, [&](const Row& row) {
      if (query(row)) findings.add(row);
    });
  findings.end({reader.rows(), reader.light()}, reader.paths());
  return 0;
}

}  // namespace lucerna::app
