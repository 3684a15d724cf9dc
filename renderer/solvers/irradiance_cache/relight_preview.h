#pragma once
// Light for the window while records are relit: all of them get a few rays, then more, in rounds, so that the
// whole picture is lit at once. Relighting proper goes pass by pass with hundreds of rays a record, and what
// it brings does not depend on any of this.
//
// Records keep the places and radii they had, and their light, scaled by what the new rays of many records
// say (light_change.h), as far as their own do not contradict it
// (shaders/irradiance_cache/relight_preview.comp). The rays read these same records: light that takes many
// bounces arrives round by round.
#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "solvers/irradiance_cache/evaluate.h"
#include "solvers/irradiance_cache/light_change.h"
#include "solvers/irradiance_cache/lookup_tables.h"
#include "solvers/irradiance_cache/ray_levels.h"
#include "solvers/irradiance_cache/record_ranges.h"

namespace lucerna::irradiance_cache {

class RelightPreview {
 public:
  /// `groups`: of lights, as Records.
  RelightPreview(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t groups)
      : device_(device), compiler_(compiler), groups_(std::max(1u, groups)), factors_(groups_, vec3(1)) {}

  /// Makes what so many records need, ahead of time. Throws Error when memory is short.
  void make_room(uint32_t count);
  /// The first `count` records of the tables are about to lose their light; where there is a preview of them
  /// already, its light is the one before. Where the light of each group of lights, or all light, is known to
  /// be `factors` times that, no ray is sent. `sky_group`: whose light the sky's is.
  void begin(const LookupTables& tables, uint32_t count, const std::optional<std::vector<vec3>>& factors = {},
             uint32_t sky_group = 0);
  /// Nothing is to be shown any more.
  void end() { count_ = 0; }
  bool active() const { return count_ > 0; }
  /// All rounds are done.
  bool complete() const { return !active() || round_ == k_rounds.size(); }
  /// Grows as the light gets better; never goes back.
  uint64_t published() const { return published_; }

  /// Rays of the next records, as many as there are slots. The wavefront's frame is that of the records,
  /// which gather that light. False when it was cancelled.
  bool step(transport::Wavefront& wavefront, const paths::Automaton& automaton, const LookupTables& tables,
            Evaluator& evaluator, const RecordLight& light, uint32_t seed,
            const std::function<bool()>& cancel);
  /// The first `count` records of the tables have their light: it is shown.
  void take(gpu::Stream& stream, const LookupTables& tables, uint32_t count);
  /// Lookups of the wavefront's paths read this from now on, where `routes` say, or no longer. The tables'
  /// bind() is called by way of Wavefront::rebind_lookup().
  void look_up(transport::Wavefront& wavefront, const LookupTables& tables, const RouteTable& routes,
               bool on);
  bool looked_up() const { return looked_up_; }
  /// In place of what the tables bind.
  void bind(gpu::Resources& to) const;
  uint64_t bytes() const;  ///< of device memory

 private:
  /// Elevations of each round's rays: 4, 16 and 64 of them.
  static constexpr std::array<uint32_t, 3> k_rounds{1, 2, 4};
  /// What begin() has left to the device.
  void make_ready(gpu::Stream& stream);
  /// What these hold becomes what was before.
  void keep_as_old(gpu::Stream& stream, const Records& records, Records::Use use, uint32_t count);
  /// What is shown: of the rays so far, that all records have had or the leading ones, and what was before.
  void mix(gpu::Stream& stream, uint32_t parts, uint32_t rays, bool leading);

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  uint32_t groups_;                   ///< at least 1
  std::unique_ptr<Records> records_;  ///< with the rays' light, and as lookups read it what is shown
  std::unique_ptr<lookup::Octree> octree_;
  gpu::Kernel kernel_;
  std::optional<LightChange> change_;
  gpu::Buffer old_, old_shares_, frame_, group_factors_;
  gpu::Resources resources_;
  RecordQueue queue_;
  size_t leading_ = 0;         ///< in the queue first
  std::vector<vec3> factors_;  ///< of the light before, since it was begun, by group
  uint32_t sky_group_ = 0;
  uint32_t count_ = 0, rays_ = 0;
  size_t round_ = 0;
  uint64_t published_ = 0;
  bool looked_up_ = false, indexed_ = false, begun_ = false;
  bool known_ = false;  ///< the light that is shown is what it will be, but for its noise
};

}  // namespace lucerna::irradiance_cache
