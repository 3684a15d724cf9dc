#include "session/picture_output.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/log.h"
#include "film/overlay.h"
#include "film/tile_scale.h"
#include "session/accuracy.h"
#include "session/picture_layers.h"
#include "shaders/shared/film.h"

namespace lucerna::session {

namespace {
/// They are drawn over the sheet.
film::View without_tiles(film::View v) {
  v.tiles = 0;
  return v;
}
}  // namespace

film::View PictureOutput::view() const {
  film::View v;
  v.layer = uint32_t(setup_.settings.choice("film.layer"));
  if (v.layer == shared::k_layer_first_own && setup_.engine)
    v.layer += setup_.engine->layers().index_of(setup_.settings.text("film.layer"));
  v.show = 0;
  for (const int c : k_components)
    if (setup_.settings.boolean(std::string("show.") + paths::k_component_names[c])) v.show |= 1u << c;
  v.curve = uint32_t(setup_.settings.choice("film.tone_curve"));
  v.exposure = float(std::exp2(setup_.settings.real("film.ev")));
  v.scale = 2 * setup_.world.flat.core_radius;
  v.heat = heat_scale(v.layer);
  if (setup_.settings.boolean("overlay.tiles")) v.tiles = setup_.tile_side();
  v.display_lut = ocio_ ? &ocio_->nodes : nullptr;
  v.tint_former = setup_.settings.boolean("overlay.former");
  return v;
}

film::HeatScale PictureOutput::heat_scale(uint32_t layer) const {
  if (layer == shared::k_layer_samples && sampling_.balanced())
    return film::sample_scale(0, std::max(2u, uint32_t(2 * sampling_.mean_samples())));
  if (layer == shared::k_layer_samples)
    return film::sample_scale(sampling_.adaptive() ? sampling_.adaptive()->options().min_samples : 0,
                              sampling_.max_samples());
  if (layer == shared::k_layer_error) return film::error_scale(setup_.settings.real("sampling.target_error"));
  double ms = 0;
  for (const auto& stage : stats().stages) ms += stage.ms;
  for (const auto& stage : progress_.prepared().stages) ms -= stage.ms;
  const auto seen = [](const transport::TransportStats& s) { return double(s.rays - s.shadow_rays); };
  return film::cost_scale(ms, seen(stats()) - seen(progress_.prepared()),
                          double(setup_.film->width()) * setup_.film->height(),
                          sampling_.adaptive() != nullptr);
}

void PictureOutput::mark_tiles(const film::View& v) {
  if (v.tiles == 0) return;
  std::vector<shared::TileMark> marks;
  for (const TileStatus& t : tile_status(setup_, sampling_, progress_, true))
    marks.push_back({film::tile_position(double{t.sum()}, setup_.settings.real("sampling.target_error")),
                     t.state | (t.heavy_tailed ? shared::k_tile_heavy : 0)});
  setup_.film->mark_tiles(marks);
}

bool PictureOutput::previewed(const film::View& v) const {
  // Samples from which the picture is shown unfiltered, whatever its noise.
  constexpr uint32_t k_previewed_samples = 256;
  return display_ && setup_.settings.text("preview.filter") == "auto" && !sampling_.done() &&
         sampling_.samples() < k_previewed_samples && display_->shows(v, *setup_.film);
}

bool PictureOutput::shows_the_same() const {
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

bool PictureOutput::remembers() const {
  return setup_.engine && setup_.film && previewed(view()) && display_->remembers();
}

std::vector<uint8_t> PictureOutput::shown_picture(bool with_coarse, const std::function<bool()>& cancel) {
  constexpr double k_little_filtered = 0.1;
  const film::View v = view();
  const bool quick = mix_.pending() && sampling_.samples() > 0 && setup_.film->quick() &&
                     v.layer == shared::k_layer_beauty && v.show == shared::k_all_components &&
                     v.tiles == 0 && !v.display_lut;
  // A drag is shown at display rate, with unfiltered samples. A sudden mix of other groups takes a little
  // longer if it would show noise in place of a filtered picture.
  if (quick && (mix_.dragged() || !previewed(v) || display_->shares().filtered < k_little_filtered)) {
    setup_.engine->developer().mix(setup_.engine->wavefront().stream(), *setup_.film, v);
    return overlays_.finish(v, cancel);
  }
  mix_.settle();
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
    display_->develop(*setup_.engine, picture_view(), *setup_.film, *setup_.coarse, v, sampling_.samples(),
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

std::vector<uint8_t> PictureOutput::picture(bool with_coarse, const std::function<bool()>& cancel) {
  mix_.settle();
  const film::View v = view();
  if (const Filtered* f = filtered(); f && shared::is_component_layer(v.layer))
    return picture_of(*f, v, cancel);
  mark_tiles(v);
  setup_.engine->developer().tone_map(setup_.engine->wavefront().stream(), *setup_.film, without_tiles(v),
                                      with_coarse ? setup_.coarse.get() : nullptr);
  return overlays_.finish(v, cancel);
}

std::vector<uint8_t> PictureOutput::picture_of(const Filtered& filtered, const film::View& v,
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
  const bool one = v.layer >= shared::k_layer_primary && shared::is_component_layer(v.layer);
  return one ? 1u << (v.layer - shared::k_layer_primary) : v.show;
}

std::vector<vec3> sum_of(const film::Image& image, uint32_t components) {
  std::vector<vec3> sum(image.samples.size(), vec3(0));
  for (size_t c = 0; c < image.components.size(); ++c)
    for (size_t i = 0; i < sum.size() && (components >> c & 1u); ++i) sum[i] += image.components[c][i];
  return sum;
}

}  // namespace

film::Brightness PictureOutput::measure(std::optional<vec2> at) const {
  if (!setup_.engine || !setup_.film) throw Error("", "there is no picture to measure");
  const film::Image image = sampling_.samples() > 0 ? setup_.film->read() : setup_.coarse->read();
  const auto sampled = [](uint32_t n) { return n > 0; };
  if (std::none_of(image.samples.begin(), image.samples.end(), sampled))
    throw Error("", "there is no picture to measure yet");
  // Layers that are no light have no exposure; the picture is measured then.
  const std::vector<vec3> sum = sum_of(image, shown_components(view()));
  if (at) return film::measure_point(sum, image.width, image.height, *at);
  const auto part = sampling_.only_region();
  if (!part) return film::measure_picture(sum, image.width, image.height);
  std::vector<vec3> inside;
  for (uint32_t i = 0; i < sum.size(); ++i)
    if (part->contains(i % image.width, i / image.width)) inside.push_back(sum[i]);
  return film::measure_picture(inside, part->right - part->left, part->bottom - part->top);
}

HeldPicture PictureOutput::held_picture() {
  if (!setup_.engine || sampling_.samples() == 0) throw Error("", "the picture has no sample yet");
  const film::View v = view();
  if (!shared::is_light_layer(v.layer))
    throw_error("", "the layer '{}' shows no light; choose beauty or a component",
                setup_.settings.text("film.layer"));
  mix_.settle();
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
  if (shared::is_own_layer(v.layer))
    held.light = setup_.film->read().layers.at(v.layer - shared::k_layer_first_own);
  else
    held.light = preview ? display_->shown_light(shown)
                         : sum_of((filtered ? *filtered->film : *setup_.film).read(), shown);
  held.filtered = filtered || preview;
  for (size_t c = 0; c < held.methods.size(); ++c)
    if (shown != shared::k_all_components && (shown >> c & 1u))
      held.shows += (held.shows.empty() ? "" : " + ") + std::string(paths::k_component_names[c]);
  if (held.filtered) {
    const film::PreviewShares shares = preview_shares();
    held.former = shares.stale;
    if (shares.error) held.shown_error = shares.error->median;
  }
  return held;
}

HeldPicture PictureOutput::described() const {
  HeldPicture held{.samples = double(stats().paths) / (double(setup_.film->width()) * setup_.film->height()),
                   .seconds = progress_.seconds(),
                   .ledger = progress_.ledger(),
                   .scene = setup_.world.scene->name,
                   .view = setup_.view_text()};
  for (size_t c = 0; c < held.methods.size(); ++c) held.methods[c] = setup_.engine->plan().choices[c].solver;
  if (sampling_.samples() >= 2) {
    const film::ImageError e = progress_.estimate_error();
    held.error = error_sum(e.seen(0), e.seen_lookup_noise, e.seen_interpolation);
  }
  return held;
}

film::FilmImage PictureOutput::film_image() {
  mix_.settle();
  return layers_of(setup_.film->read());
}

film::FilmImage PictureOutput::film_image_with_halves() {
  if (!setup_.engine || sampling_.samples() == 0) throw Error("", "the picture has no sample yet");
  mix_.settle();
  const film::Image image = setup_.film->read();
  film::FilmImage out = layers_of(image);
  add_noise_layers(out, setup_, image, !setup_.engine->solvers().empty());
  return out;
}

film::FilmImage PictureOutput::layers_of(const film::Image& image) const {
  film::FilmImage out = picture_layers(setup_, image);
  // In the window the rest has samples too.
  if (const auto part = sampling_.only_region())
    out.window = {part->left, part->top, part->right, part->bottom};
  out.metadata["device"] = context_.device.info().name;
  out.metadata["tracer"] = setup_.tracer_name();
  const film::ImageError error = progress_.estimate_error();
  std::vector<std::pair<std::string, double>> of_layers;
  for (size_t l = 0; l < error.layers.size(); ++l)
    of_layers.emplace_back(setup_.engine->layers().layers().at(l).name, error.layers[l].rms);
  out.metadata["noise"] = film::noise_text(error.rms, of_layers);
  describe(described(), out.metadata);
  if (const Filtered* f = filtered()) add_filtered_layers(out, *f);
  return out;
}

void PictureOutput::save(const std::filesystem::path& file, bool as_shown) {
  if (!setup_.engine) throw Error(file.string(), "nothing to save yet; load a scene first");
  const std::string extension = file.extension().string();
  if (extension == ".exr")
    film::write_exr(file, film_image());
  else if (extension == ".png") {
    // The inspected place is not saved.
    const Overlays::Mode mode = overlays_.mode();
    overlays_.set_mode({});
    mix_.settle();
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

PictureOutput::WindowParts PictureOutput::make_window_parts(bool again) const {
  WindowParts parts;
  if (!context_.interactive || (display_ && !again)) return parts;
  parts.display = std::make_unique<Display>(context_.device, context_.compiler);
  if (!window_filter_) parts.filter = std::make_unique<WindowFilter>(context_.device, context_.compiler);
  return parts;
}

void PictureOutput::adopt(WindowParts parts) noexcept {
  if (!parts.display) return;
  display_ = std::move(parts.display), shown_ = {};
  if (window_filter_) window_filter_->reset_kernels();
  if (parts.filter) window_filter_ = std::move(parts.filter);
}

void PictureOutput::mixed() {
  forget_filtered();
  if (display_) display_->mixed();
}

bool PictureOutput::keep_former(const std::vector<vec3>* factors) {
  if (!display_) return false;
  transport::Wavefront& wavefront = setup_.engine->wavefront();
  // Groups with different factors are a new mix of the present picture.
  if (factors) {
    std::vector<vec3> weights = setup_.relight.weights;
    for (size_t g = 0; g < weights.size(); ++g) weights[g] *= (*factors)[g];
    setup_.film->set_mix(weights);
    wavefront.mix(*setup_.film);
  }
  const Filtered* filtered = shown_.filtered && !factors ? window_filter_->result() : nullptr;
  // The root: of single pixels' bias about half is left in means over 3x3, as bench latency measures.
  return display_->take(wavefront.stream(), filtered ? *filtered->film : *setup_.film,
                        filtered ? std::sqrt(filtered->error.over_noise) : 1);
}

bool PictureOutput::restart(const scene::Changes& changes, const vec3& scale, bool same_light, float doubt,
                            uint64_t light, uint64_t now) {
  return display_ ? display_->restart(changes, scale, same_light, doubt, light, now) : same_light;
}

void PictureOutput::worked(double seconds) {
  if (!display_) return;
  display_->plan().worked(seconds);
  if (sampling_.samples() == 0) return;
  display_->warm(setup_.engine->wavefront().stream(), *setup_.film);
  setup_.engine->developer().prepare_mix(setup_.engine->wavefront().stream(), *setup_.film, view());
}

}  // namespace lucerna::session
