#pragma once
// A region of the picture: a rectangle that alone gets samples. The rest keeps those it has.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lucerna::schedule {

/// In fractions of the picture's width and height, from its upper left corner; inside 0..1, not empty.
struct Region {
  double left = 0, top = 0, width = 1, height = 1;
  bool operator==(const Region&) const = default;
};

/// "LEFT,TOP,WIDTH,HEIGHT" -> region; nullopt if the text is empty. What lies outside the picture is cut off.
/// Throws Error located at `where`: no four numbers, or nothing of it in the picture.
std::optional<Region> parse_region(const std::string& text, const std::string& where);
/// The text that parse_region() reads.
std::string region_text(const Region& region);

/// Whole pixels or blocks: from left and top to before right and bottom. Initially without bounds.
struct Rectangle {
  uint32_t left = 0, top = 0, right = ~0u, bottom = ~0u;
  bool contains(uint32_t x, uint32_t y) const { return x >= left && x < right && y >= top && y < bottom; }
  bool operator==(const Rectangle&) const = default;
};

/// The pixels of a region in a picture of that size, to the nearest pixel; at least one.
Rectangle pixels_of(const Region& region, uint32_t width, uint32_t height);
/// The blocks of 8x8 pixels that contain one of these pixels.
Rectangle blocks_of(const Rectangle& pixels);
/// Indices of the blocks in it, in raster order.
std::vector<uint32_t> indices_of(const Rectangle& blocks, uint32_t blocks_across, uint32_t blocks_down);

}  // namespace lucerna::schedule
