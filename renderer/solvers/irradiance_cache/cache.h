#pragma once
// The irradiance cache. It is built in passes before the picture begins and is then read-only, so the picture
// does not depend on the order in which records were made (method and sources: README.md).
//
// A pass traces paths from the camera, one per pixel, or more if few find gaps. A diffuse vertex that no
// record serves is a candidate. Some candidates are chosen (placement.h), evaluated (evaluate.h) and given a
// radius. Passes end when few paths still find gaps. Pixels without records are path traced.
//
// If tertiary light is cached too, the cache reads itself: rays of a record end at records of earlier passes.
// The first pass therefore also collects candidates at deeper vertices. Its records are path traced to the
// end; later records contain light of many bounces with at most one interpolation.
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

/// What determines the radius of validity of a record.
enum class Metric : uint32_t {
  split_sphere,  ///< distances of the surfaces around it (G. Ward, F. Rubinstein and R. Clear, 1988)
  hessian,  ///< curvature of its irradiance (shaders/irradiance_cache/hessian.comp); validity regions are
            ///< ellipses
};

/// Options of the radii of validity.
struct RadiusOptions {
  Metric metric = Metric::split_sphere;
  /// Scale of the radii, above 0. Split sphere: radius over the harmonic mean distance. Hessian: the integral
  /// of the relative error over an ellipse is pi/4 (reach/2)^4, in squares of the scene's radius.
  float error = 0;
  /// Upper bound of the (minor) radius over the nearest hit distance, 0..1. Near geometry changes within that
  /// distance, which the mean distance does not show.
  float nearest = 0;
  float least_pixels = 0;  ///< minimum radius as seen from the camera [pixels]; 0 or more
  float most_radius = 0;   ///< maximum radius over the scene's radius
};

/// Ranges and defaults are in the option table (options.cpp).
struct CacheOptions {
  RadiusOptions radius;
  /// Rays of a record's first level: four times a square. Each further level has four times as many, up to
  /// `most_rays`. Levels of more than k_least_slots rays are gathered in rounds of that size.
  uint32_t rays = 0, most_rays = 0;
  /// Relative standard error of the luminance above which a record gets a further level. It holds for the
  /// first level and for a record that the picture reads as much as one with a radius of 3 % of the picture's
  /// height; it is proportional to 1 / sqrt(importance()) and to sqrt(rays so far). Records darker than a
  /// tenth of the mean are compared with that. Decided from neighbouring records together (noise.h).
  float noise = 0;
  /// Fraction of its radius within which a record removes others that are not yet evaluated, 0..1. Smaller:
  /// more records; 0: none is removed.
  float thinning = 0;
  /// True: where geometry is nearer than twice the minimum radius, paths gather and end in records one vertex
  /// later.
  bool gather = false;
  /// Lookups read light that is smoothed over neighbouring records (smoothing.h).
  bool smooth = true;
  uint32_t branches = 1;  ///< gathering paths per sample of the picture
  uint32_t most_records = 0, most_passes = 0;
  /// Light groups whose shares records store, for films with compact groups; less than 2: none.
  uint32_t groups = 1;
  float stop_share = 0;  ///< building ends when at most this share of the paths find no record
  uint32_t seed = 0;
  DiscontinuityOptions screen;
};

enum class StopReason { building, covered, passes, records, dark, finished_early };
inline constexpr const char* k_stop_reasons[] = {"building", "covered", "passes",
                                                 "records",  "dark",    "finished early"};
static_assert(std::size(k_stop_reasons) == size_t(StopReason::finished_early) + 1);
/// The reason why building has stopped, as the end of a sentence.
const char* words(StopReason reason);

struct CacheStatus {
  uint32_t pass = 0;  ///< complete passes since building began or was extended
  uint32_t records = 0;
  struct {
    uint64_t uncovered = 0, paths = 0;  ///< paths that found no record; all paths
  } probed;                             ///< of the last complete pass
  uint64_t rays = 0;                    ///< over the records' hemispheres
  uint64_t bytes = 0;                   ///< of device memory
  double references = 0;                ///< mean number of leaves that list a record
  uint32_t loaded = 0;                  ///< records loaded from a file; their rays are included
  struct {
    /// Number of records being relit, of which CacheStatus::records are done; 0: not relighting.
    uint32_t records = 0;
    float share = 0;    ///< share of these that have their first level, including those in progress
    uint64_t rays = 0;  ///< rays that they had before; 0: unknown
  } relighting;
  StopReason stop = StopReason::building;
  bool waits = false;             ///< building is paused (Cache::pause)
  std::optional<StageDone> last;  ///< the most recent complete stage, since building began
  /// Since building or relighting began, including extensions; the last one may be in progress.
  std::vector<CachePass> passes;
};

/// Picture and scene, as far as building depends on them.
struct CacheView {
  /// Frames of the picture's paths, and of the records' paths, whose components are the parts.
  shared::Frame paths_frame, records_frame;
  uint32_t paths_enabled = 0, records_enabled = 0;  ///< components that each may compute, as bits
  uint32_t width = 0, height = 0;
  float scene_radius = 1;
  Box core;           ///< of the scene without distant outliers; empty: there are none
  bool dark = false;  ///< the scene has no light: no records are placed, existing ones wait to be relit
};

/// Lookups of records by paths.
struct CacheRoutes {
  paths::LookupRoutes picture,
      picture_gather;  ///< for the picture's paths; for those that gather near crowded records
  /// For the records' rays, with the parts they gather (paths::record_routes; without lookups they are path
  /// traced); for those that gather (paths::gather_routes).
  paths::LookupRoutes records, records_gather;
  /// Lookups of another solver provide the tertiary light of the records' rays.
  bool elsewhere = false;
};

class Cache {
 public:
  /// Maximum number of rays of a record gathered at once. Fixed, because record values depend on it.
  static constexpr uint32_t k_least_slots = Evaluator::k_most_rays;

  /// `slots`: of the wavefronts used with it, at least k_least_slots. Throws Error like Records, or if an
  /// option is out of range.
  Cache(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, const CacheRoutes& routes,
        const CacheOptions& options);
  ~Cache();

  /// For kernels of a wavefront that reads a cache with its own routes and this metric. `gathers`:
  /// CacheOptions::gather.
  static gpu::Defines defines(const paths::LookupRoutes& own, Metric metric, bool gathers);
  /// Binds the names of shaders/irradiance_cache/lookup.glsl.
  void bind(gpu::Resources& resources) const;
  /// Updates the minimum radius, which depends on the view. Call it whenever the view has changed; step()
  /// does.
  void look_from(const CacheView& view);
  /// Removes all records.
  void clear();
  /// Ends building, at once or with the next step(): records with all rays of the first level serve, pixels
  /// without records are path traced. Does nothing while relighting.
  void finish_early();
  /// Requires ready(). Starts further rays, to about `factor` > 1 times all rays so far, for records whose
  /// noise exceeds the bound of the last time over sqrt(factor), without changing places and radii. step()
  /// does the work while refines(). Any other change of the cache ends it.
  void refine(double factor);
  bool refines() const;
  /// Continues building with the present records for another camera or size; passes are counted from 0 again.
  /// Work in progress is finished first; a pause stays.
  void extend();
  /// Objects have left or entered these boxes (world space): drops the records whose radii they determine,
  /// and work in progress. Call relight() and extend() next.
  void drop_near(std::span<const Box> moved);
  /// Recomputes all light on the same surfaces; if diffuse surfaces have changed, call extend() too. Places
  /// and radii stay. Light is gathered again pass by pass; then building continues from, or is complete as,
  /// before. Meanwhile only relit records serve. The result equals a cache built in this light, bit by bit if
  /// places do not depend on light. Ellipses do: they are recomputed, and passes are added where they leave
  /// gaps. `factors`: known factor on the light of each group, or on all light; for preview_relighting()
  /// only. `sky_group`: group of the sky.
  void relight(const std::optional<std::vector<vec3>>& factors = {}, uint32_t sky_group = 0);
  /// Enables preview light of all records during relighting (relight_preview.h), where it is known.
  /// look_up_preview() switches lookups between the preview and the relit records.
  void preview_relighting(bool on);
  bool previews_relighting() const;
  void look_up_preview(transport::Wavefront& wavefront, bool on);
  /// Replaces all records by those of the complete passes of another cache of the same scene, made for other
  /// lookups, options or kernels. Returns what the caller must invalidate: coverage, light, or places if
  /// there is no room; then the state is as after clear().
  solvers::Invalidation adopt(transport::Wavefront& wavefront, const Cache& other);
  /// Sets where building pauses: step() then does nothing until go_on(). The result does not change.
  /// Initially off.
  void pause(PauseAfter after);
  bool stepped() const;  ///< building pauses somewhere
  /// Continues to the end of the current or next stage and pauses there; or, without `one_stage`, until
  /// building is complete whatever pause() has set. Does nothing if complete.
  void go_on(bool one_stage);
  /// For display; views into the cache, valid until it changes. Reads candidates from the device if they have
  /// changed.
  PlacementShown placement() const;
  bool ready() const;
  /// True once few paths would find no record if building ended early.
  bool usable() const;
  /// Replaces all records (Records::raw of a cache with at least these routes' parts). Afterwards as after a
  /// pass: building continues as after extend(), or, with `complete`, is ready with `status`.
  void restore(transport::Wavefront& wavefront, RawRecords raw, const CacheStatus& status, bool complete);
  /// Runs one bounded work item of building, cancellable between bounces. Afterwards the wavefront has the
  /// frame of the picture's paths. False if it was cancelled (it will be repeated) or is paused.
  bool step(transport::Wavefront& wavefront, const paths::Automaton& automaton, const CacheView& view,
            const std::function<bool()>& cancel = {});
  const CacheStatus& status() const;
  const Records& records() const;
  /// Importance of each record when the last pass had its first level: how much the picture reads it
  /// (picture_reads.h).
  const std::vector<float>& importance() const;
  uint32_t parts() const;  ///< stored in its records (bits); the others are 0
  bool recursive() const;  ///< tertiary light is looked up in records, not path traced
  bool elsewhere() const;  ///< ... or provided by another solver
  /// Traces the centres of all pixels for bind_sight(), if not done; passes of building do it themselves. The
  /// wavefront must have the view's frame. False if cancelled.
  bool look_at_picture(transport::Wavefront& wavefront, const CacheView& view,
                       const std::function<bool()>& cancel = {});
  /// Runs one work item of the film's record errors (picture_error.h), until Film::lookup_errors_complete().
  /// Requires ready(); the wavefront must have the view's frame. `restarted`: the picture has begun. False if
  /// cancelled: it will be repeated.
  bool estimate_errors(transport::Wavefront& wavefront, film::Film& film, const CacheView& view,
                       bool restarted, const std::function<bool()>& cancel = {});
  /// Lookup places of pixels, for shaders/overlay/lookup_place.glsl; overlay::k_no_sight before they are
  /// known.
  shared::SightGrid bind_sight(gpu::Resources& resources) const;
  /// Draws over the film's picture: records as discs, coloured by shared::k_record_by_*, and the number of
  /// records that serve each pixel. Needs the film's depth, or, without samples, the depth of the coarse film
  /// of the same picture (shared::k_coarse_step), and the lookup places of look_at_picture(). The stream has
  /// been submitted.
  struct Overlay {
    bool discs = false, overlap = false;
    uint32_t color = shared::k_record_by_pass;
  };
  /// Ends of the logarithmic colour scale that covers nearly all records; for rays, distance and error. 0 <
  /// first < second.
  std::pair<float, float> scale(uint32_t color) const;
  void draw(const overlay::Canvas& canvas, const Overlay& overlay);
  /// Draws the discontinuity of geometry, or of the present irradiance, at one level of the pyramid of the
  /// screen-space stage. The wavefront must have the view's frame; the stream has been submitted. Does
  /// nothing if the canvas is out of date.
  void draw_discontinuity(const overlay::Canvas& canvas, const CacheView& view, Discontinuity::Of of,
                          uint32_t level);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::irradiance_cache
