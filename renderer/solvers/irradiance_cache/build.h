#pragma once
// What a cache holds while it is built, and the stages of a pass: probe (where do paths find no record?),
// choose, measure (how far are things around what is tried?), thin, evaluate level by level, index. Internal
// to the cache: cache.h is what others see.
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "schedule/uniform.h"
#include "shaders/shared/transport.h"
#include "solvers/irradiance_cache/cache.h"
#include "solvers/irradiance_cache/clamping.h"
#include "solvers/irradiance_cache/neighbours.h"
#include "solvers/irradiance_cache/picture_error.h"
#include "solvers/irradiance_cache/worth.h"

namespace lucerna::irradiance_cache {

enum class Stage { probe, choose, measure, thin, evaluate, index, done };

/// Most that the normals of a point and of its record may differ, as 1 - cos: 20 degrees.
inline constexpr float k_normal_tolerance = 0.06f;
/// How far off a record's plane, in its radius, points may lie: what a lamp's panel in a ceiling may not.
inline constexpr float k_off_plane = 0.03f;
/// The same of records of the least radius. With one of three pixels: half a pixel.
inline constexpr float k_off_plane_least = 0.16f;

/// What the least radius of records depends on.
struct LeastRadius {
  vec3 eye{0};
  bool parallel = false;
  float of_distance = 0;  ///< of the distance from `eye`; where `parallel`, in metres
  float most = 0;         ///< [m]
  float at(const vec3& position) const {
    return std::min(of_distance * (parallel ? 1 : distance(position, eye)), most);
  }
  bool operator==(const LeastRadius&) const = default;
};

/// Elevations of a level of that many rays; there are four times as many azimuths.
uint32_t elevations_for(uint32_t rays);

/// CacheFrame::routes.
using RouteTable = std::array<uint32_t, shared::k_automaton_states>;

struct Cache::Impl {
  /// What a piece of work is done with.
  struct Work {
    transport::Wavefront& wavefront;
    const paths::Automaton& automaton;
    const CacheView& view;
    const std::function<bool()>& cancel;
  };

  CacheOptions options;
  Records records;
  lookup::Octree octree;
  gpu::Buffer frame, candidates;
  gpu::Buffer pooled;  // only where radii are by the light
  gpu::Kernel radius, ellipse, pooling, pool_keep, overlay;
  gpu::Resources resources;
  Evaluator evaluator;
  RouteTable routes{}, own_routes{};  // of the picture's paths, of the records'
  bool recursive = false;
  uint32_t parts = 0;
  LeastRadius least;
  CacheStatus status;
  Stage stage = Stage::probe;
  schedule::UniformSchedule picture;
  bool probing = false;       // the schedule of this pass has begun
  bool filling = false;       // the last pass: few ask, but these may stand side by side
  uint32_t looked_along = 0;  // paths a pixel of the passes before
  std::array<std::pair<float, float>, 3> scales{{{1, 2}, {1, 2}, {1, 2}}};  // rays, distance, error
  Discontinuity screen;
  Placement placement;
  Clamping clamping;
  Worth reads;
  PictureError picture_error;
  std::vector<float> worth;              // of the records that are evaluated, by it
  std::optional<Neighbours> neighbours;  // only where radii are bounded
  bool asks_beyond = true;               // the first passes, where the cache reads itself
  bool moved = false;                    // the camera has, since the last pass began
  bool looked = false;                   // at the picture, in this pass: the screen-space stage is done
  uint64_t own_bytes = 0;                // of device memory, without what count_bytes() adds
  // Kept for who watches until the next pass begins:
  std::vector<Place> tried;
  std::vector<uint32_t> kept;
  std::vector<float> tried_radii;
  uint64_t placement_version = 0;  // grows with every change of them and of the candidates
  Choice shown;                    // the candidates as they were last asked for
  uint64_t shown_version = ~0ull;
  Pauses pauses;
  double ms_before = 0;  // of this pass, at the end of the stage that ended last
  uint64_t rays_at_end = 0;
  uint32_t evaluated = 0;       // records up to here have light and radius, and are in the octree
  uint32_t standing = 0;        // ... and up to here place and radius: more, while they are relit
  uint32_t until = 0;           // those of the pass in progress end here
  std::vector<uint32_t> ends;   // of the records of each complete pass
  uint32_t held = 0;            // parts that all complete records hold; `parts` at least
  bool held_recursive = false;  // ... gathered as `recursive` says
  StopReason stopped = StopReason::building;            // why building had stopped before records were relit
  std::vector<uint32_t> list;                           // of this level, in the order of the records
  size_t at = 0;                                        // of which so many are done
  uint32_t level = 0, level_done = 0, rays_before = 0;  // ... and rays of each record, in this level, so far
  bool more_levels = false;

  Impl(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, const paths::LookupRoutes& own,
       const CacheOptions& o);

  /// One bounded piece of a stage each; false when it was cancelled, and is to be done again. A stage that is
  /// complete hands over to the next.
  bool probe(const Work& work);
  bool choose(const Work& work);
  bool measure(const Work& work);
  bool thin();
  bool evaluate(const Work& work);
  bool index(const Work& work);
  void finish(StopReason reason);
  /// Tells the status what the cache takes: its own, and what grows while records are placed.
  void count_bytes();
  void look_from(const CacheView& view);
  /// Building goes on; passes are counted, and the picture looked along, from the beginning.
  void count_anew(bool beyond) {
    status.pass = looked_along = 0;
    asks_beyond = beyond;
    filling = false;
    status.stop = stopped = StopReason::building;
  }
  /// The picture is another: what has been seen of it is forgotten.
  void look_elsewhere() { screen.forget(), reads.forget(); }
  /// What is placed and not evaluated is dropped, and what was asked for.
  void drop_pass();
  void relight();
  /// The records of the next pass that stand without light; after the last, building goes on where it was.
  void relight_pass();
  void forget_placement();

  /// As EllipsePush::crowd: decided once for each record, before it is evaluated.
  float crowd() const {
    return options.gather && stage == Stage::measure && status.relighting == 0 ? k_crowds : 0.0f;
  }
  /// Of the least radius: where something is nearer, records crowd. They would be read by few pixels, each
  /// with a noise of its own.
  static constexpr float k_crowds = 2;
  /// Whether radii are by the light, of which pilot rays tell.
  bool by_light() const { return options.metric == Metric::hessian; }
  /// Irradiance, luminance: what records of less are held against, because what they miss is seen less. Of
  /// the first `count`, which have light; `light`: Records::luminances().
  float dark(std::span<const float> light, uint32_t count) const;
  /// Records of complete passes.
  uint32_t complete() const { return ends.empty() ? 0 : ends.back(); }
  /// One piece of looking at the picture's points; false when it was cancelled.
  bool see(transport::Wavefront& wavefront, const CacheView& view, const std::function<bool()>& cancel);
  /// ... or all of them, for somebody who watches.
  void see_all(transport::Wavefront& wavefront, const CacheView& view) {
    if (screen.seen()) return;
    wavefront.uncounted([&] {
      while (!screen.seen()) see(wavefront, view, {});
    });
  }
  /// Records that are evaluated hold what this cache gathers, and no more.
  void hold() { held = parts, held_recursive = recursive; }
  /// Complete records from elsewhere, in place of all.
  void take(const RawRecords& raw);
  /// What lookup.glsl reads.
  void bind(gpu::Resources& to) const;
  void build_octree(transport::Wavefront& wavefront) { build_octree(wavefront, evaluated); }
  void build_octree(transport::Wavefront& wavefront, uint32_t count);
  /// What all but a few records lie between.
  void set_scales();
  /// What paths know of the cache from here on.
  void tell(uint32_t probing, const RouteTable& table);
  void tell(uint32_t probing = shared::k_probe_none) { tell(probing, routes); }

 private:
  void begin_pass(const Work& work);
  /// The screen-space stage; true when there is nothing left of it to do. `cancelled` is set when it was.
  bool look(const Work& work, bool& cancelled);
  bool looks_first() const;  ///< what the camera sees straight asks by dithering alone in this pass
  ReachOptions reach(const CacheView& view) const;
  /// How far off its plane a record of that radius serves [m], as lookup.glsl has it.
  float off_plane(const Place& place, float radius) const {
    return radius * (radius <= 1.001f * least.at(place.position) ? k_off_plane_least : k_off_plane);
  }
  void collect(const Work& work, const schedule::WorkItem& item);
  void end_pass(const Work& work);
  void next_pass();
  /// Building may wait here; `last`: of its pass.
  void ended(BuildStage stage, bool last = false);
  float share_of_noise(uint32_t record) const;
  /// One piece of looking where the picture reads records; false when it was cancelled.
  bool see_reads(const Work& work);
  /// The records of this pass that are still too noisy, for four times as many rays. False when there are
  /// none.
  bool next_level();
  /// Lights and radii of this level, for those who look up.
  void publish_level(const Work& work);
  /// What pilots of the records of this pass tell is pooled with what those around them do.
  void pool(const Work& work);
  /// Radii of the records of this pass, by how far things are, or by the light too.
  enum class By { distance, light };
  void set_radii(const Work& work, By by);
  /// ... of all, also of earlier passes, by the records around, that they be no wider than they need be.
  void bound_radii(const Work& work);
  /// ... of the first `count`, those that are evaluated at least, by what is nearest to any of them; the
  /// octree is built anew.
  void clamp_radii(const Work& work, uint32_t count, float near);
  /// Greatest radius, of ellipses the lesser, over the distance of the nearest thing: of what is only tried.
  float tried_near() const;
  /// The records of this pass, which end there, for the next piece of work on them.
  void list_until(uint32_t end);
  /// ... without those that bring no light because paths gather there.
  void leave_crowded();
  /// Those that crowded as the camera saw them, and no longer do, are dropped, and asked for anew.
  void drop_roomy(const Work& work);
  CachePass& pass() { return status.passes.back(); }
  void took(BuildStep step, double ms) { pass().ms[size_t(step)] += ms; }
  void spent(size_t done, uint32_t rays);
};

}  // namespace lucerna::irradiance_cache
