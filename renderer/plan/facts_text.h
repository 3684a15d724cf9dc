#pragma once
// The table of effects as text (lucerna info) and as JSON (lucerna info --json).
#include <nlohmann/json.hpp>
#include <string>

#include "plan/facts.h"

namespace lucerna::plan {

/// Effects that the scene calls for, in groups, a line each with the objects that prove it; then those that
/// it does not, with what is missing. `off`: keys that are switched off (effects.off).
std::string effects_text(const SceneFacts& facts, const std::vector<std::string>& off = {});

/// By key: called for, its evidence by kind and name, what it switches on, and off or not.
nlohmann::ordered_json effects_json(const SceneFacts& facts, const std::vector<std::string>& off = {});

}  // namespace lucerna::plan
