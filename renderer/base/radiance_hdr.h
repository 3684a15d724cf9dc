#pragma once
// Headers of Radiance pictures (.hdr, .pic), which image readers mostly ignore. Source: G. Ward, the Radiance
// file formats (radsite.lbl.gov/radiance/refer/filefmts.pdf).
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/primaries.h"

namespace lucerna {

/// The header of a Radiance picture.
struct RadianceHeader {
  size_t end = 0;                  ///< start of the scan lines
  uint32_t lines = 0, length = 0;  ///< scan lines in the file, and pixels of each
  bool columns = false;            ///< a scan line is a column of the picture, not a row
  bool rows_up = false;            ///< rows go from the bottom to the top (+Y)
  bool columns_left = false;       ///< columns go from the right to the left (-X)
  bool xyz = false;                ///< pixels are CIE XYZ, not RGB
  /// PRIMARIES, unless they are Rec.709's or Radiance's defaults (nearly Rec.709, and written by programs
  /// that do not set them).
  std::optional<Chromaticities> primaries;
  std::array<float, 3> scale{1, 1, 1};  ///< factor to radiance: 1 / (EXPOSURE * COLORCORR)

  uint32_t width() const { return columns ? lines : length; }
  uint32_t height() const { return columns ? length : lines; }
};

/// Nothing if the file is no Radiance picture or its header is damaged.
std::optional<RadianceHeader> read_radiance_header(const std::vector<uint8_t>& file);

/// Likewise, with a minimal header: rows from the top, RGB.
std::vector<uint8_t> without_radiance_header(const std::vector<uint8_t>& file, const RadianceHeader& header);

/// Applies the header to the file's pixels (`channels` values each, read without the header): rows from the
/// top, left to right, linear RGB radiance in the first three channels.
std::vector<float> upright_radiance(const std::vector<float>& pixels, size_t channels,
                                    const RadianceHeader& header);

}  // namespace lucerna
