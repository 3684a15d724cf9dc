#pragma once
// Length of an array for prefix sums and sorts.
#include <algorithm>
#include <cstdint>

#include "gpu/resources.h"

namespace lucerna::sort {

/// Number of elements of an array: known while recording, or only on the device, as the length of an append
/// queue is.
///
/// Kernels find their share of the work from the count itself, so that nothing has to be dispatched
/// indirectly: there are enough invocations for `most` elements (few, see Runs), and those without work
/// return immediately.
struct Count {
  uint32_t most = 0;                    ///< number of elements, or its maximum
  const gpu::Buffer* buffer = nullptr;  ///< holds the number; more than `most` counts as `most`
  uint64_t offset = 0;                  ///< bytes, a multiple of 4
};

/// Division of work into runs, one per invocation.
struct Runs {
  uint32_t group = 8;    ///< invocations a workgroup
  uint32_t wanted = 64;  ///< runs, where there are elements enough
  uint32_t least = 64;   ///< elements of a run, unless all are fewer
  uint32_t most = 1024;  ///< runs there may be, a multiple of `group` >= `wanted`: more than `wanted` where
                         ///< these would be longer than k_longest
  static constexpr uint32_t k_longest = 32768;  ///< elements of a run; see shaders/lib/runs.glsl
  /// Workgroups for that many elements or fewer: enough for all runs, as shaders/lib/runs.glsl cuts them.
  uint32_t groups(uint32_t elements) const {
    const uint64_t n = elements, few = (n + least - 1) / least, long_ones = (n + k_longest - 1) / k_longest;
    return uint32_t((std::max(std::min<uint64_t>(few, wanted), long_ones) + group - 1) / group);
  }
  /// Elements that they reach.
  uint64_t reach() const { return uint64_t(most) * k_longest; }
};

/// Invocations that keep a device busy when all have the same to do: a few vectors of lanes for every core of
/// a CPU.
uint32_t lanes_for(const gpu::Device& device);

}  // namespace lucerna::sort
