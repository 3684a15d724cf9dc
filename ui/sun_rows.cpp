#include "sun_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/sky_image.h"
#include "scene/solar.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

using commands::named;
constexpr const char* k_degree_sign = "\xC2\xB0";

void date_rows(Controls& controls, size_t i, const scene::SunTime& time) {
  auto month = float(time.month), day = float(time.day);
  bool changed = slider("##month", "Month", month, {.lo = 1, .hi = 12, .decimals = 0, .step = 1});
  tooltip("Month of the date.");
  changed |=
      slider("##day", "Day", day,
             {.lo = 1, .hi = float(scene::days_in_month(time.year, int(month))), .decimals = 0, .step = 1});
  tooltip(fmt::format("Day of the month. The year is {}; the command sun.set changes it.", time.year));
  if (changed) {
    scene::SunTime date = time;
    date.month = int(std::lround(month));
    date.day = std::min(int(std::lround(day)), scene::days_in_month(date.year, date.month));
    controls.act("sun.set", i + 1, named("date", scene::date_text(date)));
  }
  auto hours = float(time.hours);
  if (slider("##time", fmt::format("Time {}", scene::hours_text(time.hours)), hours,
             {.lo = 0, .hi = 24, .decimals = 2, .unit = "h", .step = 1.0f / 60}))
    controls.act("sun.set", i + 1, named("time", hours));
  tooltip("Time of the clock.");
}

void place_rows(Controls& controls, size_t i, const scene::SunTime& time) {
  const auto angle = [&](const char* id, const char* name, const char* word, double value, float most,
                         const char* help) {
    auto v = float(value);
    if (slider(id, name, v, {.lo = -most, .hi = most, .decimals = 2, .unit = k_degree_sign, .bar = false}))
      controls.act("sun.set", i + 1, named(word, v));
    tooltip(help);
  };
  angle("##latitude", "Latitude", "latitude", time.latitude, 90, "North is positive.");
  angle("##longitude", "Longitude", "longitude", time.longitude, 180, "East is positive.");
  auto zone = float(time.zone);
  if (slider("##zone", "Time zone", zone,
             {.lo = -12, .hi = 14, .decimals = 2, .unit = "h", .bar = false, .sign = true, .step = 0.25f}))
    controls.act("sun.set", i + 1, named("zone", zone));
  tooltip("Hours by which the clock is ahead of UTC; summer time adds one.");
  angle("##north", "North", "north", time.north, 180,
        "Direction of north in the scene: clockwise from \xE2\x88\x92Z, seen from above.");
}

}  // namespace

void sun_details(Controls& controls, size_t i, const scene::Light& light) {
  if (!light.sun) {
    if (button("##by_date", "By date and place", false, ImGui::CalcItemWidth()))
      controls.act("sun.set", i + 1, named("date", "2024-06-21"), named("time", "12:00"), named("zone", 1),
                   named("latitude", 48), named("longitude", 11));
    tooltip("Places the sun by date, time, latitude and longitude.");
    return;
  }
  const scene::SunTime& time = *light.sun;
  const scene::SunPosition position = scene::sun_position(time);
  value_row("Sun", fmt::format("{:.1f}\xC2\xB0, {:.1f}\xC2\xB0 high", position.azimuth, position.elevation),
            "From true north towards east, and above the horizon.",
            position.elevation < 0 ? colour::warning : colour::text);
  date_rows(controls, i, time);
  place_rows(controls, i, time);
  if (button("##daylight", "Colour and strength by the air", false, ImGui::CalcItemWidth()))
    controls.act("sun.set", i + 1,
                 named("turbidity", controls.open.sky().value_or(scene::SkyModel()).turbidity));
  tooltip("Sets both by the way of the light through the air, for the turbidity of the sky; in lux.");
}

void sky_rows(Controls& controls) {
  static constexpr std::array<const char*, 3> words{"preetham", "cie_clear", "cie_overcast"};
  const std::optional<scene::SkyModel> sky = controls.open.sky();
  int index = sky ? int(sky->kind) : -1;
  if (choice("##sky", "Sky", {"Daylight by turbidity", "Clear, CIE", "Overcast, CIE"}, index, 0,
             {"Preetham, Shirley and Smits 1999: with the colours of the sky.",
              "White standard sky of the CIE.", "White standard sky of the CIE, brightest in the zenith."}))
    controls.act("environment.sky", words[size_t(index)]);
  tooltip(
      "A sky by formula in place of the environment. Its sun is where the first sun of the scene stands.");
  if (!sky) return;
  float turbidity = sky->turbidity, ground = sky->ground;
  if (sky->kind == scene::SkyKind::preetham) {
    if (slider("##turbidity", "Turbidity", turbidity,
               {.lo = scene::k_least_turbidity, .hi = scene::k_most_turbidity, .decimals = 1}))
      controls.act("environment.sky", words[0], named("turbidity", turbidity));
    tooltip("Haze of the air: 2 is clear, 10 hazy.");
  }
  if (slider("##ground", "Ground", ground, {.decimals = 2}))
    controls.act("environment.sky", words[size_t(sky->kind)], named("ground", ground));
  tooltip("Reflectance of the ground below the horizon.");
}

}  // namespace lucerna::ui
