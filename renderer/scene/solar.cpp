#include "scene/solar.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "base/blackbody.h"
#include "base/color.h"
#include "base/error.h"

namespace lucerna::scene {
namespace {

constexpr double k_degree = std::numbers::pi / 180;

double sine(double degrees) { return std::sin(degrees * k_degree); }
double cosine(double degrees) { return std::cos(degrees * k_degree); }
double tangent(double degrees) { return std::tan(degrees * k_degree); }
double whole_turn(double degrees) { return degrees - 360 * std::floor(degrees / 360); }

bool is_leap(int year) { return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0); }

/// Meeus (7.1), for the Gregorian calendar.
double julian_day(int year, int month, double day) {
  if (month <= 2) --year, month += 12;
  const int century = year / 100;
  return std::floor(365.25 * (year + 4716)) + std::floor(30.6001 * (month + 1)) + day + 2 - century +
         century / 4 - 1524.5;
}

/// Days since 2000-01-01 12:00 UTC.
double days_since_epoch(const SunTime& t) {
  return julian_day(t.year, t.month, t.day + (t.hours - t.zone) / 24) - 2451545.0;
}

struct Ecliptic {
  double declination, right_ascension, distance;  // degrees, degrees, astronomical units
};

/// Apparent place of the sun: Meeus, chapter 25, low accuracy.
Ecliptic apparent_sun(double days) {
  const double t = days / 36525;
  const double mean_longitude = 280.46646 + t * (36000.76983 + t * 0.0003032);
  const double anomaly = 357.52911 + t * (35999.05029 - t * 0.0001537);
  const double eccentricity = 0.016708634 - t * (0.000042037 + t * 0.0000001267);
  const double centre = sine(anomaly) * (1.914602 - t * (0.004817 + t * 0.000014)) +
                        sine(2 * anomaly) * (0.019993 - t * 0.000101) + sine(3 * anomaly) * 0.000289;
  const double node = 125.04 - 1934.136 * t;
  const double longitude = mean_longitude + centre - 0.00569 - 0.00478 * sine(node);
  // Mean obliquity (22.2), with the main term of nutation.
  const double obliquity = 23.0 + (26.0 + (21.448 - t * (46.815 + t * (0.00059 - t * 0.001813))) / 60) / 60 +
                           0.00256 * cosine(node);
  const double distance =
      1.000001018 * (1 - eccentricity * eccentricity) / (1 + eccentricity * cosine(anomaly + centre));
  return {std::asin(sine(obliquity) * sine(longitude)) / k_degree,
          std::atan2(cosine(obliquity) * sine(longitude), cosine(longitude)) / k_degree, distance};
}

/// Degrees by which the air raises the sun.
double refraction(double elevation) {
  if (elevation > 85) return 0;
  const double t = tangent(elevation);
  double seconds = 0;
  if (elevation > 5)
    seconds = 58.1 / t - 0.07 / (t * t * t) + 0.000086 / (t * t * t * t * t);
  else if (elevation > -0.575)
    seconds = 1735 + elevation * (-518.2 + elevation * (103.4 + elevation * (-12.79 + elevation * 0.711)));
  else
    seconds = -20.772 / t;
  return seconds / 3600;
}

void check_within(double value, double lo, double hi, const char* name, const char* unit,
                  const std::string& where) {
  if (!(value >= lo && value <= hi))
    throw_error(where, "{} is {}, expected {} to {}{}", name, value, lo, hi, unit);
}

}  // namespace

int days_in_month(int year, int month) {
  constexpr std::array<int, 12> days{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return days[size_t(month - 1)] + (month == 2 && is_leap(year));
}

void check_range(const SunTime& t, const std::string& where) {
  check_within(t.year, 1901, 2099, "the year", "", where);
  check_within(t.month, 1, 12, "the month", "", where);
  if (t.day < 1 || t.day > days_in_month(t.year, t.month))
    throw_error(where, "there is no date {:04}-{:02}-{:02}: that month has {} days", t.year, t.month, t.day,
                days_in_month(t.year, t.month));
  check_within(t.hours, 0, 24, "the time", " hours", where);
  check_within(t.zone, -12, 14, "the time zone", " hours", where);
  check_within(t.latitude, -90, 90, "the latitude", " degrees", where);
  check_within(t.longitude, -180, 180, "the longitude", " degrees", where);
  check_within(t.north, -360, 360, "the direction of north", " degrees", where);
}

void parse_date(const std::string& text, const std::string& where, SunTime& time) {
  std::array<int*, 3> parts{&time.year, &time.month, &time.day};
  const char *at = text.data(), *end = text.data() + text.size();
  for (size_t i = 0; i < parts.size(); ++i) {
    const auto [next, error] = std::from_chars(at, end, *parts[i]);
    const bool separated = i == 2 ? next == end : next != end && *next == '-';
    if (error != std::errc() || !separated || *parts[i] < 0)
      throw_error(where, "'{}' is no date, expected YEAR-MONTH-DAY", text);
    at = i == 2 ? next : next + 1;
  }
}

std::string date_text(const SunTime& time) {
  return fmt::format("{:04}-{:02}-{:02}", time.year, time.month, time.day);
}

double parse_hours(const std::string& text, const std::string& where) {
  double hours = 0, unit = 1;
  const char *at = text.data(), *end = text.data() + text.size();
  for (int part = 0; part < 3; ++part, unit /= 60) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value, std::chars_format::fixed);
    if (error != std::errc() || !(value >= 0) || (part > 0 && value >= 60)) break;
    hours += unit * value;
    if (next == end && hours <= 24) return hours;
    if (*next != ':') break;
    at = next + 1;
  }
  throw_error(where, "'{}' is no time, expected HOURS:MINUTES or hours from 0 to 24", text);
}

std::string hours_text(double hours) {
  const auto seconds = static_cast<int>(std::lround(hours * 3600));
  const std::string minutes = fmt::format("{:02}:{:02}", seconds / 3600, seconds / 60 % 60);
  return seconds % 60 == 0 ? minutes : fmt::format("{}:{:02}", minutes, seconds % 60);
}

SunPosition sun_position(const SunTime& time) {
  const double days = days_since_epoch(time);
  const Ecliptic sun = apparent_sun(days);
  // Sidereal time at Greenwich: Meeus (12.4).
  const double sidereal = 280.46061837 + 360.98564736629 * days;
  const double hour_angle = sidereal + time.longitude - sun.right_ascension;
  const double latitude = time.latitude, declination = sun.declination;
  // Meeus (13.5) and (13.6), with the azimuth counted from north.
  const double up =
      sine(latitude) * sine(declination) + cosine(latitude) * cosine(declination) * cosine(hour_angle);
  const double east = -cosine(declination) * sine(hour_angle);
  const double north =
      sine(declination) * cosine(latitude) - cosine(declination) * sine(latitude) * cosine(hour_angle);
  SunPosition position;
  position.elevation = std::atan2(up, std::hypot(east, north)) / k_degree;
  position.elevation += refraction(position.elevation);
  position.azimuth = whole_turn(std::atan2(east, north) / k_degree);
  return position;
}

vec3 sun_direction(const SunTime& time) {
  const SunPosition p = sun_position(time);
  const double azimuth = p.azimuth + time.north;
  const glm::dvec3 to_sun(cosine(p.elevation) * sine(azimuth), sine(p.elevation),
                          -cosine(p.elevation) * cosine(azimuth));
  return vec3(-to_sun);
}

double air_mass(double elevation) {
  const double e = std::max(elevation, 0.0);
  return 1 / (sine(e) + 0.50572 * std::pow(e + 6.07995, -1.6364));
}

vec3 sunlight(double elevation, double turbidity, const SunTime& time) {
  if (!(elevation > 0)) return vec3(0);
  // Dominant wavelengths of Rec.709's primaries [micrometres], and ozone's absorption there [1/cm].
  constexpr std::array<double, 3> wavelengths{0.6114, 0.5491, 0.4643}, ozone{0.120, 0.085, 0.010};
  constexpr double k_ozone = 0.35, k_outside = 127500;
  const double mass = air_mass(elevation), aerosols = 0.04608 * turbidity - 0.04586;
  const double distance = apparent_sun(days_since_epoch(time)).distance;
  vec3 light = blackbody_color(5778);
  light *= float(k_outside / (double{luminance(light)} * distance * distance));
  for (int k = 0; k < 3; ++k) {
    const double w = wavelengths[size_t(k)];
    const double depth = 0.008735 * std::pow(w, -4.08) + std::max(aerosols, 0.0) * std::pow(w, -1.3) +
                         ozone[size_t(k)] * k_ozone;
    light[k] *= float(std::exp(-depth * mass));
  }
  return light;
}

}  // namespace lucerna::scene
