#pragma once
// The sun by date, time and place: its position, and the light that it sends through the air.
#include <string>

#include "base/math.h"
#include "scene/sun_time.h"

namespace lucerna::scene {

/// Throws Error that names the field if a date does not exist, or if a value is outside the range in
/// sun_time.h; `where`: location for the message.
void check_range(const SunTime& time, const std::string& where = "sun");

/// Of the Gregorian calendar; `month`: 1 to 12.
int days_in_month(int year, int month);
/// Reads "2024-06-21" into year, month and day, which need not exist. Throws Error at `where`.
void parse_date(const std::string& text, const std::string& where, SunTime& time);
std::string date_text(const SunTime& time);
/// Hours from "14:30", "14:30:15" or a number. Throws Error at `where`.
double parse_hours(const std::string& text, const std::string& where);
/// "14:30"; with seconds if there are any.
std::string hours_text(double hours);

struct SunPosition {
  double azimuth = 0;    ///< from true north towards east, 0 to 360 degrees
  double elevation = 0;  ///< above the horizon, with refraction of the standard atmosphere, degrees
};
/// J. Meeus, Astronomical Algorithms, chapters 12, 22, 25 (low accuracy) and 28, as in NOAA's solar
/// calculator: within 0.02 degrees from 1901 to 2099, between the polar circles and above 1 degree of
/// elevation. Refraction: NOAA's approximation for 101 kPa and 10 degrees Celsius.
SunPosition sun_position(const SunTime& time);

/// Direction, unit, in which the sun's light travels in the scene (Y up; SunTime::north).
vec3 sun_direction(const SunTime& time);

/// Illuminance of the sun on a plane that faces it, as linear Rec.709 whose luminance is in lux; 0 below
/// the horizon. The light of a black body of 5778 K, 127.5 klx outside of the air at the mean distance (IES
/// Lighting Handbook), at the present distance, through the air: Rayleigh scattering, aerosols of that
/// turbidity (2 to 10), 0.35 cm of ozone (Preetham et al. 1999, appendix A.1; Iqbal 1983), evaluated at the
/// dominant wavelengths of the primaries; air mass of Kasten and Young 1989.
vec3 sunlight(double elevation_degrees, double turbidity, const SunTime& time);

/// Relative optical air mass: 1 in the zenith, about 38 at the horizon. Kasten and Young 1989.
double air_mass(double elevation_degrees);

}  // namespace lucerna::scene
