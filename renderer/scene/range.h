#pragma once
// The numbers that a scene may hold: the one place that decides whether a camera, a lamp, a material or an
// environment can be rendered. Files, commands, bookmarks and the renderer itself all call it. Each function
// throws Error, located at the thing's name, and says which value is wrong and what is allowed.
#include "scene/scene.h"

namespace lucerna::scene {

/// Coordinates in the world beyond this (metres) are refused: a squared area of such a size still fits a
/// float's range.
inline constexpr float k_max_coordinate = 1e9f;
/// Intensities, emitted radiance and factors of an environment beyond this are refused: sums and products of
/// a path still fit a float's range.
inline constexpr float k_max_strength = 1e30f;
/// The widest field of view, radians.
inline constexpr float k_max_yfov = 3.14f;

/// True if all coordinates are finite and at most k_max_coordinate.
bool in_range(const vec3& position);

/// The place is in range, the three axes are finite and independent; yfov is above 0 and at most k_max_yfov,
/// or xmag and ymag are above 0 and at most k_max_coordinate; aspect is 0 to 10^4.
void check_range(const Camera& camera);
/// The place is in range, the direction finite and not 0; the intensity is 0 to k_max_strength, the cones are
/// 0 <= inner <= outer <= pi/2.
void check_range(const Light& light);
/// Factors and emitted radiance are finite, not negative and at most k_max_strength.
void check_range(const Material& material);
/// The factor is 0 to k_max_strength, the rotation finite.
void check_range(const Environment& environment);

}  // namespace lucerna::scene
