#include "solvers/light_tracing/solver.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "solvers/light_tracing/info.h"
#include "transport/aim.h"
#include "transport/casters.h"

namespace lucerna::light_tracing {

using namespace shared;
using solvers::Cancel, solvers::Picture, solvers::Task;

namespace {

constexpr uint32_t k_least_paths = 1u << 14, k_most_paths = 1u << 20;  // automatic number of paths

/// True if the scene has specular or glossy surfaces.
bool focuses(const Task& task) {
  const upload::Effects& e = task.effects;
  return e.specular || e.solid_glass || e.thin_glass;
}

std::unique_ptr<solvers::Solver> make(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t,
                                      const Task& task) {
  return std::make_unique<LightTracingSolver>(device, compiler, task);
}

/// Integer step of the sums. Small compared to a path's contribution at a distance of the width of the
/// scene's core, and coarse enough that a contribution at a thirty-thousandth of that distance still fits; at
/// thirty thousand times the distance it is a few steps.
float unit_of(const Picture& picture, double power, uint32_t paths) {
  const Frame& f = picture.frame;
  const double area = 4.0 * double(glm::length(f.camera_right)) * double(glm::length(f.camera_up)) /
                      (double(picture.width) * picture.height);
  const double far =
      f.projection == shared::k_projection_orthographic ? 1.0 : double(picture.flat.core_radius);
  const double unit = std::exp2(-34) * power / (double(paths) * area * far * far);
  return std::isfinite(unit) && unit > 1e-37 ? float(std::min(unit, 1e30)) : 1e-37f;
}

}  // namespace

const solvers::SolverType& type() {
  static const solvers::SolverType all{.info = light_tracing::info(),
                                       .routing = LightTracingSolver::routing_of,
                                       .make = make,
                                       .least_slots = 0,
                                       .sun_threshold = nullptr};
  return all;
}

solvers::Routing LightTracingSolver::routing_of(const Task& task) {
  paths::LookupRoutes routes = paths::camera_routes(task.automaton, task.enabled, task.own);
  if (!focuses(task)) routes.replaced.clear(), routes.parts = 0;
  return {.lookups = std::move(routes), .fallback = 0, .gather = {}};
}

LightTracingSolver::LightTracingSolver(gpu::Device& device, gpu::ShaderCompiler& compiler, const Task& task)
    : device_(device),
      routes_(routing_of(task).lookups),
      sends_(routes_.parts != 0),
      splats_(device, compiler, *task.scene_defines, task.automaton, task.effects.has_compact_groups()),
      paths_view_(device, compiler, *task.scene_defines, task.automaton) {}

const solvers::SolverInfo& LightTracingSolver::info() const { return light_tracing::info(); }

gpu::Defines LightTracingSolver::defines() const {
  return sends_ ? gpu::Defines{{"LUCERNA_SPLATS", "1"}} : gpu::Defines{};
}

void LightTracingSolver::bind(gpu::Resources& resources) const { splats_.bind(resources); }

bool LightTracingSolver::serves(const Task& task) const {
  const paths::LookupRoutes routes = routing_of(task).lookups;
  return routes.replaced == routes_.replaced && routes.parts == routes_.parts;
}

void LightTracingSolver::begin(const Picture& picture, solvers::Invalidation invalidated) {
  if (!lit_ || invalidated.light || invalidated.places) {
    lights_ = transport::LightSource(device_, picture.flat);
    lit_ = true, casters_set_ = false;
  }
  splats_.restart();
  begun_ = false;
  rounds_ = paths_ = joined_ = escaped_ = dark_ = 0;
  trace_s_ = 0;
  const bool aims = sends_ && lights_.power() > 0 && picture.task.settings.boolean("light.aim");
  const bool stale = invalidated.any() || aims != aims_ || !transport::same_view(picture.frame, aimed_for_);
  aims_ = aims;
  // The casters do not depend on the view.
  if (invalidated.light || invalidated.places || !aims) casters_.clear(), casters_known_ = false;
  if (!stale) return;
  aimed_ = false, casters_set_ = false;
  aimed_for_ = picture.frame;
  pairs_.clear();
  lights_.aim(device_, picture.flat, {}, 1);
}

bool LightTracingSolver::prepare(transport::Wavefront& wavefront, const Picture& picture,
                                 const Cancel& cancel) {
  if (ready()) return true;
  if (!casters_set_) {
    if (!casters_known_) casters_ = transport::find_casters(picture.flat), casters_known_ = true;
    lights_.aim(device_, picture.flat, casters_, 0.5);
    casters_set_ = true;
    aimed_ = casters_.empty();
    return true;
  }
  transport::LightRound round = round_of(picture, transport::k_pilot_round);
  round.paths = std::max(transport::k_pilot_paths, transport::k_pilot_paths_a_stratum * lights_.strata());
  if (!begun_) {
    splats_.begin(wavefront, picture.width, picture.height, round.account,
                  unit_of(picture, lights_.power(), round.paths));
    begun_ = true;
  }
  bool cancelled = false;
  const auto stops = [&] { return cancelled = cancel && cancel(); };
  const auto contributions =
      splats_.weigh(wavefront, lights_, round, picture.frame, picture.task.enabled, stops);
  if (!contributions) return !cancelled;
  lights_.share_out(transport::aim_shares(*contributions, transport::k_least_unaimed_of_caustics));
  pairs_ = overlay::aimed_pairs(picture.flat, lights_);
  aimed_ = true, begun_ = false;
  return true;
}

transport::LightRound LightTracingSolver::round_of(const Picture& picture, uint32_t sample) const {
  const uint64_t pixels = uint64_t{picture.width} * picture.height;
  const auto requested = uint32_t(picture.task.settings.integer("light.per_round"));
  return {.number = sample,
          .paths =
              requested > 0 ? requested : uint32_t(std::clamp<uint64_t>(pixels, k_least_paths, k_most_paths)),
          .parts = routes_.parts,
          .account = uint32_t(std::countr_zero(std::max(1u, picture.task.own)))};
}

bool LightTracingSolver::round_ready(uint32_t sample) const {
  return begun_ && splats_.complete() && last_sample_ == sample;
}

bool LightTracingSolver::prepare_round(transport::Wavefront& wavefront, const Picture& picture,
                                       uint32_t sample, const Cancel& cancel) {
  const transport::LightRound round = round_of(picture, sample);
  if (!begun_) {
    splats_.begin(wavefront, picture.width, picture.height, round.account,
                  unit_of(picture, lights_.power(), round.paths));
    begun_ = true;
  }
  if (!splats_.trace(wavefront, lights_, round, picture.frame, picture.task.enabled, cancel)) return false;
  if (!splats_.complete()) return true;
  const RoundFigures& f = splats_.figures();
  last_sample_ = sample;
  ++rounds_, paths_ += f.paths, joined_ += f.joined, escaped_ += f.escaped, dark_ += f.dark;
  trace_s_ += f.trace_s;
  return true;
}

void LightTracingSolver::draw(const overlay::Canvas& canvas, const Picture& picture) {
  const OptionValues& s = picture.task.settings;
  if (!sends_) return;
  if (s.boolean("overlay.light_paths"))
    paths_view_.draw(canvas, picture.flat, lights_, round_of(picture, 0),
                     uint32_t(s.integer("overlay.light_paths_of")), picture.frame, picture.task.enabled);
  if (s.boolean("overlay.light_aim") && !casters_.empty())
    paths_view_.draw_aim(canvas, picture.flat, lights_, casters_);
}

LightTracingReport LightTracingSolver::state(const Picture& picture) const {
  LightTracingReport r;
  r.lights_power = lights_.power();
  r.sends = sends_, r.ready = ready();
  r.rounds = rounds_, r.paths = paths_, r.joined = joined_, r.escaped = escaped_, r.dark = dark_;
  r.last = splats_.figures();
  r.casters = uint32_t(casters_.size());
  r.unaimed = lights_.shares().empty() ? 1 : lights_.shares()[0];
  r.sent_per_s = trace_s_ > 0 ? double(paths_) / trace_s_ : 0;
  r.bytes = splats_.bytes() + lights_.bytes();
  r.paths_shown = picture.task.settings.boolean("overlay.light_paths");
  r.aim_shown = picture.task.settings.boolean("overlay.light_aim");
  r.aimed = pairs_;
  return r;
}

std::shared_ptr<const solvers::Report> LightTracingSolver::report(const overlay::Canvas&,
                                                                  const Picture& picture, bool) {
  return std::make_shared<const solvers::Report>(make_report(state(picture)));
}

nlohmann::ordered_json LightTracingSolver::statistics(const overlay::Canvas&, const Picture& picture) {
  const LightTracingReport r = state(picture);
  return {{"per_second", {{"emitted", r.sent_per_s}}},
          {"rounds", r.rounds},
          {"paths", r.paths},
          {"joined", r.joined},
          {"escaped", r.escaped},
          {"dark", r.dark},
          {"casters", r.casters},
          {"unaimed", r.unaimed},
          {"last_round_pixels", r.last.pixels},
          {"bytes", r.bytes}};
}

std::map<std::string, double> LightTracingSolver::figures() const {
  return {{"rounds of light tracing", double(rounds_)},
          {"light paths", double(paths_)},
          {"joined to the camera", double(joined_)},
          {"seconds of light paths", trace_s_}};
}

}  // namespace lucerna::light_tracing
