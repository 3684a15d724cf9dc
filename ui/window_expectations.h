#pragma once
// Expectations about the window: a text in it, and its picture or that of a part.
#include "actions.h"
#include "commands/script_runner.h"
#include "layout.h"
#include "requests.h"

namespace lucerna::ui {

/// Adds the kinds 'text' and 'window' (commands/expectation.h).
void add_window_expectations(Actions& actions, Requests& requests, const Areas& areas,
                             commands::Expectations& expectations);

}  // namespace lucerna::ui
