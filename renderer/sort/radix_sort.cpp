#include "sort/radix_sort.h"

#include <algorithm>
#include <utility>

namespace lucerna::sort {

namespace {

struct Digit {
  uint32_t word, shift, width;
};

/// Digits of about equal width, least significant first; none reaches over the words of a key.
std::vector<Digit> digits(uint32_t bits, uint32_t widest) {
  std::vector<Digit> list;
  for (uint32_t word = 0; word * 32 < bits; ++word) {
    const uint32_t here = std::min(bits - word * 32, 32u), count = (here + widest - 1) / widest;
    for (uint32_t i = 0, shift = 0; i < count; ++i) {
      const uint32_t width = (here - shift + count - i - 1) / (count - i);
      list.push_back({word, shift, width});
      shift += width;
    }
  }
  return list;
}

}  // namespace

RadixSort::Tuning RadixSort::tuning_for(const gpu::Device& device) {
  // On lavapipe counters are cheap and passes dear, and a few runs a core keep it busy; a GPU needs many
  // invocations, and so few counters in each.
  if (device.info().is_cpu) {
    return {.runs = {.group = 8, .wanted = lanes_for(device), .least = 256, .most = 1024},
            .digit_bits = 11,
            .small_digit_bits = 8,
            .small = 1u << 17};
  }
  return {.runs = {.group = 64, .wanted = 65536, .least = 32, .most = 65536}, .digit_bits = 4};
}

RadixSort::RadixSort(gpu::Device& device, gpu::ShaderCompiler& compiler, Keys keys)
    : RadixSort(device, compiler, keys, tuning_for(device)) {}

RadixSort::RadixSort(gpu::Device& device, gpu::ShaderCompiler& compiler, Keys keys, const Tuning& tuning)
    : keys_(keys),
      tuning_(tuning),
      prefix_sum_(device, compiler),
      table_(device, {.name = "table of digits",
                      .bytes = uint64_t(tuning.runs.most) * sizeof(uint32_t) << tuning.digit_bits,
                      .texel = true}),
      table_count_(device, {.name = "length of the table of digits", .bytes = sizeof(uint32_t)}),
      unused_(device, {.name = "unused count", .bytes = sizeof(uint32_t)}) {
  large_ = kernels(device, compiler, tuning.digit_bits);
  if (tuning.small > 0) small_ = kernels(device, compiler, tuning.small_digit_bits);
}

RadixSort::Kernels RadixSort::kernels(gpu::Device& device, gpu::ShaderCompiler& compiler,
                                      uint32_t digit_bits) const {
  const Runs& runs = tuning_.runs;
  const gpu::Defines defines{{"LUCERNA_SORT_GROUP", std::to_string(runs.group) + "u"},
                             {"LUCERNA_SORT_WANTED", std::to_string(runs.wanted) + "u"},
                             {"LUCERNA_SORT_LEAST", std::to_string(runs.least) + "u"},
                             {"LUCERNA_SORT_BINS", std::to_string(1u << digit_bits) + "u"},
                             {"LUCERNA_SORT_WIDE", keys_ == Keys::bits64 ? "1" : "0"}};
  return {gpu::Kernel(device, compiler, "sort/count.comp", defines),
          gpu::Kernel(device, compiler, "sort/scatter.comp", defines)};
}

const gpu::Buffer& RadixSort::encode(gpu::Stream& stream, const gpu::Buffer& entries,
                                     const gpu::Buffer& scratch, const Count& count, uint32_t bits,
                                     const std::string& stage) {
  const uint64_t entry = keys_ == Keys::bits64 ? sizeof(shared::SortEntry64) : sizeof(shared::SortPair);
  for (const gpu::Buffer* b : {&entries, &scratch})
    if (b->bytes() / entry < count.most)
      throw_error("buffer '" + b->name() + "'", "a sort of {} entries does not fit into its {} bytes",
                  count.most, b->bytes());
  if (bits > (keys_ == Keys::bits64 ? 64 : 32))
    throw_error("sort", "keys have {} bits, but {} are requested", keys_ == Keys::bits64 ? 64 : 32, bits);
  if (count.most > tuning_.runs.reach())
    throw_error("sort", "{} entries; it reaches {}", count.most, tuning_.runs.reach());
  const gpu::Buffer *from = &entries, *to = &scratch;
  const uint32_t groups = tuning_.runs.groups(count.most);
  const bool small = count.most < tuning_.small;
  const Kernels& kernels = small ? small_ : large_;
  for (const Digit& digit : digits(bits, small ? tuning_.small_digit_bits : tuning_.digit_bits)) {
    gpu::Resources resources;
    resources.set("sort_in", *from);
    resources.set("SortOut", *to);
    resources.set("SortTable", table_);
    resources.set("SortTableCount", table_count_);
    resources.set("sort_places", table_);
    resources.set("SortCount", count.buffer ? *count.buffer : unused_);
    const shared::SortPush push{count.most,
                                count.buffer ? uint32_t(count.offset / 4) : shared::k_sort_count_here,
                                digit.shift, 1u << digit.width, digit.word};
    stream.dispatch(kernels.count, resources, push, groups, stage);
    prefix_sum_.encode(
        stream, table_, table_,
        {.most = groups * tuning_.runs.group << digit.width, .buffer = &table_count_, .offset = 0}, nullptr,
        0, stage);
    stream.dispatch(kernels.scatter, resources, push, groups, stage);
    std::swap(from, to);
  }
  return *from;
}

}  // namespace lucerna::sort
