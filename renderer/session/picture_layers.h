#pragma once
// Layers of a picture, as EXR files have them.
#include "film/io/image_file.h"
#include "session/setup.h"

namespace lucerna::session {

/// The sum, the components, with relight.layers the light groups, and albedo, normal, depth and samples; with
/// metadata of settings, scene and view. `image`: of the film, without a pending mix.
film::FilmImage picture_layers(const Setup& setup, const film::Image& image);
/// Adds what the noise is known by, for film::compare_stochastic(): the mean of the odd samples ("odd.R",
/// "odd.primary.R", ...) and, with `looks_up`, per tile of 16x16 pixels the noise and bias of lookups in the
/// mean luminance ("lookup.noise", "lookup.bias").
void add_noise_layers(film::FilmImage& out, const Setup& setup, const film::Image& image, bool looks_up);

}  // namespace lucerna::session
