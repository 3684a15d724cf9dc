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

bool LookupRefinement::begin(solvers::Refinement& refinement) {
  // At powers of two, where passes over the picture end for any size of work items (schedule/uniform.h): the
  // picture does not depend on that size.
  constexpr uint32_t k_least = 4;
  const uint32_t samples = sampling_.mark();
  if (samples < k_least) return false;
  const uint64_t paths = refinement.paths_refined();
  if (samples != weighing_.samples)
    weighing_ = {.samples = samples, .most_paths = paths + setup_.engine->wavefront().stats().paths};
  if (weighing_.over) return false;
  const double factor = balanced(paths);
  if (factor > 1) refinement.begin_refining(factor);
  weighing_.paths_before = paths;
  weighing_.over = !refinement.refines();
  return !weighing_.over;
}

std::optional<bool> LookupRefinement::refine(const PictureView& view, const std::function<bool()>& cancel) {
  solvers::Solver* solver = setup_.engine->refining();
  if (!solver) solver = setup_.engine->refinable();
  if (!solver) return std::nullopt;
  auto& refinement = *solvers::offered<solvers::Refinement>(*solver);
  if (!refinement.refines() && !begin(refinement)) return std::nullopt;
  const bool went = setup_.engine->with(*solver, view, [&](const solvers::Picture& picture) {
    return refinement.refine(setup_.engine->wavefront(), picture, cancel);
  });
  if (refinement.refines()) return went;
  if (refinement.paths_refined() == weighing_.paths_before) {
    // The bound was still too high, or all data have all paths that they can have.
    constexpr uint32_t k_most_idle = 8;
    weighing_.over = ++weighing_.idle == k_most_idle;
    return went;
  }
  weighing_.idle = 0;
  setup_.film->outdate_lookup_errors();
  errors_of_ = nullptr;
  return went;
}

double LookupRefinement::balanced(uint64_t paths) const {
  // With n paths both squared errors are proportional to 1/n, with derivative error / n: a path gains equally
  // on both sides if these are equal. A factor f on the records' paths divides their ratio by f^2.
  const film::ImageError error = progress_.estimate_error();
  const double sampled = error.seen_rms[0] * error.seen_rms[0],
               read = error.seen_lookup_noise * error.seen_lookup_noise;
  const double traced = double(std::max<uint64_t>(setup_.engine->wavefront().stats().paths, 1));
  // By whole doublings, so that the two are balanced in the middle of one. The picture waits meanwhile: at
  // most about as long as it has taken so far.
  double factor = 1;
  while (factor * double(paths) < double(weighing_.most_paths) &&
         2 * read * traced > sampled * double(paths) * factor * factor)
    factor *= 2;
  return factor;
}

}  // namespace lucerna::session
