#pragma once
// Quantities derived from lamps.
#include "scene/scene.h"

namespace lucerna::scene {

/// Radiant power of a lamp over its intensity on the axis [sr]: the solid angle weighted by relative
/// intensity. 0 for a directional light.
double solid_angle(const Light& lamp);

/// Half the sizes along `right` and across: of a sphere or disk its radius in both, of a tube half its length
/// and its radius. Metres; 0 for lamps without a shape.
vec2 half_size(const Light& lamp);
/// Radiance of a lamp with a shape: its intensity over the area seen from its front.
vec3 radiance_of(const Light& lamp);

/// A unit vector perpendicular to that direction (unit), horizontal where there is only one such.
vec3 level_right(const vec3& direction);
/// The part of `right` perpendicular to the direction, unit; level_right() if there is none.
vec3 right_across(const vec3& direction, const vec3& right);
/// level_right(), rolled by that angle about the direction, towards up.
vec3 rolled(const vec3& direction, float degrees);
/// The angle, -180 to 180, by which that is `right`.
float roll_of(const vec3& direction, const vec3& right);
/// Gives the light that direction (unit); a shape turns along by the least rotation.
void turn_to(Light& light, const vec3& direction);

/// Whether the light's `right` matters, as of shapes, profiles and pictures.
bool can_roll(const Light& light);
/// Makes a point, spot or profile lamp a lamp of that distribution, with the same power.
void set_profile(Light& light, std::shared_ptr<const LightProfile> profile);

/// Makes a lamp with a profile a point of the same power.
void drop_profile(Light& light);

/// Gives a spot that picture. White of it is as strong as the spot was.
void set_picture(Light& light, std::shared_ptr<const LightPicture> picture);

/// "point", "spot", "directional", "sphere", "rectangle", "disk", "tube" or "profile".
const char* kind_name(LightKind kind);

}  // namespace lucerna::scene
