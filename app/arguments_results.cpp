// lucerna compare, paths: what a render has written.
#include "app/arguments.h"
#include "app/verbs.h"

namespace lucerna::app {
namespace {

Verb add_compare(CLI::App& app) {
  const auto arguments = std::make_shared<CompareArguments>();
  CompareArguments& a = *arguments;
  CLI::App* verb = app.add_subcommand("compare", "compare two images");
  verb->add_option("A", a.a, "image")->required();
  verb->add_option("B", a.b, "reference")->required();
  verb->add_option("--layer", a.layer, "layer instead of R, G, B: primary, secondary, ...");
  verb->add_flag("--json", a.json, "as JSON");
  verb->add_option("--max-relmse", a.max_relmse,
                   "exit with 1 if the relative MSE is above this, or a value of any layer is not finite")
      ->check(finite() & CLI::Range(0.0, 1e300));
  return {verb, [arguments] { return compare(*arguments); }};
}

Verb add_paths(CLI::App& app) {
  const auto arguments = std::make_shared<PathsArguments>();
  PathsArguments& a = *arguments;
  CLI::App* verb = app.add_subcommand("paths", "search recorded paths (render --record-paths)");
  verb->add_option("FILE", a.file, "recorded paths (.lpath)")->required();
  verb->add_option("--where", a.where,
                   "only rows with FIELD == != < <= > >= VALUE, word ~ 'E[SG]*DL', joined by and, or, "
                   "not, ( )");
  verb->add_option("--group-by", a.group_by, "sums per value of this field");
  verb->add_flag("--csv", a.csv, "all rows, or sums, as CSV");
  verb->add_flag("--json", a.json, "all rows, or sums, as JSON");
  verb->add_option("--most", a.most, "rows of the table, the brightest first")->capture_default_str();
  return {verb, [arguments] { return search_paths(*arguments); }, describe_path_fields()};
}

}  // namespace

std::vector<Verb> add_result_verbs(CLI::App& app) { return {add_compare(app), add_paths(app)}; }

}  // namespace lucerna::app
