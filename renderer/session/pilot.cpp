#include "session/pilot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pilot/findings.h"

namespace lucerna::session {
namespace {

/// Pixels along a side: whole blocks.
uint32_t side(double pixels) { return 8 * uint32_t(std::clamp(pixels / 8 + 0.5, 1.0, 4096.0)); }

double pixels_of(uint32_t width, uint32_t height) {
  return std::min(Pilot::k_share * width * height, Pilot::k_most_pixels);
}

}  // namespace

Pilot::Pilot(gpu::Device& device, const Engine& engine, uint32_t width, uint32_t height)
    : width_(width),
      height_(height),
      film_(device, side(std::sqrt(pixels_of(width, height) * width / height)),
            side(std::sqrt(pixels_of(width, height) * height / width))),
      schedule_(film_.width() / 8 * (film_.height() / 8), k_samples, engine.wavefront().slots(), true) {}

bool Pilot::step(Engine& engine, const PictureView& picture, const std::function<bool()>& cancel) {
  const Timer timer;
  if (!std::exchange(begun_, true)) film_.clear(engine.wavefront().stream());
  const schedule::UniformSchedule before = schedule_;
  const schedule::WorkItem item = schedule_.next();
  const bool complete = engine.try_paths(picture, item, film_, cancel);
  if (!complete) schedule_ = before;
  if (!complete) return false;
  const auto blocks = double(item.blocks.size());
  // The fastest item: the first ones include warming up.
  const double seconds = timer.seconds() / (64 * blocks);
  pixel_seconds_ = pixel_seconds_ > 0 ? std::min(pixel_seconds_, seconds) : seconds;
  return true;
}

solvers::Findings Pilot::findings(bool learns) const {
  // Variance of direct light once lights are learned, over that before: a tenth to a third in rooms.
  constexpr double k_learned = 0.22;
  // Time of a sample in large items and by specialized kernels, over that in the pilot's.
  constexpr double k_pace = 0.65;
  solvers::Findings findings = pilot::evaluate(film_.read(), k_samples);
  if (learns) findings.components[paths::k_primary].variance *= k_learned;
  findings.pixels = double(width_) * height_;
  findings.seconds = k_pace * pixel_seconds_ * findings.pixels;
  return findings;
}

}  // namespace lucerna::session
