#pragma once
// What both benches print.
#include <string>

#include "raybench/measure.h"

namespace lucerna::raybench {

struct Report {
  std::string scene, device;
  uint32_t triangles = 0, tree_nodes = 0, tree_depth = 0;
  std::vector<std::string> tracers, sets;
  std::vector<uint64_t> set_sizes;
  std::vector<std::vector<Rate>> rates;  ///< [tracer][set]
  int repeats = 0;
  struct Frame {
    std::string tracer;
    FrameTime time;
  };
  FrameOptions frame_options;
  std::vector<Frame> frames;
};

/// A text table; ratios are relative to the tracer named `yardstick`, if present.
std::string to_text(const Report& report, const std::string& yardstick);
std::string to_json(const Report& report);

}  // namespace lucerna::raybench
