#pragma once
// Reverts a change of the document that the session has refused.
#include "commands/document.h"

namespace lucerna::commands {

/// Removes the change from `before` to `after` from a later document: values of `d` equal to those of `after`
/// become those of `before`. Later changes stay. Lights and materials are compared only if all three
/// documents have equally many.
void take_back(Document& d, const Document& before, const Document& after);
void take_back(Objects& values, const Objects& before, const Objects& after);

}  // namespace lucerna::commands
