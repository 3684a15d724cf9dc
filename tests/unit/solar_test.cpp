// links: scene
// The sun by date, time and place against published values, its light, and dates.
#include <catch2/catch.hpp>

#include "base/error.h"
#include "scene/solar.h"

namespace solar_tests {

using namespace lucerna;
using namespace lucerna::scene;
using Catch::Contains;

namespace {

/// Refraction raises the sun: at most so much at these elevations.
constexpr double k_refraction = 0.025;

}  // namespace

TEST_CASE("the sun stands where almanacs have it, within 0.1 degrees") {
  // I. Reda, A. Andreas, 'Solar Position Algorithm for Solar Radiation Applications', NREL/TP-560-34302,
  // table A5.1: Golden, Colorado; azimuth 194.340241, topocentric elevation with refraction 39.888378
  // degrees.
  const SunTime golden{.year = 2003,
                       .month = 10,
                       .day = 17,
                       .hours = 12 + 30.0 / 60 + 30.0 / 3600,
                       .zone = -7,
                       .latitude = 39.742476,
                       .longitude = -105.1786};
  CHECK(sun_position(golden).azimuth == Approx(194.340241).margin(0.02));
  CHECK(sun_position(golden).elevation == Approx(39.888378).margin(0.02));
  // J. Meeus, Astronomical Algorithms, example 25.a: 1992-10-13 0 h, apparent right ascension 198.38083,
  // declination -7.78507 degrees. It is in the zenith where the latitude is the declination, and the
  // longitude the right ascension less the sidereal time at Greenwich, 21.80134 degrees (USNO's formula).
  const SunTime zenith{.year = 1992,
                       .month = 10,
                       .day = 13,
                       .hours = 0,
                       .latitude = -7.78507,
                       .longitude = 198.38083 - 21.80134};
  CHECK(sun_position(zenith).elevation > 89.98);
}

TEST_CASE("declinations of solstices and equinoxes are the sun's noon heights") {
  // Instants of the seasons: Astronomical Almanac, UT. At the equinox the sun is over the equator, at the
  // solstices over the tropics at 23.436 degrees (obliquity 2024). Noon height = 90 - |latitude -
  // declination|.
  const auto noon_height = [](SunTime t) {
    // The highest of the day, sampled each half minute.
    double best = -90;
    for (int i = 0; i < 2 * 24 * 60; ++i) {
      t.hours = i / 120.0;
      best = std::max(best, sun_position(t).elevation);
    }
    return best;
  };
  const SunTime june{.year = 2024, .month = 6, .day = 20, .latitude = 50, .longitude = 0};
  CHECK(noon_height(june) == Approx(90 - 50 + 23.436).margin(k_refraction));
  const SunTime december{.year = 2024, .month = 12, .day = 21, .latitude = 50, .longitude = 0};
  CHECK(noon_height(december) == Approx(90 - 50 - 23.436).margin(0.06));
  // 2024-03-20 03:06 UT: the declination is 0, so the sun rises due east; a quarter of a degree by noon.
  const SunTime march{.year = 2024, .month = 3, .day = 20, .hours = 3.1, .latitude = 0, .longitude = 136.6};
  const SunPosition equinox = sun_position(march);
  CHECK(equinox.elevation > 85);
  // In the south it culminates in the north.
  const SunTime sydney{
      .year = 2024, .month = 6, .day = 21, .hours = 12, .zone = 10, .latitude = -33.87, .longitude = 151.21};
  CHECK(std::abs(sun_position(sydney).azimuth - 180) > 170);
}

TEST_CASE("a clock in another zone shows the same sun") {
  const SunTime utc{
      .year = 2024, .month = 6, .day = 21, .hours = 10, .zone = 0, .latitude = 48, .longitude = 11};
  SunTime summer = utc;
  summer.hours = 12, summer.zone = 2;
  CHECK(sun_position(utc).azimuth == Approx(sun_position(summer).azimuth).epsilon(1e-12));
  SunTime eve = utc;  // beyond midnight, backwards
  eve.day = 20, eve.hours = 22, eve.zone = -12;
  CHECK(sun_position(utc).elevation == Approx(sun_position(eve).elevation).epsilon(1e-12));
}

TEST_CASE("light comes from the sun's place, whatever direction north is") {
  SunTime t{.year = 2024, .month = 6, .day = 21, .hours = 9, .zone = 2, .latitude = 48.1, .longitude = 11.6};
  const SunPosition p = sun_position(t);
  const vec3 light = sun_direction(t);
  CHECK(glm::length(light) == Approx(1));
  CHECK(std::asin(-light.y) * 180 / k_pi == Approx(p.elevation).margin(1e-4));
  CHECK(-light.x > 0);  // from the east in the morning: +X
  t.north = 90;         // north is +X: the east is +Z
  const vec3 turned = sun_direction(t);
  CHECK(turned.z == Approx(light.x).margin(1e-6));
  CHECK(turned.y == light.y);
}

TEST_CASE("sunlight fades and reddens with the way through the air") {
  const SunTime t{.year = 2024, .month = 4, .day = 3};
  // A clear zenith sun of about 100 klx; published measurements are 95 to 105 klx.
  const double high = luminance(sunlight(90, 2.5, t)), low = luminance(sunlight(10, 2.5, t));
  CHECK(high == Approx(100e3).margin(8e3));
  CHECK(low < 0.5 * high);
  CHECK(luminance(sunlight(60, 6, t)) < luminance(sunlight(60, 2.5, t)));
  const vec3 set = sunlight(3, 3, t);
  CHECK(set.x > 2 * set.z);
  CHECK(sunlight(-1, 3, t) == vec3(0));
  // Perihelion and aphelion: 3.4 % each in the square of the distance.
  const double near = luminance(sunlight(60, 3, {.year = 2024, .month = 1, .day = 3}));
  const double far = luminance(sunlight(60, 3, {.year = 2024, .month = 7, .day = 5}));
  CHECK(near / far == Approx(1.069).margin(0.003));
  // Kasten and Young 1989, table: 1.000 in the zenith, 1.994 at 30, 5.589 at 10 degrees, 37.92 at the
  // horizon.
  CHECK(air_mass(90) == Approx(1.000).margin(0.001));
  CHECK(air_mass(30) == Approx(1.994).margin(0.002));
  CHECK(air_mass(10) == Approx(5.589).margin(0.005));
  CHECK(air_mass(0) == Approx(37.92).margin(0.1));
}

TEST_CASE("dates and times are read and refused") {
  SunTime t;
  parse_date("2024-02-29", "date", t);
  CHECK((t.year == 2024 && t.month == 2 && t.day == 29));
  CHECK(date_text(t) == "2024-02-29");
  check_range(t);
  for (const char* bad : {"", "2024", "2024-06", "2024-06-21 ", "2024/06/21", "21.6.2024", "2024-6-x", "--1"})
    CHECK_THROWS_WITH(parse_date(bad, "sun.set", t), Contains("is no date, expected YEAR-MONTH-DAY"));
  CHECK(parse_hours("14:30", "") == 14.5);
  CHECK(parse_hours("14:30:36", "") == Approx(14.51));
  CHECK(parse_hours("7.25", "") == 7.25);
  CHECK(hours_text(14.5) == "14:30");
  CHECK(hours_text(14.51) == "14:30:36");
  for (const char* bad : {"", "noon", "25", "12:60", "-1", "12:", "12:30:15:1", "nan"})
    CHECK_THROWS_WITH(parse_hours(bad, "time"), Contains("is no time, expected HOURS:MINUTES"));
  const auto refused = [](auto change) {
    SunTime time;
    change(time);
    try {
      check_range(time);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(refused([](SunTime& s) { s.day = 31; }),
             Contains("there is no date 2024-06-31: that month has 30"));
  CHECK_THAT(refused([](SunTime& s) { s.year = 2023, s.month = 2, s.day = 29; }), Contains("28 days"));
  CHECK_THAT(refused([](SunTime& s) { s.month = 13; }), Contains("the month is 13, expected 1 to 12"));
  CHECK_THAT(refused([](SunTime& s) { s.year = 1900; }), Contains("1901 to 2099"));
  CHECK_THAT(refused([](SunTime& s) { s.latitude = 91; }),
             Contains("the latitude is 91, expected -90 to 90"));
  CHECK_THAT(refused([](SunTime& s) { s.longitude = -181; }), Contains("the longitude"));
  CHECK_THAT(refused([](SunTime& s) { s.zone = 15; }), Contains("the time zone"));
}

}  // namespace solar_tests
