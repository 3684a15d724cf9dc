// Commands of the solvers: what each offers in its table (solvers/info.h), and files that keep its work.
#include "commands/command_list.h"
#include "commands/open_scene.h"
#include "commands/saved_files.h"
#include "solvers/registry.h"

namespace lucerna::commands {

using solvers::SolverInfo;

namespace {

void add_file_commands(Registry& registry, const OpenScene& open, SavedFiles& files,
                       const SolverInfo& solver) {
  const solvers::FileInfo& file = *solver.file;
  registry.add({.name = solver.name + ".save",
                .help = fmt::format("Saves {} for {}.load, as soon as they are complete; a script waits for "
                                    "it, and fails if it fails.",
                                    file.content, solver.name),
                .parameters = {file_to_write({file.extension}), time_limit()},
                .run =
                    [&open, &files, &solver](const Arguments& a) {
                      open.needs_scene();
                      files.add(open.session.solver_save(solver.name, a.text("file"), open.id()));
                    },
                .done = [&files](const Arguments&) { return files.latest_written(); }});
  registry.add({.name = solver.name + ".load",
                .help = fmt::format("Loads {} from a file {}.", file.content, file.fits),
                .parameters = {file_named({file.extension})},
                .run = [&open, &solver](const Arguments& a) {
                  open.needs_scene();
                  open.session.solver_load(solver.name, a.text("file"), open.id());
                }});
}

/// What the solver offers in its table, and a wait for it.
void add_leading_commands(Registry& registry, const OpenScene& open, const SolverInfo& solver) {
  // True once preparation waits or is complete, with all in force that was commanded.
  const auto still = [&open, &solver](const Arguments&) {
    const solvers::Report* current = open.report(solver);
    return open.up_to_date() && current && (current->waits || current->ready);
  };
  for (const solvers::CommandInfo& command : solver.commands) {
    Command c{.name = solver.name + "." + command.name,
              .help = command.help,
              .parameters = {},
              .run = [&open, &solver, name = command.name](const Arguments&) {
                open.needs_solver(solver);
                open.session.solver_command(solver.name, name, open.id());
              }};
    if (command.until_still) c.parameters = {time_limit()}, c.done = still;
    registry.add(std::move(c));
  }
  registry.add({.name = "wait_" + solver.name,
                .help = fmt::format("In a script: waits until preparation of {} is paused or "
                                    "complete.",
                                    solver.title),
                .parameters = {time_limit()},
                .run = [&open, &solver](const Arguments&) { open.needs_solver(solver); },
                .done = still});
}

}  // namespace

void add_solver_commands(Registry& registry, const OpenScene& open, SavedFiles& files) {
  for (const SolverInfo* solver : solvers::registered()) {
    if (solver->file) add_file_commands(registry, open, files, *solver);
    if (!solver->commands.empty()) add_leading_commands(registry, open, *solver);
  }
}

}  // namespace lucerna::commands
