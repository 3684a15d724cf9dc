#include "session/image_progress.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "base/log.h"
#include "stats/forecast.h"

namespace lucerna::session {
namespace {

/// Those in a rectangle of blocks, of what lies in a grid of cells with `side` blocks along each side.
template <class T>
std::vector<T> inside(std::span<const T> cells, const schedule::Rectangle& blocks, uint32_t across,
                      uint32_t side) {
  std::vector<T> found;
  for (uint32_t i = 0; i < cells.size(); ++i)
    if (blocks.contains(i % across * side, i / across * side)) found.push_back(cells[i]);
  return found;
}

}  // namespace

void ImageProgress::restart() {
  ledger_.clear();
  clock_.reset();
  render_s_ = prepared_s_ = 0;
  prepared_ = {};
}

void ImageProgress::note_prepared() { prepared_s_ = clock_.seconds(), prepared_ = stats(); }

film::ImageError ImageProgress::estimate_error() const {
  transport::Wavefront& wavefront = setup_.engine->wavefront();
  setup_.engine->estimator().estimate(wavefront.stream(), *setup_.film, setup_.seen_range());
  wavefront.account_stages();
  const film::Film& film = *setup_.film;
  const auto of_region = [&](auto summary, std::span<const shared::BlockError> all) {
    return sampling_.whole() ? summary(all)
                             : summary(inside(all, sampling_.region(), film.blocks_across(), 1));
  };
  film::ImageError error = of_region(film::image_error, film.errors());
  for (uint32_t first = 0; first < film.layers(); first += shared::k_error_layers) {
    const auto some = of_region(film::layer_errors, film.layer_errors(first));
    error.layers.insert(error.layers.end(), some.begin(), some.end());
  }
  error.layers.resize(film.layers());
  return error;
}

std::vector<float> ImageProgress::block_squares() const {
  estimate_error();
  std::vector<float> squares;
  for (const shared::BlockError& b : setup_.film->errors())
    squares.push_back(b.pixels > 0 ? b.seen[0] / b.pixels : 0.0f);
  return squares;
}

std::vector<film::TileError> ImageProgress::tile_errors() const {
  const uint32_t side = setup_.tile_side();
  std::vector<film::TileError> tiles = film::tile_errors(*setup_.film, side);
  film::mark_heavy_tails(tiles, (setup_.film->width() + side - 1) / side, setup_.seen_range().floor);
  return tiles;
}

bool ImageProgress::lookup_errors_known() const {
  return setup_.engine && sampling_.samples() >= 2 && !setup_.engine->owing_errors(*setup_.film);
}

bool ImageProgress::lookup_bias_estimated() const {
  if (!setup_.engine) return false;
  return std::all_of(setup_.engine->solvers().begin(), setup_.engine->solvers().end(),
                     [](const auto& solver) {
                       const auto* bias = solvers::offered<solvers::LookupBias>(*solver);
                       return !bias || bias->estimates_bias();
                     });
}

std::optional<double> ImageProgress::bias(size_t component) const {
  if (!setup_.engine) return std::nullopt;
  // Paths compute all primary light if the scene has nothing of the part that another solver looks up.
  if (component == 0 && setup_.engine->plan().solver[0] && !setup_.engine->looks_up_direct_light())
    return 0.0;
  return setup_.engine->plan().bias(component);
}

void ImageProgress::set_reference(const std::filesystem::path& file) {
  if (!setup_.engine) throw Error(file.string(), "a reference is of a scene; load the scene first");
  film::Reference reference = film::read_reference(file, setup_.width, setup_.height);
  if (!reference.scene.empty() && reference.scene != setup_.world.scene->name)
    throw_error(file.string(), "the reference is of the scene '{}', not of '{}'", reference.scene,
                setup_.world.scene->name);
  if (!reference.view.empty() && reference.view != setup_.view_text())
    throw_error(file.string(), "the reference was taken with another camera ({}; now {})", reference.view,
                setup_.view_text());
  if (!reference.noise) log::warning("{}: its own noise is unknown and counts as error", file.string());
  if (reference.seed == setup_.settings.text("seed"))
    log::warning(
        "{}: rendered with seed {} like this picture. Both share samples, so the measured error is too "
        "small; use another seed",
        file.string(), reference.seed);
  reference_ = std::move(reference);
}

bool ImageProgress::reference_applies() const {
  return reference_ && setup_.engine && reference_->width == setup_.width &&
         reference_->height == setup_.height &&
         (reference_->scene.empty() || reference_->scene == setup_.world.scene->name) &&
         (reference_->view.empty() || reference_->view == setup_.view_text());
}

ByComponent<double> ImageProgress::component_ms_a_sample() const {
  ByComponent<double> each{};
  const double samples = double(stats().paths) / (double(setup_.film->width()) * setup_.film->height());
  for (size_t c = 0; samples > 0 && c < each.size(); ++c)
    each[c] = (stats().component_ms[c] - prepared_.component_ms[c]) / samples;
  return each;
}

void ImageProgress::note(bool at_once) {
  const transport::TransportStats& s = stats();
  if (s.paths == 0 || !(at_once || ledger_.due(s.paths, uint64_t{setup_.width} * setup_.height))) return;
  std::vector<std::string> names;
  for (const paths::Layer& layer : setup_.engine->layers().layers()) names.push_back(layer.name);
  ledger_.name_layers(std::move(names));
  stats::Entry entry;
  entry.wall_s = clock_.seconds();
  entry.render_s = render_s_;
  entry.prepared_s = prepared_s_;
  entry.prepared_rays = prepared_.rays;
  for (const auto& stage : s.stages) entry.device_s += 1e-3 * stage.ms;
  entry.paths = s.paths;
  entry.rays = s.rays;
  entry.samples = sampling_.whole() ? double(s.paths) / (double(setup_.film->width()) * setup_.film->height())
                                    : sampling_.samples();
  entry.component_s[0] = entry.device_s;
  for (const int c : k_components) entry.component_s[c + 1] = 1e-3 * s.component_ms[c];
  entry.has_error = sampling_.samples() >= 2;
  if (entry.has_error) {
    const film::ImageError error = estimate_error();
    for (int k = 0; k < stats::k_layers; ++k)
      entry.error[k] = error.seen(k), entry.of_mean.error[k] = error.relative(k);
    const std::vector<uint32_t>& unknown = setup_.engine->layers_unknown();
    for (size_t l = 0; l < error.layers.size(); ++l) {
      const bool known = l < unknown.size() && unknown[l] == 0;
      entry.layers.push_back(known ? error.layers[l].seen_rms : 0);
      entry.of_mean.layers.push_back(known ? error.relative(error.layers[l]) : 0);
    }
    entry.records = error.seen_lookup_noise, entry.interpolation = error.seen_interpolation;
    entry.degrees = error.seen_degrees;
    entry.of_mean.records = error.relative_lookup_noise();
    entry.of_mean.interpolation = error.relative_interpolation();
    std::vector<film::TileError> of_tiles = film::tile_errors(*setup_.film, setup_.tile_side());
    const uint32_t side = setup_.tile_side() / shared::k_block;
    if (!sampling_.whole())
      of_tiles = inside<film::TileError>(of_tiles, sampling_.region(),
                                         (setup_.film->blocks_across() + side - 1) / side, side);
    const film::TileSpread tiles = film::tile_spread(of_tiles);
    entry.tile_median = tiles.median, entry.tile_worst_tenth = tiles.worst_tenth;
  }
  if (reference_applies()) {
    const film::Image image = setup_.film->read();
    entry.truth = film::true_errors(*reference_, image.components, image.samples);
    for (size_t l = 0; l < image.layers.size(); ++l)
      entry.truth_of_layers.push_back(
          film::true_error(*reference_, ledger_.layers()[l], image.layers[l], image.samples));
  }
  entry.total_rays = total_rays();
  ledger_.add(entry);
}

std::optional<stats::Band> ImageProgress::total_rays() const {
  const schedule::AdaptiveSchedule* schedule = sampling_.adaptive();
  if (!schedule) return std::nullopt;
  std::vector<stats::TileProgress> tiles;
  for (uint32_t t = 0; t < schedule->tiles().size(); ++t) {
    const schedule::Tile& tile = schedule->tiles()[t];
    tiles.push_back(
        {.error = tile.error,
         .goal = tile.goal(schedule->options().target_error),
         .samples = double(tile.samples),
         .pixels = 64.0 * double(schedule->blocks_of(t).size()),
         .open = tile.state == schedule::TileState::waiting || tile.state == schedule::TileState::active,
         .earlier_error = tile.earlier.error,
         .earlier_samples = double(tile.earlier.samples)});
  }
  const schedule::AdaptiveOptions& o = schedule->options();
  const std::optional<stats::Band> paths =
      stats::total_paths(tiles, schedule->tiles_across(), o.target_error, o.min_samples, o.max_samples);
  if (!paths) return std::nullopt;
  const double before = double(prepared_.rays),
               each = (double(stats().rays) - before) / double(stats().paths);
  return stats::Band{before + each * paths->low, before + each * paths->middle, before + each * paths->high};
}

}  // namespace lucerna::session
