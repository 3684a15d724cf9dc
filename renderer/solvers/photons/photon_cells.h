#pragma once
// Photons sorted by cell, and the table that finds them (shaders/shared/photons/photons.h).
//
// The sort also orders the photons of one cell by number, so the result does not depend on the input order.
#include "shaders/shared/photons/photons.h"
#include "sort/radix_sort.h"

namespace lucerna::photons {

class PhotonCells {
 public:
  /// Throws Error: a kernel does not compile (located).
  PhotonCells(gpu::Device& device, gpu::ShaderCompiler& compiler);

  /// Allocates memory for that many, and sets `lookup`'s count and mask. True if buffers have been replaced.
  /// Throws Error: memory.
  bool make_room(uint32_t count, shared::PhotonFrame& lookup);
  /// Sorts the photons in `list` with numbers `ids`, as many as prepare() allocated; `lookup`: buffer of that
  /// PhotonFrame.
  void encode(gpu::Stream& stream, const gpu::Buffer& list, const gpu::Buffer& ids, const gpu::Buffer& lookup,
              uint32_t count);
  const gpu::Buffer& photons() const { return map_; }  ///< shared::Photon, cell by cell
  const gpu::Buffer& table() const { return table_; }  ///< two words per entry: first, one past the last
  /// shared::SortEntry64 of the most recently sorted photons.
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
