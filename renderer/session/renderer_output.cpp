// The picture for display and files.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

#include "base/log.h"
#include "film/io/ocio.h"
#include "film/overlay.h"
#include "film/tile_scale.h"
#include "session/accuracy.h"
#include "session/picture_layers.h"
#include "session/renderer.h"
#include "shaders/shared/film.h"

namespace lucerna::session {

namespace {
/// They are drawn over the sheet.
film::View without_tiles(film::View v) {
  v.tiles = 0;
  return v;
}
}  // namespace

film::View Renderer::view() const {
  film::View v;
  v.layer = uint32_t(setup_.settings.choice("film.layer"));
  v.show = 0;
  for (int c = 0; c < paths::k_component_count; ++c)
    if (setup_.settings.boolean(std::string("show.") + paths::k_component_names[c])) v.show |= 1u << c;
  v.curve = uint32_t(setup_.settings.choice("film.tone_curve"));
  v.exposure = float(std::exp2(setup_.settings.real("film.ev")));
  v.scale = 2 * setup_.world.flat.core_radius;
  v.heat = heat_scale(v.layer);
  if (setup_.settings.boolean("overlay.tiles")) v.tiles = tile_side();
  v.display_lut = ocio_ ? &ocio_->nodes : nullptr;
  v.tint_former = setup_.settings.boolean("overlay.former");
  return v;
}

std::shared_ptr<const Renderer::OcioTable> Renderer::ocio_table(const plan::Settings& settings) const {
  const std::string& text = settings.text("film.ocio");
  if (text.empty()) return nullptr;
  const std::shared_ptr<const film::OcioConfig> config = film::ocio_config();
  if (!config)
    throw_error("film.ocio",
                "'{}': the environment variable OCIO names no configuration (export OCIO=FILE.ocio)", text);
  const std::string of = config->file() + ": " + text;
  if (ocio_ && ocio_->of == of) return ocio_;
  const auto [display, view] = config->split(text);
  const std::vector<vec4> nodes = config->table(display, view);
  OcioTable table{of,
                  gpu::Buffer(*device_, {.name = "display and view",
                                         .bytes = nodes.size() * sizeof(vec4),
                                         .memory = gpu::Memory::host}),
                  config->white(display, view)};
  table.nodes.write(nodes.data(), nodes.size() * sizeof(vec4));
  if (!config->source_is_rec709())
    log::warning("{}: names no linear Rec.709; radiance is taken as '{}'", config->file(), config->source());
  return std::make_shared<const OcioTable>(std::move(table));
}

void Renderer::show_by(std::shared_ptr<const OcioTable> ocio) {
  ocio_ = std::move(ocio);
  setup_.ocio_white = ocio_ ? ocio_->white : 0;
}

film::HeatScale Renderer::heat_scale(uint32_t layer) const {
  if (layer == shared::k_layer_samples)
    return film::sample_scale(adaptive() ? adaptive()->options().min_samples : 0, max_samples());
  if (layer == shared::k_layer_error) return film::error_scale(setup_.settings.real("sampling.target_error"));
  double ms = 0;
  for (const auto& stage : stats().stages) ms += stage.ms;
  for (const auto& stage : progress_.prepared().stages) ms -= stage.ms;
  const auto seen = [](const transport::TransportStats& s) { return double(s.rays - s.shadow_rays); };
  return film::cost_scale(ms, seen(stats()) - seen(progress_.prepared()),
                          double(setup_.film->width()) * setup_.film->height(), adaptive() != nullptr);
}

void Renderer::mark_tiles(const film::View& v) {
  if (v.tiles == 0) return;
  std::vector<shared::TileMark> marks;
  for (const TileStatus& t : tile_status(*this, true))
    marks.push_back({film::tile_position(double{t.sum()}, setup_.settings.real("sampling.target_error")),
                     t.state | (t.heavy_tailed ? shared::k_tile_heavy : 0)});
  setup_.film->mark_tiles(marks);
}

bool Renderer::previewed(const film::View& v) const {
  // Samples from which the picture is shown unfiltered, whatever its noise.
  constexpr uint32_t k_previewed_samples = 256;
  return display_ && setup_.settings.text("preview.filter") == "auto" && !done() &&
         samples() < k_previewed_samples && display_->shows(v, *setup_.film);
}

bool Renderer::shows_the_same() const {
  const auto draws = [&](const OptionInfo& option) {
    return option.key.starts_with("overlay.") && setup_.settings.text(option.key) != option.fallback;
  };
  if (!setup_.engine || !setup_.film || overlays_.mode().inspected || overlays_.shown_paths().of ||
      shown_.version != display_->version())
    return false;
  const Filtered* f = shown_filtered(view());
  const bool same = f ? shown_.filtered && shown_.paths == f->paths
                      : previewed(view()) && !shown_.filtered && shown_.paths == stats().paths;
  return same && std::none_of(plan::options().begin(), plan::options().end(), draws);
}

bool Renderer::remembers() const {
  return setup_.engine && setup_.film && previewed(view()) && display_->remembers();
}

std::vector<uint8_t> Renderer::shown_picture(bool with_coarse, const std::function<bool()>& cancel) {
  constexpr double k_little_filtered = 0.1;
  const film::View v = view();
  const bool quick = mix_pending_ && samples() > 0 && setup_.film->quick() &&
                     v.layer == shared::k_layer_beauty && v.show == (1u << paths::k_component_count) - 1 &&
                     v.tiles == 0 && !v.display_lut;
  // A drag is shown at display rate, with unfiltered samples. A sudden mix of other groups takes a little
  // longer if it would show noise in place of a filtered picture.
  if (quick && (mix_dragged_ || !previewed(v) || display_->shares().filtered < k_little_filtered)) {
    setup_.engine->developer().mix(setup_.engine->wavefront().stream(), *setup_.film, v);
    return overlays_.finish(v, cancel);
  }
  settle_mix();
  if (const Filtered* f = shown_filtered(v)) {
    display_->plain(*setup_.engine, picture_view(), v);
    shown_ = {display_->version(), f->paths, true};
    return picture_of(*f, v, cancel);
  }
  if (!previewed(v)) {
    if (display_) display_->plain(*setup_.engine, picture_view(), v);
    return picture(with_coarse, cancel);
  }
  mark_tiles(v);
  try {
    shown_ = {display_->version(), stats().paths, false};
    display_->develop(*setup_.engine, picture_view(), *setup_.film, *setup_.coarse, v, samples(),
                      stats().paths > 0);
  } catch (const Error& e) {
    setup_.engine->wavefront().stream().discard();
    // The picture does not need it.
    log::warning("{}; the window shows the samples as they are", e.what());
    setup_.settings.set("preview.filter", "off");
    return picture(with_coarse, cancel);
  }
  return overlays_.finish(v, cancel);
}

std::vector<uint8_t> Renderer::picture(bool with_coarse, const std::function<bool()>& cancel) {
  settle_mix();
  const film::View v = view();
  if (const Filtered* f = filtered(); f && v.layer < shared::k_layer_albedo) return picture_of(*f, v, cancel);
  mark_tiles(v);
  setup_.engine->developer().tone_map(setup_.engine->wavefront().stream(), *setup_.film, without_tiles(v),
                                      with_coarse ? setup_.coarse.get() : nullptr);
  return overlays_.finish(v, cancel);
}

std::vector<uint8_t> Renderer::picture_of(const Filtered& filtered, const film::View& v,
                                          const std::function<bool()>& cancel) {
  mark_tiles(v);
  gpu::Stream& stream = setup_.engine->wavefront().stream();
  setup_.engine->developer().tone_map(stream, *filtered.film, without_tiles(v));
  stream.copy(filtered.film->picture(), setup_.film->picture(), filtered.film->picture().bytes());
  stream.run();
  return overlays_.finish(v, cancel);
}

namespace {

/// Components (bits) of the light that a view shows: without hidden ones; a layer is one component.
uint32_t shown_components(const film::View& v) {
  const bool one = v.layer >= shared::k_layer_primary && v.layer < shared::k_layer_albedo;
  return one ? 1u << (v.layer - shared::k_layer_primary) : v.show;
}

std::vector<vec3> sum_of(const film::Image& image, uint32_t components) {
  std::vector<vec3> sum(image.samples.size(), vec3(0));
  for (size_t c = 0; c < image.components.size(); ++c)
    for (size_t i = 0; i < sum.size() && (components >> c & 1u); ++i) sum[i] += image.components[c][i];
  return sum;
}

}  // namespace

film::Brightness Renderer::measure(std::optional<vec2> at) const {
  if (!setup_.engine || !setup_.film) throw Error("", "there is no picture to measure");
  const film::Image image = samples() > 0 ? setup_.film->read() : setup_.coarse->read();
  const auto sampled = [](uint32_t n) { return n > 0; };
  if (std::none_of(image.samples.begin(), image.samples.end(), sampled))
    throw Error("", "there is no picture to measure yet");
  // Layers that are no light have no exposure; the picture is measured then.
  const std::vector<vec3> sum = sum_of(image, shown_components(view()));
  if (at) return film::measure_point(sum, image.width, image.height, *at);
  const auto part = options_.interactive ? std::nullopt : region();
  if (!part) return film::measure_picture(sum, image.width, image.height);
  std::vector<vec3> inside;
  for (uint32_t i = 0; i < sum.size(); ++i)
    if (part->contains(i % image.width, i / image.width)) inside.push_back(sum[i]);
  return film::measure_picture(inside, part->right - part->left, part->bottom - part->top);
}

HeldPicture Renderer::held_picture() {
  if (!setup_.engine || samples() == 0) throw Error("", "the picture has no sample yet");
  const film::View v = view();
  if (v.layer >= shared::k_layer_albedo)
    throw_error("", "the layer '{}' shows no light; choose beauty or a component",
                setup_.settings.text("film.layer"));
  settle_mix();
  const uint32_t shown = shown_components(v);
  const uint32_t width = setup_.film->width(), height = setup_.film->height();
  const Filtered* filtered = shown_filtered(v);
  bool preview = !filtered && previewed(v);
  if (preview) {
    // Of the present samples; if that fails, previews are off from now on.
    shown_picture(true);
    preview = previewed(v);
  }
  HeldPicture held = described();
  held.width = width, held.height = height;
  held.light = preview ? display_->shown_light(shown)
                       : sum_of((filtered ? *filtered->film : *setup_.film).read(), shown);
  held.filtered = filtered || preview;
  for (size_t c = 0; c < held.methods.size(); ++c)
    if (shown != (1u << paths::k_component_count) - 1 && (shown >> c & 1u))
      held.shows += (held.shows.empty() ? "" : " + ") + std::string(paths::k_component_names[c]);
  if (held.filtered) {
    const film::PreviewShares shares = preview_shares();
    held.former = shares.stale;
    if (shares.error) held.shown_error = shares.error->median;
  }
  return held;
}

HeldPicture Renderer::described() {
  HeldPicture held{.samples = double(stats().paths) / (double(setup_.film->width()) * setup_.film->height()),
                   .seconds = seconds(),
                   .ledger = ledger(),
                   .scene = setup_.world.scene->name,
                   .view = setup_.view_text()};
  for (size_t c = 0; c < held.methods.size(); ++c) held.methods[c] = choices()[c].solver;
  if (samples() >= 2) {
    const film::ImageError e = image_error();
    held.error = error_sum(e.seen(0), e.seen_lookup_noise, e.seen_interpolation);
  }
  return held;
}

film::FilmImage Renderer::film_image() {
  settle_mix();
  film::FilmImage out = picture_layers(setup_);
  // In the window the rest has samples too.
  if (const auto part = options_.interactive ? std::nullopt : region())
    out.window = {part->left, part->top, part->right, part->bottom};
  out.metadata["device"] = device_->info().name;
  out.metadata["tracer"] = tracer_name();
  out.metadata["noise"] = film::noise_text(image_error().rms);
  describe(described(), out.metadata);
  if (const Filtered* f = filtered()) add_filtered_layers(out, *f);
  return out;
}

film::FilmImage Renderer::film_image_with_halves() {
  if (!setup_.engine || samples() == 0) throw Error("", "the picture has no sample yet");
  film::FilmImage out = film_image();
  add_noise_layers(out, *setup_.film, looks_up());
  return out;
}

void Renderer::save(const std::filesystem::path& file, bool as_shown) {
  if (!setup_.engine) throw Error(file.string(), "nothing to save yet; load a scene first");
  const std::string extension = file.extension().string();
  if (extension == ".exr")
    film::write_exr(file, film_image());
  else if (extension == ".png") {
    // The inspected place is not saved.
    const Overlays::Mode mode = overlays_.mode();
    overlays_.set_mode({});
    settle_mix();
    const std::vector<uint8_t> shown = as_shown ? shown_picture(false) : picture(false);
    overlays_.set_mode(mode);
    std::map<std::string, std::string> metadata;
    if (const Filtered* f = as_shown ? shown_filtered(view()) : filtered())
      metadata["filter"] = filter_text(f->error);
    if (ocio_) metadata["ocio"] = ocio_->of;
    film::write_png(file, setup_.film->width(), setup_.film->height(), shown, metadata);
  } else
    throw_error(file.string(), "cannot write '{}' files; use .exr or .png", extension);
}

double peak_host_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) / 1024;
  return 0;
}

}  // namespace lucerna::session
