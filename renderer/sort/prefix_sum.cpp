#include "sort/prefix_sum.h"

#include <algorithm>
#include <thread>

#include "shaders/shared/sort.h"

namespace lucerna::sort {

uint32_t lanes_for(const gpu::Device& device) {
  if (!device.info().is_cpu) return 1u << 16;
  return 32 * std::clamp(std::thread::hardware_concurrency(), 2u, 64u);
}

PrefixSum::PrefixSum(gpu::Device& device, gpu::ShaderCompiler& compiler)
    : PrefixSum(device, compiler, runs_for(device)) {}

PrefixSum::PrefixSum(gpu::Device& device, gpu::ShaderCompiler& compiler, const Runs& runs)
    : runs_(runs),
      run_sums_(device, {.name = "sums of runs", .bytes = runs.most * sizeof(uint32_t)}),
      unused_(device, {.name = "unused total", .bytes = sizeof(uint32_t)}) {
  const gpu::Defines defines{{"LUCERNA_SCAN_GROUP", std::to_string(runs.group)},
                             {"LUCERNA_SCAN_WANTED", std::to_string(runs.wanted) + "u"},
                             {"LUCERNA_SCAN_LEAST", std::to_string(runs.least) + "u"}};
  sums_ = gpu::Kernel(device, compiler, "sort/scan_sums.comp", defines);
  spine_ = gpu::Kernel(device, compiler, "sort/scan_spine.comp", defines);
  write_ = gpu::Kernel(device, compiler, "sort/scan_write.comp", defines);
  gpu::Defines in_place = defines;
  in_place["LUCERNA_SCAN_IN_PLACE"] = "1";
  write_in_place_ = gpu::Kernel(device, compiler, "sort/scan_write.comp", in_place);
}

Runs PrefixSum::runs_for(const gpu::Device& device) {
  return device.info().is_cpu ? Runs{.group = 8, .wanted = lanes_for(device), .least = 64, .most = 4096}
                              : Runs{.group = 64, .wanted = 16384, .least = 16, .most = 16384};
}

void PrefixSum::encode(gpu::Stream& stream, const gpu::Buffer& in, const gpu::Buffer& out, const Count& count,
                       const gpu::Buffer* total, uint64_t total_offset, const std::string& stage) {
  for (const gpu::Buffer* b : {&in, &out})
    if (b->bytes() / sizeof(uint32_t) < count.most)
      throw_error("buffer '" + b->name() + "'", "a prefix sum of {} elements does not fit into its {} bytes",
                  count.most, b->bytes());
  if (count.most > runs_.reach())
    throw_error("prefix sum", "{} elements; it reaches {}", count.most, runs_.reach());
  gpu::Resources resources;
  resources.set("scan_in", in);
  resources.set("ScanOut", out);
  resources.set("ScanSums", run_sums_);
  resources.set("ScanCount", count.buffer ? *count.buffer : unused_);
  resources.set("ScanTotal", total ? *total : unused_);
  const shared::ScanPush push{count.most,
                              count.buffer ? uint32_t(count.offset / 4) : shared::k_sort_count_here,
                              total ? uint32_t(total_offset / 4) : 0};
  const uint32_t groups = runs_.groups(count.most);
  stream.dispatch(sums_, resources, push, groups, stage);
  stream.dispatch(spine_, resources, push, 1, stage);
  stream.dispatch(&in == &out ? write_in_place_ : write_, resources, push, groups, stage);
}

}  // namespace lucerna::sort
