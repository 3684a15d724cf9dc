#include <algorithm>
#include <cmath>

#include "solvers/photons/solver.h"
#include "transport/aim.h"
#include "transport/casters.h"

namespace lucerna::photons {

using namespace shared;
using paths::k_caustic_part;
using solvers::Cancel, solvers::Picture;

namespace {

constexpr uint32_t k_eye_paths = 1u << 14;
constexpr double k_pilot_radius = 3;  // of its own pixels, which are wide

/// The frame of the pilot's eye paths: the same view with fewer pixels.
Frame small_frame(const Picture& picture) {
  Frame frame = picture.frame;
  const double pixels = double(picture.width) * picture.height;
  const double scale = std::min(1.0, std::sqrt(k_eye_paths / pixels));
  frame.width = std::max(1u, uint32_t(std::lround(scale * picture.width)));
  frame.height = std::max(1u, uint32_t(std::lround(scale * picture.height)));
  return frame;
}

}  // namespace

void PhotonSolver::begin_aim(const Picture& picture, solvers::Spoils spoils) {
  const bool caustics = (parts_ >> k_caustic_part & 1u) != 0;
  const bool aims = sends_ && caustics && lights_.power() > 0 && picture.task.settings.boolean("photons.aim");
  const bool spares = sends_ && lights_.power() > 0 && picture.task.settings.boolean("photons.importons");
  const bool stale =
      spoils.any() || aims != aims_ || spares != spares_ || !transport::same_view(picture.frame, aimed_for_);
  aims_ = aims, spares_ = spares;
  // Whoever only looks from elsewhere finds the same casters.
  if (spoils.light || spoils.places || !aims) casters_.clear(), casters_known_ = false;
  if (!stale) return;
  aimed_ = false;
  aim_step_ = AimStep::casters;
  aimed_for_ = picture.frame;
  worth_.clear(), pairs_.clear();
  lights_.aim(device_, picture.flat, {}, 1);
  map_.store_by_importance(false);
}

bool PhotonSolver::prepare(transport::Wavefront& wavefront, const Picture& picture, const Cancel& cancel) {
  if (ready()) return true;
  if (pilot_done()) return feed(wavefront, picture, cancel);
  const Frame frame = small_frame(picture);
  if (aim_step_ == AimStep::casters) {
    if (feeds_) wavefront.rebind_lookup();  // what eye paths note is the rounds'
    if (aims_ && !casters_known_) casters_ = transport::find_casters(picture.flat), casters_known_ = true;
    lights_.aim(device_, picture.flat, casters_, 0.5);
    aimed_ = casters_.empty() && !spares_;
    if (aimed_) return true;
    eye_schedule_.emplace((frame.width + 7) / 8 * ((frame.height + 7) / 8), 1, wavefront.slots());
    map_.note_importance(wavefront, lookup_of(picture, frame, k_pilot_radius));
    aim_step_ = AimStep::importance;
    return true;
  }
  if (aim_step_ == AimStep::importance) {
    // Paths that go on for this solver's own light alone.
    Frame own = picture.frame_for(routing_of(picture.task), picture.task.own);
    own.width = frame.width, own.height = frame.height;
    const schedule::UniformSchedule before = *eye_schedule_;
    wavefront.set_frame(own, picture.task.own);
    const bool complete = wavefront.probe(eye_schedule_->next(), cancel);
    wavefront.set_frame(picture.frame, picture.task.enabled);
    if (!complete) eye_schedule_ = before;
    if (!eye_schedule_->done()) return complete;
    map_.clear();
    map_.store_by_importance(spares_);
    aim_step_ = AimStep::worth;
    aimed_ = casters_.empty();
    return complete;
  }
  Round round = round_of(picture, transport::k_pilot_round);
  round.lookup = lookup_of(picture, frame, k_pilot_radius);
  round.paths = std::max(transport::k_pilot_paths, transport::k_pilot_paths_a_stratum * lights_.strata());
  if (!map_.trace(wavefront, lights_, round, picture.frame, picture.task.enabled, cancel)) return false;
  if (map_.traced() > 0) return true;
  worth_ = map_.worth(wavefront, lights_);
  lights_.share_out(transport::aim_shares(worth_, parts_ == 1u << k_caustic_part));
  pairs_ = overlay::aimed_pairs(picture.flat, lights_);
  map_.clear();
  aimed_ = true;
  return true;
}

}  // namespace lucerna::photons
