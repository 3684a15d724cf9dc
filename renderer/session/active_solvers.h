#pragma once
// The active solvers by name (solvers/registry.h): their commands, files, reports and figures. Path tracing
// is not one of them: it is the wavefront.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "session/overlays.h"
#include "session/sampling.h"
#include "session/transaction.h"

namespace lucerna::session {

class ActiveSolvers {
 public:
  /// All must outlive it.
  ActiveSolvers(const SetupContext& context, Setup& setup, const Sampling& sampling, Overlays& overlays)
      : context_(context), setup_(setup), sampling_(sampling), overlays_(overlays) {}

  /// Null if it computes nothing.
  solvers::Solver* find(std::string_view name) { return setup_.engine ? setup_.engine->find(name) : nullptr; }
  /// Runs one of SolverInfo::commands; does nothing if the solver is not active.
  void command(const std::string& name, const std::string& command);
  /// Writes the data of a solver (SolverInfo::file), once it is ready. Throws Error located at `file`: the
  /// solver is not active, not ready, or the file cannot be written (then the old file stays).
  void save(const std::string& name, const std::filesystem::path& file);
  /// Renderer::solver_load, without the restart.
  void load(const std::string& name, const std::filesystem::path& file);
  /// True if all solvers have data for most of the picture (solvers::Preparation::usable).
  bool usable() const;
  /// True if a user steps through the preparation of one (solvers::Preparation::stepped).
  bool stepped() const;
  /// Ends preparation as soon as possible (solvers::Preparation::finish_early).
  void finish_early();
  /// Reports for the picture that the latest PictureOutput::picture() has shown, of solvers and of views over
  /// the picture.
  std::vector<std::shared_ptr<const solvers::Report>> reports();
  /// Sum of a figure over the solvers (solvers::Statistics::figures); 0 if none has it.
  double figure(const std::string& name) const;
  /// Statistics by solver, for --stats.
  nlohmann::ordered_json statistics();

 private:
  std::vector<const solvers::Preparation*> preparations() const;  // of the solvers that prepare
  solvers::Provenance provenance() const;
  solvers::Solver& for_file(const std::string& name, const std::filesystem::path& file, const char* nothing,
                            const char* no_scene);

  const SetupContext& context_;
  Setup& setup_;
  const Sampling& sampling_;
  Overlays& overlays_;
};

}  // namespace lucerna::session
