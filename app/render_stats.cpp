#include "app/render_stats.h"

#include <algorithm>

#include "base/error_sum.h"
#include "base/log.h"
#include "plan/facts_text.h"
#include "plan/plan.h"
#include "stats/forecast.h"

namespace lucerna::app {
namespace {

/// Errors of the picture, estimated from its halves (film/error.h): as seen, and of the mean; with each
/// component's share of the noise, and its bias where it is known to be zero.
nlohmann::ordered_json make_error(session::Renderer& r) {
  const film::ImageError error = r.image_error();
  nlohmann::ordered_json j;
  j["of"] = "sum";
  j["seen"] = error.seen_sum();
  j["of_mean"] = error.relative_sum();
  j["rms"] = error_sum(error.rms[0], error.lookup_noise_rms, error.interpolation_rms);
  j["white"] = error.white, j["dark"] = error.dark;
  const std::vector<film::TileError> tiles = r.progress().tile_errors();
  const auto write_tiles = [](nlohmann::ordered_json& to, const film::TileSpread& spread) {
    to["tile_median"] = spread.median;
    to["tile_worst_decile"] = spread.worst_tenth;
    to["tile_worst"] = spread.worst;
  };
  const film::TileSpread sum = film::tile_spread(tiles);
  write_tiles(j, sum);
  j["heavy_tailed_tiles"] = sum.heavy_tailed;
  // Tiles where photons are looked up and none has arrived.
  j["unknown_tiles"] = std::count_if(tiles.begin(), tiles.end(), [](const auto& t) { return t.unknown; });
  // The parts of the sum, by cause.
  const auto part = [&](const char* name, double seen, double of_mean, double rms,
                        double film::TileError::*of) {
    j[name] = {{"seen", seen}, {"of_mean", of_mean}, {"rms", rms}};
    write_tiles(j[name], film::tile_spread(tiles, of));
  };
  part("paths", error.seen(0), error.relative(0), error.rms[0], &film::TileError::relative);
  if (r.looks_up() && !r.progress().lookup_errors_known()) j["records"] = j["bias"] = nullptr;
  if (r.looks_up() && r.progress().lookup_errors_known()) {
    part("records", error.seen_lookup_noise, error.relative_lookup_noise(), error.lookup_noise_rms,
         &film::TileError::relative_lookup_noise);
    part("bias", error.seen_interpolation, error.relative_interpolation(), error.interpolation_rms,
         &film::TileError::relative_interpolation);
  }
  if (!r.progress().lookup_bias_estimated()) j["bias"] = nullptr;
  for (const int c : k_components) {
    auto& component = j["components"][paths::k_component_names[c]];
    component = {{"seen", error.seen(c + 1)},
                 {"share", error.share(c)},
                 {"of_mean", error.relative(c + 1)},
                 {"rms", error.rms[c + 1]},
                 {"bias", nullptr}};
    if (const auto bias = r.progress().bias(size_t(c))) component["bias"] = *bias;
  }
  return j;
}

double filtered_error(const film::ImageError& samples, const film::FilterError& filter) {
  return error_sum(filter.relative(), samples.relative_lookup_noise(), samples.relative_interpolation());
}

/// Errors of the filtered picture: its noise and bias, and the error of its lookups.
nlohmann::ordered_json make_filtered(session::Renderer& r, const session::Filtered& filtered) {
  const film::FilterError& f = filtered.error;
  const film::ImageError samples = r.image_error();
  nlohmann::ordered_json j;
  j["rms"] = error_sum(f.rms, samples.lookup_noise_rms, samples.interpolation_rms);
  j["of_mean"] = filtered_error(samples, f);
  j["filter"] = {{"rms", f.rms}, {"of_mean", f.relative()}};
  j["filter"]["tile_median"] = f.tile_median;
  j["filter"]["tile_worst_decile"] = f.tile_worst_tenth;
  j["ms"] = filtered.ms();
  return j;
}

/// Difference from the reference, without the reference's noise if its file states it.
nlohmann::ordered_json make_truth(const film::Reference& reference, const stats::Ledger& ledger) {
  nlohmann::ordered_json j;
  j["reference"] = reference.file.string();
  for (int k = 0; k < stats::k_layers; ++k) {
    auto& layer = j[stats::k_layer_names[k]];
    if (!ledger.entries().empty() && ledger.entries().back().truth)
      layer["of_mean"] = (*ledger.entries().back().truth)[k];
    if (reference.noise) layer["reference_noise"] = (*reference.noise)[k] / reference.mean_luminance;
  }
  return j;
}

/// Tiles above the target with the maximum of samples, the worst first.
std::vector<uint32_t> unreached(const schedule::AdaptiveSchedule& s) {
  std::vector<uint32_t> list;
  for (uint32_t t = 0; t < s.tiles().size(); ++t)
    if (const schedule::TileState state = s.tiles()[t].state;
        state != schedule::TileState::done && state != schedule::TileState::resting)
      list.push_back(t);
  std::sort(list.begin(), list.end(), [&](uint32_t a, uint32_t b) {
    const float ea = s.tiles()[a].sum(), eb = s.tiles()[b].sum();
    return ea != eb ? ea > eb : a < b;
  });
  return list;
}

/// The number of these that are limited by the error of lookups: more samples would hardly help.
size_t limited(const schedule::AdaptiveSchedule& s) {
  return size_t(std::count_if(s.tiles().begin(), s.tiles().end(),
                              [&](const schedule::Tile& t) { return t.limited(s.options().target_error); }));
}

nlohmann::ordered_json make_tiles(const schedule::AdaptiveSchedule& s) {
  using schedule::TileState;
  nlohmann::ordered_json j;
  j["side"] = s.options().tile;
  j["target_error"] = s.options().target_error;
  j["count"] = s.sampled_tiles();
  j["done"] = s.count(TileState::done);
  j["capped"] = s.count(TileState::capped);
  j["limited_by_lookups"] = limited(s);
  j["unfinished"] = s.count(TileState::active) + s.count(TileState::waiting);
  j["least_samples"] = s.least_samples();
  j["most_samples"] = s.most_samples();
  j["unreached"] = nlohmann::ordered_json::array();
  for (const uint32_t t : unreached(s)) {
    const schedule::Tile& tile = s.tiles()[t];
    j["unreached"].push_back({{"x", t % s.tiles_across() * s.options().tile},
                              {"y", t / s.tiles_across() * s.options().tile},
                              {"error", tile.sum()},
                              {"paths", tile.error},
                              {"records", tile.records},
                              {"bias", tile.interpolation},
                              {"samples", tile.samples}});
  }
  return j;
}

nlohmann::ordered_json make_ledger(const stats::Ledger& ledger) {
  auto list = nlohmann::ordered_json::array();
  for (const stats::Entry& e : ledger.entries()) {
    nlohmann::ordered_json j{{"wall_s", e.wall_s},         {"render_s", e.render_s}, {"device_s", e.device_s},
                             {"prepared_s", e.prepared_s}, {"paths", e.paths},       {"rays", e.rays},
                             {"samples", e.samples}};
    for (int k = 0; k < stats::k_layers; ++k) {
      if (e.has_error) j["seen"][stats::k_layer_names[k]] = e.error[k];
      if (e.has_error) j["of_mean"][stats::k_layer_names[k]] = e.of_mean.error[k];
      j["component_s"][stats::k_layer_names[k]] = e.component_s[k];
    }
    for (size_t l = 0; l < e.layers.size(); ++l)
      if (e.layers[l] > 0)
        j["seen"][ledger.layers()[l]] = e.layers[l], j["of_mean"][ledger.layers()[l]] = e.of_mean.layers[l];
    if (e.has_error)
      j["seen_records"] = e.records, j["seen_bias"] = e.interpolation, j["seen_total"] = e.sum(),
      j["seen_degrees"] = e.degrees, j["of_mean_records"] = e.of_mean.records,
      j["of_mean_bias"] = e.of_mean.interpolation, j["of_mean_total"] = e.of_mean.sum(),
      j["tile_median"] = e.tile_median, j["tile_worst_decile"] = e.tile_worst_tenth;
    if (e.truth)
      for (int k = 0; k < stats::k_layers; ++k) j["truth"][stats::k_layer_names[k]] = (*e.truth)[k];
    for (size_t l = 0; l < e.truth_of_layers.size(); ++l)
      if (e.truth_of_layers[l]) j["truth"][ledger.layers()[l]] = *e.truth_of_layers[l];
    if (e.total_rays) j["forecast_rays"] = {e.total_rays->low, e.total_rays->middle, e.total_rays->high};
    list.push_back(std::move(j));
  }
  return list;
}

/// Seconds to smaller errors, past or forecast, as [low, middle, high]; in uniform sampling. Empty without
/// enough data. Errors below the limit of lookups are listed separately.
nlohmann::ordered_json make_forecast(const stats::Ledger& ledger) {
  auto j = nlohmann::ordered_json::object();
  for (const double target : {0.05, 0.02, 0.01, 0.005}) {
    if (const auto band = stats::seconds_to(ledger, target))
      j["seconds_to"][fmt::format("{}", target)] = {band->low, band->middle, band->high};
    if (stats::paths_target(ledger, target) <= 0) j["limited_by_lookups"].push_back(target);
  }
  if (const stats::Outlook outlook(ledger); outlook.known()) j["exponent"] = outlook.exponent();
  return j;
}

}  // namespace

double filtered_error(session::Renderer& r, const session::Filtered& filtered) {
  return filtered_error(r.image_error(), filtered.error);
}

void report_unreached(const schedule::AdaptiveSchedule& s, const std::string& advice) {
  const std::vector<uint32_t> list = unreached(s);
  if (list.empty()) return;
  const schedule::Tile& worst = s.tiles()[list.front()];
  const size_t by_lookups = limited(s);
  if (by_lookups > 0)
    log::warning(
        "{} of {} tiles stay over the error of {} because of lookups; the worst has an error of {:.3f}, of "
        "which paths {:.3f}, at x {} y {}. More samples hardly help; {}",
        by_lookups, s.sampled_tiles(), s.options().target_error, worst.sum(), worst.error,
        list.front() % s.tiles_across() * s.options().tile,
        list.front() / s.tiles_across() * s.options().tile, advice);
  if (by_lookups == list.size()) return;
  log::warning(
      "{} of {} tiles are over the error of {}: {} with all of {} samples, {} not finished; the worst, "
      "{:.3f}, "
      "at x {} y {}. More samples: --set sampling.max_samples=N",
      list.size() - by_lookups, s.sampled_tiles(), s.options().target_error,
      s.count(schedule::TileState::capped) - by_lookups, s.options().max_samples,
      list.size() - s.count(schedule::TileState::capped), worst.sum(),
      list.front() % s.tiles_across() * s.options().tile, list.front() / s.tiles_across() * s.options().tile);
}

void report_unseen(session::Renderer& r) {
  constexpr double k_most = 0.5;
  const film::ImageError error = r.image_error();
  if (error.white + error.dark <= k_most) return;
  log::warning(
      "with film.ev={} {:.0f} % of the picture is white and {:.0f} % black: no error is visible there, and "
      "tiles stop early. Set the exposure of the finished picture (--set film.ev=EV), or let it be measured "
      "(--set film.exposure_at_load=always)",
      r.settings().text("film.ev"), 100 * error.white, 100 * error.dark);
}

nlohmann::ordered_json make_stats(session::Renderer& r, double wall) {
  const film::Image image = r.image();
  const auto means = film::Film::means(image);
  nlohmann::ordered_json j;
  j["version"] = LUCERNA_VERSION;
  j["scene"] = r.scene()->file;
  j["device"] = r.device().info().name;
  j["tracer"] = r.tracer_name();
  j["width"] = r.film().width();
  j["height"] = r.film().height();
  j["settings"] = nlohmann::ordered_json::parse(r.settings().changed_json());
  j["effects"] = plan::effects_json(r.facts(), plan::effects_off(r.settings()));
  j["wall_s"] = wall;
  j["load_s"] = r.load_seconds();
  j["compile_s"] = r.compile_seconds();
  if (const schedule::BalancedSchedule* s = r.sampling().balanced())
    j["samples"] = s->mean_samples();
  else
    j["samples"] = r.samples();
  j["paths"] = r.stats().paths;
  j["rays"] = r.stats().rays;
  j["shadow_rays"] = r.stats().shadow_rays;
  j["mrays_per_s"] = 1e-6 * double(r.stats().rays) / std::max(wall, 1e-9);
  j["dropped"] = r.stats().dropped;
  j["ended_by_roulette"] = r.stats().roulette;
  j["ended_by_depth"] = r.stats().depth;
  j["peak_host_mb"] = session::peak_host_mb();
  j["peak_device_mb"] = double(r.device().peak_bytes()) / (1 << 20);
  j["error"] = make_error(r);
  if (const session::Filtered* f = r.output().filtered()) j["filtered"] = make_filtered(r, *f);
  if (const film::Reference* reference = r.progress().reference())
    j["truth"] = make_truth(*reference, r.progress().ledger());
  if (r.sampling().adaptive()) j["tiles"] = make_tiles(*r.sampling().adaptive());
  j["ledger"] = make_ledger(r.progress().ledger());
  if (!r.sampling().adaptive()) j["forecast"] = make_forecast(r.progress().ledger());
  j.update(r.solvers().statistics());
  for (const auto& s : r.stats().stages)
    j["stages"].push_back({{"name", s.name}, {"ms", s.ms}, {"on", s.host ? "host" : "device"}});
  for (const int c : k_components) {
    const std::string name = paths::k_component_names[c];
    j["components"][name] = {{"solver", r.choices()[size_t(c)].solver},
                             {"mean_radiance", {means[c].x, means[c].y, means[c].z}},
                             {"ms", r.stats().component_ms[c]}};
    if (!r.choices()[size_t(c)].reason.empty())
      j["components"][name]["reason"] = r.choices()[size_t(c)].reason;
  }
  for (const session::LayerStatus& layer : r.layer_status(image)) {
    j["layers"][layer.name] = {{"expression", layer.expression},
                               {"mean_radiance", {layer.mean.x, layer.mean.y, layer.mean.z}},
                               {"share", layer.share}};
    if (layer.error) j["layers"][layer.name]["seen"] = *layer.error;
    if (layer.error_of_mean) j["layers"][layer.name]["of_mean"] = *layer.error_of_mean;
    if (!layer.lacks.empty()) j["layers"][layer.name]["lacks"] = layer.lacks;
  }
  return j;
}

}  // namespace lucerna::app
