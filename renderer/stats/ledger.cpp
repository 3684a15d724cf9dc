#include "stats/ledger.h"

#include <fmt/format.h>

#include <numeric>

namespace lucerna::stats {

const std::array<const char*, k_layers> k_layer_names = {"sum", "primary", "secondary", "tertiary",
                                                         "caustic"};

double Entry::share(int component) const {
  const double all = std::inner_product(error.begin() + 1, error.end(), error.begin() + 1, 0.0);
  const double own = error[static_cast<size_t>(component) + 1];
  return all > 0 ? own * own / all : 0;
}

void Ledger::add(const Entry& entry) {
  // The end of a render may come right after a line: it takes that line's place.
  if (!entries_.empty() && entries_.back().paths == entry.paths) entries_.pop_back();
  entries_.push_back(entry);
  ++changes_;
}

std::string Ledger::csv() const {
  std::string text = "wall_s,render_s,device_s,prepared_s,paths,rays,prepared_rays,samples";
  for (const char* what : {"seen", "of_mean", "truth", "device_s"})
    for (const char* layer : k_layer_names) text += fmt::format(",{}_{}", what, layer);
  text +=
      ",seen_records,seen_bias,seen_total,of_mean_records,of_mean_bias,of_mean_total,seen_median_tile,seen_"
      "worst_tenth_of_tiles,forecast_rays_low,forecast_rays,forecast_rays_high";
  for (const char* what : {"seen", "of_mean", "truth"})
    for (const std::string& layer : layers_) text += fmt::format(",{}_{}", what, layer);
  text += '\n';
  for (const Entry& e : entries_) {
    text += fmt::format("{},{},{},{},{},{},{},{}", e.wall_s, e.render_s, e.device_s, e.prepared_s, e.paths,
                        e.rays, e.prepared_rays, e.samples);
    for (const auto* errors : {&e.error, &e.of_mean.error})
      for (const double x : *errors) text += e.has_error ? fmt::format(",{}", x) : ",";
    for (int k = 0; k < k_layers; ++k) text += e.truth ? fmt::format(",{}", (*e.truth)[k]) : ",";
    for (const double x : e.component_s) text += fmt::format(",{}", x);
    text += e.has_error ? fmt::format(",{},{},{},{},{},{},{},{}", e.records, e.interpolation, e.sum(),
                                      e.of_mean.records, e.of_mean.interpolation, e.of_mean.sum(),
                                      e.tile_median, e.tile_worst_tenth)
                        : ",,,,,,,,";
    text += e.total_rays
                ? fmt::format(",{},{},{}", e.total_rays->low, e.total_rays->middle, e.total_rays->high)
                : ",,,";
    for (const auto* errors : {&e.layers, &e.of_mean.layers})
      for (size_t l = 0; l < layers_.size(); ++l)
        text +=
            e.has_error && l < errors->size() && (*errors)[l] > 0 ? fmt::format(",{}", (*errors)[l]) : ",";
    for (size_t l = 0; l < layers_.size(); ++l)
      text += l < e.truth_of_layers.size() && e.truth_of_layers[l] ? fmt::format(",{}", *e.truth_of_layers[l])
                                                                   : ",";
    text += '\n';
  }
  return text;
}

}  // namespace lucerna::stats
