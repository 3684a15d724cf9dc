#pragma once
// Shades the hits of a wavefront by class (transport/hit_classes.h), as soon as the number of hits is so
// large that compiling the kernels takes less time than they save. Before that, and for few paths, one kernel
// shades all. The pictures are identical; the choice depends only on counts.
#include <future>

#include "gpu/stream.h"
#include "shaders/shared/transport.h"
#include "transport/hit_classes.h"

namespace lucerna::transport {

/// When hits are shaded by class. Counts of hits.
struct HitClassRules {
  bool enabled = true;
  uint64_t count_after =
      1'000'000;  ///< number of hits after which they are counted by kind, and kernels are compiled
  uint64_t switch_after = 2'500'000;  ///< number of hits after which these kernels are waited for and used
  uint32_t least_hits = 16384;        ///< of paths in flight; fewer are shaded by the kernel for all
  uint32_t least_of_class = 1024;     ///< fewer of a class at a time likewise
  /// From the second run on, where there are more than a few.
  static HitClassRules at_once() { return {true, 0, 0, 256, 64}; }
  static HitClassRules never() { return {false, 0, 0, 0, 0}; }
};

class HitShading {
 public:
  using Features = std::array<uint32_t, shared::k_hit_kinds>;
  /// `slots`: of the wavefront; `defines`: of the kernel for all hits; `features`: by kind.
  HitShading(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, gpu::Defines defines,
             const Features& features, const HitClassRules& rules);

  /// Other kinds begin from scratch.
  void set_features(const Features& features);
  /// Sets the resources of the kernel for all hits; by parity of the queue.
  void bind(size_t parity, const gpu::Resources& resources);

  /// Before the first hits of a run are shaded: makes the kernels ready once it is time.
  void begin_run(gpu::Stream& stream);
  /// True if that many hits at once are shaded by class.
  bool shades(uint32_t hits) const { return ready_ && hits >= rules_.least_hits; }
  /// Records what counts hits by kind, if it is time. `counters`: cleared at the beginning of the run.
  void count(gpu::Stream& stream, size_t parity, uint32_t hits, bool use_queue);
  /// After a run that shaded `hits`, of which `counters` are.
  void end_run(uint64_t hits, const uint32_t* counters);

  /// Records the sorting of hits into their classes' parts of the queue; `counters` contain the sizes
  /// afterwards.
  void sort(gpu::Stream& stream, size_t parity, uint32_t hits, bool use_queue, const gpu::Buffer& counters);
  /// Records what shades them. `all`: the kernel for all hits.
  void shade(gpu::Stream& stream, size_t parity, const gpu::Kernel& all, const uint32_t* counters);

  const HitClasses& classes() const { return classes_; }
  bool ready() const { return ready_; }

 private:
  void choose();

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  uint32_t slots_;
  gpu::Defines defines_;
  Features features_;
  HitClassRules rules_;
  uint64_t shaded_ = 0;
  std::array<uint64_t, shared::k_hit_kinds> hits_{};  ///< by kind
  bool counting_ = false, chosen_ = false, ready_ = false;
  HitClasses classes_;
  std::array<uint32_t, 4> packed_{};
  DarkKinds dark_;
  std::future<std::vector<gpu::Kernel>> compiling_;
  std::vector<gpu::Kernel> kernels_;  ///< by class
  gpu::Kernel counts_, sorts_;
  gpu::Buffer queue_;                            ///< slots_ entries a class
  std::array<gpu::Resources, 2> from_, within_;  ///< the run's queue, and this one
};

}  // namespace lucerna::transport
