// The renderer's solvers: refinement, commands, files and reports by name.
#include <bit>

#include "base/log.h"
#include "scene/hash.h"
#include "session/renderer.h"

namespace lucerna::session {

std::optional<bool> Renderer::refine(const std::function<bool()>& cancel) {
  solvers::Solver* solver = setup_.engine->refining();
  if (!solver) {
    // At powers of two, where passes over the picture end for any size of work items (schedule/uniform.h):
    // the picture does not depend on that size.
    constexpr uint32_t k_least = 16;
    solver = setup_.engine->refinable();
    if (!solver) return std::nullopt;
    const uint32_t samples = sampling_.most_samples();
    if (samples < k_least || !std::has_single_bit(samples) || samples == weighed_at_) return std::nullopt;
    weighed_at_ = samples;
    if (!refining_pays(solvers::offered<solvers::Refinement>(*solver)->paths_refined())) return std::nullopt;
  }
  auto& refinement = *solvers::offered<solvers::Refinement>(*solver);
  const bool went = setup_.engine->with(*solver, picture_view(), [&](const solvers::Picture& picture) {
    return refinement.refine(setup_.engine->wavefront(), picture, cancel);
  });
  if (!refinement.refines()) {
    setup_.film->forget_lookup_errors();
    errors_of_ = nullptr;
  }
  return went;
}

bool Renderer::refining_pays(uint64_t paths) {
  // With n paths both squared errors are proportional to 1/n, with derivative error / n. Refinement doubles
  // its paths in each step, so the two are balanced in the middle of a step.
  const film::ImageError error = image_error();
  const double sampled = error.seen_rms[0] * error.seen_rms[0],
               read = error.seen_lookup_noise * error.seen_lookup_noise;
  return 2 * read / double(paths) > sampled / double(std::max<uint64_t>(stats().paths, 1));
}

void Renderer::solver_command(const std::string& name, const std::string& command) {
  solvers::Solver* found = solver(name);
  if (auto* commands = found ? solvers::offered<solvers::Commands>(*found) : nullptr)
    commands->command(command);
}

void Renderer::inspect(std::optional<vec2> at) {
  Overlays::Mode mode = overlays_.mode();
  mode.inspected = at;
  overlays_.set_mode(mode);
}

void Renderer::set_window_scale(uint32_t scale) {
  Overlays::Mode mode = overlays_.mode();
  mode.scale = std::max(1u, scale);
  overlays_.set_mode(mode);
}

std::vector<std::shared_ptr<const solvers::Report>> Renderer::reports() {
  std::vector<std::shared_ptr<const solvers::Report>> all;
  visit_solvers([&](solvers::Solver& solver, const overlay::Canvas& canvas, const solvers::Picture& picture) {
    all.push_back(solver.report(canvas, picture, samples() > 0));
  });
  if (const solvers::Report* lights = overlays_.lights_report())
    all.push_back(std::make_shared<const solvers::Report>(*lights));
  if (const solvers::Report* focus = overlays_.focus_report())
    all.push_back(std::make_shared<const solvers::Report>(*focus));
  if (const solvers::Report* paths = overlays_.paths_report())
    all.push_back(std::make_shared<const solvers::Report>(*paths));
  return all;
}

double Renderer::figure(const std::string& name) const {
  double sum = 0;
  if (setup_.engine)
    for (const auto& solver : setup_.engine->solvers())
      if (const auto* statistics = solvers::offered<solvers::Statistics>(*solver))
        for (const auto& [key, value] : statistics->figures()) sum += key == name ? value : 0;
  return sum;
}

nlohmann::ordered_json Renderer::solver_statistics() {
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  if (const transport::LightLearning* learning = setup_.engine->wavefront().learning())
    all["lights"] = {{"clusters", learning->clusters().count()},
                     {"rows", learning->rows()},
                     {"records", learning->records()},
                     {"arrived", learning->arrived()},
                     {"gain", learning->gain()},
                     {"bytes", learning->bytes()}};
  visit_solvers([&](solvers::Solver& solver, const overlay::Canvas& canvas, const solvers::Picture& picture) {
    auto* statistics = solvers::offered<solvers::Statistics>(solver);
    if (!statistics) return;
    if (nlohmann::ordered_json own = statistics->statistics(canvas, picture); !own.is_null())
      all[solver.info().name] = std::move(own);
  });
  return all;
}

solvers::Provenance Renderer::provenance() const {
  const scene::LightHash hash = scene::light_hash(*setup_.world.lit);
  return {.scene = setup_.world.scene->name,
          .hashes = {{"geometry", hash.geometry},
                     {"materials", hash.materials},
                     {"lights", hash.lights},
                     {"environment", hash.environment}},
          .view = fmt::format("{} {}x{}", setup_.view_text(), setup_.width, setup_.height)};
}

solvers::Solver& Renderer::solver_for_file(const std::string& name, const std::filesystem::path& file,
                                           const char* nothing, const char* no_scene) {
  if (!setup_.engine) throw Error(file.string(), no_scene);
  if (solvers::Solver* found = solver(name); found && solvers::offered<solvers::Persistence>(*found))
    return *found;
  std::string components;
  if (const solvers::SolverInfo* info = solvers::find(name))
    for (size_t c = 0; c < info->serves.size(); ++c)
      if (info->serves[c])
        components +=
            fmt::format("{}components.{}", components.empty() ? "" : ", ", paths::k_component_names[c]);
  throw_error(file.string(), "{}: no component is computed by '{}' ({})", nothing, name, components);
}

void Renderer::solver_save(const std::string& name, const std::filesystem::path& file) {
  const solvers::Solver& found = solver_for_file(name, file, "there is nothing to save",
                                                 "there is nothing to save yet; load a scene first");
  setup_.engine->with(found, picture_view(), [&](const solvers::Picture& picture) {
    solvers::offered<solvers::Persistence>(found)->save(file.string(), picture, provenance());
  });
}

void Renderer::solver_load(const std::string& name, const std::filesystem::path& file) {
  solvers::Solver& found = solver_for_file(name, file, "nothing would look it up",
                                           "this file is of a scene; load the scene first");
  setup_.engine->with(found, picture_view(), [&](const solvers::Picture& picture) {
    solvers::offered<solvers::Persistence>(found)->load(file.string(), setup_.engine->wavefront(), picture,
                                                        provenance());
  });
  restart(scene::Changes{});
}

void Renderer::finish_early() {
  if (!setup_.engine) return;
  for (const auto& solver : setup_.engine->solvers())
    if (auto* preparation = solvers::offered<solvers::Preparation>(*solver);
        preparation && !preparation->ready())
      preparation->finish_early();
}

}  // namespace lucerna::session
