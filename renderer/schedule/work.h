#pragma once
// A work item: blocks of 8x8 pixels, each with the same number of further samples.
#include <cstdint>
#include <vector>

#include "shaders/shared/film.h"

namespace lucerna::schedule {

using shared::WorkBlock;

struct WorkItem {
  std::vector<WorkBlock> blocks;
  uint32_t sample_count = 0;
  uint32_t slots() const { return static_cast<uint32_t>(blocks.size()) * 64 * sample_count; }
};

}  // namespace lucerna::schedule
