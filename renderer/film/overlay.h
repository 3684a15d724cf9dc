#pragma once
// What the heat maps and the overlay of tiles show: the scales that picture and legend share
// (shaders/shared/ramp.h holds the colours).
#include "film/film.h"
#include "film/tile_scale.h"

namespace lucerna::film {

/// Samples a pixel, from `least` to `most`: in factors where they differ by more than one, else from 0.
HeatScale sample_scale(uint32_t least, uint32_t most);
/// Relative error, from a tenth of the target to ten times it, so that a colour means the same all render
/// long.
HeatScale error_scale(double target);
/// Device time of a pixel, from a fifth (adaptive: a tenth) of the mean to as many times it. `ms`: of the
/// whole picture so far, for `vertices` of paths in `pixels` pixels.
HeatScale cost_scale(double ms, double vertices, double pixels, bool adaptive);

}  // namespace lucerna::film
