// Undoable commands: the sun by date, time and place; skies by formula.
#include <algorithm>

#include "base/error.h"
#include "base/log.h"
#include "commands/command_list.h"
#include "commands/open_scene.h"
#include "commands/sky_follow.h"
#include "scene/sky_image.h"
#include "scene/solar.h"

namespace lucerna::commands {
namespace {

Parameter number(const char* name, const char* help, const char* unit, double lo, double hi) {
  return {.name = name, .type = Type::real, .help = help, .lo = lo, .hi = hi, .unit = unit, .optional = true};
}

bool is_sun(const scene::Light& light) { return light.kind == scene::LightKind::directional; }

std::vector<std::string> sun_names(const OpenScene& open) {
  std::vector<std::string> names;
  for (const scene::Light& light : open.lights())
    if (is_sun(light) && !light.name.empty()) names.push_back(light.name);
  return names;
}

scene::Light& sun_of(OpenScene& open, const std::string& which) {
  scene::Light& light = open.edit().lights[open.light_index(which)];
  if (!is_sun(light)) throw Error("", fmt::format("light '{}' is no sun", light.name));
  return light;
}

/// The present place and date of the sun, changed by the given words. Throws Error if it is invalid.
scene::SunTime requested_time(const Arguments& a, const std::optional<scene::SunTime>& before) {
  if (!before && !(a.has("date") && a.has("time") && a.has("latitude") && a.has("longitude")))
    throw Error("", "the sun has no date and place yet: give date, time, latitude and longitude");
  scene::SunTime time = before.value_or(scene::SunTime());
  if (a.has("date")) scene::parse_date(a.text("date"), "date", time);
  if (a.has("time")) time.hours = scene::parse_hours(a.text("time"), "time");
  if (a.has("zone")) time.zone = a.real("zone");
  if (a.has("latitude")) time.latitude = a.real("latitude");
  if (a.has("longitude")) time.longitude = a.real("longitude");
  if (a.has("north")) time.north = a.real("north");
  scene::check_range(time, "date");
  return time;
}

void set_sun(OpenScene& open, const Arguments& a) {
  scene::Light& light = sun_of(open, a.text("light"));
  const scene::Light before = light;
  light.sun = requested_time(a, light.sun);
  light.direction = scene::sun_direction(*light.sun);
  const double elevation = scene::sun_position(*light.sun).elevation;
  if (a.has("turbidity")) light.intensity = scene::sunlight(elevation, a.real("turbidity"), *light.sun);
  if (elevation < 0) log::warning("sun '{}' is {:.1f} degrees below the horizon", light.name, -elevation);
  follow_sun(open, before, light);
}

void set_sky(OpenScene& open, const Arguments& a) {
  open.needs_scene();
  scene::SkyModel sky = open.sky().value_or(scene::SkyModel());
  const std::string& kind = a.text("kind");
  sky.kind = kind == "preetham"    ? scene::SkyKind::preetham
             : kind == "cie_clear" ? scene::SkyKind::cie_clear
                                   : scene::SkyKind::cie_overcast;
  if (a.has("turbidity")) sky.turbidity = a.number("turbidity");
  if (a.has("ground")) sky.ground = a.number("ground");
  const std::vector<scene::Light>& lights = open.edit().lights;
  const auto first = std::find_if(lights.begin(), lights.end(),
                                  [](const scene::Light& l) { return is_sun(l) && l.enabled; });
  if (a.has("sun"))
    sky.to_sun = -sun_of(open, a.text("sun")).direction;
  else if (first != lights.end())
    sky.to_sun = -first->direction;
  if (sky.to_sun.y < 0)
    throw Error("", "the sun is below the horizon, where these skies end: set its date and time first");
  Document& d = open.edit();
  // A sky in place of an image keeps no brightness of it.
  if (!open.sky()) d.environment_scale = 1;
  if (a.has("scale")) d.environment_scale = a.number("scale");
  d.environment_rotation = 0;
  d.environment_file.clear();
  d.sky = sky;
}

}  // namespace

void add_sun_commands(Registry& registry, OpenScene& open) {
  registry.add(
      {.name = "sun.set",
       .help =
           "Turns a sun to where it stands at a date, time and place; a sky that was made for it follows. "
           "Omitted values stay unchanged.",
       .parameters =
           {{.name = "light",
             .help = "name of a sun, or its number among the lights from 1",
             .which = true,
             .names = [&open](const std::vector<std::string>&) { return sun_names(open); }},
            {.name = "date", .help = "YEAR-MONTH-DAY, 1901 to 2099", .optional = true},
            {.name = "time", .help = "of the clock: HOURS:MINUTES, or hours", .optional = true},
            number("zone", "by which the clock is ahead of UTC; 0 at first", "hours", -12, 14),
            number("latitude", "north is positive", "degrees", -90, 90),
            number("longitude", "east is positive", "degrees", -180, 180),
            number("north", "direction of north in the scene: clockwise from -Z, seen from above", "degrees",
                   -360, 360),
            number("turbidity",
                   "also sets colour and strength by the air in the way, in lux; without it, they stay", "",
                   scene::k_least_turbidity, scene::k_most_turbidity)},
       .run = [&open](const Arguments& a) { set_sun(open, a); },
       .undoable = true,
       .replaces_sunlight = [](const Arguments& a) { return a.has("turbidity"); }});
  registry.add(
      {.name = "environment.sky",
       .help = "Lights the scene by a sky, in cd/m2, whose sun is where a sun of the scene stands and moves "
               "with it. preetham: by turbidity; cie_clear and cie_overcast: white standard skies.",
       .parameters = {{.name = "kind",
                       .type = Type::choice,
                       .choices = {"preetham", "cie_clear", "cie_overcast"}},
                      number("turbidity", "of preetham: 2 is clear, 10 hazy; 3 at first", "",
                             scene::k_least_turbidity, scene::k_most_turbidity),
                      number("ground", "reflectance of the ground below the horizon; 0.2 at first", "", 0, 1),
                      number("scale", "multiplies its radiance", "", 0, 1e6),
                      {.name = "sun",
                       .help = "name or number of the sun; without it, the first that is on",
                       .optional = true,
                       .names = [&open](const std::vector<std::string>&) { return sun_names(open); }}},
       .run = [&open](const Arguments& a) { set_sky(open, a); },
       .undoable = true});
}

}  // namespace lucerna::commands
