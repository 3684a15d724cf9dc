// Progress of a render: ledger, reference, cost by component.
#include <utility>

#include "base/log.h"
#include "session/renderer.h"
#include "stats/forecast.h"

namespace lucerna::session {

std::string Renderer::view_text() const {
  std::string text = camera_.orthographic
                         ? fmt::format("orthographic {:.5g} {:.5g}", camera_.xmag, camera_.ymag)
                         : fmt::format("perspective {:.5g}", camera_.yfov);
  text += fmt::format(" aspect {:.5g} at", camera_.aspect);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) text += fmt::format(" {:.5g}", camera_.to_world[column][row] + 0.0f);
  if (camera_.shift != vec2(0)) text += fmt::format(" shift {:.5g} {:.5g}", camera_.shift.x, camera_.shift.y);
  if (const scene::Section& cut = camera_.section; cut.cuts())
    text += fmt::format(" section {:.5g} {:.5g} {:.5g} at {:.5g}", cut.normal.x, cut.normal.y, cut.normal.z,
                        cut.offset);
  if (const scene::Lens& lens = camera_.lens; !camera_.orthographic && lens.f_number != 0)
    text += fmt::format(" lens f/{:.5g} focus {:.5g} blades {} rotation {:.5g}", lens.f_number,
                        lens.focus_distance, lens.blades, lens.blades == 0 ? 0 : lens.rotation);
  return text;
}

void Renderer::set_reference(const std::filesystem::path& file) {
  if (!engine_) throw Error(file.string(), "a reference is of a scene; load the scene first");
  film::Reference reference = film::read_reference(file, width_, height_);
  if (!reference.scene.empty() && reference.scene != world_.scene->name)
    throw_error(file.string(), "the reference is of the scene '{}', not of '{}'", reference.scene,
                world_.scene->name);
  if (!reference.view.empty() && reference.view != view_text())
    throw_error(file.string(), "the reference was taken with another camera ({}; now {})", reference.view,
                view_text());
  if (!reference.noise) log::warning("{}: its own noise is unknown and counts as error", file.string());
  if (reference.seed == settings_.text("seed"))
    log::warning(
        "{}: rendered with seed {} like this picture. Both share samples, so the measured error is too "
        "small; use another seed",
        file.string(), reference.seed);
  reference_ = std::move(reference);
}

bool Renderer::reference_applies() const {
  return reference_ && engine_ && reference_->width == width_ && reference_->height == height_ &&
         (reference_->scene.empty() || reference_->scene == world_.scene->name) &&
         (reference_->view.empty() || reference_->view == view_text());
}

std::array<double, shared::k_component_count> Renderer::component_ms_a_sample() const {
  std::array<double, shared::k_component_count> each{};
  const double samples = double(stats().paths) / (double(film_->width()) * film_->height());
  for (size_t c = 0; samples > 0 && c < each.size(); ++c)
    each[c] = (stats().component_ms[c] - prepared_.component_ms[c]) / samples;
  return each;
}

void Renderer::note_progress(bool at_once) {
  const transport::TransportStats& s = stats();
  if (s.paths == 0 || !(at_once || ledger_.due(s.paths, uint64_t{width_} * height_))) return;
  stats::Entry entry;
  entry.wall_s = clock_.seconds();
  entry.render_s = render_s_;
  entry.prepared_s = prepared_s_;
  entry.prepared_rays = prepared_.rays;
  for (const auto& stage : s.stages) entry.device_s += 1e-3 * stage.ms;
  entry.paths = s.paths;
  entry.rays = s.rays;
  entry.samples = double(s.paths) / (double(film_->width()) * film_->height());
  entry.component_s[0] = entry.device_s;
  for (int c = 0; c < paths::k_component_count; ++c) entry.component_s[c + 1] = 1e-3 * s.component_ms[c];
  entry.has_error = samples() >= 2;
  if (entry.has_error) {
    const film::ImageError error = image_error();
    for (int k = 0; k < stats::k_layers; ++k)
      entry.error[k] = error.seen(k), entry.of_mean.error[k] = error.relative(k);
    entry.records = error.seen_records, entry.interpolation = error.seen_interpolation;
    entry.degrees = error.seen_degrees;
    entry.of_mean.records = error.relative_records();
    entry.of_mean.interpolation = error.relative_interpolation();
    const film::TileSpread tiles = film::tile_spread(film::tile_errors(*film_, tile_side()));
    entry.tile_median = tiles.median, entry.tile_worst_tenth = tiles.worst_tenth;
  }
  if (reference_applies()) {
    const film::Image image = film_->read();
    entry.truth = film::true_errors(*reference_, image.components, image.samples);
  }
  if (const schedule::AdaptiveSchedule* schedule = adaptive()) {
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
    const double before = double(prepared_.rays), each = (double(s.rays) - before) / double(s.paths);
    if (paths)
      entry.total_rays =
          stats::Band{before + each * paths->low, before + each * paths->middle, before + each * paths->high};
  }
  ledger_.add(entry);
}

}  // namespace lucerna::session
