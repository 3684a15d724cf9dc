#pragma once
// A date, a time and a place on the earth, from which the direction of the sun follows (solar.h).

namespace lucerna::scene {

struct SunTime {
  int year = 2024, month = 6, day = 21;  ///< Gregorian; 1901 to 2099
  double hours = 12;                     ///< of the clock, 0 to 24
  double zone = 0;                       ///< hours by which the clock is ahead of UTC, -12 to 14
  double latitude = 0;                   ///< degrees, north positive
  double longitude = 0;                  ///< degrees, east positive
  /// Direction of north in the scene: degrees clockwise, seen from above, from -Z.
  double north = 0;
  bool operator==(const SunTime&) const = default;
};

}  // namespace lucerna::scene
