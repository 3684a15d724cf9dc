#pragma once
// Expectations about the window: a text in it, and its picture or that of a part.
#include "commands/script_runner.h"
#include "state.h"

namespace lucerna::ui {

/// Adds the kinds 'text' and 'window' (commands/expectation.h).
void add_window_expectations(Ui& ui, commands::Expectations& expectations);

}  // namespace lucerna::ui
