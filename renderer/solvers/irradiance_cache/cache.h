#pragma once
// The irradiance cache as a solver: built in passes before the picture is begun, then only read, so that the
// picture does not depend on the order in which records came (README.md has method and sources).
//
// A pass sends paths from the camera through the scene (one a pixel, and more while few of them ask); where a
// diffuse vertex finds no record it asks for one. Of the places asked for some are chosen (placement.h),
// evaluated (evaluate.h) and given a radius. Passes end when few paths still ask. What no record serves is
// path traced.
//
// Where tertiary light is cached too the cache reads itself: a record's rays end where they find records of
// earlier passes. So the first pass also asks at vertices deeper in the scene; its own records are path
// traced to the end, and light that takes many bounces is in all later ones with no more than one
// interpolation.
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "overlay/canvas.h"
#include "paths/automaton.h"
#include "solvers/info.h"
#include "solvers/irradiance_cache/build_log.h"
#include "solvers/irradiance_cache/discontinuity.h"
#include "solvers/irradiance_cache/evaluate.h"
#include "solvers/irradiance_cache/records.h"
#include "solvers/irradiance_cache/stages.h"
#include "solvers/lookup/octree.h"

namespace lucerna::irradiance_cache {

/// What decides how far a record serves.
enum class Metric : uint32_t {
  split_sphere,  ///< how far things are that it sees (G. Ward, F. Rubinstein and R. Clear, 1988)
  hessian,       ///< how its irradiance bends (shaders/irradiance_cache/hessian.comp); radii are of ellipses
};

/// How far records serve.
struct RadiusOptions {
  Metric metric = Metric::split_sphere;
  /// Above 0; radii are in proportion to it. Split sphere: radius of a record over the harmonic mean distance
  /// of what it sees. Hessian: so that the integral of its relative error over its ellipse is pi/4 of the
  /// fourth power of half of this, in squares of the scene's radius.
  float error = 0;
  /// Of a radius, an ellipse's lesser one, over the distance of the nearest thing that the record's rays met:
  /// at most 1. What is near changes within that distance, of which the mean distance tells little.
  float nearest = 0;
  float least_pixels = 0;  ///< least radius as the camera sees it; 0 or more
  float most_radius = 0;   ///< of the scene's radius
};

/// As the registry has them, where their ranges and defaults stand (options.cpp).
struct CacheOptions {
  RadiusOptions radius;
  /// Rays of a record's first level: four times a square. Each further level has four times as many, up to
  /// `most_rays`; what is more than k_least_slots is gathered in rounds of as many.
  uint32_t rays = 0, most_rays = 0;
  /// Relative standard error of its luminance above which a record gets another level: after the first, and
  /// when as much of the picture reads it as one with a radius of 3 % of the picture's height. In proportion
  /// to one over the square root of how much does (importance()) and to the square root of the rays so far.
  /// Records darker than a tenth of the mean are held against that. Judged by the records around (noise.h).
  float noise = 0;
  /// Of its radius: where a record makes others superfluous that are not yet evaluated, 0..1. The less, the
  /// more records; 0: none goes.
  float thinning = 0;
  /// Where something is nearer than twice the least radius paths gather themselves and end in records one
  /// vertex later.
  bool gather = false;
  uint32_t branches = 1;  ///< by how many paths a sample of the picture does so
  uint32_t most_records = 0, most_passes = 0;
  /// Groups of lights whose shares records keep, for films that keep them in short; less than 2: none.
  uint32_t groups = 1;
  float stop_share = 0;  ///< building ends when no more of the paths than this ask for records
  uint32_t seed = 0;
  DiscontinuityOptions screen;
};

enum class StopReason { building, covered, passes, records, dark, finished_early };
inline constexpr const char* k_stop_reasons[] = {"building", "covered", "passes",
                                                 "records",  "dark",    "finished early"};
static_assert(std::size(k_stop_reasons) == size_t(StopReason::finished_early) + 1);
/// Why building has stopped, as the rest of a sentence.
const char* words(StopReason reason);

struct CacheStatus {
  uint32_t pass = 0;  ///< complete since the building began or was extended
  uint32_t records = 0;
  struct {
    uint64_t uncovered = 0, paths = 0;  ///< paths that asked, paths
  } probed;                             ///< of the last complete pass
  uint64_t rays = 0;                    ///< of the records' own hemispheres
  uint64_t bytes = 0;                   ///< of device memory
  double references = 0;                ///< leaves that list a record, on average
  uint32_t loaded = 0;                  ///< of the records, from a file; their rays count too
  struct {
    /// Not 0: so many records keep their places and are relit, CacheStatus::records of them so far.
    uint32_t records = 0;
    float share = 0;    ///< of these that has its first level, those under way included
    uint64_t rays = 0;  ///< that they had before; 0: not known
  } relighting;
  StopReason stop = StopReason::building;
  bool waits = false;             ///< building has come to a pause (Cache::pause)
  std::optional<StageDone> last;  ///< the stage that has ended last, since it was begun
  /// Since it was begun or relit, extensions too; the last may be in progress.
  std::vector<CachePass> passes;
};

/// What the building needs to know of the picture and its scene.
struct CacheView {
  /// Of the picture's paths; of the records', whose components are the parts.
  shared::Frame paths_frame, records_frame;
  uint32_t paths_enabled = 0, records_enabled = 0;  ///< ... and what each may bring, in bits
  uint32_t width = 0, height = 0;
  float scene_radius = 1;
  Box core;           ///< of the scene where something stands far away from it; empty: all lies together
  bool dark = false;  ///< the scene has no light: nothing is placed, and what there is waits to be relit
};

/// Where paths look up.
struct CacheRoutes {
  paths::LookupRoutes picture, picture_gather;  ///< the picture's; those that gather because records crowd
  /// The rays of records, and the parts that they gather (paths::record_routes; without any lookup they are
  /// path traced); those that gather (paths::gather_routes).
  paths::LookupRoutes records, records_gather;
  /// The rays of records bring tertiary light by the lookups of another solver.
  bool elsewhere = false;
};

class Cache {
 public:
  /// Rays of a record that are gathered at once, at most: no fewer whatever slots there are, because records
  /// would depend on them.
  static constexpr uint32_t k_least_slots = Evaluator::k_most_rays;

  /// `slots`: of the wavefronts that it will be used with, k_least_slots or more.
  /// Throws Error as Records, or when an option is out of its range.
  Cache(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, const CacheRoutes& routes,
        const CacheOptions& options);
  ~Cache();

  /// For the kernels of a wavefront that reads a cache with these routes of its own and this metric.
  /// `gathers`: CacheOptions::gather.
  static gpu::Defines defines(const paths::LookupRoutes& own, Metric metric, bool gathers);
  /// Under the names of shaders/irradiance_cache/lookup.glsl.
  void bind(gpu::Resources& resources) const;
  /// Which records are the least that there may be, and so serve coarsely, depends on who looks. Call it
  /// whenever the view is another; step() does.
  void look_from(const CacheView& view);
  /// Begins anew, without records.
  void clear();
  /// Building ends where it is: records that have light serve, and what none serves is path traced. Not while
  /// records are relit.
  void finish_early();
  /// When ready: records whose noise is more than the picture can bear by now, over the root of 2 what it
  /// could the last time, get further light, with the same places and radii, while step() is called and
  /// refines(). Whatever changes the cache ends it.
  void refine();
  bool refines() const;
  /// Goes on building with what there is, for a picture from elsewhere or of another size: its passes are
  /// counted anew. Work in progress is finished first. While building waits it goes on waiting.
  void extend();
  /// Other light on the same surfaces, of which those that were diffuse are so still (else extend() too):
  /// places and radii stay, and all light is gathered anew, pass by pass as the records came; then building
  /// goes on where it was, or is complete as it was. Meanwhile those that are relit serve, and no others. The
  /// outcome is that of a cache built in this light, to the bit where places do not depend on light. Ellipses
  /// do: they are made anew, and passes added where they leave gaps.
  /// `factors`: of the light of each group, or of all light, where that is known; for preview_relighting()
  /// alone. `sky_group`: whose light the sky's is.
  void relight(const std::optional<std::vector<vec3>>& factors = {}, uint32_t sky_group = 0);
  /// Somebody watches: while records are relit there is a light of them all for display
  /// (relight_preview.h) where that is known, which look_up_preview() has lookups read, and no longer.
  void preview_relighting(bool on);
  bool previews_relighting() const;
  void look_up_preview(transport::Wavefront& wavefront, bool on);
  /// In place of its own, the records of another cache of the same scene, made for other lookups, options or
  /// kernels: as far as passes are complete. Returns what of them does not serve here, for the caller to see
  /// to: coverage, light, or places, where there is no room for them; then this is as after clear().
  solvers::Invalidation adopt(transport::Wavefront& wavefront, const Cache& other);
  /// Building is to wait after every stage or pass from now on: step() then does nothing until go_on(). What
  /// is built is the same, bit for bit. Off in the beginning.
  void pause(PauseAfter after);
  /// Goes on: to the end of the next stage, which may be one in progress, and waits there; or until building
  /// is complete, whatever pause() has said. Nothing where it is complete already.
  void go_on(bool one_stage);
  /// For who watches; views of what the cache holds until it is changed. Candidates are read from the device
  /// when there are others than before.
  PlacementShown placement() const;
  bool ready() const;
  /// Begins anew with records from elsewhere (Records::raw, of a cache that has these routes' parts at
  /// least), as after a pass of building: it goes on as extend() does, or, with `complete`, is ready and
  /// stands as `status` says.
  void restore(transport::Wavefront& wavefront, RawRecords raw, const CacheStatus& status, bool complete);
  /// One bounded piece of the building, cancellable between bounces; on return the wavefront's frame is that
  /// of the picture's paths. False when it was cancelled: it will be done again; or while it waits.
  bool step(transport::Wavefront& wavefront, const paths::Automaton& automaton, const CacheView& view,
            const std::function<bool()>& cancel = {});
  const CacheStatus& status() const;
  const Records& records() const;
  /// Of the records, when the last pass had its first level: how much of the picture reads them
  /// (picture_reads.h).
  const std::vector<float>& importance() const;
  uint32_t parts() const;  ///< that its records hold (bits); the others are 0
  bool recursive() const;  ///< their tertiary light is looked up in other records, not path traced
  bool elsewhere() const;  ///< ... or by another solver
  /// Looks through the centre of every pixel, for bind_sight(), unless that has been done: while the cache is
  /// being built its own passes do. The wavefront's frame is the view's.
  /// False when it was cancelled.
  bool look_at_picture(transport::Wavefront& wavefront, const CacheView& view,
                       const std::function<bool()>& cancel = {});
  /// Goes on estimating, for the film, what the picture's records make it wrong by (picture_error.h), a piece
  /// at a time, until Film::record_errors_complete(). Only when ready(); the wavefront's frame is the view's.
  /// `anew`: the picture is begun. False when it was cancelled: it will be done again.
  bool estimate_errors(transport::Wavefront& wavefront, film::Film& film, const CacheView& view,
                       bool restarted, const std::function<bool()>& cancel = {});
  /// For shaders/overlay/lookup_place.glsl: where pixels ask for records; overlay::k_no_sight before that is
  /// known.
  shared::SightGrid bind_sight(gpu::Resources& resources) const;
  /// Draws over the film's picture: records as discs, coloured by one of shared::k_record_by_*; how many
  /// serve each pixel. Needs the film's depth, and where it has no samples that of the coarse film of the
  /// same picture (shared::k_coarse_step); where pixels ask is what look_at_picture() has seen. The stream
  /// is run.
  struct Overlay {
    bool discs = false, overlap = false;
    uint32_t color = shared::k_record_by_pass;
  };
  /// Ends of the logarithmic scale of a value that records are coloured by, from nearly all records; of rays,
  /// distance and error only. 0 < first < second.
  std::pair<float, float> scale(uint32_t color) const;
  void draw(const overlay::Canvas& canvas, const Overlay& overlay);
  /// Lays over the film's picture what of it the screen-space stage sees: the discontinuity of the geometry,
  /// or of the irradiance that the present records give, at a level of its pyramid. The wavefront's frame is
  /// the view's. The stream is run. Nothing where the canvas says that the picture is out of date.
  void draw_discontinuity(const overlay::Canvas& canvas, const CacheView& view, Discontinuity::Of of,
                          uint32_t level);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::irradiance_cache
