#pragma once
// Image files to texels, through OpenImageIO.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scene/io/document.h"
#include "scene/scene.h"

namespace lucerna::scene {

/// Conversion of formats with more than 8 bits per channel. `keep`: 16-bit and float files become floats,
/// values as stored. `eight_bit`: 16-bit files are rounded to 8 bits; float files stay floats.
/// `linear_floats`: all become floats; 8- and 16-bit files count as sRGB and are linearized.
enum class Precision { keep, eight_bit, linear_floats };

/// Decodes the first image of a file in memory. The format is detected by its first bytes, else by `hint` (a
/// file name or MIME type). Grey becomes RGBA, missing alpha is 1, alpha stays unassociated in files that
/// store it so. An EXR's (or cropped TIFF's) data window is placed in its display window, black and
/// transparent outside. A Radiance picture may have any orientation; EXPOSURE and COLORCORR are divided out.
/// Other primaries (an EXR's chromaticities unless `precision` is `keep`; a Radiance picture's PRIMARIES or
/// XYZ) are converted to Rec.709. Throws an Error at `where` if the format is unknown or cannot be read from
/// memory, if decoding fails, or if the image has no texels or more than 2^28; OverBudget as Budget::take.
Image decode_image(const std::vector<uint8_t>& bytes, const std::string& hint, const std::string& where,
                   Precision precision, Budget& budget);

/// "image/png" or "image/jpeg" by a file's first bytes; "" for others, which glTF does not have.
std::string mime_type(std::string_view bytes);

/// Throws an Error at `where` unless a latitude-longitude image is about twice as wide as high (within 2 %),
/// or a single texel. Cube maps and mirror balls are neither.
void check_environment_shape(const Image& image, const std::string& where);

/// Makes float texels finite and non-negative: NaN and negative values become 0, +infinity 65504 (the largest
/// half float). Returns the number of changed values. No effect on byte texels.
size_t mend_texels(Image& image);

}  // namespace lucerna::scene
