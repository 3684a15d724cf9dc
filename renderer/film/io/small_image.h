#pragma once
// Images of files, made small.
#include <cstdint>
#include <string>
#include <vector>

#include "base/math.h"

namespace lucerna::film {

struct SmallImage {
  uint32_t width = 0, height = 0;
  std::vector<vec3> colours;  ///< row by row; finite, not negative
  bool encoded = false;       ///< 0..1 for a display, of an 8- or 16-bit file; else linear
};

/// Reads an image file of any format of OpenImageIO and makes it at most `most` pixels wide and high, by
/// means over boxes. Throws Error located at the file: it cannot be read.
SmallImage read_small_image(const std::string& file, uint32_t most);

}  // namespace lucerna::film
