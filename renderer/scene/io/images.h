#pragma once
// Image files to texels, through OpenImageIO.
#include <filesystem>
#include <string>
#include <vector>

#include "scene/io/document.h"
#include "scene/scene.h"

namespace lucerna::scene {

/// What becomes of formats with more than 8 bits a channel. `keep`: 16-bit and float files become floats,
/// values as stored. `eight_bit`: 16-bit files are rounded to 8 bits; float files stay floats.
/// `linear_floats`: everything becomes floats, and 8- and 16-bit files are taken for sRGB and linearized.
enum class Precision { keep, eight_bit, linear_floats };

/// Decodes the first image of a file held in memory, and opens no file. The format is told by its first
/// bytes, else by `hint` (a file name or a MIME type). Grey and grey with alpha are spread to RGBA, missing
/// alpha is 1, alpha stays unassociated in files that store it so. An EXR's (or cropped TIFF's) data window
/// is placed in its display window, black and without alpha outside. A Radiance picture has any orientation,
/// its EXPOSURE and COLORCORR are divided out. Colours of other primaries (an EXR's chromaticities where
/// `precision` is not `keep`; a Radiance picture's PRIMARIES, or XYZ) become Rec.709's. Throws an Error at
/// `where` if its format is not known or cannot be read from memory, if it cannot be decoded, has no texels,
/// or has more than 2^28; OverBudget as Budget::take.
Image decode_image(const std::vector<uint8_t>& bytes, const std::string& hint, const std::string& where,
                   Precision precision, Budget& budget);

/// Throws an Error at `where` unless an image that is to be read by latitude and longitude is about twice as
/// wide as high (within 2 %), or a single texel: cube maps and mirror balls are neither.
void check_environment_shape(const Image& image, const std::string& where);

/// Makes float texels finite and not negative: NaN and negative values become 0, +infinity 65504 (the largest
/// half float). Gives back how many values were changed. Does nothing to byte texels.
size_t mend_texels(Image& image);

}  // namespace lucerna::scene
