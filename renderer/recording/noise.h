#pragma once
// Noise of recorded paths: which components, words, lights and materials it comes from.
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "recording/recording.h"

namespace lucerna::recording {

/// A part of the light, with its shares of light and noise. Shares of noise sum to 1 over the parts of one
/// kind; one can be below 0 if its light is opposed to the rest, as two ways of sampling the same light are.
struct NoiseShare {
  std::string name;
  double noise = 0;  ///< share of the variance of a sample, as seen
  double light = 0;  ///< share of the light, as seen
};

/// What would reduce the noise: settings, with a reason.
struct NoiseCure {
  std::vector<std::pair<std::string, std::string>> settings;  ///< keys and values; empty: none is known
  std::string label;                                          ///< of a button: "Caustic light by photons"
  std::string reason;                                         ///< why
};

struct NoiseReport {
  uint32_t pixels = 0, paths = 0;
  double of_sample = 0;  ///< error as seen of one sample a pixel: root mean square, 1 = the light itself
  ByComponent<double> light{};     ///< shares, 0..1
  ByComponent<double> variance{};  ///< of one sample, over the squared light around
  /// Largest share of noise first.
  std::vector<NoiseShare> components, words, lights, materials;
  std::string sentence;
  NoiseCure cure;
};

/// `around`: by path of the recording, the luminance around its pixel, > 0: darkness hides noise, and light
/// shows it relative to itself. Paths of one pixel are consecutive; pixels with fewer than two paths do not
/// count. A pixel counts with a variance of at most `most` of that squared luminance. Without sentence and
/// cure.
NoiseReport analyse_noise(const Recording& recording, const std::vector<double>& around, double most);

/// "Caustic light makes 84 % of the noise here: words EDSL, of 'Lamp', by way of 'glass'." "": there is no
/// noise.
std::string noise_sentence(const NoiseReport& report, bool whole_picture);
/// The report as lines for a log.
std::vector<std::string> noise_lines(const NoiseReport& report);

}  // namespace lucerna::recording
