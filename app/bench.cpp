#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "app/bench_progress.h"
#include "app/interrupt.h"
#include "app/verbs.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/timer.h"
#include "bench/auto_verdict.h"
#include "bench/compare_reports.h"
#include "bench/machine.h"
#include "bench/page.h"
#include "bench/program.h"
#include "bench/report.h"
#include "bench/runner.h"
#include "gpu/device.h"

namespace lucerna::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

class Listening {
 public:
  explicit Listening(std::function<void(log::Level, const std::string&)> hear)
      : token_(log::add_listener(std::move(hear))) {}
  ~Listening() { log::remove_listener(token_); }
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;

 private:
  int token_;
};

bench::Matrix choose_matrix(const BenchArguments& a) {
  if (a.built_in.size() + size_t(!a.matrix.empty()) != 1) {
    std::string names;
    for (const bench::BuiltinInfo& info : bench::builtin_matrices()) names += " or --" + info.name;
    throw_error("bench", "name one matrix: a MATRIX.json{} (see lucerna bench --help)", names);
  }
  bench::Matrix m = a.matrix.empty()
                        ? bench::builtin_matrix(a.built_in[0], fs::path(LUCERNA_SOURCE_DIR) / "scenes")
                        : bench::read_matrix(a.matrix);
  if (a.repeats > 0) m.repeats = a.repeats;
  return m;
}

/// The report of an earlier run into the same folder; null if there is none, or an incomplete file.
Json earlier_report(const fs::path& folder) {
  if (!file_exists(folder / "report.json")) return {};
  try {
    return bench::read_report(folder);
  } catch (const Error&) {
    return {};
  }
}

/// Adds a hash of each setting's program, so a folder is not continued with another build.
void add_programs(const bench::Matrix& matrix, Json& identity) {
  for (const bench::Setting& setting : matrix.settings) {
    if (setting.program.empty() || identity.contains(setting.program)) continue;
    const std::string bytes = read_file(setting.program);
    Hash hash;
    hash.add_bytes(bytes.data(), bytes.size());
    identity[setting.program] = fmt::format("build {:016x}", hash.low());
  }
}

int run(const BenchArguments& a, const bench::Matrix& matrix) {
  const Timer timer;
  const fs::path path = a.report;
  const bench::Machine machine = bench::this_machine();
  const double load = bench::load_average();
  Json device, identity;
  {
    const gpu::Device chosen({a.device, false});
    device = {{"name", chosen.info().name}, {"driver", chosen.info().driver}};
    identity = {{"version", LUCERNA_VERSION}, {"device", chosen.info().name}, {"processor", machine.cpu}};
  }
  add_programs(matrix, identity);
  const bench::Folder folder(path, matrix, identity);
  const Json before = earlier_report(path);

  const Interrupt interrupt;
  ProgressLine line(a.quiet);
  const bench::Hooks hooks{.interrupted = [&] { return interrupt.signal() != 0; },
                           .progress = [&](const bench::Status& s) { line.show(s); },
                           .message = [&](const std::string& text) { line.message(text); }};
  // A scene is loaded for every render; each of its warnings is printed once.
  log::set_console_level(log::Level::error);
  std::set<std::string> warned;
  const Listening listening([&](log::Level level, const std::string& text) {
    if (level == log::Level::warning && warned.insert(text).second) line.message(text);
  });
  const bench::RunOptions options{
      .device = a.device,
      .references = a.references.empty() ? path / "references" : fs::path(a.references),
      .scenes = a.scenes};
  const bench::RunSummary summary = bench::run_matrix(matrix, folder, options, hooks);
  line.clear();

  Json about{{"version", LUCERNA_VERSION},
             {"date", bench::now_utc()},
             {"command", a.command},
             {"wall_s", timer.seconds() + (before.is_object() ? before.value("wall_s", 0.0) : 0)},
             {"machine",
              {{"cpu", machine.cpu},
               {"cores", machine.cores},
               {"memory_gib", machine.memory_gib},
               {"system", machine.system},
               {"load", std::max(0.0, load)}}},
             {"device", device}};
  const size_t total = matrix.cells().size();
  // If nothing was measured the figures are computed again, but the report keeps its date.
  if (summary.measured == 0 && before.is_object())
    for (auto& [key, value] : about.items())
      if (before.contains(key)) value = before.at(key);
  bench::write_report(path, bench::make_report(matrix, summary, about));
  if (!summary.complete) {
    line.message(
        fmt::format("interrupted; {} of {} renders are kept in {}: the same command continues with them",
                    summary.results.size(), total, path.string()));
    return interrupt.signal() ? interrupt.status() : 1;
  }
  if (summary.measured == 0)
    line.message(fmt::format(
        "all {} renders exist already; name another folder with --report to measure again", total));
  for (const std::string& found : bench::findings(bench::read_report(path)))
    std::printf("%s\n", found.c_str());
  std::printf("%s", bench::auto_verdict(bench::read_report(path)).c_str());
  std::printf("%s\n", (path / "report.html").c_str());
  return 0;
}

}  // namespace

int bench_matrix(const BenchArguments& a) {
  if (!a.compare.empty()) {
    const Json before = bench::read_report(a.compare[0]), after = bench::read_report(a.compare[1]);
    std::printf("%s", bench::compare_reports(before, after).c_str());
    return 0;
  }
  if (!a.page.empty()) {
    const Json report = bench::read_report(a.page);
    write_file(fs::path(a.page) / "report.html", bench::make_page(report, fs::path(a.page) / "pictures"));
    std::printf("%s\n", (fs::path(a.page) / "report.html").c_str());
    return 0;
  }
  return run(a, choose_matrix(a));
}

int bench_interiors(const BenchInteriorsArguments& a) {
  bench::InteriorsOptions options = a.options;
  options.own = fs::path(LUCERNA_SOURCE_DIR) / "scenes";
  std::error_code code;
  options.program = fs::read_symlink("/proc/self/exe", code);
  if (code) throw_error("/proc/self/exe", "cannot be read: {}", code.message());
  std::string help;
  if (!options.against.empty()) {
    const bench::ProgramResult other = bench::run_program(options.against, {"render", "--help"}, {});
    if (other.status != 0 || other.text.find("components.secondary") == std::string::npos)
      throw_error("--against", "'{}': expected another lucerna", options.against.string());
    help = other.text;
  }
  std::vector<std::string> left_out;
  const bench::Matrix matrix = bench::interiors_matrix(options, help, left_out);
  if (!left_out.empty())
    std::fprintf(stderr, "lucerna: %s does not support %s; these settings have no counterpart\n",
                 options.against.c_str(), fmt::format("{}", fmt::join(left_out, ", ")).c_str());
  BenchArguments renders;
  static_cast<VerbArguments&>(renders) = a;
  renders.report = a.report, renders.references = a.references, renders.quiet = a.quiet;
  return run(renders, matrix);
}

}  // namespace lucerna::app
