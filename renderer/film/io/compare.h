#pragma once
// Difference of an image from a reference: the figures of `lucerna compare`, also for stochastic images.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "film/io/flip.h"
#include "film/io/image_file.h"

namespace lucerna::film {

struct CompareOptions {
  double epsilon = 0.01;         ///< regularization of relative measures, in squared units of the layer; > 0
  double trimmed_share = 0.001;  ///< share of the worst pixels that the trimmed measures drop; 0..1
  /// True if the values are display colours in the sRGB encoding, as in PNG files; false: linear light.
  bool encoded = false;
  uint32_t block = 16;  ///< side of the blocks, pixels; > 0 (blocks at the right and bottom may be smaller)
};

/// Pixels of one layer with a value that is NaN or infinite, in a and in b. Z is infinite where nothing was
/// hit: there NaNs count, and infinities in one image alone where Z is the layer that is compared.
struct NonFinitePixels {
  std::string layer;
  std::array<uint64_t, 2> count{0, 0};
};

/// With a the image, b the reference, C the layer's channels (all weigh the same) and mean_C the average over
/// them: every mean is over the pixels whose channels are finite in both images, in double precision.
struct Comparison {
  std::string layer;
  uint32_t width = 0, height = 0;
  std::vector<std::string> channels;         ///< names in b, in the order of the vectors below
  uint64_t pixels = 0;                       ///< number of pixels finite in both images: basis of the figures
  std::array<uint64_t, 2> non_finite{0, 0};  ///< values (not pixels) that are NaN or infinite, in a and in b
  std::array<uint64_t, 2> nan{0, 0};         ///< NaNs among those
  /// Layers of either image, the one compared or not, that are not finite somewhere. No figure below holds
  /// for such pictures.
  std::vector<NonFinitePixels> non_finite_layers;
  std::vector<double> mean_a, mean_b;  ///< per channel
  std::vector<double>
      mean_ratio;     ///< mean_a / mean_b per channel; 1 when both are 0, infinite when only b is
  double rmse = 0;    ///< sqrt(mean over pixels of mean_C (a - b)^2)
  double relmse = 0;  ///< mean over pixels of mean_C (a - b)^2 / (b^2 + epsilon)
  struct {
    double rmse = 0, relmse = 0;
  } trimmed;  ///< likewise, without the ceil(trimmed_share * pixels) worst pixels of each
  struct {
    double absolute = 0;  ///< of mean_C |a - b|
    double relative = 0;  ///< of mean_C |a - b| / sqrt(b^2 + epsilon)
  } p99;                  ///< 99th percentiles over pixels
  struct {
    double absolute = 0;               ///< mean_C |a - b|
    std::array<uint32_t, 2> at{0, 0};  ///< its pixel, from the top left
  } largest;
  /// Mean over all pixels of flip_hdr(), of flip() where values are encoded; without a value unless all
  /// values are finite and the layer has three channels.
  std::optional<double> flip;
  struct {
    uint64_t count = 0;                   ///< with light in b (sum over pixels and C above 0)
    double p05 = 1, median = 1, p95 = 1;  ///< of sum a / sum b over those
  } blocks;
};

/// Compares one layer (FilmImage::layer; "" is the sum R, G, B). Throws Error, located at the layer or
/// "compare", if the sizes differ, a layer is missing or has a different number of channels, or an option is
/// out of range. Non-finite values do not throw: they are counted, and their pixels are left out. Percentiles
/// are nearest-rank: the ceil(q n)-th smallest value.
Comparison compare(const FilmImage& a, const FilmImage& b, const std::string& layer = "",
                   const CompareOptions& options = {});

/// One JSON object, one line; numbers that are not finite are null.
std::string to_json(const Comparison& comparison);
/// "" or which layers are not finite, one line: "rgb: 12 pixels of the first image, 0 of the second; ...".
std::string non_finite_text(const Comparison& comparison);
/// A few lines of text, ending in a line break.
std::string to_text(const Comparison& comparison);

/// |a - b| * factor of a layer as sRGB bytes (RGBA, alpha 255) for write_png; a single channel is shown grey;
/// values that are not finite are magenta. Throws as compare() does.
std::vector<uint8_t> difference_picture(const FilmImage& a, const FilmImage& b, const std::string& layer,
                                        float factor);

}  // namespace lucerna::film
