#pragma once
// Recorded paths of the present picture, and what they say about its noise.
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "plan/facts.h"
#include "recording/noise.h"
#include "session/path_recording.h"
#include "session/sampling.h"
#include "session/transaction.h"

namespace lucerna::session {

class PathStudy {
 public:
  /// All must outlive it. `facts`: of the scene.
  PathStudy(const SetupContext& context, const Setup& setup, const Sampling& sampling,
            const plan::SceneFacts& facts)
      : context_(context),
        setup_(setup),
        sampling_(sampling),
        facts_(facts),
        recorder_(std::in_place, context.device, context.compiler) {}

  /// Records paths of the present picture by tracing them again; nothing else changes. Throws Error: no
  /// scene, kernels, memory.
  recording::Recording begin() const;
  /// Appends these paths to such a recording. False if cancelled: then some are missing.
  bool record(std::span<const shared::PathChoice> choices, recording::Recording& into,
              const std::function<bool()>& cancel = {},
              uint32_t events_per_path = transport::PathRecorder::k_events);
  /// Explains the noise of a part of the picture, 0..1 to the right and down, from a small seeded trial of
  /// its paths: shares by component, word, light and material, and settings that would reduce it
  /// (plan/choose.h).
  recording::NoiseReport explain_noise(const vec2& lo, const vec2& hi);
  /// Call when kernels must be compiled again.
  void reset_kernels() { recorder_.emplace(context_.device, context_.compiler); }

 private:
  PictureView view() const;
  recording::NoiseCure cure_of(const recording::NoiseReport& report) const;

  const SetupContext& context_;
  const Setup& setup_;
  const Sampling& sampling_;
  const plan::SceneFacts& facts_;
  std::optional<PathRecording> recorder_;  ///< never empty
};

}  // namespace lucerna::session
