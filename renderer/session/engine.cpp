#include "session/engine.h"

#include <algorithm>

#include "base/error.h"
#include "base/timer.h"
#include "solvers/registry.h"
#include "transport/vertex_hooks.h"

namespace lucerna::session {
namespace {

/// Lookups of several solvers in one table: in a state each part is brought by one of them.
void merge(paths::LookupRoutes& into, const paths::LookupRoutes& more) {
  into.traced &= more.traced;
  into.parts |= more.parts;
  if (into.component.empty()) into.component = more.component;
  for (size_t state = 0; state < more.component.size(); ++state)
    for (size_t part = 0; part < more.component[state].size(); ++part)
      if (into.component[state][part] == paths::k_no_component)
        into.component[state][part] = more.component[state][part];
}

/// Components (bits) that lookups bring.
uint32_t brought(const paths::LookupRoutes& routes) {
  uint32_t bits = 0;
  for (const auto& by_part : routes.component)
    for (const uint8_t component : by_part)
      if (component != paths::k_no_component) bits |= 1u << component;
  return bits;
}

}  // namespace

Engine::Engine(gpu::Device& device, gpu::ShaderCompiler& compiler, const paths::Automaton& automaton,
               const World& world, const plan::Plan& plan, const plan::Settings& settings,
               gpu::Defines defines)
    : automaton_(automaton),
      plan_(plan),
      scene_defines_(world.device->defines()),
      developer_(device, compiler) {
  const Timer timer;
  auto slots = uint32_t(settings.integer("path.batch")) / 64 * 64;
  if (settings.boolean("sampling.coherent"))
    defines["LUCERNA_COHERENT"] = settings.text("sampling.tile") == "8" ? "3" : "4";
  if (settings.text("film.background") == "hidden") defines["LUCERNA_HIDDEN_BACKGROUND"] = "1";
  const std::vector<const solvers::SolverInfo*> at_work = plan.at_work();
  for (const solvers::SolverInfo* info : at_work)
    slots = std::max(slots, solvers::type_of(*info).least_slots);
  std::vector<transport::VertexHook> hooks;
  const upload::Effects& effects = world.flat.effects;
  for (const solvers::SolverInfo* info : at_work) {
    const solvers::SolverType& type = solvers::type_of(*info);
    if (!type.make) continue;
    solvers_.push_back(type.make(device, compiler, slots, task_of(*info, settings, effects)));
    const solvers::Solver& solver = *solvers_.back();
    for (const auto& [name, value] : solver.defines()) defines[name] = value;
    if (!solver.hook().empty()) hooks.push_back({info->name, solver.hook()});
  }
  check_partition(settings, effects);
  for (const auto& [name, value] : transport::hook_defines(hooks)) defines[name] = value;
  std::function<void(gpu::Resources&)> bind;
  if (!solvers_.empty())
    bind = [this](gpu::Resources& r) {
      for (const auto& solver : solvers_) solver->bind(r);
    };
  wavefront_ = std::make_unique<transport::Wavefront>(device, compiler, *world.device, slots, world.trace(),
                                                      defines, bind);
  estimator_.emplace(device, compiler, !solvers_.empty());
  routing_ = routing(settings, effects);
  compile_seconds_ = timer.seconds();
}

void Engine::check_partition(const plan::Settings& settings, const upload::Effects& effects) const {
  std::array<const solvers::SolverInfo*, paths::k_component_count> by{};
  for (const auto& solver : solvers_) {
    const uint32_t bits = brought(solver->routing(task_of(solver->info(), settings, effects)).lookups);
    for (size_t c = 0; c < by.size(); ++c) {
      if ((bits >> c & 1u) == 0) continue;
      if (by[c])
        throw_error(
            std::string("components.") + paths::k_component_names[c],
            "light of the words {} would be counted twice: by '{}', with what it looks up for another "
            "component, and by '{}'; give both components to one of them",
            paths::k_component_expressions[c], by[c]->name, solver->info().name);
      by[c] = &solver->info();
    }
  }
}

bool Engine::serves(const plan::Plan& plan, const plan::Settings& settings, const World& world) const {
  size_t wanted = 0;
  for (const solvers::SolverInfo* info : plan.at_work())
    if (solvers::type_of(*info).make) {
      if (!find(info->name)) return false;
      ++wanted;
    }
  if (wanted != solvers_.size() || world.device->defines() != scene_defines_) return false;
  return std::all_of(solvers_.begin(), solvers_.end(), [&](const auto& solver) {
    return solver->serves(task_of(plan, solver->info(), settings, world.flat.effects));
  });
}

void Engine::adopt(const Engine& before, const scene::Changes& changes) {
  for (const auto& solver : solvers_)
    if (const solvers::Solver* old = before.find(solver->info().name);
        old && !solvers::spoiled_by(solver->info(), changes).places)
      solver->adopt(*wavefront_, *old);
}

void Engine::begin(const PictureView& picture, const scene::Changes& changes) {
  // What is switched off changes without new kernels.
  routing_ = routing(picture.settings, picture.world.flat.effects);
  for (const auto& solver : solvers_)
    with(*solver, picture, [&](const solvers::Picture& own) {
      solver->begin(own, solvers::spoiled_by(solver->info(), changes));
    });
  wavefront_->set_frame(frame(picture, picture.width, picture.height), plan_.enabled());
}

solvers::Solver* Engine::find(std::string_view name) const {
  for (const auto& solver : solvers_)
    if (solver->info().name == name) return solver.get();
  return nullptr;
}

solvers::Solver* Engine::unready() const {
  for (const auto& solver : solvers_)
    if (!solver->ready()) return solver.get();
  return nullptr;
}

bool Engine::waits() const {
  const solvers::Solver* next = unready();
  return next && next->waits();
}

uint64_t Engine::published() const {
  uint64_t sum = 0;
  for (const auto& solver : solvers_) sum += solver->published();
  return sum;
}

solvers::Task Engine::task_of(const plan::Plan& plan, const solvers::SolverInfo& solver,
                              const plan::Settings& settings, const upload::Effects& effects) const {
  return {.automaton = automaton_,
          .settings = settings,
          .enabled = plan.enabled(),
          .own = plan.components_of(solver),
          .effects = effects};
}

solvers::Task Engine::task_of(const solvers::SolverInfo& solver, const plan::Settings& settings,
                              const upload::Effects& effects) const {
  return task_of(plan_, solver, settings, effects);
}

solvers::Routing Engine::routing(const plan::Settings& settings, const upload::Effects& effects) const {
  // Nothing is looked up yet, and everything is traced.
  solvers::Routing all{
      .lookups = {.component = {}, .parts = 0, .traced = plan_.enabled()}, .fallback = 0, .gather = {}};
  for (const auto& solver : solvers_) {
    const solvers::Routing own = solver->routing(task_of(solver->info(), settings, effects));
    merge(all.lookups, own.lookups);
    all.fallback |= own.fallback;
    if (!own.gather.component.empty()) merge(all.gather, own.gather);
  }
  return all;
}

shared::Frame Engine::frame(const PictureView& picture, uint32_t width, uint32_t height) const {
  const solvers::Task task = {
      .automaton = automaton_, .settings = picture.settings, .enabled = plan_.enabled()};
  const solvers::Picture own{.task = task,
                             .flat = picture.world.flat,
                             .camera = picture.camera,
                             .width = width,
                             .height = height,
                             .frame = {}};
  return own.frame_for(routing_, routing_.lookups.traced);
}

bool Engine::looked_up_besides(size_t component) const {
  // The part of light that comes straight from a light.
  return std::any_of(routing_.lookups.component.begin(), routing_.lookups.component.end(),
                     [&](const auto& by_part) { return by_part[0] == component; });
}

float wanted_sun_threshold(const paths::Automaton& automaton, const plan::Plan& plan,
                           const plan::Settings& settings) {
  float threshold = 0;
  for (const solvers::SolverInfo* info : plan.at_work())
    if (const auto wanted = solvers::type_of(*info).sun_threshold)
      threshold = std::max(threshold, wanted({.automaton = automaton,
                                              .settings = settings,
                                              .enabled = plan.enabled(),
                                              .own = plan.components_of(*info),
                                              .effects = {}}));
  return threshold;
}

}  // namespace lucerna::session
