#include "session/active_solvers.h"

#include <algorithm>

#include "base/log.h"
#include "scene/hash.h"

namespace lucerna::session {

void ActiveSolvers::command(const std::string& name, const std::string& command) {
  solvers::Solver* found = find(name);
  if (auto* commands = found ? solvers::offered<solvers::Commands>(*found) : nullptr)
    commands->command(command);
}

std::vector<std::shared_ptr<const solvers::Report>> ActiveSolvers::reports() {
  std::vector<std::shared_ptr<const solvers::Report>> all;
  overlays_.visit_solvers(
      [&](solvers::Solver& solver, const overlay::Canvas& canvas, const solvers::Picture& picture) {
        all.push_back(solver.report(canvas, picture, sampling_.samples() > 0));
      });
  if (const solvers::Report* lights = overlays_.lights_report())
    all.push_back(std::make_shared<const solvers::Report>(*lights));
  if (const solvers::Report* focus = overlays_.focus_report())
    all.push_back(std::make_shared<const solvers::Report>(*focus));
  if (const solvers::Report* paths = overlays_.paths_report())
    all.push_back(std::make_shared<const solvers::Report>(*paths));
  return all;
}

double ActiveSolvers::figure(const std::string& name) const {
  double sum = 0;
  if (setup_.engine)
    for (const auto& solver : setup_.engine->solvers())
      if (const auto* statistics = solvers::offered<solvers::Statistics>(*solver))
        for (const auto& [key, value] : statistics->figures()) sum += key == name ? value : 0;
  return sum;
}

nlohmann::ordered_json ActiveSolvers::statistics() {
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  if (const transport::LightLearning* learning = setup_.engine->wavefront().learning())
    all["lights"] = {{"clusters", learning->clusters().count()},
                     {"rows", learning->rows()},
                     {"records", learning->records()},
                     {"arrived", learning->arrived()},
                     {"gain", learning->gain()},
                     {"replayed", learning->replayed()},
                     {"bytes", learning->bytes()}};
  overlays_.visit_solvers(
      [&](solvers::Solver& solver, const overlay::Canvas& canvas, const solvers::Picture& picture) {
        auto* statistics = solvers::offered<solvers::Statistics>(solver);
        if (!statistics) return;
        if (nlohmann::ordered_json own = statistics->statistics(canvas, picture); !own.is_null())
          all[solver.info().name] = std::move(own);
      });
  return all;
}

solvers::Provenance ActiveSolvers::provenance() const {
  const scene::LightHash hash = scene::light_hash(*setup_.world.lit);
  return {.scene = setup_.world.scene->name,
          .hashes = {{"geometry", hash.geometry},
                     {"materials", hash.materials},
                     {"lights", hash.lights},
                     {"environment", hash.environment}},
          .view = fmt::format("{} {}x{}", setup_.view_text(), setup_.width, setup_.height)};
}

solvers::Solver& ActiveSolvers::for_file(const std::string& name, const std::filesystem::path& file,
                                         const char* nothing, const char* no_scene) {
  if (!setup_.engine) throw Error(file.string(), no_scene);
  if (solvers::Solver* found = find(name); found && solvers::offered<solvers::Persistence>(*found))
    return *found;
  std::string components;
  if (const solvers::SolverInfo* info = solvers::find(name))
    for (size_t c = 0; c < info->serves.size(); ++c)
      if (info->serves[c])
        components +=
            fmt::format("{}components.{}", components.empty() ? "" : ", ", paths::k_component_names[c]);
  throw_error(file.string(), "{}: no component is computed by '{}' ({})", nothing, name, components);
}

void ActiveSolvers::save(const std::string& name, const std::filesystem::path& file) {
  const solvers::Solver& found =
      for_file(name, file, "there is nothing to save", "there is nothing to save yet; load a scene first");
  setup_.engine->with(found, setup_.view(context_.automaton), [&](const solvers::Picture& picture) {
    solvers::offered<solvers::Persistence>(found)->save(file.string(), picture, provenance());
  });
}

void ActiveSolvers::load(const std::string& name, const std::filesystem::path& file) {
  solvers::Solver& found =
      for_file(name, file, "nothing would look it up", "this file is of a scene; load the scene first");
  setup_.engine->with(found, setup_.view(context_.automaton), [&](const solvers::Picture& picture) {
    solvers::offered<solvers::Persistence>(found)->load(file.string(), setup_.engine->wavefront(), picture,
                                                        provenance());
  });
}

std::vector<const solvers::Preparation*> ActiveSolvers::preparations() const {
  std::vector<const solvers::Preparation*> all;
  if (!setup_.engine) return all;
  for (const auto& solver : setup_.engine->solvers())
    if (const auto* preparation = solvers::offered<solvers::Preparation>(*solver)) all.push_back(preparation);
  return all;
}

bool ActiveSolvers::usable() const {
  return std::ranges::all_of(preparations(), &solvers::Preparation::usable);
}

bool ActiveSolvers::stepped() const {
  return std::ranges::any_of(preparations(), &solvers::Preparation::stepped);
}

void ActiveSolvers::finish_early() {
  if (!setup_.engine) return;
  for (const auto& solver : setup_.engine->solvers())
    if (auto* preparation = solvers::offered<solvers::Preparation>(*solver);
        preparation && !preparation->ready())
      preparation->finish_early();
}

}  // namespace lucerna::session
