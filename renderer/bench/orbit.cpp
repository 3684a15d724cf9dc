#include "bench/orbit.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <thread>
#include <vector>

#include "base/timer.h"
#include "session/pick.h"

namespace lucerna::bench {
namespace {

constexpr double k_send_s = 1.0 / 60, k_swing_s = 4, k_swing_degrees = 20;

double quantile(std::vector<double> of, double share) {
  if (of.empty()) return 0;
  std::sort(of.begin(), of.end());
  return of[std::min(of.size() - 1, size_t(share * double(of.size())))];
}

}  // namespace

Orbit orbit_of(std::span<const OrbitFrame> frames, std::span<const double> sent_s, double seconds) {
  Orbit orbit;
  std::vector<double> gaps, behind;
  double last = 0;
  size_t shown = 0;
  for (size_t i = 0; i < frames.size(); ++i) {
    if (i > 0 && frames[i].camera == frames[i - 1].camera) continue;
    gaps.push_back(frames[i].seconds - last), last = frames[i].seconds;
    behind.push_back(frames[i].seconds - sent_s[frames[i].camera]);
    ++shown;
  }
  gaps.push_back(seconds - last);
  orbit.frames_s = double(shown) / seconds;
  orbit.gap_s = quantile(gaps, 0.95), orbit.behind_s = quantile(behind, 0.5);
  return orbit;
}

scene::Camera orbit_camera(const scene::Camera& from, float distance, double seconds) {
  const auto angle = float(glm::radians(k_swing_degrees) * std::sin(2 * k_pi * seconds / k_swing_s));
  const vec3 centre = vec3(from.to_world[3]) - distance * glm::normalize(vec3(from.to_world[2]));
  scene::Camera camera = from;
  camera.to_world = glm::translate(mat4(1), centre) * glm::rotate(mat4(1), angle, vec3(0, 1, 0)) *
                    glm::translate(mat4(1), -centre) * from.to_world;
  return camera;
}

Orbit measure_orbit(session::Session& session, double seconds, const std::function<void()>& check) {
  const auto first = session.snapshot();
  if (!first || !session.scene()) return {};
  const scene::Camera from = first->camera;
  const std::shared_ptr<const scene::Scene> scene = session.scene();
  const auto middle = session::pick(*scene, from, 0.5f, 0.5f, float(first->width) / float(first->height));
  const float distance = middle ? middle->distance : 0.5f * scene::bounds(*scene).radius();
  std::vector<double> sent;
  std::vector<OrbitFrame> frames;
  std::map<uint64_t, size_t> of_command;
  const Timer clock;
  uint64_t last = first->id;
  while (clock.seconds() < seconds) {
    check();
    if (sent.empty() || clock.seconds() - sent.back() >= k_send_s) {
      sent.push_back(clock.seconds());
      session.set_camera(orbit_camera(from, distance, sent.back()));
      of_command[session.commands()] = sent.size() - 1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const auto now = session.snapshot();
    if (now->id == last) continue;
    last = now->id;
    // The newest camera whose effect the picture includes.
    const auto next = of_command.upper_bound(now->commands);
    if (next != of_command.begin()) frames.push_back({clock.seconds(), std::prev(next)->second});
  }
  session.set_camera(from);
  return orbit_of(frames, sent, seconds);
}

}  // namespace lucerna::bench
