#include "stats/ledger.h"

#include <fmt/format.h>

namespace lucerna::stats {

const std::array<const char*, k_layers> k_layer_names = {"sum", "primary", "secondary", "tertiary",
                                                         "caustic"};

void Ledger::add(const Entry& entry) {
  // The end of a render may come right after a line: it takes that line's place.
  if (!entries_.empty() && entries_.back().paths == entry.paths) entries_.pop_back();
  entries_.push_back(entry);
  ++changes_;
}

std::string Ledger::csv() const {
  std::string text = "wall_s,render_s,device_s,prepared_s,paths,rays,prepared_rays,samples";
  for (const char* what : {"error", "truth", "device_s"})
    for (const char* layer : k_layer_names) text += fmt::format(",{}_{}", what, layer);
  text +=
      ",error_records,error_bias,error_told,error_median_tile,error_worst_tenth_of_tiles,forecast_"
      "rays_low,forecast_rays,forecast_rays_high\n";
  for (const Entry& e : entries_) {
    text += fmt::format("{},{},{},{},{},{},{},{}", e.wall_s, e.render_s, e.device_s, e.prepared_s, e.paths,
                        e.rays, e.prepared_rays, e.samples);
    for (const double x : e.error) text += e.told ? fmt::format(",{}", x) : ",";
    for (int k = 0; k < k_layers; ++k) text += e.truth ? fmt::format(",{}", (*e.truth)[k]) : ",";
    for (const double x : e.component_s) text += fmt::format(",{}", x);
    text += e.told ? fmt::format(",{},{},{},{},{}", e.records, e.interpolation, e.sum(), e.tile_median,
                                 e.tile_worst_tenth)
                   : ",,,,,";
    text += e.total_rays
                ? fmt::format(",{},{},{}\n", e.total_rays->low, e.total_rays->middle, e.total_rays->high)
                : ",,,\n";
  }
  return text;
}

}  // namespace lucerna::stats
