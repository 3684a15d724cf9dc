#include "session/display.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "schedule/uniform.h"

namespace lucerna::session {

namespace {

/// Samples of every pixel from which a preview sample, with its larger pixels, adds nothing.
constexpr uint32_t k_draft_until = 4;

}  // namespace

bool Display::restart(const scene::Changes& changes, const vec3& scale, bool same_light, float doubt,
                      uint64_t light, uint64_t now) {
  const auto is = [&](scene::Change c) { return changes.edits.contains(c); };
  const bool repainted =
      is(scene::Change::colour) || is(scene::Change::material) || is(scene::Change::shaders);
  if (repainted || changes.other_surfaces()) sight_.forget();
  if (changes.other_surfaces() || is(scene::Change::size))
    preview_.forget();
  else
    preview_.keep(scale, repainted, same_light, doubt, light);
  const bool returned = !same_light && preview_.put_back(now);
  plan_.restart();
  former_is_preview_ = false;
  ++version_;
  return same_light || returned;
}

bool Display::take(gpu::Stream& stream, const film::Film& film, double noise) {
  bool taken = false;
  ++version_;
  if (plain_ && film::Preview::fits(device_.info().limits, film.width(), film.height())) try {
      preview_.take(stream, film, plain_->shown, plain_->camera, float(noise),
                    sight_.surfaces(plain_->camera, film.width(), film.height()));
      taken = true;
    } catch (const Error&) {
      preview_.forget();  // no memory: the next picture starts without history
    }
  plain_.reset();
  return taken;
}

void Display::plain(const Engine& engine, const PictureView& view, const film::View& shown) {
  shares_ = {};
  plain_.reset();
  // A layer of its own scale, or of some paths, is no picture to go on from; the last developed one is.
  if (!shared::is_component_layer(shown.layer)) return;
  plain_ = {preview_camera(engine.frame(view, view.width, view.height)), shown};
}

void Display::show_filtered(gpu::Stream& stream, const film::Film& film, const film::FilterError& error,
                            const film::View& shown) {
  filtered_error_ = film::ShownError{error.tile_median, error.tile_worst_tenth};
  if (!film::Preview::fits(device_.info().limits, film.width(), film.height())) return;
  try {
    filtered_error_ = preview_.show_filtered(stream, film, error.luminances, error.pixels, shown);
  } catch (const Error&) {
    stream.discard();  // no memory: the filter's own estimate stays
  }
}

void Display::judge_filtered(gpu::Stream& stream, const film::Film& film) {
  if (const auto error = preview_.judge_filtered(stream, film)) filtered_error_ = error;
}

void Display::warm(gpu::Stream& stream, const film::Film& film) {
  if (developed_ && !std::exchange(warm_, true)) preview_.warm(stream, film);
}

void Display::light_changed() {
  preview_.better();
  former_is_preview_ = true;
  plan_.light_changed();
  ++version_;
}

void Display::mixed() {
  preview_.forget();
  plan_.light_changed();
  ++version_;
}

bool Display::draw(DraftPlan::Next what, Engine& engine, const PictureView& view, film::Film& coarse,
                   const std::function<bool()>& cancel) {
  ++version_;
  if (what == DraftPlan::Next::sight) return sight_.see(engine, view, cancel);
  const bool fine = what == DraftPlan::Next::fine;
  const uint32_t step = fine ? shared::k_preview_step : shared::k_coarse_step;
  if (fine) {
    const uint32_t width = std::max(1u, view.width / step), height = std::max(1u, view.height / step);
    if (!fine_ || fine_->width() != width || fine_->height() != height)
      fine_ = std::make_unique<film::Film>(device_, width, height);
  }
  film::Film& film = fine ? *fine_ : coarse;
  transport::Wavefront& wavefront = engine.wavefront();
  const uint32_t before = fine ? plan_.fine_samples() : plan_.coarse_samples();
  if (before == 0) film.clear(wavefront.stream());
  film.set_mix(view.mix);
  shared::Frame frame = engine.draft_frame(view, film.width(), film.height());
  frame.most_branches = 1;  // the number of samples matters more than their quality
  wavefront.set_frame(frame, engine.enabled());
  schedule::UniformSchedule schedule(film.blocks(), 1, wavefront.slots());
  bool complete = true;
  const auto look_up_preview = [&](bool on) {
    for (const auto& solver : engine.solvers())
      if (auto* lookups = solvers::offered<solvers::PreviewLookups>(*solver))
        lookups->look_up_preview(wavefront, on);
  };
  const auto rays = [&] { return wavefront.stats().rays + wavefront.stats().shadow_rays; };
  if (!fine && before == 0) coarse_rays_ = 0;
  look_up_preview(true);
  wavefront.uncounted([&] {
    const uint64_t rays_before = rays();
    while (complete && !schedule.done()) {
      schedule::WorkItem item = schedule.next();
      for (shared::WorkBlock& block : item.blocks) block.first_sample += before;
      complete = wavefront.run(item, film, cancel);
    }
    if (!fine) coarse_rays_ += rays() - rays_before;
  });
  look_up_preview(false);
  wavefront.set_frame(engine.frame(view, view.width, view.height), engine.enabled());
  return complete;
}

bool Display::shows(const film::View& view, const film::Film& film) const {
  return shared::is_component_layer(view.layer) &&
         film::Preview::fits(device_.info().limits, film.width(), film.height());
}

void Display::develop(Engine& engine, const PictureView& view, const film::Film& film,
                      const film::Film& coarse, const film::View& shown, uint32_t samples, bool begun) {
  plain_.reset();
  developed_ = true;
  const film::Film* draft = plan_.shows_fine() ? fine_.get() : plan_.coarse_samples() > 0 ? &coarse : nullptr;
  if (samples >= k_draft_until) draft = nullptr;
  const film::Sampled sampled = samples > 0 ? film::Sampled::all
                                : begun     ? film::Sampled::some
                                            : film::Sampled::none;
  const film::PreviewCamera camera = preview_camera(engine.frame(view, view.width, view.height));
  if (!draft && sampled == film::Sampled::none && preview_.has_history()) {
    gpu::Stream& stream = engine.wavefront().stream();
    std::optional<PixelSight::Coarse> seen;
    if (preview_.recalls_on(camera)) seen = sight_.see_coarse(engine, view);
    if (seen)
      preview_.recall_on(stream, film, shown, camera, *seen->surfaces, seen->width, seen->height);
    else
      preview_.recall(stream, film, shown, camera);
    shares_ = {.stale = 1};
    return;
  }
  // While the camera moves, a picture without known surfaces would be a poor source of the next ones.
  if (draft && sampled == film::Sampled::none && preview_.recalls_on(camera))
    while (sight_.wanted(engine, view)) sight_.see(engine, view, {});
  shares_ = preview_.develop(engine.wavefront().stream(), film, draft, shown, camera, true, sampled,
                             sight_.surfaces(engine, view));
}

}  // namespace lucerna::session
