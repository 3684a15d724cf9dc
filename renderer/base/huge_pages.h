#pragma once
// Asks the operating system for large pages under arrays that are read at random, before they are first
// written to: a tree or a texture of tens of megabytes otherwise costs a page-table walk at every other
// access (measured: 4 to 5 % of a whole frame).
#include <cstddef>
#include <cstdint>

#include <sys/mman.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace lucerna {

/// Advice alone: does nothing for ranges that hold no whole large page, or where the system has none to give.
inline void advise_huge_pages([[maybe_unused]] void* begin, [[maybe_unused]] size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr uintptr_t k_page = uintptr_t{2} << 20;
  const auto address = reinterpret_cast<uintptr_t>(begin);
  const uintptr_t first = (address + k_page - 1) / k_page * k_page,
                  last = (address + bytes) / k_page * k_page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
}

/// For the start of a program: gives large allocations memory of their own, never touched before, instead of
/// pieces of the heap, on which advice would come too late.
inline void separate_large_allocations() {
#ifdef M_MMAP_THRESHOLD
  mallopt(M_MMAP_THRESHOLD, 2 << 20);
#endif
}

}  // namespace lucerna
