#include "session/engine.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/log.h"
#include "base/timer.h"
#include "solvers/registry.h"
#include "transport/vertex_hooks.h"

namespace lucerna::session {
namespace {

/// Merges lookups of several solvers; in each state one solver provides each part.
void merge(paths::LookupRoutes& into, const paths::LookupRoutes& more) {
  into.traced &= more.traced;
  into.replaced.resize(std::max(into.replaced.size(), more.replaced.size()), 0);
  for (size_t state = 0; state < more.replaced.size(); ++state) into.replaced[state] |= more.replaced[state];
  into.parts |= more.parts;
  if (into.component.empty()) into.component = more.component;
  for (size_t state = 0; state < more.component.size(); ++state)
    for (size_t part = 0; part < more.component[state].size(); ++part)
      if (into.component[state][part] == paths::k_no_component)
        into.component[state][part] = more.component[state][part];
}

/// Components (bits) that lookups provide.
uint32_t looked_up_components(const paths::LookupRoutes& routes) {
  uint32_t bits = 0;
  for (const auto& by_part : routes.component)
    for (const uint8_t component : by_part)
      if (component != paths::k_no_component) bits |= 1u << component;
  return bits;
}

/// Registers the solver of these components (bits). Throws Error, located at the component, if another solver
/// has it.
void claim(ByComponent<const solvers::SolverInfo*>& by, const solvers::SolverInfo& info, uint32_t bits) {
  for (size_t c = 0; c < by.size(); ++c) {
    if ((bits >> c & 1u) == 0) continue;
    if (by[c])
      throw_error(
          std::string("components.") + paths::k_component_names[c],
          "light of the words {} would be counted twice: by '{}', whose lookups for another component "
          "include it, and by '{}'; choose one of them for both components",
          paths::k_component_expressions[c], by[c]->name, info.name);
    by[c] = &info;
  }
}

/// #defines of kernels for the settings of light selection.
gpu::Defines wanted_learned_defines(const plan::Settings& settings, const upload::FlatScene& flat) {
  return settings.text("lights.sampling") == "learned" ? upload::learned_defines(flat) : gpu::Defines{};
}

/// True if these changes affect neither lights nor occluders.
bool same_lights(const scene::Changes& changes) {
  return std::all_of(changes.edits.begin(), changes.edits.end(), [](scene::Change edit) {
    return edit == scene::Change::camera || edit == scene::Change::size || edit == scene::Change::restart;
  });
}

/// Light samples recorded in one dispatch.
constexpr uint32_t k_most_recorded_paths = 32768;
/// Samples a pixel of the pilot picture in each generation, and its pixels per pixel of the picture. In sum
/// about two samples of a small picture, and less of a large one, because learning depends on the scene.
constexpr uint32_t k_generations[] = {2, 4, 8};
constexpr double k_pilot_share = 1.0 / 7, k_most_pilot_pixels = 256 * 144;

/// The first solver that offers the capability and meets the condition; null: none.
template <class Capability, class Condition>
solvers::Solver* first(const std::vector<std::shared_ptr<solvers::Solver>>& all, Condition&& meets) {
  for (const auto& solver : all)
    if (const Capability* offer = solvers::offered<Capability>(*solver); offer && meets(*offer))
      return solver.get();
  return nullptr;
}

/// Delegates these components (bits) to paths.
void to_paths(plan::Plan& plan, uint32_t components) {
  for (size_t c = 0; c < plan.solver.size(); ++c)
    if ((components >> c & 1u) != 0 && plan.solver[c])
      plan.solver[c] = solvers::find("path"), plan.rest[c] = nullptr;
}

/// Components (bits) that are computed. Where all surfaces are diffuse, no path from the eye has a caustic:
/// paths followed for it alone would find nothing.
uint32_t enabled_by(const plan::Plan& plan, bool only_diffuse) {
  const bool nothing = only_diffuse && plan.solver[paths::k_caustic] == solvers::find("path");
  return plan.enabled() & ~(nothing ? uint32_t{paths::k_caustic_bit} : 0u);
}

}  // namespace

solvers::Task task_of(const paths::Automaton& automaton, const plan::Plan& plan,
                      const solvers::SolverInfo& solver, const plan::Settings& settings,
                      const upload::Effects& effects) {
  uint32_t provided = 0, consuming = 0;
  for (const solvers::SolverInfo* other : plan.at_work()) {
    if (other == &solver) continue;
    if (other->provides_lookups) provided |= plan.components_of(*other);
    if (other->consumes_lookups) consuming |= plan.components_of(*other);
  }
  return {.automaton = automaton,
          .settings = settings,
          .enabled = enabled_by(plan, effects.only_diffuse()),
          .own = plan.components_of(solver),
          .directly_visible_by_other = plan.rests_of(solver),
          .provided = provided,
          .consuming = consuming,
          .effects = effects};
}

Engine::Engine(gpu::Device& device, gpu::ShaderCompiler& compiler, const paths::Automaton& automaton,
               const World& world, const plan::Plan& plan, const plan::Settings& settings,
               gpu::Defines defines, const Engine* before, bool same_lights,
               std::span<const Predecessor> predecessors)
    : automaton_(automaton),
      plan_(plan),
      only_diffuse_(world.flat.effects.only_diffuse()),
      made_for_{.scene_defines = world.device->defines(), .lights = upload::light_separation(world.flat)} {
  const Timer timer;
  route(settings, world.flat.effects);
  auto slots = uint32_t(settings.integer("path.batch")) / 64 * 64;
  if (settings.boolean("sampling.coherent"))
    defines["LUCERNA_COHERENT"] = settings.text("sampling.tile") == "8" ? "3" : "4";
  if (settings.text("film.background") == "hidden") defines["LUCERNA_HIDDEN_BACKGROUND"] = "1";
  const std::vector<const solvers::SolverInfo*> at_work = plan.at_work();
  for (const solvers::SolverInfo* info : at_work)
    slots = std::max(slots, solvers::type_of(*info).least_slots);
  made_for_.slots = slots;
  std::vector<transport::VertexHook> hooks;
  const upload::Effects& effects = world.flat.effects;
  for (const solvers::SolverInfo* info : at_work) {
    const solvers::SolverType& type = solvers::type_of(*info);
    if (!type.make) continue;
    solvers::Task task = task_of(automaton_, plan_, *info, settings, effects);
    task.scene_defines = &made_for_.scene_defines;
    const Predecessor* same = working_on(*info, task, predecessors);
    solvers_.push_back(same ? same->solver : type.make(device, compiler, slots, task));
    const solvers::Solver& solver = *solvers_.back();
    const auto* kernels = solvers::offered<solvers::Kernels>(solver);
    if (!kernels) continue;
    for (const auto& [name, value] : kernels->defines()) defines[name] = value;
    if (!kernels->hook().empty()) hooks.push_back({info->name, kernels->hook()});
  }
  for (const auto& [name, value] : transport::hook_defines(hooks)) defines[name] = value;
  learned_defines_ = wanted_learned_defines(settings, world.flat);
  std::shared_ptr<transport::LightLearning> learning;
  if (!learned_defines_.empty()) {
    for (const auto& [name, value] : learned_defines_) defines[name] = value;
    const uint32_t most_paths = std::min(slots, k_most_recorded_paths);
    if (before && same_lights && before->learned_defines_ == learned_defines_)
      learning = before->wavefront_->shared_learning();
    if (learning && learning->most_paths() == most_paths)
      begun_ = before->begun_;
    else
      learning = std::make_shared<transport::LightLearning>(device, upload::make_light_clusters(world.flat),
                                                            most_paths);
  }
  std::function<void(gpu::Resources&)> bind;
  if (!solvers_.empty())
    bind = [this](gpu::Resources& r) {
      for (const auto& solver : solvers_)
        if (const auto* kernels = solvers::offered<solvers::Kernels>(*solver)) kernels->bind(r);
    };
  const std::string& classes = settings.text("path.classes");
  const auto rules = classes == "off"      ? transport::HitClassRules::never()
                     : classes == "always" ? transport::HitClassRules::at_once()
                                           : transport::HitClassRules{};
  path_defines_ = world.device->defines();
  for (const auto& [name, value] : defines) path_defines_[name] = value;
  wavefront_ = std::make_unique<transport::Wavefront>(device, compiler, *world.device, slots, world.trace(),
                                                      defines, bind, rules, std::move(learning));
  developer_ = before ? before->developer_ : std::make_shared<film::Developer>(device, compiler);
  estimator_ = before && before->solvers_.empty() == solvers_.empty()
                   ? before->estimator_
                   : std::make_shared<film::ErrorEstimator>(device, compiler, !solvers_.empty());
  take_up(predecessors);
  compile_seconds_ = timer.seconds();
}

bool Engine::serves(const plan::Plan& plan, const plan::Settings& settings, const World& world) const {
  size_t wanted = 0;
  for (const solvers::SolverInfo* info : plan.at_work())
    if (solvers::type_of(*info).make) {
      if (!find(info->name)) return false;
      ++wanted;
    }
  if (wanted != solvers_.size() || world.device->defines() != made_for_.scene_defines ||
      wanted_learned_defines(settings, world.flat) != learned_defines_)
    return false;
  return std::all_of(solvers_.begin(), solvers_.end(), [&](const auto& solver) {
    return solver->serves(task_of(automaton_, plan, solver->info(), settings, world.flat.effects));
  });
}

uint32_t Engine::enabled() const { return enabled_by(plan_, only_diffuse_); }

const Predecessor* Engine::working_on(const solvers::SolverInfo& info, const solvers::Task& task,
                                      std::span<const Predecessor> predecessors) const {
  const auto restarts = [&](const std::string& key) {
    return solvers::owner_of(key) == &info && plan::find_option(key)->restarts;
  };
  for (const Predecessor& p : predecessors)
    if (&p.solver->info() == &info && p.made_for == made_for_ &&
        !solvers::invalidated_by(info, p.since).places &&
        std::none_of(p.since.settings.begin(), p.since.settings.end(), restarts) && p.solver->serves(task))
      return &p;
  return nullptr;
}

void Engine::take_up(std::span<const Predecessor> predecessors) {
  const auto note = [&](const solvers::Solver& own, const Predecessor& p) {
    taken_up_.insert(p.solver.get());
    if (p.kept) missed_[&own] = p.since;
  };
  for (const auto& own : solvers_) {
    const auto same = std::find_if(predecessors.begin(), predecessors.end(),
                                   [&](const Predecessor& p) { return p.solver == own; });
    if (same != predecessors.end()) {
      note(*own, *same);
      continue;
    }
    for (const Predecessor& p : predecessors) {
      if (&p.solver->info() != &own->info() || solvers::invalidated_by(own->info(), p.since).places) continue;
      if (auto* adoption = solvers::offered<solvers::Adoption>(*own)) adoption->adopt(*wavefront_, *p.solver);
      note(*own, p);
      break;
    }
  }
}

bool Engine::took_up(const solvers::Solver& predecessor) const { return taken_up_.contains(&predecessor); }

void Engine::begin(const PictureView& picture, const scene::Changes& changes,
                   const std::optional<std::vector<vec3>>& light_factors) {
  // Components that are off change without new kernels.
  route(picture.settings, picture.world.flat.effects);
  for (const auto& solver : solvers_)
    with(*solver, picture, [&](solvers::Picture own) {
      scene::Changes since = changes;
      if (const auto missed = missed_.find(solver.get()); missed != missed_.end()) {
        since.settings = missed->second.settings;
        since.edits.insert(missed->second.edits.begin(), missed->second.edits.end());
      } else {
        own.light_factors = light_factors;
        own.moved = since.moved;
      }
      solver->begin(own, solvers::invalidated_by(solver->info(), since));
    });
  missed_.clear();
  made_for_.lights = upload::light_separation(picture.world.flat);
  set_layers(picture);
  begun_settings_ = picture.settings.all();
  // A new engine has learned nothing of its world.
  const bool learned = wavefront_->learning() && std::exchange(begun_, true);
  learned_elsewhere_ = learned && same_lights(changes);
  if (learned && !learned_elsewhere_)
    wavefront_->forget_learned(upload::make_light_clusters(picture.world.flat));
  route(picture.settings, picture.world.flat.effects);  // with the components delegated now
  wavefront_->set_frame(frame(picture, picture.width, picture.height), enabled());
}

void Engine::set_layers(const PictureView& picture) {
  const std::vector<paths::Layer> before = layers_.layers();
  layers_ = layer_set(automaton_, picture.settings);
  const std::vector<uint32_t> unknown_before = std::exchange(layers_unknown_, {});
  if (layers_.size() == 0) return;
  // Of all lookups, whether or not components are delegated to paths for now.
  const solvers::Routing all = routing(plan_, picture.settings, picture.world.flat.effects);
  const paths::LayerSet::Routed routed = layers_.routed(all.lookups, all.gather);
  layers_unknown_ = routed.unknown;
  wavefront_->set_layers(routed.table);
  for (uint32_t l = 0; l < layers_.size(); ++l)
    if (layers_unknown_[l] != 0 && (layers_.layers() != before || layers_unknown_ != unknown_before))
      log::warning(
          "film.layers: '{}' lacks light of the {} component, whose solver stores the light of several "
          "words together; path tracing knows them apart",
          layers_.layers()[l].name, paths::unknown_text(layers_unknown_[l]));
}

solvers::Solver* Engine::find(std::string_view name) const {
  for (const auto& solver : solvers_)
    if (solver->info().name == name) return solver.get();
  return nullptr;
}

solvers::Solver* Engine::unready() const {
  // Last to first: data of later ones may be read while earlier ones prepare (photons by records).
  for (auto solver = solvers_.rbegin(); solver != solvers_.rend(); ++solver)
    if (!solvers::ready(**solver)) return solver->get();
  return nullptr;
}

bool Engine::in_rounds() const {
  return first<solvers::Rounds>(solvers_, [](const auto& rounds) { return rounds.in_rounds(); }) != nullptr;
}

solvers::Solver* Engine::unready_for(uint32_t sample) const {
  return first<solvers::Rounds>(
      solvers_, [&](const auto& rounds) { return rounds.in_rounds() && !rounds.round_ready(sample); });
}

solvers::Solver* Engine::owing_errors(const film::Film& film) const {
  return first<solvers::LookupErrors>(solvers_, [&](const auto& errors) { return errors.owes_errors(film); });
}

solvers::Solver* Engine::refining() const {
  return first<solvers::Refinement>(solvers_, [](const auto& refinement) { return refinement.refines(); });
}

solvers::Solver* Engine::refinable() const {
  return first<solvers::Refinement>(solvers_,
                                    [](const auto& refinement) { return refinement.paths_refined() > 0; });
}

bool Engine::learns(uint32_t samples) const {
  const transport::LightLearning* learning = wavefront_->learning();
  if (!learning || learned_elsewhere_ || !learning->pays() ||
      learning->generations() >= std::size(k_generations))
    return false;
  return samples >= 1u << learning->generations();
}

void Engine::begin_samples(const PictureView& picture) {
  if (!std::exchange(learned_elsewhere_, false)) return;
  wavefront_->rewind_learning();
  wavefront_->set_frame(frame(picture, picture.width, picture.height), enabled());
}

bool Engine::learn(const PictureView& picture, const std::function<bool()>& cancel) {
  const uint32_t generation = wavefront_->learning()->generations();
  const double aspect = double(picture.width) / picture.height;
  const double pixels = std::min(k_pilot_share * picture.width * picture.height, k_most_pilot_pixels);
  const auto blocks = [](double side) { return uint32_t(std::clamp(side / 8 + 0.5, 1.0, 4096.0)); };
  const uint32_t across = blocks(std::sqrt(pixels * aspect)), down = blocks(std::sqrt(pixels / aspect));
  uint32_t first = 0;
  for (uint32_t g = 0; g < generation; ++g) first += k_generations[g];
  schedule::WorkItem item{{}, k_generations[generation]};
  for (uint32_t b = 0; b < across * down; ++b) item.blocks.push_back({b, first});
  // Learning does not depend on how components are computed.
  shared::Frame pilot = pilot_frame(picture, 8 * across, 8 * down);
  pilot.max_depth = std::min(pilot.max_depth, shared::k_learned_vertices);
  const bool went =
      wavefront_->learn(item, pilot, frame(picture, picture.width, picture.height), enabled(), cancel);
  transport::LightLearning& learning = *wavefront_->learning();
  if (went && (generation + 1 == std::size(k_generations) || !learning.pays())) learning.end();
  return went;
}

shared::Frame Engine::pilot_frame(const PictureView& picture, uint32_t width, uint32_t height) const {
  plan::Plan all = plan_;
  for (size_t c = 0; c < all.solver.size(); ++c) all.solver[c] = solvers::find("path"), all.rest[c] = nullptr;
  const solvers::Routing traced = routing(all, picture.settings, picture.world.flat.effects);
  shared::Frame frame = frame_of({.here = traced, .delegated = traced}, picture, width, height);
  frame.seed ^= 0x6c6c6c6cu;  // samples that no picture uses
  return frame;
}

bool Engine::waits() const {
  const solvers::Solver* next = unready();
  return next && solvers::offered<solvers::Preparation>(*next)->waits();
}

bool Engine::prepare(solvers::Solver& solver, const PictureView& picture,
                     const std::function<bool()>& cancel) {
  auto& preparation = *solvers::offered<solvers::Preparation>(solver);
  const uint32_t before = preparation.delegated_components();
  const bool went = with(solver, picture, [&](const solvers::Picture& own) {
    return preparation.prepare(*wavefront_, own, cancel);
  });
  if (preparation.delegated_components() != before) {
    route(picture.settings, picture.world.flat.effects);
    wavefront_->set_frame(frame(picture, picture.width, picture.height), enabled());
  }
  return went;
}

void Engine::route(const plan::Settings& settings, const upload::Effects& effects) {
  plan::Plan here = plan_;
  for (const auto& solver : solvers_) to_paths(here, solvers::delegated_components(*solver));
  routes_ = routes_of(here, settings, effects);
}

PathRoutes Engine::routes_of(const plan::Plan& here, const plan::Settings& settings,
                             const upload::Effects& effects) const {
  PathRoutes routes{.here = routing(here, settings, effects), .delegated = {}};
  plan::Plan delegated = here;
  for (const solvers::SolverInfo* info : here.at_work())
    if (const auto delegable_components = solvers::type_of(*info).delegable_components)
      to_paths(delegated, delegable_components(task_of(automaton_, here, *info, settings, effects)));
  if (delegated.solver != here.solver) routes.delegated = routing(delegated, settings, effects);
  return routes;
}

solvers::Routing Engine::routing(const plan::Plan& plan, const plan::Settings& settings,
                                 const upload::Effects& effects) const {
  // Without lookups everything is traced.
  solvers::Routing all{
      .lookups = {.component = {}, .parts = 0, .traced = enabled_by(plan, effects.only_diffuse())},
      .fallback = 0,
      .gather = {}};
  ByComponent<const solvers::SolverInfo*> by{};
  uint32_t always = 0;  // components of solvers without a fallback
  for (const solvers::SolverInfo* info : plan.at_work()) {
    const auto routing_of = solvers::type_of(*info).routing;
    if (!routing_of) continue;
    const solvers::Routing own = routing_of(task_of(automaton_, plan, *info, settings, effects));
    claim(by, *info, looked_up_components(own.lookups) & ~own.through);
    merge(all.lookups, own.lookups);
    all.fallback |= own.fallback;
    always |= looked_up_components(own.lookups) & ~own.fallback;
    if (!own.gather.component.empty()) merge(all.gather, own.gather);
  }
  // Paths without data in one lookup still find another's.
  all.fallback &= ~always;
  return all;
}

shared::Frame Engine::frame(const PictureView& picture, uint32_t width, uint32_t height) const {
  return frame_of(routes_, picture, width, height);
}

shared::Frame Engine::draft_frame(const PictureView& picture, uint32_t width, uint32_t height) const {
  plan::Plan here = plan_;
  uint32_t all_missing = 0;
  for (const auto& solver : solvers_) {
    const auto* preparation = solvers::offered<solvers::Preparation>(*solver);
    if (!preparation) continue;
    const uint32_t missing =
        with(*solver, picture, [&](const solvers::Picture& own) { return preparation->missing(own); });
    to_paths(here, preparation->delegated_components() | missing);
    all_missing |= missing;
  }
  if (all_missing == 0) return frame(picture, width, height);
  return frame_of(routes_of(here, picture.settings, picture.world.flat.effects), picture, width, height);
}

bool Engine::looks_up_direct_light() const { return (routes_.here.lookups.parts & 1u) != 0; }

float wanted_sun_threshold(const paths::Automaton& automaton, const plan::Plan& plan,
                           const plan::Settings& settings) {
  float threshold = 0;
  for (const solvers::SolverInfo* info : plan.at_work())
    if (const auto wanted = solvers::type_of(*info).sun_threshold)
      threshold = std::max(threshold, wanted(task_of(automaton, plan, *info, settings, {})));
  return threshold;
}

}  // namespace lucerna::session
