#include "solvers/registry.h"

#include <stdexcept>

#include "solvers/irradiance_cache/info.h"
#include "solvers/path_tracing/info.h"

namespace lucerna::solvers {
namespace {

struct Registry {
  std::vector<const SolverInfo*> list{&path_tracing::info(), &irradiance_cache::info()};
  bool read = false;
};

Registry& registry() {
  static Registry all;
  return all;
}

}  // namespace

const std::vector<const SolverInfo*>& registered() {
  registry().read = true;
  return registry().list;
}

void add(const SolverInfo& solver) {
  if (registry().read) throw std::logic_error("solvers::add: the list of solvers is in use already");
  registry().list.push_back(&solver);
}

const SolverInfo* find(std::string_view name) {
  for (const SolverInfo* solver : registered())
    if (solver->name == name) return solver;
  return nullptr;
}

const SolverInfo* owner_of(std::string_view key) {
  for (const SolverInfo* solver : registered())
    for (const OptionInfo& option : solver->options)
      if (option.key == key) return solver;
  return nullptr;
}

Spoils spoiled_by_setting(const SolverInfo& solver, std::string_view key) {
  const SolverInfo* owner = owner_of(key);
  return owner && owner != &solver ? k_spoils_nothing : spoiled_by(solver, key);
}

Spoils spoiled_by(const SolverInfo& solver, const scene::Changes& changes) {
  Spoils all;
  for (const scene::Change edit : changes.edits) all |= spoiled_by(solver, edit);
  for (const std::string& key : changes.settings) all |= spoiled_by_setting(solver, key);
  return all;
}

}  // namespace lucerna::solvers
