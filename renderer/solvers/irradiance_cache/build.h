#pragma once
// State of a cache during building, and the stages of a pass: probe (find paths without records), choose,
// measure (distances around the tried places), thin, evaluate (level by level), index. Internal; the
// interface is cache.h.
//
// build.cpp: stages and passes; build_places.cpp: stages up to the places; build_radii.cpp: radii;
// build_light.cpp: light; relight.cpp: new light on existing places.
#include <span>
#include <vector>

#include "solvers/irradiance_cache/lookup_tables.h"
#include "solvers/irradiance_cache/pass_places.h"
#include "solvers/irradiance_cache/pass_progress.h"
#include "solvers/irradiance_cache/picture_seen.h"
#include "solvers/irradiance_cache/radii.h"
#include "solvers/irradiance_cache/ray_levels.h"
#include "solvers/irradiance_cache/record_ranges.h"
#include "solvers/irradiance_cache/records_overlay.h"
#include "solvers/irradiance_cache/relight_preview.h"

namespace lucerna::irradiance_cache {

enum class Stage { probe, choose, measure, thin, evaluate, index, done };

/// Elevations of a level with that many rays; there are four times as many azimuths.
uint32_t elevations_for(uint32_t rays);

/// The current stage and its progress.
struct BuildProgress {
  Stage stage = Stage::probe;
  PictureProbing probing;
  RecordQueue queue;  ///< of the stages measure and evaluate
  RayLevels levels;   ///< of the stage evaluate
  StageClock clock;
  Pauses pauses;
  Refining refining;
  /// Why building had stopped before relighting; it stops again for that reason afterwards.
  StopReason stopped_before = StopReason::building;
  bool ends_early = false;  ///< building ends with the stage `index`
};

struct Cache::Impl {
  /// Arguments of a work item.
  struct Work {
    transport::Wavefront& wavefront;
    const paths::Automaton& automaton;
    const CacheView& view;
    const std::function<bool()>& cancel;
    gpu::Stream& stream() const { return wavefront.stream(); }
  };

  CacheOptions options;
  LookupTables tables;
  RecordRanges ranges;  // of tables.records
  RecordLight gathers;  // parts of evaluated records
  RecordLight held;     // parts that all complete records have; includes `gathers`
  Radii radii;
  Evaluator evaluator;
  PassPlaces places;
  PictureSeen picture;
  RecordsOverlay overlay;
  BuildProgress progress;
  CacheStatus status;
  RelightPreview preview;
  IndexFor index_for = IndexFor::picture;  ///< of the latest octree
  bool previews = false;                   ///< a preview of relighting is wanted

  Impl(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, const CacheRoutes& routes,
       const CacheOptions& o);

  /// One bounded work item of the present stage, or of each one; false if cancelled: it will be repeated. A
  /// complete stage starts the next one.
  bool work_on_stage(const Work& work);
  bool probe(const Work& work);
  bool choose(const Work& work);
  bool measure(const Work& work);
  bool thin(const Work& work);
  bool evaluate(const Work& work);
  bool index(const Work& work);
  void finish(StopReason reason);
  void clear();
  void look_from(const CacheView& view);
  /// Restarts building: passes, and paths along the picture, count from 0.
  void restart_passes(bool beyond);
  /// Drops places that are not evaluated, and all candidates.
  void drop_pass();
  /// In the first level of a pass: building ends with those of its records that have all rays of the level.
  /// Otherwise, or if there are none: returns false and does nothing.
  bool end_with_first_level();
  /// Estimated share of the picture's paths that would find no record if building ended now.
  double missing() const;
  void relight(const std::optional<std::vector<vec3>>& factors, uint32_t sky_group);
  /// If the first pass has no light yet: keeps its places and repeats only what depends on light. Otherwise,
  /// or if nothing is being built: returns false and does nothing.
  bool relight_first_places();
  /// Starts relighting the next pass's records; after the last pass, building continues from before.
  void relight_pass();
  void drop_near(std::span<const Box> moved);
  /// Replaces all records by complete ones from elsewhere.
  void replace_records(const RawRecords& raw);

  /// Queues further rays for records whose noise exceeds the last bound over sqrt(2).
  void begin_refining(double factor);
  /// Cancels that; the next time starts from the noise bound of building.
  void end_refining();
  void forget_refining();
  /// Traces one batch of the picture's points; false if cancelled.
  bool see(transport::Wavefront& wavefront, const CacheView& view, const std::function<bool()>& cancel);
  /// Traces all of them, for display. False if cancelled.
  bool see_all(transport::Wavefront& wavefront, const CacheView& view,
               const std::function<bool()>& cancel = {});

  Radii::Bind binding() const {
    return [this](gpu::Resources& to) { tables.bind(to); };
  }
  /// Builds the octree over the first `count` records.
  void build_octree(transport::Wavefront& wavefront, uint32_t count, IndexFor use) {
    status.references = tables.build_octree(wavefront, count, use);
    index_for = use;
  }
  /// Building is complete: the octree gets the detail that the picture wants.
  void index_for_picture(transport::Wavefront& wavefront) {
    if (ranges.evaluated() > 0 && index_for != IndexFor::picture)
      build_octree(wavefront, ranges.evaluated(), IndexFor::picture);
  }
  void write_frame(uint32_t probing, const RouteTable& routes) {
    tables.write_frame(ranges.evaluated(), probing, routes);
  }
  /// ... for the picture's paths.
  void write_frame(uint32_t probing = shared::k_probe_none) {
    tables.write_frame(ranges.evaluated(), probing, tables.picture_routes,
                       probing == shared::k_probe_none ? options.branches : 1);
  }
  /// dark_luminance() of the evaluated records.
  float dark() const;

 private:
  // Stages and passes:
  void begin_pass(const Work& work);
  void end_pass(const Work& work);
  void next_pass();
  /// Pauses here if requested; `last`: last stage of its pass.
  void end_stage(BuildStage stage, bool last = false);
  /// Queues the records of this pass, up to `end`.
  void queue_until(uint32_t end);
  CachePass& pass() { return status.passes.back(); }
  void add_time(BuildStep step, double ms) { pass().ms[size_t(step)] += ms; }
  void add_rays(size_t records, uint32_t rays);
  /// Updates the memory in the status: the cache's own, and what grows while records are placed.
  void count_bytes();

  // Places:
  /// Runs the screen-space stage; true when complete. Sets `cancelled`.
  bool look(const Work& work, bool& cancelled);
  bool looks_first() const;  ///< directly visible surfaces get candidates by dithering only in this pass
  ReachOptions reach(const CacheView& view) const;
  /// Collects the candidates of these blocks; `first`: position in the probed list.
  void collect(const Work& work, const schedule::WorkItem& item, uint32_t first);
  /// Ends the probing of this pass, or of all passes.
  void end_probing();
  /// Drops records that were crowded for an earlier camera and no longer are; they become candidates again.
  void drop_roomy(const Work& work);

  // Radii:
  /// Radii::Wanted::crowd: decided once for each record, before it is evaluated.
  float crowd() const;
  /// For the queued records of this pass.
  Radii::Wanted wanted_radii() const;
  /// Averages the pilot results of this pass's records with those of their neighbours.
  void pool(const Work& work);
  /// Sets the radii of this pass's records, from distances, or from light too.
  enum class By { distance, light };
  void set_radii(const Work& work, By by);
  /// Clamps the radii of the first `count` records, at least the evaluated ones, by the nearest geometry that
  /// any neighbour has met, by the octree over these; rebuilds it over the evaluated ones.
  void clamp_radii(const Work& work, uint32_t count, float near);
  /// build_octree(), timed.
  void index_records(const Work& work, uint32_t count, IndexFor use);

  // Light:
  /// Traces one batch of the importance paths; false if cancelled.
  bool see_reads(const Work& work);
  /// Traces one round of rays of the next queued records; false if cancelled.
  bool gather(const Work& work);
  /// Queues the records of this pass that are too noisy, as many as its rays allow, for four times as many
  /// rays. False if there are none.
  bool next_level(const CacheView& view);
  bool at_last_level() const;
  /// The noisy ones among records with equally many rays, at most `most`, the noisiest. `figures`: of every
  /// record.
  std::vector<uint32_t> noisy(const std::vector<uint32_t>& records,
                              const std::vector<Records::Figures>& figures, size_t most = SIZE_MAX) const;
  /// Queues the next records of any pass for refinement, and sets their level. False if there are none.
  bool next_refined();
  float share_of_noise(uint32_t record) const;
  /// Without crowded records, which store no light.
  std::vector<uint32_t> without_crowded(std::vector<uint32_t> list) const;
  /// Publishes light and radii of this level to lookups.
  void publish_level(const Work& work);
  /// Publishes the light of all evaluated records, smoothed (smoothing.h).
  void publish_smoothed();
};

}  // namespace lucerna::irradiance_cache
