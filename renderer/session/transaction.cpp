#include "session/transaction.h"

#include <algorithm>
#include <utility>

#include "shaders/shared/film.h"

namespace lucerna::session {

namespace {

film::GroupStorage storage_of(const upload::Effects& effects) {
  return effects.group_components ? film::GroupStorage::by_component : film::GroupStorage::compact;
}

/// True if the film stores light groups and layers like the paths traced for these effects.
bool stores_groups_of(const film::Film& film, const upload::Effects& effects) {
  return film.groups() == effects.light_groups && film.layers() == effects.layers &&
         (film.groups() == 1 || film.group_storage() == storage_of(effects));
}

}  // namespace

Transaction::Transaction(const SetupContext& context, Setup& setup, Target target, plan::Plan plan)
    : context_(context),
      setup_(setup),
      target_(std::move(target)),
      plan_(std::move(plan)),
      relight_(make_relight()) {
  const paths::LayerSet layers = layer_set(context_.automaton, target_.settings);
  layers_ = layers.size();
  // Without the layer that was shown, the picture is.
  if (target_.settings.text("film.layers") != setup_.settings.text("film.layers") &&
      target_.settings.text("film.layer") == setup_.settings.text("film.layer") &&
      target_.settings.choice("film.layer") == int(plan::find_option("film.layer")->choices.size()) &&
      layers.index_of(target_.settings.text("film.layer")) == layers.size())
    target_.settings.set("film.layer", "beauty");
  check_shown_layer(layers, target_.settings);
  if (layers_ > 0 && target_.settings.text("relight.enabled") == "on")
    throw_error("film.layers", "layers are not stored by light group; use relight.enabled=compact");
}

Relight Transaction::make_relight() const {
  // A larger picture may leave no memory for separate groups.
  Relight relight = session::make_relight(plan_, target_.settings, target_.scene, context_.interactive,
                                          uint64_t{target_.width} * target_.height,
                                          context_.device.info().memory_bytes, setup_.relight);
  keep_written(relight, setup_.relight);
  if (target_.scene == setup_.world.scene && relight.baked == setup_.relight.baked &&
      relight.traced == setup_.relight.traced)
    relight.lit = setup_.world.lit;
  return relight;
}

upload::LightSeparation Transaction::separation() const {
  float threshold = wanted_sun_threshold(context_.automaton, plan_, target_.settings);
  // With one group, the film's sums suffice.
  const bool several = relight_.separate && relight_.groups->groups.size() > 1;
  if (several && relight_.groups->has_sun) threshold = scene::k_sun_threshold;
  return {threshold, several ? relight_.groups : nullptr,
          !several || relight_.kept == film::GroupStorage::by_component, layers_};
}

void Transaction::make_world(const Progress& progress) {
  world_ = session::make_world(context_.device, target_.scene, relight_.lit, target_.settings.text("tracer"),
                               separation(), progress);
}

void Transaction::edit_world(bool factors) {
  const upload::LightSeparation wanted = separation();
  if (target_.scene == setup_.world.scene && !relit() &&
      wanted == upload::light_separation(setup_.world.flat))
    return;
  edit_.emplace(context_.device, setup_.world, target_.scene, relight_.lit, wanted, factors || relit());
}

void Transaction::build(const scene::Changes& changes, bool new_engine) {
  const film::Film* film = setup_.film.get();
  if (!film || film->width() != target_.width || film->height() != target_.height ||
      !stores_groups_of(*film, world().flat.effects))
    build_films();
  if (new_engine || world_ || !setup_.engine->serves(plan_, target_.settings, world())) build_engine(changes);
}

void Transaction::build_films() {
  const upload::Effects& effects = world().flat.effects;
  film_ = std::make_unique<film::Film>(context_.device, target_.width, target_.height, effects.light_groups,
                                       storage_of(effects), effects.layers);
  coarse_ = std::make_unique<film::Film>(context_.device, std::max(1u, target_.width / shared::k_coarse_step),
                                         std::max(1u, target_.height / shared::k_coarse_step));
}

void Transaction::build_engine(const scene::Changes& changes) {
  const Engine* before = setup_.engine.get();
  std::vector<Predecessor> predecessors;
  if (before)
    for (const auto& solver : before->solvers())
      predecessors.push_back({.solver = solver, .made_for = before->made_for(), .since = changes});
  for (Predecessor& kept : setup_.kept.predecessors(target_.settings, changes.edits))
    predecessors.push_back(std::move(kept));
  const bool same_shaders = !changes.edits.contains(scene::Change::shaders);
  engine_ = std::make_unique<Engine>(context_.device, context_.compiler, context_.automaton, world(), plan_,
                                     target_.settings, context_.defines, same_shaders ? before : nullptr,
                                     !world_ && !edit_, predecessors);
  kept_ = setup_.kept;
  if (before) kept_.replace(*before, *engine_, changes.edits);
}

void Transaction::commit() noexcept {
  const bool rebuilt = engine_ != nullptr;
  if (rebuilt) {
    setup_.engine = std::move(engine_);
    setup_.kept = std::move(kept_);
  } else {
    setup_.engine->set_plan(std::move(plan_));
  }
  if (edit_) edit_->keep();
  if (world_) setup_.world = std::move(*world_);
  if (edit_ && !rebuilt) setup_.engine->wavefront().rebind(*setup_.world.device);
  if (film_) setup_.film = std::move(film_), setup_.coarse = std::move(coarse_);
  setup_.relight = std::move(relight_);
  setup_.settings = std::move(target_.settings);
  setup_.camera = std::move(target_.camera);
  setup_.width = target_.width, setup_.height = target_.height;
  // Kept data is optional: most of the memory is left to the picture.
  if (rebuilt && context_.device.allocated_bytes() > context_.device.info().memory_bytes / 2)
    setup_.kept.clear();
}

}  // namespace lucerna::session
