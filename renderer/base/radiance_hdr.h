#pragma once
// Radiance pictures (.hdr, .pic): what their header says of the pixels, which readers of images pass over.
// Source: G. Ward, the Radiance file formats (radsite.lbl.gov/radiance/refer/filefmts.pdf).
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/primaries.h"

namespace lucerna {

/// The header of a Radiance picture.
struct RadianceHeader {
  size_t end = 0;                  ///< where the scan lines begin
  uint32_t lines = 0, length = 0;  ///< scan lines in the file, and pixels of each
  bool columns = false;            ///< a scan line is a column of the picture, not a row
  bool rows_up = false;            ///< rows go from the bottom to the top (+Y)
  bool columns_left = false;       ///< columns go from the right to the left (-X)
  bool xyz = false;                ///< pixels are CIE XYZ, not RGB
  /// PRIMARIES, where they are neither Radiance's own (which differ little from Rec.709's, and stand in files
  /// whose writer did not think of them) nor Rec.709's.
  std::optional<Chromaticities> primaries;
  std::array<float, 3> scale{1, 1, 1};  ///< makes pixels radiance: 1 / (EXPOSURE * COLORCORR), of all lines

  uint32_t width() const { return columns ? lines : length; }
  uint32_t height() const { return columns ? length : lines; }
};

/// Nothing where this is no such file, or its header is damaged.
std::optional<RadianceHeader> read_radiance_header(const std::vector<uint8_t>& file);

/// The same scan lines below a header that says nothing but their number: rows from the top, RGB.
std::vector<uint8_t> without_radiance_header(const std::vector<uint8_t>& file, const RadianceHeader& header);

/// Pixels of the file without its header (`channels` values each), as the header has them: rows from the top,
/// from left to right, linear RGB radiance in the first three channels.
std::vector<float> upright_radiance(const std::vector<float>& pixels, size_t channels,
                                    const RadianceHeader& header);

}  // namespace lucerna
