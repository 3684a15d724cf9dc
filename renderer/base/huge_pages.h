#pragma once
// Requests large pages for memory that is read at random (trees, textures), before it is first written. This
// saves page-table walks.
#include <cstddef>
#include <cstdint>

#include <sys/mman.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace lucerna {

/// Advises the operating system. No effect on ranges without a whole large page, or if large pages are not
/// available.
inline void advise_huge_pages([[maybe_unused]] void* begin, [[maybe_unused]] size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr uintptr_t k_page = uintptr_t{2} << 20;
  const auto address = reinterpret_cast<uintptr_t>(begin);
  const uintptr_t first = (address + k_page - 1) / k_page * k_page,
                  last = (address + bytes) / k_page * k_page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
}

/// Call at the start of the program: large allocations get fresh memory instead of parts of the heap, for
/// which the advice would come too late.
inline void separate_large_allocations() {
#ifdef M_MMAP_THRESHOLD
  mallopt(M_MMAP_THRESHOLD, 2 << 20);
#endif
}

}  // namespace lucerna
