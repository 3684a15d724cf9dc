#pragma once
// Expected cost and error of a solver in a scene, from a short pilot of path tracing: data for the choice of
// solvers (components.X=auto, plan/choose.h). Costs are in samples: the cost of one path-traced sample of
// every pixel.
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

namespace lucerna::solvers {

/// Results of a pilot: the picture's first samples, by paths (pilot/findings.h).
struct Findings {
  struct Component {
    double energy = 0;    ///< share of the picture's light, 0..1
    double variance = 0;  ///< of one sample of a pixel, over the squared light around the pixel; mean
  };
  std::array<Component, 4> components{};  ///< primary, secondary, tertiary, caustic
  double pixels = 0;                      ///< of the picture to be rendered
  double rays = 7;                        ///< of a sample of a pixel
  double seconds = 0;                     ///< a sample of that picture, measured; for limits of time only
  double waiting = 1;                     ///< time of preparation over its cost: preview samples share it

  /// What the picture has cost so far with the solvers chosen first; for limits of time only. Measured
  /// instead of predicted: the cost of these solvers.
  struct Begun {
    std::array<std::string, 4> solvers;  ///< of each component
    double samples = 0;                  ///< of every pixel
    double sample = 0;                   ///< cost of one
    double spent = 0;                    ///< cost so far, with preparation
  };
  std::optional<Begun> begun{};
};

/// Prospect of components that a solver computes together.
struct Prospect {
  double preparation = 0;  ///< cost before the first sample
  double sample = 0;       ///< change of the cost of a sample; below 0: paths end sooner
  double variance = 0;     ///< of these components, as Findings::Component::variance
  /// Error as seen of the prepared data, which all samples share. Refinement reduces it in the course of
  /// `refined` samples and more: prepared_error().
  double prepared = 0, refined = 1;
  double floor = 0;  ///< error as seen that neither reduces: a bias
};

/// Prospect::prepared after that many samples: measured, its square falls a little slower than the samples
/// grow, because rays go first where they help most.
inline double prepared_error(const Prospect& p, double samples) {
  return p.prepared * std::pow(1 + samples / p.refined, -0.4);
}

/// Prospect for these components (bits); nullopt: not suited.
using PredictProspect = std::optional<Prospect> (*)(const Findings& findings, uint32_t components);

}  // namespace lucerna::solvers
