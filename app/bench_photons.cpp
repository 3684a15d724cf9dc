// The cost of photons and the decrease of their errors.
#include <algorithm>
#include <bit>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/bench_progress.h"
#include "app/interrupt.h"
#include "app/verbs.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/log.h"
#include "base/timer.h"
#include "bench/machine.h"
#include "bench/photons.h"
#include "gpu/device.h"

namespace lucerna::app {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

int bench_photons(const BenchPhotonsArguments& a) {
  const Timer timer;
  bench::PhotonBenchOptions options = a.options;
  options.device = a.device;
  options.scenes = fs::path(LUCERNA_SOURCE_DIR) / "scenes";
  if (!std::has_single_bit(options.rounds))
    throw_error("--rounds", "'{}': expected a power of two, such as 256", options.rounds);
  const fs::path path = a.report;
  const bench::Machine machine = bench::this_machine();
  const double load = std::max(0.0, bench::load_average());
  Json device;
  {
    const gpu::Device chosen({options.device, false});
    device = {{"name", chosen.info().name}, {"driver", chosen.info().driver}};
  }
  const Json identity{{"version", LUCERNA_VERSION}, {"device", device["name"]}, {"processor", machine.cpu}};
  const bench::ReportFolder folder(path, bench::to_json(options), identity, {"units"});
  double before = 0;
  if (file_exists(path / "report.json"))
    if (const Json old = Json::parse(read_file(path / "report.json"), nullptr, false); old.is_object())
      before = old.value("wall_s", 0.0);

  const Interrupt interrupt;
  ProgressLine line(a.quiet);
  log::set_console_level(log::Level::error);
  const std::optional<Json> measured =
      bench::measure_photons(options, folder,
                             {.interrupted = [&] { return interrupt.signal() != 0; },
                              .progress = [&](const bench::Status& s) { line.show(s); },
                              .message = [&](const std::string& text) { line.message(text); }});
  line.clear();
  if (!measured) {
    line.message(fmt::format(
        "interrupted; finished parts are kept in {}: the same command continues with them", path.string()));
    return interrupt.signal() ? interrupt.status() : 1;
  }
  Json report{{"bench", "photons"},
              {"version", LUCERNA_VERSION},
              {"date", bench::now_utc()},
              {"command", a.command},
              {"wall_s", before + timer.seconds()},
              {"machine",
               {{"cpu", machine.cpu},
                {"cores", machine.cores},
                {"memory_gib", machine.memory_gib},
                {"system", machine.system},
                {"load", load}}},
              {"device", device}};
  for (const auto& [part, found] : measured->items()) report[part] = found;
  const std::string text = bench::photons_text(report);
  write_file(path / "report.json", json_text(report, 1) + "\n");
  write_file(path / "report.txt", text);
  write_file(path / "report.html", bench::photons_page(report));
  std::printf("%s%s\n", text.c_str(), (path / "report.html").c_str());
  return 0;
}

}  // namespace lucerna::app
