#pragma once
// The wavefront: traces paths through all their vertices; from the camera to the film, or between kernels of
// others.
//
//   source -> [closest hit -> shade (emission, light sample, scatter) -> shadow hit -> shadow light] ... ->
//   sink
//
// Path state is allocated once for `slots` paths, whatever the picture's size.
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "film/film.h"
#include "schedule/work.h"
#include "shaders/shared/layers.h"
#include "shaders/shared/ray.h"
#include "shaders/shared/scene.h"
#include "shaders/shared/transport.h"
#include "transport/hit_shading.h"
#include "transport/light_learning.h"
#include "upload/device_scene.h"

namespace lucerna::transport {

/// Traces rays[j], j = queue ? queue[i] : i for i < count, into hits[j], on the host's mapped memory.
using HostTrace = std::function<void(bvh::Query, std::span<const shared::Ray>, std::span<shared::Hit>,
                                     const uint32_t* queue, uint32_t count, bool coherent)>;

struct StageSum {
  std::string name;
  double ms = 0;
  bool host = false;  ///< wall time on the host; otherwise device time
};

/// Sums since the last reset().
struct TransportStats {
  uint64_t paths = 0;  ///< paths added to the film
  uint64_t rays = 0, shadow_rays = 0;
  uint64_t dropped = 0;              ///< contributions refused because they were not finite
  uint64_t roulette = 0, depth = 0;  ///< paths ended by roulette, by the maximum depth
  std::vector<StageSum> stages;
  ByComponent<double> component_ms{};  ///< sums to the stages' total
};

/// Source and destination of paths, recorded on the wavefront's stream with resources from bind_paths(). Path
/// p is in slot p.
struct PathEnds {
  std::function<void()> begin;  ///< writes ray, path state and zero radiance of every slot
  std::function<void()>
      first_hits;             ///< reads the hits of the first rays (before they are shaded); may be empty
  std::function<void()> end;  ///< reads the radiance of every slot, by component
  bool hits_only = false;     ///< traces only the first rays, without shading
  /// Kernel that replaces shade.comp at every vertex, for light paths: it includes
  /// shaders/lib/wavefront.glsl, takes a TransportPush, and is the stage of that name. Null: shade.comp.
  const gpu::Kernel* vertex = nullptr;
  std::string vertex_stage = {};
  std::function<void(gpu::Resources&)> bind_vertex = {};  ///< binds its resources other than the paths
  /// Kernel that receives the light of shadow rays of these vertices instead of the paths' radiance: a
  /// variant of transport/shadow.comp. Reads what `bind_vertex` sets. Null: shadow.comp.
  const gpu::Kernel* arrival = nullptr;
};

class Wavefront {
 public:
  /// `host_trace` empty: compute-bvh. `bind_lookup`: binds the resources of kernels that `extra_defines`
  /// compile with a lookup; called again by rebind(). Compiles all kernels (throws Error, located) and warms
  /// them up, except those of `rules`. `learning`: required if `extra_defines` contain
  /// upload::learned_defines().
  Wavefront(gpu::Device& device, gpu::ShaderCompiler& compiler, const upload::DeviceScene& scene,
            uint32_t slots, HostTrace host_trace, const gpu::Defines& extra_defines = {},
            std::function<void(gpu::Resources&)> bind_lookup = {}, const HitClassRules& rules = {},
            std::shared_ptr<LightLearning> learning = {});
  ~Wavefront();

  /// Sets the frame's constants; `enabled`: computed components (bit i). Compiles the kernel of cameras with
  /// a lens or a section plane for the first of them (throws Error, located).
  void set_frame(const shared::Frame& frame, uint32_t enabled);
  /// Table of the layers by path expressions (paths::LayerSet), of which the scene's effects give the number.
  void set_layers(const shared::LayerTable& table);
  /// Binds the scene's buffers, after DeviceScene::exchange.
  void rebind(const upload::DeviceScene& scene);
  /// Calls `bind_lookup` again, after a change of its buffers.
  void rebind_lookup();
  uint32_t slots() const;
  /// Traces the item and adds it to the film, by light group if scene and film separate groups, else mixed as
  /// the film says. `cancel` is called between bounces; a cancelled item leaves the film unchanged and
  /// returns false.
  bool run(const schedule::WorkItem& item, film::Film& film, const std::function<bool()>& cancel = {});
  /// Recomputes the film's picture from its light groups by their mix (film::Film::set_mix), if it stores
  /// them by component. Traces nothing.
  void mix(film::Film& film);
  /// Likewise, for a film other than the picture's: stats().paths is unchanged.
  bool try_out(const schedule::WorkItem& item, film::Film& film, const std::function<bool()>& cancel = {});
  /// Likewise, without a film, for data that kernels note.
  bool probe(const schedule::WorkItem& item, const std::function<bool()>& cancel = {});
  /// Traces the item to learn from its light samples: one generation of `learning`, or replays it. Afterwards
  /// the frame is `picture` with `enabled` components again. False if cancelled: nothing was learned.
  bool learn(const schedule::WorkItem& item, const shared::Frame& pilot, const shared::Frame& picture,
             uint32_t enabled, const std::function<bool()>& cancel = {});
  /// Null: lights are chosen by power.
  LightLearning* learning();
  std::shared_ptr<LightLearning> shared_learning();
  /// Resets learned light selection, for other lights. The frame must be set again.
  void forget_learned(upload::LightClusters clusters);
  /// Resets it for a picture of the same lights, which may replay its generations (LightLearning::replay()).
  void rewind_learning();
  const LightLearning* learning() const;
  /// Traces `count` <= slots() paths between the caller's ends; cancellable as above, then without `end`.
  /// Their time and rays count in stats() like those of the film's paths. Uses the frame of set_frame().
  bool run(uint32_t count, const PathEnds& ends, const std::function<bool()>& cancel = {});
  /// Binds the paths' buffers, with the names of shaders/lib/wavefront.glsl, and the scene's.
  void bind_paths(gpu::Resources& resources) const;
  gpu::Stream& stream();
  /// Runs the commands that others have recorded on the stream and adds their stages' times to stats(), as
  /// eye paths'.
  void account_stages();
  /// One shared::Hit per slot, of the last traced rays.
  const gpu::Buffer& hits() const;

  const TransportStats& stats() const;
  void reset_stats();
  /// Calls `trace` without accounting: stats() are unchanged, as for work that is not part of the picture.
  void uncounted(const std::function<void()>& trace);
  double compile_seconds() const;
  /// Classes of hits with separate kernels; none before these are ready.
  HitClasses hit_classes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::transport
