#include "solvers/registry.h"

#include <stdexcept>

#include "solvers/irradiance_cache/solver.h"
#include "solvers/light_tracing/solver.h"
#include "solvers/path_tracing/info.h"
#include "solvers/photons/solver.h"

namespace lucerna::solvers {
namespace {

const SolverType k_path_tracing{.info = path_tracing::info()};

struct Registry {
  std::vector<const SolverType*> types{&k_path_tracing, &irradiance_cache::type(), &photons::type(),
                                       &light_tracing::type()};
  std::vector<const SolverInfo*> infos;  ///< filled by the first registered()
};

Registry& registry() {
  static Registry all;
  return all;
}

}  // namespace

const std::vector<const SolverInfo*>& registered() {
  Registry& r = registry();
  if (r.infos.empty())
    for (const SolverType* type : r.types) r.infos.push_back(&type->info);
  return r.infos;
}

void add(const SolverType& solver) {
  if (!registry().infos.empty())
    throw std::logic_error("solvers::add: the list of solvers is in use already");
  registry().types.push_back(&solver);
}

const SolverType& type_of(const SolverInfo& solver) {
  for (const SolverType* type : registry().types)
    if (&type->info == &solver) return *type;
  throw std::logic_error("solvers::type_of: '" + solver.name + "' is not registered");
}

const SolverInfo* find(std::string_view name) {
  for (const SolverInfo* solver : registered())
    if (solver->name == name) return solver;
  return nullptr;
}

bool chooses(std::string_view choice, std::string_view solver) {
  const size_t plus = choice.find('+');
  return choice.substr(0, plus) == solver ||
         (plus != std::string_view::npos && choice.substr(plus + 1) == solver);
}

const SolverInfo* owner_of(std::string_view key) {
  for (const SolverInfo* solver : registered())
    for (const OptionInfo& option : solver->options)
      if (option.key == key) return solver;
  return nullptr;
}

Invalidation invalidated_by_setting(const SolverInfo& solver, std::string_view key) {
  const SolverInfo* owner = owner_of(key);
  return owner && owner != &solver ? k_invalidates_nothing : invalidated_by(solver, key);
}

Invalidation invalidated_by(const SolverInfo& solver, const scene::Changes& changes) {
  Invalidation all;
  for (const scene::Change edit : changes.edits) all |= invalidated_by(solver, edit);
  for (const std::string& key : changes.settings) all |= invalidated_by_setting(solver, key);
  return all;
}

}  // namespace lucerna::solvers
