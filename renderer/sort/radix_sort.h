#pragma once
// Stable radix sort on the device.
#include "gpu/stream.h"
#include "shaders/shared/sort.h"
#include "sort/prefix_sum.h"

namespace lucerna::sort {

enum class Keys { bits32, bits64 };  ///< of shared::SortPair, of shared::SortEntry64

/// Sorts (key, value) by key; equal keys keep their order. Least significant digit first; the number of
/// passes depends on the significant bits of the key: at 1 M pairs on lavapipe one for every 11 bits.
///
/// A pass: every invocation counts the digits of its run of entries; the prefix sum of the counts, digit by
/// digit, is the destination of each run's entries; every invocation then moves its entries in order. No
/// barriers, no atomics.
class RadixSort {
 public:
  /// How work is cut. Results do not depend on it.
  struct Tuning {
    Runs runs;
    uint32_t digit_bits = 8;        ///< most bits of a digit, 1..12
    uint32_t small_digit_bits = 8;  ///< ... where there are fewer than `small` entries
    uint32_t small = 0;
  };
  static Tuning tuning_for(const gpu::Device& device);

  RadixSort(gpu::Device& device, gpu::ShaderCompiler& compiler, Keys keys);
  RadixSort(gpu::Device& device, gpu::ShaderCompiler& compiler, Keys keys, const Tuning& tuning);

  /// Records the sort of `count` entries by the `bits` low bits of their keys, 0 to 32 or 64; higher bits are
  /// carried along and ignored. Returns the one of the two buffers in which the sorted entries will be; the
  /// other holds nothing of use, and entries beyond the count are left alone in both. Both are texel buffers
  /// for at least count.most entries. Throws Error when they are not, or for too many bits.
  const gpu::Buffer& encode(gpu::Stream& stream, const gpu::Buffer& entries, const gpu::Buffer& scratch,
                            const Count& count, uint32_t bits, const std::string& stage = {});

 private:
  struct Kernels {
    gpu::Kernel count, scatter;
  };
  Kernels kernels(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t digit_bits) const;

  Keys keys_;
  Tuning tuning_;
  PrefixSum prefix_sum_;
  gpu::Buffer table_, table_count_, unused_;
  Kernels large_, small_;  ///< differ in the number of counters, which lavapipe clears in every workgroup
};

}  // namespace lucerna::sort
