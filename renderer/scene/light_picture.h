#pragma once
// Pictures that spots project.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/math.h"

namespace lucerna::scene {

struct Light;

/// A picture in front of a spot, upright as seen from the lamp. Points of it are the middles of its texels,
/// the outer ones on its border; between them it is bilinear.
struct LightPicture {
  std::string name;                 ///< of its file, without folders
  std::vector<uint8_t> file;        ///< its bytes, as they are saved
  uint32_t width = 0, height = 0;   ///< 2 to k_most_picture
  std::vector<vec3> texels;         ///< linear, by rows from the top; finite, not negative
  std::vector<vec4> alias;          ///< table for choosing a cell between four points by its mean luminance
  std::vector<float> cell_density;  ///< by cell: its probability times the number of cells
  /// Mean luminance of blocks, k_blocks * k_blocks, likewise.
  std::vector<float> blocks;
  static constexpr uint32_t k_blocks = 48;
  vec3 at(uint32_t x, uint32_t y) const { return texels[size_t{y} * width + x]; }
  /// Bilinear; u to the right and v down, 0 to 1.
  vec3 at(const vec2& uv) const;
};

inline constexpr uint32_t k_most_picture = 1024;
/// Largest outer cone of a spot with a picture [radians].
inline constexpr float k_widest_picture = 1.4f;

/// A picture of these texels, of any size: larger ones than k_most_picture are reduced by whole factors, a
/// side of one texel is doubled. Fills everything but the name and the file. Throws Error at `where`: it is
/// black or has a texel that is negative or not finite.
LightPicture make_picture(uint32_t width, uint32_t height, std::vector<vec3> texels,
                          const std::string& where);

/// Half the picture's width and height [m] on a plane 1 m in front of the spot: its corners are on the outer
/// cone.
vec2 picture_extent(const Light& spot);
/// Relative intensity of a spot with a picture along a direction, unit.
vec3 picture_along(const Light& spot, const vec3& direction);
/// The solid angle of its picture, weighted by its luminance [sr].
double picture_solid_angle(const Light& spot);

}  // namespace lucerna::scene
