#pragma once
// Smoothness of the window while the camera moves.
#include <functional>
#include <span>

#include "session/session.h"

namespace lucerna::bench {

struct Orbit {
  double frames_s = 0;  ///< pictures of another camera per second
  double gap_s = 0;     ///< 95th percentile of the time between two of them
  double behind_s = 0;  ///< median age of their cameras when shown: since set_camera()
};

/// A picture of the camera `camera`, an index into the cameras sent.
struct OrbitFrame {
  double seconds = 0;
  size_t camera = 0;
};
/// From the pictures shown within `seconds`, in order; cameras were sent at these times.
Orbit orbit_of(std::span<const OrbitFrame> frames, std::span<const double> sent_s, double seconds);

/// The camera after that time: it swings by 20 degrees to both sides around a vertical axis at that distance
/// in front of it, in four seconds.
scene::Camera orbit_camera(const scene::Camera& from, float distance, double seconds);

/// Sends a camera that swings around what is in the middle of the picture, 60 times per second for that long,
/// then the first one again. `check` may throw.
Orbit measure_orbit(session::Session& session, double seconds, const std::function<void()>& check);

}  // namespace lucerna::bench
