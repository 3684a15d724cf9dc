#pragma once
// What the cache has seen of the picture that it is built for.
#include <vector>

#include "solvers/irradiance_cache/discontinuity.h"
#include "solvers/irradiance_cache/picture_error.h"
#include "solvers/irradiance_cache/picture_reads.h"

namespace lucerna::irradiance_cache {

/// `screen` and `reads` are of one picture, and forgotten together when it is another.
struct PictureSeen {
  Discontinuity screen;  ///< where it changes
  PictureReads reads;    ///< where it reads records
  std::vector<float>
      importance;      ///< how much of it reads each of the records that were evaluated when it was asked
  PictureError error;  ///< what the records' errors make of it

  PictureSeen(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t most_records,
              const gpu::Defines& defines)
      : screen(device, compiler, defines),
        reads(device, compiler, most_records, defines),
        error(device, compiler, defines) {}
  void forget() { screen.forget(), reads.forget(); }
  uint64_t bytes() const { return screen.bytes() + reads.bytes(); }
};

}  // namespace lucerna::irradiance_cache
