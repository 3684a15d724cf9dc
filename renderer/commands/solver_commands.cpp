// Commands of the solvers: what each offers in its table (solvers/info.h), and files that keep its work.
#include <algorithm>

#include "base/error.h"
#include "commands/workspace.h"
#include "plan/views.h"
#include "session/session.h"
#include "solvers/registry.h"

namespace lucerna::commands {

using solvers::SolverInfo;

bool Workspace::uses(const SolverInfo& solver) const {
  for (size_t c = 0; c < solver.serves.size(); ++c)
    if (solver.serves[c] &&
        solvers::chooses(setting(std::string("components.") + session::k_component_names[c]), solver.name))
      return true;
  return false;
}

const solvers::Report* Workspace::report(const SolverInfo& solver) const {
  if (!snapshot) return nullptr;
  for (const auto& report : snapshot->reports)
    if (report->solver == solver.name) return report.get();
  return nullptr;
}

const solvers::Report* Workspace::waiting() const {
  if (!snapshot) return nullptr;
  for (const auto& report : snapshot->reports)
    if (report->waits) return report.get();
  return nullptr;
}

void Workspace::needs_solver(const SolverInfo& solver) const {
  needs_scene();
  if (uses(solver)) return;
  const auto first = solver.serves.begin() + (solver.primary_part.empty() ? 0 : 1);
  const auto served = size_t(std::find(first, solver.serves.end(), true) - solver.serves.begin());
  throw Error(
      "", fmt::format("no component takes its light from the {}; set components.{} {}", solver.name,
                      session::k_component_names[std::min(served, solver.serves.size() - 1)], solver.name));
}

void Workspace::needs_lookup() const {
  needs_scene();
  // Views of no solver have something to show everywhere.
  for (const solvers::ViewInfo& view : plan::views())
    if (view.inspects_pointer && setting(view.option) == "true") return;
  const SolverInfo* missing = nullptr;
  for (const SolverInfo* solver : solvers::registered()) {
    if (!solver->looked_up) continue;
    if (uses(*solver)) return;
    if (!missing) missing = solver;
  }
  if (!missing) throw Error("", "no solver is looked up");
  needs_solver(*missing);
}

void Workspace::add_solver_commands() {
  for (const SolverInfo* solver : solvers::registered()) {
    if (solver->file) add_file_commands(*solver);
    if (!solver->commands.empty()) add_leading_commands(*solver);
  }
}

void Workspace::add_file_commands(const SolverInfo& solver) {
  const solvers::FileInfo& file = *solver.file;
  registry.add({.name = solver.name + ".save",
                .help = fmt::format("Saves {} for {}.load, as soon as they are complete; a script waits for "
                                    "it, and fails if it fails.",
                                    file.content, solver.name),
                .parameters = {file_to_write({file.extension}), time_limit()},
                .run =
                    [this, &solver](const Arguments& a) {
                      needs_scene();
                      saved_ = session.solver_save(solver.name, a.text("file"), scene_id_);
                    },
                .done = [this](const Arguments&) { return saved(); }});
  registry.add({.name = solver.name + ".load",
                .help = fmt::format("Loads {} from a file {}.", file.content, file.fits),
                .parameters = {file_named({file.extension})},
                .run = [this, &solver](const Arguments& a) {
                  needs_scene();
                  session.solver_load(solver.name, a.text("file"), scene_id_);
                }});
}

void Workspace::add_leading_commands(const SolverInfo& solver) {
  // True once preparation waits or is complete, with all in force that was commanded.
  const auto still = [this, &solver](const Arguments&) {
    const solvers::Report* current = report(solver);
    return up_to_date() && current && (current->waits || current->ready);
  };
  for (const solvers::CommandInfo& command : solver.commands) {
    Command c{.name = solver.name + "." + command.name,
              .help = command.help,
              .parameters = {},
              .run = [this, &solver, name = command.name](const Arguments&) {
                needs_solver(solver);
                session.solver_command(solver.name, name, scene_id_);
              }};
    if (command.until_still) c.parameters = {time_limit()}, c.done = still;
    registry.add(std::move(c));
  }
  registry.add({.name = "wait_" + solver.name,
                .help = fmt::format("In a script: waits until preparation of {} is paused or "
                                    "complete.",
                                    solver.title),
                .parameters = {time_limit()},
                .run = [this, &solver](const Arguments&) { needs_solver(solver); },
                .done = still});
}

}  // namespace lucerna::commands
