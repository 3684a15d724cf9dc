#include "solvers/irradiance_cache/neighbours.h"

#include <bit>

#include "gpu/kernel.h"
#include "shaders/shared/irradiance_cache/neighbours.h"
#include "sort/prefix_sum.h"
#include "sort/radix_sort.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

constexpr const char* k_stage = "neighbours";
/// cos 30 degrees: up to twelve stand apart by that. By more, those that would close the ring are passed over
/// for farther ones, and records stay wider.
constexpr float k_apart = 0.866f;
/// Not quite 180 degrees: no half plane is without any. To ask for more leaves records wider than they need
/// be: with 120 degrees lookups gain only half as much.
constexpr float k_gap = 3.0f;

}  // namespace

struct Neighbours::Impl {
  gpu::Device& device;
  sort::PrefixSum prefix_sum;
  sort::RadixSort sorter;
  gpu::Kernel counting, writing, bounding;
  gpu::Buffer counts, before, total, pairs[2];
  gpu::Resources resources;
};

Neighbours::Neighbours(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& defines)
    : impl_(new Impl{device,
                     {device, compiler},
                     {device, compiler, sort::Keys::bits64},
                     {},
                     {},
                     {},
                     {},
                     {},
                     {},
                     {},
                     {}}) {
  gpu::Defines counting = defines, writing = defines;
  counting["LUCERNA_WRITE"] = "0", writing["LUCERNA_WRITE"] = "1";
  impl_->counting = gpu::Kernel(device, compiler, "irradiance_cache/pairs.comp", counting);
  impl_->writing = gpu::Kernel(device, compiler, "irradiance_cache/pairs.comp", writing);
  impl_->bounding = gpu::Kernel(device, compiler, "irradiance_cache/bound.comp");
  impl_->total = gpu::Buffer(
      device, {.name = "neighbours' sum", .bytes = 16, .memory = gpu::Memory::host, .texel = true});
}
Neighbours::~Neighbours() = default;

void Neighbours::bound(gpu::Stream& stream, const std::function<void(gpu::Resources&)>& bind,
                       uint32_t count) {
  Impl& i = *impl_;
  if (count == 0) return;
  gpu::make_texel_room(i.device, i.counts, "neighbours' counts", uint64_t{count} * 4);
  gpu::make_texel_room(i.device, i.before, "neighbours before", uint64_t{count} * 4);
  bind(i.resources);
  i.resources.set("PairCounts", i.counts);
  i.resources.set("PairsBefore", i.before);
  NeighbourPush push{count, 0, k_apart, k_gap};
  stream.dispatch(i.counting, i.resources, push, gpu::groups_for(count, 64), k_stage);
  i.prefix_sum.encode(stream, i.counts, i.before, {.most = count}, &i.total, 0, k_stage);
  stream.run();
  push.pairs = *static_cast<const uint32_t*>(i.total.mapped());
  if (push.pairs == 0) return;
  for (gpu::Buffer& buffer : i.pairs)
    gpu::make_texel_room(i.device, buffer, "neighbours", uint64_t{push.pairs} * sizeof(SortEntry64));
  i.resources.set("Pairs", i.pairs[0]);
  stream.dispatch(i.writing, i.resources, push, gpu::groups_for(count, 64), k_stage);
  const gpu::Buffer& sorted = i.sorter.encode(stream, i.pairs[0], i.pairs[1], {.most = push.pairs},
                                              k_neighbour_distance_bits + std::bit_width(count), k_stage);
  i.resources.set("pair_texels", sorted);
  stream.dispatch(i.bounding, i.resources, push, gpu::groups_for(count, 64), k_stage);
  stream.run();
}

uint64_t Neighbours::bytes() const {
  uint64_t sum = 0;
  for (const gpu::Buffer* b : {&impl_->counts, &impl_->before, &impl_->pairs[0], &impl_->pairs[1]})
    sum += *b ? b->bytes() : 0;
  return sum;
}

}  // namespace lucerna::irradiance_cache
