#include "commands/light_words.h"

#include <algorithm>
#include <array>

#include "base/blackbody.h"
#include "base/color.h"
#include "base/error.h"
#include "base/log.h"
#include "commands/light_edit.h"
#include "scene/io/light_picture_file.h"
#include "scene/io/light_profile_file.h"
#include "scene/lamp.h"
#include "scene/range.h"

namespace lucerna::commands {
namespace {

constexpr const char* k_no_file = "none";

Parameter angle(const char* name, const char* help, double lo, double hi) {
  return {.name = name,
          .type = Type::real,
          .help = help,
          .lo = lo,
          .hi = hi,
          .unit = "degrees",
          .optional = true};
}

Parameter size(const char* name, const char* help) {
  return {.name = name,
          .type = Type::real,
          .help = help,
          .lo = double{scene::k_least_lamp},
          .hi = double{scene::k_max_lamp},
          .unit = "m",
          .optional = true};
}

Parameter lux_distance() {
  return {.name = "distance",
          .type = Type::real,
          .help = "of lx, from the lamp's middle; without it, that of light.unit",
          .lo = 1e-3,
          .hi = 1e4,
          .unit = "m",
          .optional = true};
}

/// Refuses what a lamp of its kind does not have.
void check_kind(const Arguments& a, const scene::Light& light) {
  const auto refuse = [&](const char* name, const char* why) {
    if (a.has(name)) throw Error("", fmt::format("{}: a {} {}", name, kind_of(light), why));
  };
  if (light.kind == scene::LightKind::directional) {
    refuse("power", "shines from infinitely far: its intensity is what counts");
    for (const char* name : {"cd", "lm"}) refuse(name, "shines from infinitely far: give lx");
    refuse("distance", "is as strong at any distance");
    refuse("position", "is infinitely far: azimuth and elevation say where");
  }
  using scene::LightKind;
  if (light.kind == LightKind::point || light.kind == LightKind::sphere)
    for (const char* name : {"direction", "azimuth", "elevation"}) refuse(name, "shines in all directions");
  if (light.kind != LightKind::rectangle)
    for (const char* name : {"width", "height"}) refuse(name, "is no rectangle");
  if (light.kind != LightKind::tube) refuse("length", "is no tube");
  if (!has_shape(light.kind) || light.kind == LightKind::rectangle) refuse("radius", "has no radius");
  if (!has_shape(light.kind))
    for (const char* name : {"visible", "nits"}) refuse(name, "has no shape");
  if (light.kind != LightKind::rectangle && light.kind != LightKind::disk)
    refuse("two_sided", "has no second side");
  if (light.kind != LightKind::point && light.kind != LightKind::spot && light.kind != LightKind::profile)
    refuse("profile", "takes no distribution");
  if (light.kind != LightKind::spot) refuse("picture", "takes no picture: a spot does");
  const bool projects = light.picture || a.has("picture");
  if (light.kind != LightKind::rectangle && light.kind != LightKind::tube &&
      light.kind != LightKind::profile && !projects)
    for (const char* name : {"right", "roll"}) refuse(name, "looks the same when it is rolled");
  if (light.kind != scene::LightKind::spot)
    for (const char* name : {"cone", "inner_cone"}) refuse(name, "has no cone");
}

/// Applies the requested place, direction and cones.
void aim(const Arguments& a, scene::Light& light) {
  constexpr float degree = k_pi / 180;
  const vec3 before = light.direction;
  take(a, "position", light.position);
  if (a.has("direction")) {
    const vec3 d = a.vector("direction");
    if (!(glm::length(d) > 1e-6f)) throw Error("", "direction: its length is 0");
    turn_to(light, vec3(glm::normalize(glm::dvec3(d))));
  }
  if (a.has("azimuth") || a.has("elevation")) {
    Bearing bearing = bearing_of(light.direction);
    take(a, "azimuth", bearing.azimuth);
    take(a, "elevation", bearing.elevation);
    turn_to(light, direction_from(bearing));
  }
  // Turned by hand: no longer where a date puts it.
  if (light.direction != before) light.sun.reset();
  if (a.has("cone") && a.has("inner_cone") && a.real("inner_cone") > a.real("cone"))
    throw Error("", fmt::format("inner_cone: {} degrees is more than the cone's {}", a.real("inner_cone"),
                                a.real("cone")));
  // One alone moves the other where it must.
  if (a.has("cone")) light.outer_cone = degree * a.number("cone");
  if (a.has("inner_cone"))
    light.inner_cone = degree * a.number("inner_cone");
  else
    light.inner_cone = std::min(light.inner_cone, light.outer_cone);
  light.outer_cone = std::max(light.outer_cone, light.inner_cone);
  if (light.picture && light.outer_cone > scene::k_widest_picture)
    throw Error("", fmt::format("cone: with a picture it has at most {:.0f} degrees",
                                glm::degrees(scene::k_widest_picture) - 0.5f));
}

std::shared_ptr<const scene::LightPicture> picture_file(const std::string& file) {
  size_t mended = 0;
  auto picture = scene::load_light_picture(file, mended);
  if (mended > 0)
    log::warning("{}: {} texels are negative or not finite; they are 0 or the largest value", file, mended);
  return picture;
}

/// Applies the requested shape.
void shape(const Arguments& a, scene::Light& light) {
  take(a, "width", light.width);
  take(a, "length", light.width);
  take(a, "height", light.height);
  take(a, "radius", light.radius);
  take(a, "two_sided", light.two_sided);
  take(a, "visible", light.visible);
  if (a.has("right")) {
    const vec3 right = a.vector("right");
    if (light.kind == scene::LightKind::tube && glm::length(right) > 1e-6f) {
      // Its axis; it shines all around.
      const glm::dvec3 axis = glm::normalize(glm::dvec3(right));
      const glm::dvec3 along(light.direction), across = along - axis * glm::dot(axis, along);
      light.direction = glm::length(across) > 1e-3 ? vec3(glm::normalize(across))
                                                   : scene::right_across(vec3(axis), vec3(0, -1, 0));
    }
    if (!(glm::length(glm::cross(right, light.direction)) > 1e-6f))
      throw Error("", "right: it is 0 or along the light's direction");
    light.right = scene::right_across(light.direction, right);
  }
  if (a.has("roll")) light.right = scene::rolled(light.direction, a.number("roll"));
}

/// Applies the requested strength, colour and switch. `distance`: of lux, if not given.
void shine(const Arguments& a, scene::Light& light, float distance) {
  const vec3 tint = requested_tint(a, "color", tint_of(light.intensity));
  float strength = strength_in(a, tint, light.intensity);
  take(a, "intensity", strength);
  if (a.has("power")) strength = a.number("power") / std::max(float(scene::solid_angle(light)), 1e-9f);
  if (a.has("intensity") || a.has("power") || a.has("color") || a.has("kelvin"))
    light.intensity = strength * tint;
  const auto unit = given_unit(a, {});
  if (a.has("distance") && unit != scene::LightUnit::lux) throw Error("", "distance: it counts for lx only");
  if (unit) {
    take(a, "distance", distance);
    const std::optional<double> factor = scene::unit_factor(light, *unit, double{distance});
    if (!factor) throw Error("", fmt::format("lx: {} m from its middle is inside the lamp", distance));
    light.intensity = given_strength(a, *unit, *factor, light.intensity);
  }
  take(a, "on", light.enabled);
}

}  // namespace

Parameter kelvin() {
  return {.name = "kelvin",
          .type = Type::real,
          .help = "colour of a black body of that temperature, at equal luminous intensity",
          .lo = k_coolest_kelvin,
          .hi = k_hottest_kelvin,
          .unit = "K",
          .optional = true};
}

void exclude(const Arguments& a, const char* one, const char* other) {
  if (a.has(one) && a.has(other))
    throw Error("", fmt::format("{} and {} exclude each other: give one", one, other));
}

void take(const Arguments& a, const char* name, float& value) {
  if (a.has(name)) value = a.number(name);
}
void take(const Arguments& a, const char* name, vec3& value) {
  if (a.has(name)) value = a.vector(name);
}
void take(const Arguments& a, const char* name, bool& value) {
  if (a.has(name)) value = a.boolean(name);
}

vec3 requested_tint(const Arguments& a, const char* color, const vec3& before) {
  if (a.has("kelvin")) return blackbody_color(a.number("kelvin"));
  if (!a.has(color)) return before;
  if (strength_of(a.vector(color)) <= 0)
    throw Error("", fmt::format("{}: at least one channel must be above 0", color));
  return tint_of(a.vector(color));
}

float strength_in(const Arguments& a, const vec3& tint, const vec3& before) {
  return a.has("kelvin") ? luminance(before) / luminance(tint) : strength_of(before);
}

const char* kind_of(const scene::Light& light) {
  static constexpr const char* k_names[] = {"point lamp",     "spot lamp", "sun",       "sphere lamp",
                                            "rectangle lamp", "disk lamp", "tube lamp", "profile lamp"};
  return k_names[static_cast<size_t>(light.kind)];
}

bool can_be_aimed(const scene::Light& light) {
  using scene::LightKind;
  return light.kind == LightKind::spot || light.kind == LightKind::rectangle ||
         light.kind == LightKind::disk || light.kind == LightKind::profile;
}

std::vector<Parameter> strength_parameters(std::initializer_list<scene::LightUnit> units) {
  static constexpr std::array<const char*, scene::k_light_units> k_helps{
      "luminous intensity in front of a lamp; of a profile, the largest", "luminous flux of all its light",
      "illuminance of a small plane that faces a sun, or a lamp at a distance in front of it",
      "lumens over 683, as exporters of glTF have it; of a sun, per m2", "luminance of a surface"};
  std::vector<Parameter> parameters;
  for (const scene::LightUnit unit : units) {
    const scene::LightUnitInfo& info = info_of(unit);
    parameters.push_back({.name = info.word,
                          .type = Type::real,
                          .help = k_helps[size_t(unit)],
                          .lo = 0,
                          .hi = 1e12,
                          .unit = unit == scene::LightUnit::nit ? "cd/m2" : info.symbol,
                          .optional = true});
    if (unit == scene::LightUnit::lux) parameters.push_back(lux_distance());
  }
  return parameters;
}

std::optional<scene::LightUnit> given_unit(const Arguments& a, std::initializer_list<const char*> other) {
  std::optional<scene::LightUnit> unit;
  const char* given = nullptr;
  const auto take_one = [&](const char* name) {
    if (!a.has(name)) return false;
    if (given) exclude(a, given, name);
    given = name;
    return true;
  };
  for (const char* name : other) take_one(name);
  for (const scene::LightUnitInfo& info : scene::k_unit_table)
    if (take_one(info.word)) unit = info.unit;
  return unit;
}

vec3 given_strength(const Arguments& a, scene::LightUnit unit, double factor, const vec3& before) {
  constexpr float k_most = 1e9f;
  const char* word = info_of(unit).word;
  const vec3 after = scene::with_strength(before, factor, a.real(word));
  if (!(strength_of(after) <= k_most))
    throw Error("",
                fmt::format("{}: {} makes the strongest channel more than {}", word, a.real(word), k_most));
  return after;
}

std::vector<Parameter> light_parameters() {
  std::vector<Parameter> all = {
      {.name = "intensity",
       .type = Type::real,
       .help = "of the strongest channel, in front of the lamp, before the colour; lx of a sun",
       .lo = 0,
       .hi = 1e9,
       .unit = "cd",
       .optional = true},
      {.name = "color",
       .type = Type::vector,
       .help = "linear; its strongest channel is scaled to 1",
       .lo = 0,
       .hi = 1e9,
       .optional = true},
      {.name = "on", .type = Type::boolean, .help = "turns it on or off", .optional = true},
      kelvin(),
      {.name = "power",
       .type = Type::real,
       .help = "all light of a lamp in its strongest channel, before the colour; replaces intensity",
       .lo = 0,
       .hi = 1e9,
       .unit = "lm",
       .optional = true},
      {.name = "position",
       .type = Type::vector,
       .help = "of a lamp",
       .lo = -1e6,
       .hi = 1e6,
       .unit = "m",
       .optional = true},
      {.name = "direction",
       .type = Type::vector,
       .help = "direction of a sun or spot; any length above 0",
       .lo = -1e6,
       .hi = 1e6,
       .optional = true},
      angle("azimuth", "from where a sun or a spot shines, as a compass: 0 from -Z, 90 from +X", -360, 360),
      angle("elevation", "the same above the horizon", -90, 90),
      angle("cone", "of a spot, from its axis to where there is no light", 0.01, 90),
      angle("inner_cone", "of a spot, from its axis to where its light begins to fade", 0, 90),
      size("radius", "of a sphere, disk or tube; the lamp keeps its power"),
      size("width", "of a rectangle; the lamp keeps its power"),
      size("height", "of a rectangle; the lamp keeps its power"),
      size("length", "of a tube; the lamp keeps its power"),
      {.name = "right",
       .type = Type::vector,
       .help = "direction of a rectangle's width or a tube's length; any length above 0",
       .lo = -1e6,
       .hi = 1e6,
       .optional = true},
      angle("roll", "of a rectangle or tube about its direction; 0: its width is level", -360, 360),
      {.name = "two_sided",
       .type = Type::boolean,
       .help = "a rectangle or disk shines to both sides",
       .optional = true},
      {.name = "profile",
       .type = Type::file,
       .help = "measured distribution of a point or spot, IES LM-63 or EULUMDAT; the lamp keeps its power; "
               "none: a point",
       .choices = {".ies", ".ldt"},
       .words = {k_no_file},
       .optional = true},
      {.name = "picture",
       .type = Type::file,
       .help = "image that a spot projects; its corners are on the cone, and white is as strong as the spot; "
               "none: without",
       .choices = {".png", ".jpg", ".exr", ".hdr"},
       .words = {k_no_file},
       .optional = true},
      {.name = "visible",
       .type = Type::boolean,
       .help = "the camera sees the shape; mirrors show it in any case",
       .optional = true}};
  using scene::LightUnit;
  for (Parameter& p : strength_parameters(
           {LightUnit::candela, LightUnit::lumen, LightUnit::lux, LightUnit::watt, LightUnit::nit}))
    all.push_back(std::move(p));
  return all;
}

void check_light_words(const Arguments& a) {
  given_unit(a, {"intensity", "power"}), exclude(a, "color", "kelvin");
  exclude(a, "direction", "azimuth"), exclude(a, "direction", "elevation");
  exclude(a, "right", "roll"), exclude(a, "profile", "picture");
}

void apply_light_words(const Arguments& a, scene::Light& light, float distance) {
  check_kind(a, light);
  if (a.has("profile") && a.text("profile") != k_no_file)
    set_profile(light, scene::load_light_profile(a.text("profile")));
  else if (a.has("profile") && light.profile)
    scene::drop_profile(light);
  if (a.has("picture") && a.text("picture") == k_no_file)
    light.picture.reset();
  else if (a.has("picture"))
    set_picture(light, picture_file(a.text("picture")));
  aim(a, light);
  shape(a, light);
  shine(a, light, distance);
}

}  // namespace lucerna::commands
