#pragma once
// Compares two noisy pictures of the same thing: are their differences larger than their noise explains?
//
// Tiles of both pictures are compared channel by channel, and so is the picture as a whole, each by Welch's
// t-test of the means. The noise comes from the two halves of the samples (layers "odd" and "samples"): v of
// a pixel has one degree of freedom, that of a tile has as many as Satterthwaite's formula gives, so a tile
// with a few bright specks has few, and needs a large difference. Pixels that share data (photons, cache
// records) have correlated noise: the variance of a tile is then raised to what the difference of its halves'
// means implies, averaged over the tiles around; noise and bias of lookups are added (layer "lookup"). The
// p-values are corrected for the number of tests by Sidak's formula, so equal pictures fail with a
// probability of about `significance`.
#include <array>
#include <string>
#include <vector>

#include "film/io/image_file.h"

namespace lucerna::film {

struct StochasticOptions {
  std::string layer;            ///< as in FilmImage::layer(); "": the sum
  double significance = 0.001;  ///< probability that equal pictures differ, 0..1 exclusive
  double tolerance = 0.002;     ///< relative difference of means that counts as none
  uint32_t tile = 16;           ///< side of the tiles [pixels], > 0
};

struct StochasticComparison {
  uint32_t width = 0, height = 0, tile = 16, across = 0;  ///< pixels; tiles in a row
  size_t tests = 0;
  double p = 1;  ///< smallest p-value, corrected for the number of tests; below `significance`: different
  bool different = false;
  /// Corrected p-value of each tile, the smallest of its channels, in raster order.
  std::vector<float> tile_p;
  size_t different_tiles = 0;
  /// The test with the smallest p-value.
  struct {
    std::array<uint32_t, 4> area{};  ///< left, top, width, height [pixels]
    std::string channel;
    double now = 0, reference = 0, noise = 0;  ///< means, and the standard error of their difference
  } worst;
};

/// Layers for compare_stochastic() from a picture with all layers: the mean of all samples and of the odd
/// ones of one layer, "samples", and "lookup.noise" and "lookup.bias" if there are any. Throws Error if the
/// picture has no such layer or no "odd" one.
FilmImage stochastic_layers(const FilmImage& image, const std::string& layer);

/// Throws Error, located at `where` (the reference's file): the sizes differ, a layer is missing, a pixel has
/// fewer than two samples, or values are not finite.
StochasticComparison compare_stochastic(const FilmImage& now, const FilmImage& reference,
                                        const StochasticOptions& options, const std::string& where);

/// One line: "no difference beyond noise (p = 0.31, 240 tests)", or where, what, and how improbable.
std::string to_text(const StochasticComparison& comparison);

/// The tiles as sRGB bytes (RGBA) for write_png: black where p is 1, grey to white as it falls to the
/// significance, red below.
std::vector<uint8_t> tile_picture(const StochasticComparison& comparison, double significance);

/// P(|T| >= t) for Student's T with `degrees` > 0 degrees of freedom, which need not be whole.
double student_two_sided(double t, double degrees);

}  // namespace lucerna::film
