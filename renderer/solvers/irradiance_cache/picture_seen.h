#pragma once
// Measurements of the cache in the picture for which it is built.
#include <vector>

#include "solvers/irradiance_cache/discontinuity.h"
#include "solvers/irradiance_cache/picture_error.h"
#include "solvers/irradiance_cache/picture_reads.h"

namespace lucerna::irradiance_cache {

/// `screen` and `reads` belong to one picture and are reset together.
struct PictureSeen {
  Discontinuity screen;           ///< where it changes
  PictureReads reads;             ///< where it reads records
  std::vector<float> importance;  ///< of the records that were evaluated at that time (picture_reads.h)
  PictureError error;             ///< errors from the records

  PictureSeen(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t most_records,
              const gpu::Defines& defines)
      : screen(device, compiler, defines),
        reads(device, compiler, most_records, defines),
        error(device, compiler, defines) {}
  void forget() { screen.forget(), reads.forget(); }
  uint64_t bytes() const { return screen.bytes() + reads.bytes(); }
};

}  // namespace lucerna::irradiance_cache
