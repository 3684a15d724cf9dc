#include <algorithm>
#include <bit>
#include <cmath>

#include "solvers/photons/solver.h"
#include "transport/aim.h"
#include "transport/casters.h"

namespace lucerna::photons {

using namespace shared;
using paths::k_caustic_part;
using solvers::Cancel, solvers::Picture, solvers::Task;

namespace {

constexpr uint32_t k_eye_paths = 1u << 14;
constexpr double k_pilot_radius = 3;  // [pixels] of the pilot's small picture

// Entrances of distant light: pilot rounds run until this many paths contribute, or for this many rounds. If
// such paths are a large part of all, aiming gains nothing; with very few, boxes would be random.
constexpr uint32_t k_first_hit_paths = 1u << 16, k_most_first_hit_rounds = 8, k_first_hit_round = 0xffffff00u;
constexpr size_t k_enough_hits = 512, k_least_hits = 16;
constexpr double k_many = 0.2;
/// After this many rounds with too few, paths are aimed at the places where eye paths continue behind
/// lookups.
constexpr uint32_t k_unaimed_first_hit_rounds = 2, k_reached_vertices = 3;
constexpr uint32_t k_most_regions = 1u << 15;  // texels of delegated_regions

constexpr double k_least_from_afar = 0.05;  // share of all lights' power; below it entrances are not searched

/// True if the scene reaches beyond its core: a wide ground, a terrain, a distant wall.
bool beyond_core(const Picture& picture) { return picture.flat.core_radius < picture.flat.scene_radius; }

/// First hits of the contributing ones among `paths` distant light paths.
std::vector<transport::FirstHit> hits_of_use(std::span<const PhotonContribution> photons, uint32_t paths,
                                             const upload::FlatLights& lights) {
  struct Path {
    transport::FirstHit hit;
    uint32_t events = ~0u;  ///< of its first stored photon
  };
  std::vector<Path> all(paths);
  for (const PhotonContribution& p : photons) {
    if (!transport::from_afar(lights, p.light)) continue;
    Path& path = all[p.id >> k_photon_id_events];
    const uint32_t events = p.id & k_most_light_events;
    path.hit.contribution += double(p.contribution);
    if (events < path.events) path.events = events, path.hit.place = p.position;
  }
  std::vector<transport::FirstHit> found;
  for (const Path& path : all)
    if (path.hit.contribution > 0) found.push_back(path.hit);
  return found;
}

/// Photons per square metre around a typical lookup: the median over lookups, which are as dense as the
/// importance at photons; from the nearest photons, each counted `gain` times.
double typical_density(std::span<const PhotonContribution> photons, std::span<const double> gain) {
  constexpr size_t k_places = 128, k_nearest = 32;
  std::vector<const PhotonContribution*> seen;
  for (const PhotonContribution& p : photons)
    if (p.importance > 0 && p.contribution > 0) seen.push_back(&p);
  if (seen.size() < 2 * k_nearest) return 0;
  struct Place {
    double density, lookups;
  };
  std::vector<Place> places;
  std::vector<std::pair<float, float>> near(seen.size());  // squared distance, gain
  for (size_t k = 0; k < k_places; ++k) {
    const PhotonContribution& at = *seen[k * seen.size() / k_places];
    for (size_t i = 0; i < seen.size(); ++i) {
      const vec3 away = seen[i]->position - at.position;
      near[i] = {glm::dot(away, away), float(gain[size_t(seen[i] - photons.data())])};
    }
    std::nth_element(near.begin(), near.begin() + k_nearest, near.end());
    double sum = 0;
    for (size_t i = 0; i < k_nearest; ++i) sum += double(near[i].second);
    const double area = double(k_pi) * std::max(double(near[k_nearest].first), 1e-30);
    places.push_back({sum / area, double(at.importance) * area / sum});
  }
  std::sort(places.begin(), places.end(),
            [](const Place& a, const Place& b) { return a.density < b.density; });
  double all = 0, before = 0;
  for (const Place& p : places) all += p.lookups;
  for (const Place& p : places)
    if ((before += p.lookups) >= 0.5 * all) return p.density;
  return places.back().density;
}

}  // namespace

Frame PhotonSolver::small_frame(const Picture& picture) {
  Frame frame = picture.frame;
  const double pixels = double(picture.width) * picture.height;
  const double scale = std::min(1.0, std::sqrt(k_eye_paths / pixels));
  frame.width = std::max(1u, uint32_t(std::lround(scale * picture.width)));
  frame.height = std::max(1u, uint32_t(std::lround(scale * picture.height)));
  return frame;
}

bool PhotonSolver::may_hide(const Picture& picture) const {
  // Light of point lamps behind smooth mirrors and glass.
  const upload::Effects& e = picture.task.effects;
  if (!e.specular && !e.solid_glass && !e.thin_glass) return false;
  const std::span<const double> powers = lights_.powers();
  for (size_t i = 0; i < picture.flat.entries.size(); ++i) {
    const uint32_t kind = picture.flat.entries[i].kind;
    const bool has_no_size = kind == k_light_point || kind == k_light_spot || kind == k_light_directional ||
                             kind == k_light_profile || kind == k_light_projector;
    if (has_no_size && powers[i] > 0) return true;
  }
  return false;
}

void PhotonSolver::begin_aim(const Picture& picture, solvers::Invalidation invalidated) {
  constexpr uint32_t k_caustics = 1u << k_caustic_part;
  const bool lit = sends_ && lights_.power() > 0, requested = picture.task.settings.boolean("photons.aim");
  bundles_ = lit && requested && (parts_ & k_caustics) != 0;
  enters_ = lit && requested && (parts_ & ~k_caustics) != 0 &&
            lights_.power_from_afar() > k_least_from_afar * lights_.power();
  const bool aims = bundles_ || enters_;
  const bool shares_lights = lit && requested && light_groups_.members.size() > 1;
  const bool spares = lit && picture.task.settings.boolean("photons.importons");
  const bool weighs = lit && delegable_ != 0;
  hides_ = lit && may_hide(picture);
  const bool stale = invalidated.any() || aims != aims_ || shares_lights != shares_lights_ ||
                     spares != spares_ || weighs != weighs_ ||
                     !transport::same_view(picture.frame, aimed_for_);
  if (stale) unreachable_found_ = false;
  begin_trials(picture, stale);
  aims_ = aims, shares_lights_ = shares_lights, spares_ = spares, weighs_ = weighs;
  // The casters do not depend on the view.
  if (invalidated.light || invalidated.places || !bundles_) casters_.clear(), casters_known_ = false;
  if (!stale) return;
  aimed_ = false;
  aim_step_ = AimStep::casters;
  aimed_for_ = picture.frame;
  pairs_.clear(), boxes_.clear(), reached_boxes_.clear(), first_hits_.clear();
  first_hit_rounds_ = 0;
  density_at_lookups_ = 0;
  regions_ = {};
  write_delegated_regions();
  lights_.aim(device_, picture.flat, {}, 1);
  lights_.choose_by(lights_.powers());
  map_.store_by_importance(false);
}

bool PhotonSolver::prepare(transport::Wavefront& wavefront, const Picture& picture, const Cancel& cancel) {
  if (ready()) return true;
  if (pilot_done()) {
    if (stands() && !standing_served_) return prepare_standing(wavefront, picture, cancel);
    return try_ways(wavefront, picture, cancel);
  }
  switch (aim_step_) {
    case AimStep::casters: {
      if (stands()) wavefront.rebind_lookup();  // eye paths record lookups of rounds
      if (bundles_ && !casters_known_)
        casters_ = transport::find_casters(picture.flat), casters_known_ = true;
      boxes_ = casters_;
      aimed_ = boxes_.empty() && !enters_ && !shares_lights_ && !spares_ && !weighs_ && !hides_;
      if (aimed_) return true;
      const Frame frame = small_frame(picture);
      eye_schedule_.emplace((frame.width + 7) / 8 * ((frame.height + 7) / 8), 1, wavefront.slots());
      map_.note_importance(wavefront, lookup_of(picture, frame, k_pilot_radius),
                           weighs_ || enters_ ? frame.width * frame.height : 0,
                           enters_ ? k_reached_vertices : 0);
      aim_step_ = AimStep::importance;
      return true;
    }
    case AimStep::importance:
      return note_importance(wavefront, picture, cancel);
    case AimStep::first_hits:
      return note_first_hits(wavefront, picture, cancel);
    case AimStep::contribution:
      return share_out(wavefront, picture, cancel);
  }
  return true;
}

bool PhotonSolver::note_importance(transport::Wavefront& wavefront, const Picture& picture,
                                   const Cancel& cancel) {
  const Frame frame = small_frame(picture);
  // Paths that continue only for this solver's light. If records compute it, with lookups behind surfaces
  // like those around the picture's, paths do so instead, whether or not records exist yet. To aim distant
  // light they continue behind lookups, to the places that it has to reach.
  Task task = picture.task;
  if (enters_ && !feeds_) task.own &= ~k_deep;
  solvers::Routing routing = routing_of(task);
  if (feeds_) routing.fallback = picture.task.own;
  Frame own = picture.frame_for(routing, picture.task.own);
  if (feeds_) transport::compute_everything(own);
  own.width = frame.width, own.height = frame.height;
  const schedule::UniformSchedule before = *eye_schedule_;
  wavefront.set_frame(own, picture.task.own);
  const bool complete = wavefront.probe(eye_schedule_->next(), cancel);
  wavefront.set_frame(picture.frame, picture.task.enabled);
  if (!complete) eye_schedule_ = before;
  if (!eye_schedule_->done()) return complete;
  if (enters_) {
    std::vector<transport::FirstHit> reached;
    for (const PhotonLookup& l : map_.reached())
      if (l.carried > 0) reached.push_back({l.position, double(l.carried)});
    reached_boxes_ = transport::nested_boxes(std::move(reached), 2 * picture.flat.core_radius);
    aim_step_ = AimStep::first_hits;
  }
  map_.clear();
  if (!enters_) begin_sharing(picture);
  return complete;
}

void PhotonSolver::begin_sharing(const Picture& picture) {
  aim_step_ = AimStep::contribution;
  map_.store_by_importance(spares_);
  lights_.aim(device_, picture.flat, boxes_, 0.5);
  if (shares_lights_)
    lights_.choose_by(transport::light_weights(light_groups_.members, lights_.powers(), {}));
  map_.store_radiance(weighs_);
  // Nothing is aimed and no other result of the pilot is needed.
  aimed_ = boxes_.empty() && !needs_density() && !weighs_ && !shares_lights_ && !hides_;
}

bool PhotonSolver::note_first_hits(transport::Wavefront& wavefront, const Picture& picture,
                                   const Cancel& cancel) {
  Round round = round_of(picture, k_first_hit_round + first_hit_rounds_);
  round.lookup = lookup_of(picture, small_frame(picture), k_pilot_radius);
  round.paths = k_first_hit_paths;
  round.parts |= 1u;  // direct light marks the first surfaces of paths
  if (!map_.trace(wavefront, lights_, round, picture.frame, picture.task.enabled, cancel)) return false;
  if (map_.traced() > 0) return true;
  const std::vector<transport::FirstHit> hits =
      hits_of_use(map_.contributions(wavefront, lights_), round.paths, picture.flat);
  first_hits_.insert(first_hits_.end(), hits.begin(), hits.end());
  ++first_hit_rounds_;
  map_.clear();
  const double from_afar = lights_.power_from_afar() / lights_.power() * round.paths * first_hit_rounds_;
  const bool by_chance = first_hit_rounds_ <= k_unaimed_first_hit_rounds;
  const bool many = by_chance && double(first_hits_.size()) > k_many * from_afar;
  if (!many && first_hits_.size() < k_enough_hits && first_hit_rounds_ < k_most_first_hit_rounds) {
    // Too rare to be found by chance: half of the further paths are aimed at the reached places.
    if (first_hit_rounds_ == k_unaimed_first_hit_rounds)
      lights_.aim(device_, picture.flat, reached_boxes_, 0.5);
    return true;
  }
  const auto aim_at = [&](const std::vector<Box>& places) {
    boxes_.insert(boxes_.end(), places.begin(), places.end());
  };
  if (!many && first_hits_.size() >= k_least_hits) aim_at(transport::first_hit_boxes(std::move(first_hits_)));
  // If only aimed paths found entrances, there are others. Surfaces beyond the scene's core get almost no
  // paths by chance, whatever was found within it: few samples are no evidence that little light comes from
  // them.
  if (beyond_core(picture) || (!many && !by_chance)) aim_at(reached_boxes_);
  first_hits_.clear();
  begin_sharing(picture);
  return true;
}

bool PhotonSolver::share_out(transport::Wavefront& wavefront, const Picture& picture, const Cancel& cancel) {
  Round round = round_of(picture, transport::k_pilot_round);
  round.lookup = lookup_of(picture, small_frame(picture), k_pilot_radius);
  round.paths = std::max(transport::k_pilot_paths, transport::k_pilot_paths_a_stratum * lights_.strata());
  if (boxes_.size() > casters_.size() && beyond_core(picture))
    round.paths = std::max(round.paths, std::min(transport::k_ground_pilot_paths_a_stratum * lights_.strata(),
                                                 transport::k_most_ground_pilot_paths));
  if (!map_.trace(wavefront, lights_, round, picture.frame, picture.task.enabled, cancel)) return false;
  if (map_.traced() > 0) return true;
  const std::vector<PhotonContribution> photons = map_.contributions(wavefront, lights_);
  std::vector<double> contribution(lights_.strata(), 0.0), by_light(lights_.powers().size(), 0.0);
  for (const PhotonContribution& p : photons)
    contribution[p.stratum] += double(p.contribution), by_light[p.light] += double(p.contribution);
  const double least = parts_ == 1u << k_caustic_part    ? transport::k_least_unaimed_of_caustics
                       : boxes_.size() > casters_.size() ? transport::k_least_unaimed_from_afar
                                                         : transport::k_least_unaimed_of_all;
  const std::vector<double> before(lights_.shares().begin(), lights_.shares().end());
  lights_.share_out(transport::aim_shares(contribution, least));
  // The probability of an unaimed path has changed by the factors of its stratum and its light.
  std::vector<double> by_entry(by_light.size(), 1.0);
  if (shares_lights_) {
    const auto weights = [&](std::span<const double> contribution) {
      return transport::light_weights(light_groups_.members, lights_.powers(), contribution);
    };
    const std::vector<double> pilot = weights({}), now = weights(by_light);
    for (size_t i = 0; i < by_entry.size(); ++i) by_entry[i] = pilot[i] > 0 ? now[i] / pilot[i] : 1;
    lights_.choose_by(now);
  }
  std::vector<double> gain;
  for (const PhotonContribution& p : photons)
    gain.push_back(lights_.shares()[p.stratum] / before[p.stratum] *
                   (p.stratum == 0 ? by_entry[p.light] : 1));
  unreachable_found_ = std::any_of(photons.begin(), photons.end(), [](const PhotonContribution& p) {
    return p.unreachable != 0 && p.contribution > 0;
  });
  route(picture.task);
  if (needs_density()) density_at_lookups_ = typical_density(photons, gain) / double(round.paths);
  pairs_ = overlay::aimed_pairs(picture.flat, lights_);
  if (weighs_) {
    map_.store_radiance(false);
    choose_delegated_regions(picture, photons, gain, round.paths);
  }
  map_.clear();
  aimed_ = true;
  return true;
}

void PhotonSolver::choose_delegated_regions(const Picture& picture,
                                            std::span<const PhotonContribution> photons,
                                            std::span<const double> gain, uint32_t pilot_paths) {
  const Frame small = small_frame(picture);
  const std::vector<PhotonLookup> noted = map_.lookups();
  // Typical of a finished picture: radii fall slowly.
  const double radius = radius_law(picture.task.settings).at(k_typical_round);
  const uint32_t paths = round_of(picture, 0).paths;
  const EfficiencyPilot pilot{.lookups = std::span(noted).first(size_t{small.width} * small.height),
                              .width = small.width,
                              .height = small.height,
                              .photons = photons,
                              .gain = gain,
                              .paths = double(paths) / pilot_paths,
                              .around = lookup_of(picture, small, k_pilot_radius),
                              .round = lookup_of(picture, picture.frame, radius)};
  // If secondary or tertiary light is path traced, paths continue behind the first diffuse vertex and find
  // caustics at no extra cost.
  const uint32_t behind = picture.frame.automaton[0] & 0xffu;
  const bool goes_on = (picture.frame.automaton[behind] >> 27 & 1u) != 0;
  // True if rounds store nothing else that is looked up.
  const bool alone = picture.task.own == delegable_ && !unreachable_found_;
  const EfficiencyCosts costs{
      .base = k_cost_base + (goes_on ? k_cost_tail : 0),
      .lookup = alone ? k_cost_lookup : 0,
      .onward = goes_on ? 0 : k_cost_onward,
      .paths = alone ? k_cost_light_path * paths / (double(picture.width) * picture.height) : 0};
  regions_ = choose_regions(caustic_moments(pilot), small.width, small.height, costs);
  if (regions_.delegated.size() >= k_most_regions) regions_ = {};
  // So few photons do not prove that paths can find all light: photons continue to compute the unreachable
  // light.
  if (regions_.scarce && hides_) unreachable_found_ = true, route(picture.task);
  write_delegated_regions();
}

void PhotonSolver::write_delegated_regions() {
  const uint32_t width = std::max(1u, regions_.width), height = std::max(1u, regions_.height);
  std::vector<vec4> texels{vec4(std::bit_cast<float>(width), std::bit_cast<float>(height), 0, 0)};
  for (const float share : regions_.delegated) texels.emplace_back(share, 0, 0, 0);
  texels.resize(1 + size_t{width} * height, vec4(0));
  gpu::make_texel_room(device_, delegated_regions_, "regions left to paths", k_most_regions * sizeof(vec4));
  delegated_regions_.write(std::span<const vec4>(texels));
}

}  // namespace lucerna::photons
