#pragma once
// Developer tools that measure single parts of the renderer. Each prints its figures and returns the exit
// status; errors are thrown.
#include <cstdint>
#include <string>
#include <vector>

#include "scene/io/load.h"

namespace lucerna::tools {

struct SortArguments {
  std::string device;
  std::vector<uint32_t> sizes{1 << 10, 1 << 14, 1 << 17, 1 << 20, 1 << 22};
  int repeats = 7;
  uint32_t seed = 1;
  std::string json;  ///< file to write the figures to; empty: none
};
int measure_sort(const SortArguments& arguments);

struct LookupArguments {
  std::string device;
  std::vector<uint32_t> sizes{10000, 100000, 1000000};
  uint32_t queries = 1 << 18, seed = 1;
  int repeats = 5;
  std::string json;  ///< file to write the figures to; empty: none
};
int measure_lookup(const LookupArguments& arguments);

struct InterpolationArguments {
  std::string device, scene;
  uint32_t width = 256, height = 256, samples = 1;
  std::string reference;  ///< converged EXR of the same picture; empty: no errors
  std::vector<std::string> set;
  int repeats = 7;
  std::string json;  ///< file to write the figures to; empty: none
  scene::LoadOptions scenes;
};
int measure_interpolation(const InterpolationArguments& arguments);

struct MixArguments {
  std::string device, scene;
  uint32_t width = 960, height = 540, samples = 16;
  std::vector<std::string> set;
  std::string keep = "compact";  ///< relight.enabled: compact or on
  int repeats = 5;
  std::string json;  ///< file to write the figures to; empty: none
  scene::LoadOptions scenes;
};
int measure_mix(const MixArguments& arguments);

}  // namespace lucerna::tools
