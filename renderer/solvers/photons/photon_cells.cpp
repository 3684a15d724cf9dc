#include "solvers/photons/photon_cells.h"

#include <algorithm>
#include <bit>

namespace lucerna::photons {

using namespace shared;

namespace {

constexpr uint32_t k_least_entries = 1024, k_most_entries = 1u << 22;  // of the table
constexpr uint32_t k_entries_a_photon = 4;

}  // namespace

PhotonCells::PhotonCells(gpu::Device& device, gpu::ShaderCompiler& compiler)
    : device_(device),
      keys_(device, compiler, "photons/keys.comp"),
      arrange_(device, compiler, "photons/arrange.comp"),
      radix_sort_(device, compiler, sort::Keys::bits64) {
  gpu::make_texel_room(device, map_, "photons", sizeof(Photon));
  gpu::make_texel_room(device, table_, "table of photons", 8 * k_least_entries);
}

bool PhotonCells::make_room(uint32_t count, PhotonFrame& lookup) {
  entries_in_table_ = std::clamp(std::bit_ceil(std::max(1u, k_entries_a_photon * std::min(count, 1u << 28))),
                                 k_least_entries, k_most_entries);
  lookup.count = count;
  lookup.mask = entries_in_table_ - 1;
  bool moved = false;
  const auto room = [&](gpu::Buffer& buffer, const char* name, uint64_t bytes) {
    if (buffer && buffer.bytes() >= bytes) return;
    gpu::make_texel_room(device_, buffer, name, (bytes + 15) / 16 * 16);
    moved = true;
  };
  room(table_, "table of photons", uint64_t{8} * entries_in_table_);
  room(map_, "photons", uint64_t{count} * sizeof(Photon));
  room(entries_, "keys of photons", uint64_t{16} * count);
  room(scratch_, "keys of photons", uint64_t{16} * count);
  return moved;
}

void PhotonCells::encode(gpu::Stream& stream, const gpu::Buffer& list, const gpu::Buffer& ids,
                         const gpu::Buffer& lookup, uint32_t count) {
  stream.fill(table_, 0);
  if (count == 0) return;
  gpu::Resources r;
  r.set("photon_list_texels", list);
  r.set("PhotonIds", ids);
  r.set("PhotonBlock", lookup);
  r.set("PhotonKeys", entries_);
  r.set("PhotonMap", map_);
  r.set("PhotonTable", table_);
  const PhotonListPush push{count};
  const uint32_t groups = gpu::groups_for(count, 64);
  stream.dispatch(keys_, r, push, groups, "photon map");
  const gpu::Buffer& sorted =
      radix_sort_.encode(stream, entries_, scratch_, {.most = count},
                         32 + uint32_t(std::bit_width(entries_in_table_ - 1)), "photon map");
  sorted_ = &sorted;
  r.set("photon_sorted", sorted);
  stream.dispatch(arrange_, r, push, groups, "photon map");
}

uint64_t PhotonCells::bytes() const {
  uint64_t sum = 0;
  for (const gpu::Buffer* b : {&entries_, &scratch_, &map_, &table_}) sum += *b ? b->bytes() : 0;
  return sum;
}

}  // namespace lucerna::photons
