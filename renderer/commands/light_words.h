#pragma once
// Parameters of commands that describe a light: its strength, colour, place and cones.
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "commands/registry.h"
#include "scene/light_units.h"
#include "scene/scene.h"

namespace lucerna::commands {

/// Parameter "kelvin".
Parameter kelvin();
/// Throws Error if both are given.
void exclude(const Arguments& a, const char* one, const char* other);
/// Sets a value to the argument of that name, if it is given.
void take(const Arguments& a, const char* name, float& value);
void take(const Arguments& a, const char* name, vec3& value);
void take(const Arguments& a, const char* name, bool& value);
/// The requested colour, its strongest channel 1, from the parameter of that name or in kelvin; else
/// `before`.
vec3 requested_tint(const Arguments& a, const char* color, const vec3& before);
/// The strength of light of that tint in place of `before`: a temperature keeps the luminance, a colour the
/// strongest channel.
float strength_in(const Arguments& a, const vec3& tint, const vec3& before);

/// "sun", "spot lamp", "point lamp", "sphere lamp", "rectangle lamp", "disk lamp" or "tube lamp".
const char* kind_of(const scene::Light& light);
/// True if the light has a direction that matters.
bool can_be_aimed(const scene::Light& light);
/// Parameters of a strength in these units, and of the distance for lux if that is one of them.
std::vector<Parameter> strength_parameters(std::initializer_list<scene::LightUnit> units);
/// The unit in which a strength is given; nothing if it is not. Throws Error if it is given twice, also by
/// one of the `other` parameters.
std::optional<scene::LightUnit> given_unit(const Arguments& a, std::initializer_list<const char*> other);
/// `before` with the strength that is given in `unit`, whose value for luminance 1 is `factor`. Throws Error
/// if it is too strong.
vec3 given_strength(const Arguments& a, scene::LightUnit unit, double factor, const vec3& before);

/// Parameters of a light's properties, all optional.
std::vector<Parameter> light_parameters();
/// Checks that need no light: of parameters that exclude each other.
void check_light_words(const Arguments& a);
/// Applies the given parameters; `distance` [m]: of lux, if not given. Throws Error for those that a light of
/// its kind does not have.
void apply_light_words(const Arguments& a, scene::Light& light, float distance);

}  // namespace lucerna::commands
