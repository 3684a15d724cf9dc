#pragma once
// Recording and running work. A Stream is used by one thread. Work runs in order: each dispatch starts after
// the one before has finished and its writes are visible (a full compute barrier between dispatches).
#include <string>
#include <vector>

#include "gpu/kernel.h"

namespace lucerna::gpu {

/// Largest number of workgroups along an axis that every Vulkan device supports.
inline constexpr uint32_t k_most_groups = 65535;

/// Workgroups of `workgroup` invocations that cover `items`.
inline uint32_t groups_for(uint64_t items, uint32_t workgroup) {
  return static_cast<uint32_t>((items + workgroup - 1) / workgroup);
}

/// Device time of one stage between two submits, from timestamp queries.
struct StageTime {
  std::string stage;
  double milliseconds;
};

class Stream {
 public:
  explicit Stream(Device& device);
  ~Stream();
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  /// Runs `groups` workgroups of the kernel. Above k_most_groups they form a grid of x × y workgroups with x
  /// * y >= groups; so kernels take their index from global_index() (shaders/lib/invocation.glsl), never from
  /// gl_GlobalInvocationID.x, and return if it is beyond their count. 0 groups only warm the kernel up:
  /// software devices compile at the first dispatch. `push` must be as large as the kernel's push constants.
  /// `stage` names the timer of the dispatch ("": none). Throws Error, naming both, if a resource declared by
  /// the kernel is not in the table.
  void dispatch(const Kernel& kernel, const Resources& resources, const void* push, size_t push_bytes,
                uint32_t groups, const std::string& stage = {});
  /// Likewise, with workgroup counts read from three uint32 at `offset` of `arguments` when it runs, each at
  /// most k_most_groups (see indirect_groups() in shaders/lib/invocation.glsl).
  void dispatch_indirect(const Kernel& kernel, const Resources& resources, const void* push,
                         size_t push_bytes, const Buffer& arguments, uint64_t offset,
                         const std::string& stage = {});
  template <class Push>
  void dispatch(const Kernel& k, const Resources& r, const Push& push, uint32_t groups,
                const std::string& stage = {}) {
    dispatch(k, r, &push, sizeof(Push), groups, stage);
  }
  template <class Push>
  void dispatch_indirect(const Kernel& k, const Resources& r, const Push& push, const Buffer& args,
                         uint64_t offset, const std::string& stage = {}) {
    dispatch_indirect(k, r, &push, sizeof(Push), args, offset, stage);
  }
  void fill(const Buffer& buffer, uint32_t value, uint64_t offset = 0, uint64_t bytes = ~0ull);
  void copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t from_offset = 0,
            uint64_t to_offset = 0);

  /// Submits the recorded work and waits for it; host-visible memory is then coherent for the host. Does
  /// nothing if nothing was recorded.
  void run();
  /// Drops recorded work that has not run, for work that could not be recorded completely, whose buffers may
  /// be freed before the next run.
  void discard();
  /// Device milliseconds per stage since the last call, summed over dispatches of the same stage, in order of
  /// first use.
  std::vector<StageTime> take_times();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::gpu
