#pragma once
// A reference picture, taken as the truth, layer by layer.
#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/math.h"
#include "film/io/image_file.h"

namespace lucerna::film {

inline constexpr int k_reference_layers = 5;  ///< the sum, then primary, secondary, tertiary, caustic
using LayerFigures = std::array<double, k_reference_layers>;

/// A layer beside these: of a path expression, by its name.
struct ReferenceLayer {
  std::vector<float> luminance;  ///< as in Reference; may be not finite, and is then no truth
  std::optional<double> noise;
};

struct Reference {
  std::filesystem::path file;
  uint32_t width = 0, height = 0;
  std::array<std::vector<float>, k_reference_layers> luminance;  ///< Rec.709, a value a pixel, top row first
  double mean_luminance = 0;                                     ///< mean luminance of the sum
  /// Root mean square of its own standard error over the pixels, in luminance (metadata "noise"); nullopt:
  /// missing, and measured errors include the reference's noise.
  std::optional<LayerFigures> noise;
  /// Its layers of three channels that no picture has of itself.
  std::map<std::string, ReferenceLayer> own_layers;
  std::string scene, view, seed;  ///< from its metadata; empty: missing
};

/// Reads an EXR as `lucerna render` writes it, for a picture of that size. Throws Error located at `file`:
/// unreadable, of another size, a layer missing (R G B and each component's), values that are not finite, or
/// black all over.
Reference read_reference(const std::filesystem::path& file, uint32_t width, uint32_t height);

/// The metadata "noise" of a picture whose layers have these errors; `own`: of its layers by path
/// expressions, by name.
std::string noise_text(const LayerFigures& rms, std::span<const std::pair<std::string, double>> own = {});

/// Root mean square over the pixels with samples of the difference in luminance, the reference's noise
/// variance taken off, over the reference's mean luminance. 0: the difference is no larger than the
/// reference's own noise. Components are means over a pixel's samples; sizes as the reference's.
LayerFigures true_errors(const Reference& reference, std::span<const std::vector<vec3>> components,
                         std::span<const uint32_t> samples);
/// Likewise of a layer by path expression; nullopt if the reference has none of that name.
std::optional<double> true_error(const Reference& reference, const std::string& layer,
                                 std::span<const vec3> radiance, std::span<const uint32_t> samples);

}  // namespace lucerna::film
