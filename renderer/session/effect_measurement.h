#pragma once
// Measures what each effect of a scene costs and contributes, by leaving it out: two small path-traced
// pictures of the view, with and without, sample by sample in turn.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "session/effect_costs.h"
#include "session/renderer.h"

namespace lucerna::session {

/// Measures all effects of a renderer's scene that can be off, and its components. The scene, camera and
/// settings are those at the beginning, with components traced by paths and lights chosen by their power. Its
/// pictures depend on these and the seed only, durations do not.
class EffectMeasurement {
 public:
  /// Samples a pixel in each of the small pictures, and pixels of one.
  static constexpr uint32_t k_samples = 16;
  static constexpr double k_pixels = 128 * 72;

  /// Throws Error: memory, or no scene.
  EffectMeasurement(Renderer& picture, const RendererOptions& options);
  ~EffectMeasurement();
  /// Measures a part of an effect. False if cancelled: the part will be repeated. Throws Error.
  bool step(const std::function<bool()>& cancel);
  bool done() const { return at_ == result_.effects.size(); }
  double progress() const;       ///< 0..1
  std::string activity() const;  ///< the effect being measured: "measuring effects: normal maps"
  /// Requires done().
  EffectCosts take();

 private:
  /// Durations of rounds of one picture [ms per sample of the picture].
  using Rounds = std::vector<double>;
  /// The settings of the small pictures, without this effect ("": with all).
  void leave_out(Renderer& renderer, const std::string& key) const;
  /// Renders until that many samples; false if cancelled.
  bool render(Renderer& renderer, uint32_t samples, Rounds* rounds,
              const std::function<bool()>& cancel) const;
  void finish_effect();

  plan::Settings settings_;
  double pixels_;  ///< of the picture
  std::unique_ptr<Renderer> with_, without_;
  bool prepared_ = false;  ///< without_ leaves out the effect `at_`
  uint32_t samples_ = 0;   ///< of both
  Rounds with_rounds_, without_rounds_, all_rounds_;
  EffectCosts result_;
  size_t at_ = 0;  ///< effect being measured
};

}  // namespace lucerna::session
