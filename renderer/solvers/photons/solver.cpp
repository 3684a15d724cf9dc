#include "solvers/photons/solver.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/timer.h"
#include "solvers/photons/info.h"

namespace lucerna::photons {

using namespace shared;
using paths::k_secondary, paths::k_tertiary, paths::k_caustic;
using paths::k_secondary_bit, paths::k_tertiary_bit, paths::k_caustic_bit, paths::k_caustic_part;
using solvers::Picture, solvers::Task, solvers::Cancel;

namespace {

constexpr uint32_t k_least_paths = 1u << 14, k_most_paths = 1u << 20;  // automatic number of paths
// While rounds only seek light that paths cannot find, and have found none: their share of the paths, and the
// minimum. Every round is unbiased on its own, whatever its number of paths.
constexpr uint32_t k_vain_share = 16, k_vain_paths = 1024;
constexpr uint32_t k_most_light_groups = 64;
// A typical lookup finds about this many standing photons; errors there affect all lookups around. The radius
// is constant, independent of the view, and at most as wide as for one photon per path on a cube inside the
// scene's sphere.
constexpr uint32_t k_standing_round = 0xfffffe00u;
constexpr float k_standing_photons = 30;
/// Light paths of standing photons: for records; and for gathering paths, per pixel, and at least, at first.
/// Later maps have more, in proportion to the samples.
constexpr uint32_t k_paths_for_records = 1u << 20, k_gather_paths_a_pixel = 2,
                   k_least_gather_paths = 1u << 17, k_most_gather_paths = 1u << 22;
/// Minimum photons that determine an irradiance cell; as many again determine its light.
constexpr uint32_t k_cell_photons = 8;
/// Maximum size of irradiance cells, in discs that contain as many photons at typical lookups.
constexpr float k_widest = 8;
/// Maximum radius over half the smaller side of the picture for orthographic cameras; otherwise
/// k_photon_most_slope limits it.
constexpr float k_most_radius = 0.25f;

paths::LookupRoutes routes_of(const Task& task) {
  return paths::photon_routes(task.automaton, task.enabled, task.own, task.directly_visible_by_other);
}

/// Parts of light that are looked up and exist: caustics only if the scene has specular or glossy surfaces.
uint32_t parts_of(const Task& task) {
  const upload::Effects& e = task.effects;
  const bool focuses = e.specular || e.solid_glass || e.thin_glass;
  return routes_of(task).parts & (focuses ? ~0u : ~(1u << k_caustic_part));
}

/// True if another solver traces rays to prepare secondary light for lookups, and this solver computes
/// tertiary light.
bool feeds(const Task& task) {
  return (task.own >> k_tertiary & 1u) != 0 && (task.consuming >> k_secondary & 1u) != 0;
}

/// True if tertiary light is read from an irradiance map: lookups are behind a diffuse vertex, which is not
/// so if this solver computes secondary light too.
bool prepares_irradiance(const Task& task) {
  enum : uint32_t { off, records, all };
  const auto requested = uint32_t(task.settings.choice("photons.irradiance_map"));
  const bool wanted = requested == all || (requested == records && feeds(task));
  return wanted && parts_of(task) != 0 && (task.own >> k_tertiary & 1u) != 0 &&
         (task.own >> k_secondary & 1u) == 0;
}

/// True if all own light is read from it.
bool gathers_alone(const Task& task) { return prepares_irradiance(task) && task.own == k_tertiary_bit; }

/// States of the eye path in which lookups contribute tertiary light and nothing else.
uint64_t tertiary_states(const PhotonFrame& lookup) {
  uint64_t states = 0;
  for (uint32_t state = 0; state < k_automaton_states; ++state) {
    bool some = false, others = false;
    for (uint32_t p = 0; p < paths::k_part_count; ++p) {
      if ((lookup.component[state] >> (k_photon_unreachable_only_shift + p) & 1u) != 0) continue;
      const uint32_t c = lookup.component[state] >> 4 * p & 15u;
      some = some || c == k_tertiary, others = others || (c != k_tertiary && c != k_photon_no_component);
    }
    if (some && !others) states |= uint64_t{1} << state;
  }
  return states;
}

/// Lookups of light of these components that no eye path finds: at the first diffuse vertex, because paths
/// continue for all other light.
paths::LookupRoutes unreachable_routes(const Task& task, uint32_t components) {
  constexpr uint32_t k_photon_components = k_secondary_bit | k_tertiary_bit | k_caustic_bit;
  paths::LookupRoutes routes = paths::photon_routes(
      task.automaton, task.enabled, task.enabled & k_photon_components, task.directly_visible_by_other);
  routes.parts = 0;
  for (auto& by_part : routes.component)
    for (uint32_t p = 0; p < paths::k_part_count; ++p) {
      uint8_t& c = by_part[p];
      if (c == paths::k_no_component || c == k_secondary || (components >> c & 1u) == 0)
        c = paths::k_no_component;
      else
        routes.parts |= 1u << p;
    }
  return routes;
}

nlohmann::ordered_json component_names(uint32_t components) {
  nlohmann::ordered_json names = nlohmann::ordered_json::array();
  for (const size_t c : k_components)
    if ((components >> c & 1u) != 0) names.push_back(paths::k_component_names[c]);
  return names;
}

/// Size of the scene without distant outliers, which must not change the radius.
float most_radius(const Frame& frame) {
  if (frame.projection != shared::k_projection_orthographic) return std::numeric_limits<float>::max();
  return k_most_radius * std::min(glm::length(frame.camera_right), glm::length(frame.camera_up));
}

/// Index of the irradiance map that a sample reads: 0 for the first ones, then 1, ...
uint32_t epoch_of(uint32_t sample) {
  return uint32_t(std::bit_width(sample / PhotonSolver::k_first_gather_samples + 1)) - 1;
}

std::unique_ptr<solvers::Solver> make(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t,
                                      const Task& task) {
  return std::make_unique<PhotonSolver>(device, compiler, task);
}

}  // namespace

const solvers::SolverType& type() {
  static const solvers::SolverType all{.info = photons::info(),
                                       .routing = PhotonSolver::routing_of,
                                       .make = make,
                                       .delegable_components = PhotonSolver::delegable_components,
                                       .least_slots = 0,
                                       .sun_threshold = nullptr};
  return all;
}

solvers::Routing PhotonSolver::routing_of(const Task& task) {
  paths::LookupRoutes routes = routes_of(task);
  if (parts_of(task) == 0) routes.component.clear(), routes.parts = 0;
  // A gathering path that finds too few photons continues for the light it would have read; so do records'
  // rays.
  const bool goes_on = feeds(task) || prepares_irradiance(task);
  const uint32_t others = task.own & ~k_tertiary_bit;
  return {.lookups = routes, .fallback = goes_on ? task.enabled & ~others : 0, .gather = {}};
}

RadiusLaw PhotonSolver::radius_law(const OptionValues& settings) {
  return {.first = settings.real("photons.radius"),
          .floor = settings.real("photons.floor"),
          .alpha = settings.real("photons.alpha")};
}

uint32_t PhotonSolver::delegable_components(const Task& task) {
  const bool computes =
      (parts_of(task) >> k_caustic_part & 1u) != 0 && (task.directly_visible_by_other & k_caustic_bit) == 0;
  return computes && task.settings.boolean("photons.efficiency") ? task.own & k_caustic_bit : 0;
}

PhotonSolver::PhotonSolver(gpu::Device& device, gpu::ShaderCompiler& compiler, const Task& task)
    : device_(device),
      compiler_(compiler),
      scene_defines_(*task.scene_defines),
      routes_(routes_of(task)),
      delegable_(delegable_components(task)),
      parts_(parts_of(task)),
      sends_(parts_ != 0),
      map_(device, compiler, *task.scene_defines, task.automaton),
      feeds_(sends_ && feeds(task)),
      view_(device, compiler),
      paths_view_(device, compiler, *task.scene_defines, task.automaton),
      inspector_(device, compiler, *task.scene_defines),
      surfaces_(device) {
  if (prepares_irradiance(task))
    irradiance_.emplace(device, task.effects.has_compact_groups() ? task.effects.light_groups : 0);
  gathers_alone_ = gathers_alone(task);
  route(task);
  write_delegated_regions();
}

gpu::Defines PhotonSolver::defines() const {
  gpu::Defines defines;
  if (sends_) defines["LUCERNA_LOOKUP_BIAS"] = "1";
  if ((parts_ & 1u) != 0) defines["LUCERNA_PHOTON_DIRECT"] = "1";
  if (irradiance_) defines["LUCERNA_PHOTON_IRRADIANCE"] = "1";
  if (delegable_ != 0) defines["LUCERNA_DELEGATED_REGIONS"] = "1";
  return defines;
}

const solvers::SolverInfo& PhotonSolver::info() const { return photons::info(); }

void PhotonSolver::bind(gpu::Resources& resources) const {
  shown_map().bind(resources);
  if (irradiance_) irradiance_->bind(resources);
  surfaces_.bind(resources);
  resources.set("delegated_regions", delegated_regions_);
}

bool PhotonSolver::serves(const Task& task) const {
  return routes_of(task).component == routes_.component && parts_of(task) == parts_ &&
         delegable_components(task) == delegable_ && (sends_ && feeds(task)) == feeds_ &&
         prepares_irradiance(task) == irradiance_.has_value() && gathers_alone(task) == gathers_alone_;
}

void PhotonSolver::begin(const Picture& picture, solvers::Invalidation invalidated) {
  if (!lit_ || invalidated.light || invalidated.places) {
    lights_ = transport::LightSource(device_, picture.flat);
    light_groups_ = transport::group_lights(picture.flat, lights_.powers(), k_most_light_groups);
    lit_ = true;
  }
  if (invalidated.places) map_.clear(), surfaces_.invalidate();
  if (invalidated.any()) inspector_.forget();
  if (invalidated.places && irradiance_) irradiance_->invalidate();
  if (standing_ && invalidated.any()) standing_->clear();
  if (irradiance_ && invalidated.any()) irradiance_->clear();
  if ((feeds_ || irradiance_) && !standing_)
    standing_.emplace(device_, compiler_, scene_defines_, picture.task.automaton);
  if (standing_) standing_->store_surface(irradiance_.has_value());
  reads_standing_ = standing_served_ = false;
  map_.restart();
  ++begun_;
  fresh_ = true;
  begin_aim(picture, invalidated);
  rounds_ = paths_ = photons_ = escaped_ = dark_ = 0;
  trace_s_ = build_s_ = 0;
  spared_ = 0;
}

void PhotonSolver::look_up_preview(transport::Wavefront& wavefront, bool on) {
  (void)wavefront;
  map_.hold_notes(on);
}

uint32_t PhotonSolver::whole_parts() const {
  const uint32_t parts = parts_ & here_routes_.parts;
  return regions_.nowhere ? parts & ~(1u << k_caustic_part) : parts;
}

uint32_t PhotonSolver::sent_parts() const {
  return whole_parts() | (parts_ & (unreachable_here_.parts | unreachable_delegated_.parts));
}

void PhotonSolver::route(const Task& task) {
  const auto routes = [&](uint32_t delegated) {
    return paths::photon_routes(task.automaton, task.enabled, task.own & ~delegated,
                                task.directly_visible_by_other);
  };
  here_routes_ = routes(delegated_), delegated_routes_ = routes(delegated_ | delegable_);
  // Paths that find no irradiance continue on their own, too.
  const uint32_t by_paths = delegated_ | (gathers() && !feeds_ ? k_tertiary_bit : 0);
  const auto unreachable = [&](uint32_t components) {
    return unreachable_routes(task, unreachable_found_ ? components & task.own : 0);
  };
  unreachable_here_ = unreachable(by_paths), unreachable_delegated_ = unreachable(by_paths | delegable_);
}

bool PhotonSolver::gathers() const { return irradiance_ && (delegated_ >> k_tertiary & 1u) == 0; }

bool PhotonSolver::reads_rounds() const {
  // If only irradiance is read, rounds are traced for light that no path finds.
  return sent_parts() != 0 && !(gathers_alone_ && gathers() && unreachable_here_.parts == 0);
}

bool PhotonSolver::round_ready(uint32_t sample) const {
  return (!reads_rounds() || (!fresh_ && map_.complete() && last_sample_ == sample)) &&
         (!renews_standing() || standing_made(epoch_of(sample)));
}

Round PhotonSolver::round_of(const Picture& picture, uint32_t sample) const {
  const OptionValues& s = picture.task.settings;
  Round round;
  round.number = sample;
  const auto requested = uint32_t(s.integer("photons.per_round"));
  round.paths = requested > 0 ? requested : paths_of_round(picture);
  round.parts = sent_parts();
  round.account = uint32_t(std::countr_zero(std::max(1u, picture.task.own)));

  round.lookup = lookup_of(picture, picture.frame, radius_law(s).at(sample));
  return round;
}

uint32_t PhotonSolver::paths_of_round(const Picture& picture) {
  const uint64_t pixels = uint64_t{picture.width} * picture.height;
  return uint32_t(std::clamp<uint64_t>(pixels, k_least_paths, k_most_paths));
}

PhotonFrame PhotonSolver::lookup_of(const Picture& picture, const Frame& frame, double radius_pixels) const {
  PhotonFrame f{};
  const auto pixel =
      float(2 * glm::length(frame.camera_right) / float(frame.width));  // at 1 m, or everywhere
  const float radius = pixel * float(radius_pixels);
  f.eye = frame.camera_origin;
  f.slope = frame.projection == shared::k_projection_orthographic ? 0 : std::min(radius, k_photon_most_slope);
  f.base = frame.projection == shared::k_projection_orthographic ? radius : 0;
  f.most = most_radius(frame);
  f.most_candidates = k_photon_most_candidates, f.most_visits = k_photon_most_visits;
  f.surface_nodes = picture.task.settings.boolean("photons.borders") ? surfaces_.nodes() : 0;
  // Paths in the fallback states of another solver find photons like all others.
  for (uint32_t state = 0; state < k_automaton_states; ++state) {
    const uint32_t of_eye = without_phase(state), phase = phase_of(state);
    const bool here = state < k_delegated_states;
    const paths::LookupRoutes &routes = here ? here_routes_ : delegated_routes_,
                              &unreachable = here ? unreachable_here_ : unreachable_delegated_;
    f.component[state] = k_photon_no_components;
    // Paths that continued for lack of data look up no more, except records' rays, which start in these
    // states.
    const bool continued = gathers() && !feeds_ ? phase != k_phase_start : phase == k_phase_known;
    if (continued || of_eye >= routes.component.size()) continue;
    uint32_t packed = 0;
    for (uint32_t p = 0; p < paths::k_part_count; ++p) {
      uint8_t c = routes.component[of_eye][p];
      // Records contribute tertiary light to paths that they serve; photons contribute it to the records'
      // rays and to paths without records, both in other states.
      if (feeds_ && phase == k_phase_start && c == k_tertiary) c = paths::k_no_component;
      if (c == paths::k_no_component && phase == k_phase_start) {
        c = unreachable.component[of_eye][p];
        if (c != paths::k_no_component) packed |= 1u << (k_photon_unreachable_only_shift + p);
      }
      packed |= (c == paths::k_no_component ? k_photon_no_component : uint32_t{c}) << 4 * p;
    }
    f.component[state] = packed;
  }
  return f;
}

bool PhotonSolver::standing_made(uint32_t epoch) const {
  const auto made = [&](bool complete, uint32_t round) {
    return complete && round >= k_standing_round + epoch;
  };
  return made(standing_->complete(), standing_->round()) &&
         (!irradiance_ || made(irradiance_->complete(), irradiance_round_));
}

bool PhotonSolver::make_standing(transport::Wavefront& wavefront, const Picture& picture, uint32_t epoch,
                                 const Cancel& cancel) {
  const OptionValues& s = picture.task.settings;
  if (s.boolean("photons.borders") && !surfaces_.serves(picture.flat)) {
    surfaces_.make(device_, picture.flat);
    wavefront.rebind_lookup();
    return true;
  }
  const uint32_t number = k_standing_round + epoch;
  if (!standing_->complete() || standing_->round() < number) {
    Round round = round_of(picture, number);
    const uint64_t pixels = uint64_t{picture.width} * picture.height;
    const auto requested = uint64_t(s.integer("photons.per_round"));
    const uint64_t first =
        requested > 0 ? requested : std::max<uint64_t>(k_gather_paths_a_pixel * pixels, k_least_gather_paths);
    round.paths =
        feeds_
            ? std::max(k_paths_for_records, round.paths)
            : uint32_t(std::min<uint64_t>(
                  k_most_light_paths,
                  std::max(first, std::min<uint64_t>(first << std::min(epoch, 32u), k_most_gather_paths))));
    round.lookup = lookup_of(picture, picture.frame, 1);
    round.lookup.slope = 0;
    round.lookup.most_candidates = k_photon_standing_candidates;
    round.lookup.base = standing_radius(picture, standing_->fitting(round.paths), k_standing_photons);
    round.lookup.most = round.lookup.base;
    standing_->store_by_importance_of(map_);
    standing_->store_parts(0, gathers() && !feeds_ && unreachable_found_);
    if (!standing_->trace(wavefront, lights_, round, picture.frame, picture.task.enabled, cancel))
      return false;
    if (!reads_rounds() && standing_->traced() == 0) account(standing_->figures());
    return true;
  }
  if (irradiance_->complete()) irradiance_->restart();
  irradiance_->make(
      wavefront, *standing_, picture.flat,
      {.nearest = k_cell_photons,
       .widest = k_widest * standing_radius(picture, standing_->figures().paths, 2 * float(k_cell_photons)),
       .states = tertiary_states(standing_->lookup()),
       // rounds do not serve records' rays, and continuing paths cannot find point lights in mirrors
       .gathers = feeds_ && hides_,
       .max_depth = picture.frame.max_depth});
  irradiance_round_ = standing_->round();
  return true;
}

float PhotonSolver::standing_radius(const Picture& picture, uint32_t paths, float photons) const {
  const auto found = float(density_at_lookups_ * paths);  // photons per square metre
  const float widest = picture.flat.core_radius * std::sqrt(8 * photons / (k_pi * float(paths)));
  return found > 0 ? std::min(widest, std::sqrt(photons / (k_pi * found))) : widest;
}

bool PhotonSolver::prepare_standing(transport::Wavefront& wavefront, const Picture& picture,
                                    const Cancel& cancel) {
  if (!standing_made(0)) return make_standing(wavefront, picture, 0, cancel);
  reads_standing_ = feeds_ || !reads_rounds();
  wavefront.rebind_lookup();
  standing_served_ = true;
  return true;
}

bool PhotonSolver::prepare_round(transport::Wavefront& wavefront, const Picture& picture, uint32_t sample,
                                 const Cancel& cancel) {
  if (renews_standing() && !standing_made(epoch_of(sample)))
    return make_standing(wavefront, picture, epoch_of(sample), cancel);
  if (fresh_ && picture.task.settings.boolean("photons.borders") && !surfaces_.serves(picture.flat)) {
    surfaces_.make(device_, picture.flat);
    wavefront.rebind_lookup();
    return true;
  }
  read_standing(wavefront, false);
  Round round = round_of(picture, sample);
  if (seeks_in_vain())
    round.paths = std::max(round.paths / k_vain_share, std::min(round.paths, k_vain_paths));
  store_parts(round.parts);
  if (!map_.trace(wavefront, lights_, round, picture.frame, picture.task.enabled, cancel)) return false;
  if (map_.traced() > 0) return true;  // not complete yet
  fresh_ = false, last_sample_ = sample;
  account(map_.figures());
  return true;
}

bool PhotonSolver::seeks_in_vain() const { return whole_parts() == 0 && rounds_ > 0 && photons_ == 0; }

void PhotonSolver::store_parts(uint32_t sent) {
  const uint32_t only = sent & ~whole_parts();
  map_.store_parts(only | (only == sent ? k_photon_ends_reachable : 0), false);
}

void PhotonSolver::account(const RoundFigures& f) {
  ++rounds_, paths_ += lights_.power() > 0 ? f.paths : 0, photons_ += f.photons;
  escaped_ += f.escaped, dark_ += f.dark, spared_ += f.spared;
  trace_s_ += f.trace_s, build_s_ += f.build_s;
}

void PhotonSolver::draw(const overlay::Canvas& canvas, const Picture& picture) {
  const OptionValues& settings = picture.task.settings;
  density_ = {}, inspected_.reset();
  if (!sends_) return;
  const auto read = [this](gpu::Resources& r) { bind(r); };
  const auto of = uint32_t(settings.choice("overlay.photon_density"));
  if ((of > 0 || looked_at_) && !inspector_.look(canvas, picture.frame)) return;
  // Before there are photons there is nothing to draw.
  const PhotonMap& shown = shown_map();
  if (of > 0 && (shown.complete() || of > k_density_of_irradiance))
    density_ = inspector_.draw_density(canvas, read, of, shown.figures().photons, shown_version());
  view_.draw(canvas, shown_map(), uint32_t(settings.choice("overlay.photons")));
  if (settings.boolean("overlay.photon_paths"))
    paths_view_.draw(canvas, picture.flat, lights_, round_of(picture, 0),
                     uint32_t(settings.integer("overlay.photon_paths_of")), picture.frame,
                     picture.task.enabled);
  if (settings.boolean("overlay.photon_aim") && lights_.strata() > 1)
    paths_view_.draw_aim(canvas, picture.flat, lights_, boxes_);
  if (!looked_at_ || !shown.complete()) return;
  inspected_ = inspector_.inspect(canvas, read, *looked_at_);
}

PhotonReport PhotonSolver::state(const Picture& picture) const {
  PhotonReport r;
  const OptionValues& s = picture.task.settings;
  r.lights_power = lights_.power();
  r.sends = sends_, r.sends_rounds = in_rounds();
  if (tries_) r.tried = trials_.empty() ? 0 : trials_[0].judged;
  r.delegated = delegated_;
  for (const Trial& t : trials_)
    if (t.delegated == delegated_ && t.product > 0) r.delegation_gain = 1 / t.product;
  r.maps = gathers_alone_ && !reads_rounds(), r.pieces = irradiance_ ? irradiance_->pieces() : 0;
  r.rounds = rounds_, r.paths = paths_, r.photons = photons_, r.escaped = escaped_, r.dark = dark_;
  r.last = shown_map().figures();
  r.spared = spared_;
  r.trace_s = trace_s_, r.build_s = build_s_;
  r.casters = uint32_t(casters_.size());
  r.entrances = uint32_t(std::max(boxes_.size(), casters_.size()) - casters_.size());
  r.weighs = weighs_, r.by_photons = regions_.by_photons, r.efficiency_gain = regions_.gain;
  r.unaimed = lights_.shares().empty() ? 1 : lights_.shares()[0];
  r.ready = ready();
  const auto rate = [](uint64_t n, double seconds) { return seconds > 0 ? double(n) / seconds : 0; };
  r.emitted_per_s = rate(paths_, trace_s_), r.stored_per_s = rate(photons_, trace_s_);
  r.sorted_per_s = rate(photons_, build_s_);
  r.density = density_;
  r.looked_at = looked_at_, r.inspected = inspected_;
  r.bytes = map_.bytes() + lights_.bytes() + surfaces_.bytes() + (standing_ ? standing_->bytes() : 0) +
            (irradiance_ ? irradiance_->bytes() : 0);
  r.radius_law = radius_law(s);
  r.radius_pixels = r.radius_law.at(rounds_ > 0 ? last_sample_ : 0);
  r.at_floor = r.radius_pixels <= r.radius_law.floor;
  const auto pixel = double(2 * glm::length(picture.frame.camera_right) / float(picture.frame.width));
  r.limited = r.radius_pixels * pixel > double(picture.frame.projection == shared::k_projection_orthographic
                                                   ? most_radius(picture.frame)
                                                   : k_photon_most_slope);
  r.view = uint32_t(s.choice("overlay.photons"));
  r.paths_shown = s.boolean("overlay.photon_paths");
  r.aim_shown = s.boolean("overlay.photon_aim");
  r.aimed = pairs_;
  return r;
}

std::shared_ptr<const solvers::Report> PhotonSolver::report(const overlay::Canvas&, const Picture& picture,
                                                            bool) {
  return std::make_shared<const solvers::Report>(make_report(state(picture)));
}

nlohmann::ordered_json PhotonSolver::statistics(const overlay::Canvas& canvas, const Picture& picture) {
  const PhotonReport r = state(picture);
  nlohmann::ordered_json rates;
  if (map_.complete()) {
    const auto read = [this](gpu::Resources& resources) { bind(resources); };
    inspector_.look_up(canvas, read, k_photons_in_disc);  // kernels compile at their first run
    const Timer timer;
    inspector_.look_up(canvas, read, k_photons_in_disc);
    const double seconds = timer.seconds();
    double lookups = 0, gathered = 0;
    for (const float n : inspector_.densities())
      if (n >= 0) ++lookups, gathered += double(n);
    rates = {{"emitted", r.emitted_per_s},     {"stored", r.stored_per_s},
             {"sorted", r.sorted_per_s},       {"looked_up", lookups / seconds},
             {"gathered", gathered / seconds}, {"gathered_a_lookup", lookups > 0 ? gathered / lookups : 0}};
  }
  nlohmann::ordered_json ways = nlohmann::ordered_json::array();
  for (const Trial& t : trials_)
    ways.push_back({{"delegated_to_paths", component_names(t.delegated)},
                    {"cost", t.cost},
                    {"noise_times_cost", t.product}});
  return {{"per_second", rates},
          {"rounds", r.rounds},
          {"paths", r.paths},
          {"photons", r.photons},
          {"escaped", r.escaped},
          {"dark", r.dark},
          {"spared", r.spared},
          {"casters", r.casters},
          {"entrances", r.entrances},
          {"unaimed", r.unaimed},
          {"by_photons", r.by_photons},
          {"efficiency_gain", r.efficiency_gain},
          {"ways", ways},
          {"delegated_to_paths", component_names(delegated_)},
          {"last_round_photons", r.last.photons},
          {"radius_pixels", r.radius_pixels},
          {"standing_photons", standing_ ? standing_->figures().photons : 0},
          {"standing_radius", standing_ ? double(standing_->lookup().base) : 0.0},
          {"irradiance_pieces", irradiance_ ? irradiance_->pieces() : 0},
          {"bytes", r.bytes}};
}

std::map<std::string, double> PhotonSolver::figures() const {
  return {{"photon rounds", double(rounds_)},
          {"light paths", double(paths_)},
          {"photons", double(photons_)},
          {"seconds of light paths", trace_s_},
          {"seconds of sorting photons", build_s_}};
}

}  // namespace lucerna::photons
