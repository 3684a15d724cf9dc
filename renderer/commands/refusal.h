#pragma once
// What is left of a change of the document that the session has refused.
#include "commands/workspace.h"

namespace lucerna::commands {

/// Takes the change from `before` to `after` out of a document that was made after it: where `d` has the
/// values of `after` it gets those of `before`. What was changed again since stays. Lights and materials
/// count if all three have as many.
void take_back(Document& d, const Document& before, const Document& after);

}  // namespace lucerna::commands
