#pragma once
// Photons in the order of their cells, and the table that finds them (shaders/shared/photons/photons.h).
//
// The sort that puts them into their cells also puts those of one cell into the order of their numbers, so
// that nothing hangs on the order in which they are given.
#include "shaders/shared/photons/photons.h"
#include "sort/radix_sort.h"

namespace lucerna::photons {

class PhotonCells {
 public:
  /// Throws Error: a kernel does not compile (located).
  PhotonCells(gpu::Device& device, gpu::ShaderCompiler& compiler);

  /// Makes room for so many, and fills in `lookup`'s count and mask. Whether buffers are others than before.
  /// Throws Error when memory is short.
  bool make_room(uint32_t count, shared::PhotonFrame& lookup);
  /// Of the photons in `list`, with numbers `ids` of their own, as many as there was room made for; `lookup`:
  /// a PhotonFrame, as filled in.
  void encode(gpu::Stream& stream, const gpu::Buffer& list, const gpu::Buffer& ids, const gpu::Buffer& lookup,
              uint32_t count);
  const gpu::Buffer& photons() const { return map_; }  ///< shared::Photon each, cell by cell
  const gpu::Buffer& table() const { return table_; }  ///< two words an entry: first, behind the last
  /// shared::SortEntry64 each, of the photons put in order last.
  const gpu::Buffer& sorted() const { return *sorted_; }
  uint32_t entries() const { return entries_in_table_; }
  uint64_t bytes() const;

 private:
  gpu::Device& device_;
  gpu::Kernel keys_, arrange_;
  sort::RadixSort radix_sort_;
  gpu::Buffer entries_, scratch_, map_, table_;
  const gpu::Buffer* sorted_ = nullptr;
  uint32_t entries_in_table_ = 0;
};

}  // namespace lucerna::photons
