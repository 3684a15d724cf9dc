#pragma once
// Legends of what the window itself shows over or in place of the picture; those of solvers come with their
// reports.
#include <vector>

#include "session/session.h"

namespace lucerna::ui {

/// Of a layer that is no light and no heat map (session::Legend), of the marks of lights, and of the tint of
/// former light.
std::vector<solvers::Legend> window_legends(const session::Legend& layer, bool light_marks,
                                            bool former = false);

/// What a heat map shows: its title, and what its colours mean.
struct HeatWords {
  const char *title, *note;
};
HeatWords heat_words(uint32_t layer);

}  // namespace lucerna::ui
