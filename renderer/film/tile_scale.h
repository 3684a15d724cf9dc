#pragma once
// The scale of the tiles' overlay, which picture and legend share (shaders/shared/ramp.h holds the colours).

namespace lucerna::film {

/// Multiple of the target at which the ramp ends.
inline constexpr float k_tiles_far = 8;

/// Position of a tile with that error on the ramp of tiles: 0 far above the target .. 1 at or below it,
/// linear in the error's logarithm. -1 for unknown errors (negative or NaN) and targets that are not
/// positive.
float tile_position(double error, double target);

}  // namespace lucerna::film
