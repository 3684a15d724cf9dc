// The report as files.
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/json_text.h"
#include "bench/page.h"
#include "bench/report.h"

namespace lucerna::bench {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string make_csv(const Json& report) {
  std::string text =
      "scene,setting,budget,repeat,seed,tracer,wall_s,device_s,setup_s,rays,paths,samples,mse,relmse,relmse_"
      "all,seen,seen_all,"
      "in_reference_noise,tiles_median,tiles_decile,tiles_worst,heavy_tiles,tiles_over,records,"
      "record_rays,paths_error,records_error,interpolation_error";
  for (const char* what : {"estimated", "true", "device_s"})
    for (const char* layer : stats::k_layer_names) text += fmt::format(",{}_{}", what, layer);
  text += ",forecast_s,forecast_rays\n";
  for (const Json& entry : report.at("results")) {
    const Result r = result_from_json(entry, "results");
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
                        r.scene, r.setting, r.budget, r.repeat, r.seed, r.tracer, r.wall_s, r.device_s,
                        r.setup_s, r.rays, r.paths, r.samples, r.mse, r.relmse, r.relmse_all, r.seen,
                        r.seen_all, int(r.in_reference_noise), r.tiles.median, r.tiles.decile, r.tiles.worst,
                        r.tiles.heavy, r.tiles.over, r.records, r.record_rays, r.parts.paths, r.parts.records,
                        r.parts.interpolation);
    for (const Layers* layers : {&r.estimated, &r.truth, &r.component_s})
      for (const double x : *layers) text += fmt::format(",{}", x);
    text +=
        r.forecast ? fmt::format(",{},{}\n", r.forecast->seconds.middle, r.forecast->rays.middle) : ",,\n";
  }
  return text;
}

void write_report(const fs::path& folder, const Json& report) {
  write_file(folder / "report.json", json_text(report, 1) + "\n");
  write_file(folder / "report.csv", make_csv(report));
  write_file(folder / "report.html", make_page(report, folder / "pictures"));
}

Json read_report(const fs::path& file_or_folder) {
  const fs::path file = is_folder(file_or_folder) ? file_or_folder / "report.json" : file_or_folder;
  Json report = Json::parse(read_file(file), nullptr, false);
  if (report.is_discarded()) throw_error(file.string(), "not JSON, perhaps half a file");
  if (!report.is_object() || report.value("what", "") != "lucerna bench" || !report.contains("scenes"))
    throw_error(file.string(), "no report of lucerna bench");
  if (report.value("format", 0) != 1) throw_error(file.string(), "a report of another version of the bench");
  return report;
}

}  // namespace lucerna::bench
