#pragma once
// What a cache holds while it is built, and the stages of a pass: probe (where do paths find no record?),
// choose, measure (how far are things around what is tried?), thin, evaluate level by level, index. Internal
// to the cache: cache.h is what others see.
//
// build.cpp leads from stage to stage and pass to pass; build_places.cpp has the stages up to the places of
// records, build_radii.cpp how far these serve, build_light.cpp their light; relight.cpp other light on
// places that stay.
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

/// Elevations of a level of that many rays; there are four times as many azimuths.
uint32_t elevations_for(uint32_t rays);

/// The stage that is next to be worked at, and what it has to go through.
struct BuildProgress {
  Stage stage = Stage::probe;
  PictureProbing probing;
  RecordQueue queue;  ///< of the stages measure and evaluate
  RayLevels levels;   ///< of the stage evaluate
  StageClock clock;
  Pauses pauses;
  Refining refining;
  /// Why building had stopped before records were relit, which it does again once they are.
  StopReason stopped_before = StopReason::building;
};

struct Cache::Impl {
  /// What a piece of work is done with.
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
  RecordLight gathers;  // what records that are evaluated hold
  RecordLight held;     // what all complete ones do; `gathers` at least
  Radii radii;
  Evaluator evaluator;
  PassPlaces places;
  PictureSeen picture;
  RecordsOverlay overlay;
  BuildProgress progress;
  CacheStatus status;
  RelightPreview preview;
  bool previews = false;  ///< somebody watches

  Impl(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, const CacheRoutes& routes,
       const CacheOptions& o);

  /// One bounded piece of a stage each; false when it was cancelled, and is to be done again. A stage that is
  /// complete hands over to the next.
  bool probe(const Work& work);
  bool choose(const Work& work);
  bool measure(const Work& work);
  bool thin(const Work& work);
  bool evaluate(const Work& work);
  bool index(const Work& work);
  void finish(StopReason reason);
  void clear();
  void look_from(const CacheView& view);
  /// Building goes on; passes are counted, and the picture looked along, from the beginning.
  void restart_passes(bool beyond);
  /// What is placed and not evaluated is dropped, and what was asked for.
  void drop_pass();
  void relight(const std::optional<std::vector<vec3>>& factors, uint32_t sky_group);
  /// The first pass has no light yet: places that it has found stay, and only what light has gone into is
  /// done again. False, and nothing done, where there are records with light, or nothing is being built.
  bool relight_first_places();
  /// The records of the next pass that stand without light; after the last, building goes on where it was.
  void relight_pass();
  /// Complete records from elsewhere, in place of all.
  void replace_records(const RawRecords& raw);

  /// Records that are noisier than the last time allowed, over the root of 2, are to get further rays.
  void begin_refining();
  /// That is given up as far as it has come; and the next time begins with the noise of building again.
  void end_refining();
  void forget_refining();
  /// One piece of looking at the picture's points; false when it was cancelled.
  bool see(transport::Wavefront& wavefront, const CacheView& view, const std::function<bool()>& cancel);
  /// ... or all of them, for somebody who watches.
  /// False when it was cancelled.
  bool see_all(transport::Wavefront& wavefront, const CacheView& view,
               const std::function<bool()>& cancel = {});

  Radii::Bind binding() const {
    return [this](gpu::Resources& to) { tables.bind(to); };
  }
  /// Over the records that are evaluated, or the first `count`.
  void build_octree(transport::Wavefront& wavefront) { build_octree(wavefront, ranges.evaluated()); }
  void build_octree(transport::Wavefront& wavefront, uint32_t count) {
    status.references = tables.build_octree(wavefront, count);
  }
  void write_frame(uint32_t probing, const RouteTable& routes) {
    tables.write_frame(ranges.evaluated(), probing, routes);
  }
  /// ... of the picture's paths.
  void write_frame(uint32_t probing = shared::k_probe_none) {
    tables.write_frame(ranges.evaluated(), probing, tables.picture_routes,
                       probing == shared::k_probe_none ? options.branches : 1);
  }
  /// Of the records that are evaluated, as dark_luminance().
  float dark() const;

 private:
  // Stages and passes:
  void begin_pass(const Work& work);
  void end_pass(const Work& work);
  void next_pass();
  /// Building may wait here; `last`: of its pass.
  void end_stage(BuildStage stage, bool last = false);
  /// The records of this pass, which end there, for the next piece of work on them.
  void queue_until(uint32_t end);
  CachePass& pass() { return status.passes.back(); }
  void add_time(BuildStep step, double ms) { pass().ms[size_t(step)] += ms; }
  void add_rays(size_t records, uint32_t rays);
  /// Writes into the status what the cache takes: its own, and what grows while records are placed.
  void count_bytes();

  // Places:
  /// The screen-space stage; true when there is nothing left of it to do. `cancelled` is set when it was.
  bool look(const Work& work, bool& cancelled);
  bool looks_first() const;  ///< what the camera sees straight asks by dithering alone in this pass
  ReachOptions reach(const CacheView& view) const;
  /// What the paths of these blocks ask for, the first of which is there in the list of those looked at.
  void collect(const Work& work, const schedule::WorkItem& item, uint32_t first);
  /// All paths of this pass have asked: is it the last?
  void end_probing();
  /// Those that crowded as the camera saw them, and no longer do, are dropped, and asked for anew.
  void drop_roomy(const Work& work);

  // Radii:
  /// As Radii::Wanted::crowd: decided once for each record, before it is evaluated.
  float crowd() const;
  /// Of the records of this pass, which are waiting.
  Radii::Wanted wanted_radii() const;
  /// What pilots of the records of this pass tell is pooled with what those around them do.
  void pool(const Work& work);
  /// Radii of the records of this pass, by how far things are, or by the light too.
  enum class By { distance, light };
  void set_radii(const Work& work, By by);
  /// ... of all, also of earlier passes, by the records around, that they be no wider than they need be.
  /// ... of the first `count`, those that are evaluated at least, by what is nearest to any of them; the
  /// octree is built anew.
  void clamp_radii(const Work& work, uint32_t count, float near);

  // Light:
  /// One piece of looking where the picture reads records; false when it was cancelled.
  bool see_reads(const Work& work);
  /// A round of rays of the next records in the queue; false when it was cancelled.
  bool gather(const Work& work);
  /// The records of this pass that are still too noisy, for four times as many rays. False when there are
  /// none.
  bool next_level();
  bool at_last_level() const;
  /// Of these, which have all had as many rays, those that are too noisy. `figures`: of every record.
  std::vector<uint32_t> noisy(const std::vector<uint32_t>& records,
                              const std::vector<Records::Figures>& figures) const;
  /// The records of any pass that are to get further light next, and their level. False when there are none.
  bool next_refined();
  float share_of_noise(uint32_t record) const;
  /// ... without those that bring no light because paths gather there.
  std::vector<uint32_t> without_crowded(std::vector<uint32_t> list) const;
  /// Lights and radii of this level, for those who look up.
  void publish_level(const Work& work);
};

}  // namespace lucerna::irradiance_cache
