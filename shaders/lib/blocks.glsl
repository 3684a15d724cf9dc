// The blocks of 8x8 pixels of a work item.
#ifndef LUCERNA_LIB_BLOCKS
#define LUCERNA_LIB_BLOCKS
#include "shaders/shared/film.h"

layout(scalar) readonly buffer WorkBlocks { WorkBlock blocks[]; };

uint compact_bits(uint x) {  // every other bit of a 6-bit Morton code
  return (x & 1u) | ((x >> 1) & 2u) | ((x >> 2) & 4u);
}

// Index of the pixel with the given Morton code (0..63) of a block, in a picture of that width; may be outside.
uvec2 block_pixel(uint block, uint code, uint width) {
  uint across = (width + k_block - 1u) / k_block;
  return k_block * uvec2(block % across, block / across) + uvec2(compact_bits(code), compact_bits(code >> 1));
}
#endif
