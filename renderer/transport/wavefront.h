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
  uint64_t paths = 0;  ///< of the film's
  uint64_t rays = 0, shadow_rays = 0;
  uint64_t dropped = 0;              ///< contributions refused because they were not finite
  uint64_t roulette = 0, depth = 0;  ///< paths ended by roulette, by the maximum depth
  std::vector<StageSum> stages;
  std::array<double, shared::k_component_count> component_ms{};  ///< sums to the stages' total
};

/// Where paths come from and where their light goes, recorded on the wavefront's stream with resources that
/// bind_paths() has filled. Path p lies in slot p.
struct PathEnds {
  std::function<void()> begin;  ///< writes ray, path state and zero radiance of every slot
  std::function<void()>
      first_hits;             ///< reads the hits of the first rays (before they are shaded); may be empty
  std::function<void()> end;  ///< reads the radiance of every slot, by component
  bool hits_only = false;     ///< only the first rays are traced, and nothing is shaded
  /// Kernel that replaces shade.comp at every vertex, for light paths: it includes
  /// shaders/lib/wavefront.glsl, takes a TransportPush, and is the stage of that name. Null: shade.comp.
  const gpu::Kernel* vertex = nullptr;
  std::string vertex_stage = {};
  std::function<void(gpu::Resources&)> bind_vertex = {};  ///< binds what it reads besides the paths
  /// Kernel that receives the light of shadow rays of these vertices instead of the paths' radiance: a
  /// variant of transport/shadow.comp. Reads what `bind_vertex` sets. Null: shadow.comp.
  const gpu::Kernel* arrival = nullptr;
};

class Wavefront {
 public:
  /// `host_trace` empty: compute-bvh. `bind_lookup`: sets what kernels read that are compiled, by
  /// `extra_defines`, with a lookup; called again by rebind(). Compiles all kernels (throws Error, located)
  /// and warms them up, but for those of `rules`. `learning`: given where `extra_defines` have
  /// upload::learned_defines().
  Wavefront(gpu::Device& device, gpu::ShaderCompiler& compiler, const upload::DeviceScene& scene,
            uint32_t slots, HostTrace host_trace, const gpu::Defines& extra_defines = {},
            std::function<void(gpu::Resources&)> bind_lookup = {}, const HitClassRules& rules = {},
            std::shared_ptr<LightLearning> learning = {});
  ~Wavefront();

  /// The frame's constants; `enabled`: components on (bit i).
  void set_frame(const shared::Frame& frame, uint32_t enabled);
  /// After DeviceScene::exchange.
  void rebind(const upload::DeviceScene& scene);
  /// Calls `bind_lookup` again: after its buffers have changed.
  void rebind_lookup();
  uint32_t slots() const;
  /// Traces the item and adds it to the film, by light group if scene and film separate groups, else mixed as
  /// the film says. `cancel` is called between bounces; a cancelled item leaves the film unchanged and
  /// returns false.
  bool run(const schedule::WorkItem& item, film::Film& film, const std::function<bool()>& cancel = {});
  /// Recomputes the film's picture from its light groups by their mix (film::Film::set_mix), if it stores
  /// them by component. Traces nothing.
  void mix(film::Film& film);
  /// The same for a film that is not the picture's: stats().paths stays as it is.
  bool try_out(const schedule::WorkItem& item, film::Film& film, const std::function<bool()>& cancel = {});
  /// The same without a film: for what kernels note on the way.
  bool probe(const schedule::WorkItem& item, const std::function<bool()>& cancel = {});
  /// Traces the item for what its light samples teach: one generation of the learning it was made with. The
  /// frame is then `picture` again, of `enabled` components. False when it was cancelled: nothing was
  /// learned.
  bool learn(const schedule::WorkItem& item, const shared::Frame& pilot, const shared::Frame& picture,
             uint32_t enabled, const std::function<bool()>& cancel = {});
  /// Null: lights are chosen by power.
  LightLearning* learning();
  /// Resets learned light selection, for the present lights or these. The frame must be set again.
  void forget_learned(std::optional<upload::LightClusters> clusters = {});
  const LightLearning* learning() const;
  /// Traces `count` <= slots() paths between ends of the caller's; cancellable as above, `end` is then not
  /// called. Their time and rays are in stats() like those of the film's paths. Their frame is that of
  /// set_frame().
  bool run(uint32_t count, const PathEnds& ends, const std::function<bool()>& cancel = {});
  /// The paths' buffers, under the names of shaders/lib/wavefront.glsl, and the scene's.
  void bind_paths(gpu::Resources& resources) const;
  gpu::Stream& stream();
  /// Runs what others have recorded on the stream and takes its stages' times into stats(), as the eye's.
  void account_stages();
  /// shared::Hit a slot, of the rays traced last.
  const gpu::Buffer& hits() const;

  const TransportStats& stats() const;
  void reset_stats();
  /// What `trace` runs here is no part of the picture's cost: stats() stay as they are.
  void uncounted(const std::function<void()>& trace);
  double compile_seconds() const;
  /// Classes of hits with separate kernels; none before these are ready.
  HitClasses hit_classes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::transport
