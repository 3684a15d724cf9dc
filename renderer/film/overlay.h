#pragma once
// Contents of heat maps and of the tile overlay: scales common to picture and legend (colours:
// shaders/shared/ramp.h).
#include "film/film.h"
#include "film/tile_scale.h"

namespace lucerna::film {

/// Samples a pixel, from `least` to `most`: logarithmic if they differ by more than one, else from 0.
HeatScale sample_scale(uint32_t least, uint32_t most);
/// Relative error, from a tenth of the target to ten times the target, so that colours have a constant
/// meaning.
HeatScale error_scale(double target);
/// Device time of a pixel, from a fifth (adaptive: a tenth) of the mean to as many times it. `ms`: of the
/// whole picture so far, for `vertices` of paths in `pixels` pixels.
HeatScale cost_scale(double ms, double vertices, double pixels, bool adaptive);

}  // namespace lucerna::film
