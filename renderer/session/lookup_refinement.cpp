#include "session/lookup_refinement.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace lucerna::session {

std::optional<bool> LookupRefinement::step(const std::function<bool()>& cancel) {
  const PictureView view = setup_.view(context_.automaton);
  // As soon as every pixel has a sample, so that the picture does not wait, and before errors are published.
  solvers::Solver* solver = sampling_.samples() > 0 ? setup_.engine->owing_errors(*setup_.film) : nullptr;
  if (!solver) return refine(view, cancel);
  const bool restarted = std::exchange(errors_of_, solver) != solver;
  return setup_.engine->with(*solver, view, [&](const solvers::Picture& picture) {
    return solvers::offered<solvers::LookupErrors>(*solver)->estimate_errors(
        setup_.engine->wavefront(), *setup_.film, picture, restarted, cancel);
  });
}

std::optional<bool> LookupRefinement::refine(const PictureView& view, const std::function<bool()>& cancel) {
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
    if (!pays(solvers::offered<solvers::Refinement>(*solver)->paths_refined())) return std::nullopt;
  }
  auto& refinement = *solvers::offered<solvers::Refinement>(*solver);
  const bool went = setup_.engine->with(*solver, view, [&](const solvers::Picture& picture) {
    return refinement.refine(setup_.engine->wavefront(), picture, cancel);
  });
  if (!refinement.refines()) {
    setup_.film->forget_lookup_errors();
    errors_of_ = nullptr;
  }
  return went;
}

bool LookupRefinement::pays(uint64_t paths) const {
  // With n paths both squared errors are proportional to 1/n, with derivative error / n. Refinement doubles
  // its paths in each step, so the two are balanced in the middle of a step.
  const film::ImageError error = progress_.estimate_error();
  const double sampled = error.seen_rms[0] * error.seen_rms[0],
               read = error.seen_lookup_noise * error.seen_lookup_noise;
  const uint64_t traced = setup_.engine->wavefront().stats().paths;
  return 2 * read / double(paths) > sampled / double(std::max<uint64_t>(traced, 1));
}

}  // namespace lucerna::session
