#pragma once
// What a pixel of the picture shows, layer by layer, and what surface it is.
#include <optional>
#include <string>
#include <vector>

#include "film/io/image_file.h"
#include "scene/scene.h"

namespace lucerna::commands {

/// A layer at a pixel: the mean of its samples, and the standard errors of the luminance of that mean and of
/// the mean of the tile of 16x16 pixels around it; nullopt: not known.
struct PixelLayer {
  std::string name;
  std::vector<float> value;  ///< by channel
  std::optional<double> noise, tile_noise;
};

struct PixelReport {
  uint32_t x = 0, y = 0;  ///< the pixel, from the top left
  uint32_t samples = 0;
  std::vector<PixelLayer> layers;  ///< the sum, its components, then the other layers of the file
  /// Noise and bias of lookups in the mean luminance of the tile; nullopt: no lookups, or not known.
  std::optional<double> lookup_noise, lookup_bias;
};

/// Of a place, 0..1 to the right and down, in a picture with halves (Session::layers).
PixelReport report_pixel(const film::FilmImage& image, const vec2& at);

/// The surface that the centre of the pixel shows, one line per property: object, material, triangle, texture
/// coordinates, place, normal. "nothing but the environment" where there is none.
std::vector<std::string> surface_lines(const scene::Scene& scene, const scene::Camera& camera, const vec2& at,
                                       float aspect);

/// The report as lines: "caustic  0.12 0.10 0.08  +- 0.031 (0.0042 in its tile)".
std::vector<std::string> to_lines(const PixelReport& report);

}  // namespace lucerna::commands
