#pragma once
// Compares two pictures for the display, such as screenshots, by a tolerance that another driver's rounding
// and antialiasing do not exceed.
#include <string>
#include <vector>

#include "film/io/image_file.h"

namespace lucerna::film {

struct MatchOptions {
  double within = 0.04;  ///< difference of a cell's mean, 0..1 of the encoded values, that counts as none
  double share = 0.002;  ///< share of the cells that may differ more
  uint32_t cell = 4;     ///< side of a cell [pixels], > 0
};

/// Pictures are compared by the means of cells: a shifted edge or other noise changes pixels, but not the
/// mean of several.
struct PictureMatch {
  double share = 0;       ///< of the cells that differ by more than MatchOptions::within in some channel
  double largest = 0;     ///< difference of a cell, 0..1
  uint32_t x = 0, y = 0;  ///< its place [pixels]
  bool matches = true;
};

/// A picture with channels R, G, B in the sRGB encoding, 0..1, from RGBA bytes, top row first.
FilmImage display_picture(uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba);

/// Throws Error, located at `where` (the reference's file), if the sizes differ or a channel R, G or B is
/// missing.
PictureMatch match_pictures(const FilmImage& now, const FilmImage& reference, const MatchOptions& options,
                            const std::string& where);

/// One line: "differs in 3.1 % of its area, most at 120,64 (0.42)".
std::string to_text(const PictureMatch& match);

}  // namespace lucerna::film
