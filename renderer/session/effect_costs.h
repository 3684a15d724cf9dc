#pragma once
// What each effect of a scene costs and contributes in a picture (EffectMeasurement).
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "pilot/difference.h"

namespace lucerna::session {

struct EffectCost {
  std::string key;    ///< plan::Effect::key
  std::string label;  ///< plan::Effect::label
  /// Time that a sample of the picture takes longer with the effect [ms], and its uncertainty: both from the
  /// fastest of six rounds with and without it. Below 0: without the effect paths are longer.
  double ms = 0, ms_error = 0;
  pilot::Difference part;  ///< what it contributes
};

struct EffectCosts {
  uint32_t width = 0, height = 0;   ///< of the picture
  double sample_ms = 0;             ///< of a path-traced sample of the picture with all effects
  std::vector<EffectCost> effects;  ///< the most expensive first
};

/// The three most expensive ones in a line.
std::string costs_line(const EffectCosts& costs);
/// Table for the terminal.
std::string costs_text(const EffectCosts& costs);
nlohmann::ordered_json costs_json(const EffectCosts& costs);

}  // namespace lucerna::session
