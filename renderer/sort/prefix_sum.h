#pragma once
// Exclusive prefix sums on the device.
#include "gpu/stream.h"
#include "sort/count.h"

namespace lucerna::sort {

/// out[i] = in[0] + ... + in[i - 1], of unsigned 32-bit integers, modulo 2^32.
///
/// Three kernels: the sum of every run; the prefix sum of these by one workgroup; each run from there. No
/// atomics.
class PrefixSum {
 public:
  PrefixSum(gpu::Device& device, gpu::ShaderCompiler& compiler);
  PrefixSum(gpu::Device& device, gpu::ShaderCompiler& compiler, const Runs& runs);
  static Runs runs_for(const gpu::Device& device);

  /// Records the sum of `count` elements of `in` into `out`, which may be the same buffer. `in` is a texel
  /// buffer; both hold at least count.most elements, or Error is thrown. The sum of all elements is written
  /// to `total` at `total_offset` bytes (a multiple of 4), also when there are none; null: nowhere. Elements
  /// of `out` beyond the count are left alone.
  void encode(gpu::Stream& stream, const gpu::Buffer& in, const gpu::Buffer& out, const Count& count,
              const gpu::Buffer* total = nullptr, uint64_t total_offset = 0, const std::string& stage = {});

 private:
  Runs runs_;
  gpu::Kernel sums_, spine_, write_, write_in_place_;
  gpu::Buffer run_sums_, unused_;
};

}  // namespace lucerna::sort
