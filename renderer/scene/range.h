#pragma once
// Valid ranges of a scene's numbers: decides whether a camera, lamp, material or environment can be rendered.
// Called for files, commands, bookmarks and by the renderer. Each function throws Error, located at the
// object's name, with the invalid value and the valid range.
#include "scene/scene.h"

namespace lucerna::scene {

/// Largest coordinate in the world [m]; a squared area of this size still fits a float.
inline constexpr float k_max_coordinate = 1e9f;
/// Largest intensity, emitted radiance and environment factor; sums and products along a path still fit a
/// float.
inline constexpr float k_max_strength = 1e30f;
/// Largest field of view [radians].
inline constexpr float k_max_yfov = 3.14f;
inline constexpr float k_least_f_number = 0.1f, k_max_f_number = 1000;
/// Smallest distance of the plane of focus [m].
inline constexpr float k_least_focus = 1e-4f;
inline constexpr uint32_t k_max_blades = 32;
/// Sizes of lamps with a shape [m].
inline constexpr float k_least_lamp = 1e-4f, k_max_lamp = 1e4f;
/// Largest lens shift, in sizes of the picture.
inline constexpr float k_max_shift = 20;
inline constexpr float k_max_height = 10;      ///< Material::height, and its negative [m]
inline constexpr float k_max_dispersion = 20;  ///< Material::dispersion: an Abbe number of 1

/// True if all coordinates are finite and at most k_max_coordinate.
bool in_range(const vec3& position);

/// The position is in range, the axes are finite and independent; yfov is above 0 and at most k_max_yfov, or
/// xmag and ymag are above 0 and at most k_max_coordinate; aspect is 0 to 10^4. The f-number is 0, or
/// k_least_f_number to k_max_f_number with a plane of focus from k_least_focus to k_max_coordinate; blades
/// are 0, or 3 to k_max_blades; shifts are -k_max_shift to k_max_shift. A
/// section's normal is unit or 0, its offset at most k_max_coordinate.
void check_range(const Camera& camera);
/// The position is in range, the direction finite and not 0; the intensity is 0 to k_max_strength, the cones
/// are 0 <= inner <= outer <= pi/2; sizes of a shape are k_least_lamp to k_max_lamp, its `right` is unit and
/// perpendicular to the direction.
void check_range(const Light& light);
/// Factors and emitted radiance are finite, not negative and at most k_max_strength.
void check_range(const Material& material);
/// The factor is 0 to k_max_strength, the rotation finite.
void check_range(const Environment& environment);

}  // namespace lucerna::scene
