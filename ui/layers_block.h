#pragma once
// The section Layers: light by path expressions, which can be shown and is written to EXR files.
#include <string>

#include "controls.h"

namespace lucerna::ui {

/// A layer that is being typed.
struct TypedLayer {
  std::string name, expression;
};

/// For the section's heading; "" if there is none.
std::string layer_count(const Controls& controls);
/// Inside a panel's section. Requires a scene.
void draw_layers(Controls& controls, TypedLayer& typed);

}  // namespace lucerna::ui
