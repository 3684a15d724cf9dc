#include "session/overlays.h"

#include <algorithm>

#include "base/log.h"
#include "solvers/registry.h"

namespace lucerna::session {

void Overlays::set_mode(const Mode& mode) {
  mode_ = mode;
  if (!setup_.engine) return;
  for (const auto& solver : setup_.engine->solvers())
    if (auto* views = solvers::offered<solvers::Views>(*solver)) views->look_at(mode.inspected);
}

void Overlays::inspect(std::optional<vec2> at) {
  Mode mode = mode_;
  mode.inspected = at;
  set_mode(mode);
}

void Overlays::set_window_scale(uint32_t scale) {
  Mode mode = mode_;
  mode.scale = std::max(1u, scale);
  set_mode(mode);
}

bool Overlays::are_on() const {
  if (!setup_.engine || !setup_.film) return false;
  const auto on = [&](const OptionInfo& option) {
    const solvers::SolverInfo* owner = solvers::owner_of(option.key);
    return option.key.starts_with("overlay.") && owner && setup_.engine->find(owner->name) &&
           setup_.settings.text(option.key) != option.fallback;
  };
  return mode_.inspected || paths_shown_.of || LightsView::shown(setup_.settings) ||
         FocusView::shown(setup_.settings) || std::any_of(plan::options().begin(), plan::options().end(), on);
}

overlay::Sheet& Overlays::sheet() {
  if (!sheet_) {
    sheet_ = std::make_unique<overlay::Sheet>(context_.device, context_.compiler);
    fit(1);
  }
  return *sheet_;
}

void Overlays::fit(uint32_t scale) {
  const uint64_t pixels = uint64_t{setup_.width} * setup_.height;
  while (scale > 1 && pixels * scale * scale > overlay::Sight::k_most_points) --scale;
  sheet().fit(*setup_.film, scale, setup_.engine->frame(view(), scale * setup_.width, scale * setup_.height));
}

void Overlays::forget_surfaces() {
  if (sheet_) sheet_->forget();
}

bool Overlays::waits() { return !fails_ && are_on() && !sheet().surfaces_known() && sheet().can_trace(); }

void Overlays::trace(const std::function<bool()>& cancel) {
  if (!waits()) return;
  Engine& engine = *setup_.engine;
  transport::Wavefront& wavefront = engine.wavefront();
  fit(scale());
  try {
    sheet().trace(wavefront, *setup_.film, engine.enabled(), engine.defines(), cancel);
  } catch (const Error& e) {
    wavefront.stream().discard();
    sheet().forget();
    fails_ = true;
    log::warning("{}; overlays follow the samples of the picture", e.what());
  }
  wavefront.set_frame(engine.frame(view(), setup_.width, setup_.height), engine.enabled());
}

std::vector<uint8_t> Overlays::finish(const film::View& shown, const std::function<bool()>& cancel) {
  fit(are_on() || shown.tiles > 0 ? mode_.scale : 1);
  if (mode_.complete) trace(cancel);
  gpu::Stream& stream = setup_.engine->wavefront().stream();
  sheet().enlarge(stream, *setup_.film);
  setup_.engine->developer().draw_tiles(stream, *setup_.film, shown, sheet().picture(*setup_.film), scale());
  visit_solvers(
      [](solvers::Solver& solver, const overlay::Canvas& canvas, const solvers::Picture& picture) {
        if (auto* views = solvers::offered<solvers::Views>(solver)) views->draw(canvas, picture);
      },
      cancel);
  draw_lights(cancel);
  draw_focus(cancel);
  draw_paths(cancel);
  if (scale() == 1) return setup_.film->read_picture();
  std::vector<uint8_t> pixels(uint64_t{setup_.width} * setup_.height * scale() * scale() * 4);
  sheet().picture(*setup_.film).read(pixels.data(), pixels.size());
  return pixels;
}

void Overlays::visit_solvers(const Visit& f, const std::function<bool()>& cancel) {
  if (!setup_.engine || !setup_.film) return;
  fit(scale());
  const overlay::Canvas canvas{setup_.engine->wavefront(), *setup_.film, *setup_.coarse, sheet(), cancel};
  for (const auto& solver : setup_.engine->solvers())
    setup_.engine->with(*solver, view(),
                        [&](const solvers::Picture& picture) { f(*solver, canvas, picture); });
}

void Overlays::draw_lights(const std::function<bool()>& cancel) {
  if (!setup_.engine || !setup_.film || !LightsView::shown(setup_.settings)) {
    if (lights_) lights_->forget();
    return;
  }
  if (!lights_) lights_ = std::make_unique<LightsView>(context_.device, context_.compiler);
  Engine& engine = *setup_.engine;
  lights_->draw({engine.wavefront(), *setup_.film, *setup_.coarse, sheet(), cancel},
                engine.wavefront().learning(), setup_.world.flat,
                engine.frame(view(), setup_.film->width(), setup_.film->height()), *setup_.world.scene,
                setup_.settings, mode_.inspected);
}

void Overlays::draw_focus(const std::function<bool()>& cancel) {
  if (!setup_.engine || !setup_.film || !FocusView::shown(setup_.settings)) {
    if (focus_) focus_->forget();
    return;
  }
  if (!focus_) focus_ = std::make_unique<FocusView>(context_.device, context_.compiler);
  Engine& engine = *setup_.engine;
  focus_->draw({engine.wavefront(), *setup_.film, *setup_.coarse, sheet(), cancel},
               engine.frame(view(), setup_.film->width(), setup_.film->height()));
}

void Overlays::draw_paths(const std::function<bool()>& cancel) {
  if (!setup_.engine || !setup_.film || !paths_shown_.of) {
    if (paths_) paths_->forget();
    return;
  }
  if (!paths_) paths_ = std::make_unique<PathsView>(context_.device, context_.compiler);
  paths_->draw({setup_.engine->wavefront(), *setup_.film, *setup_.coarse, sheet(), cancel}, paths_shown_,
               setup_.settings, setup_.world.flat.core_radius);
}

}  // namespace lucerna::session
