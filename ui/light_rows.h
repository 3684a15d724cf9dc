#pragma once
// The list of lights in the scene panel: lamps, suns and emissive surfaces, with their properties.
#include "commands/navigation.h"
#include "controls.h"
#include "list_rows.h"
#include "scene_view.h"

namespace lucerna::ui {

/// All rows, and the buttons that add lights. `reveal`: the selected row is scrolled into view.
void draw_light_rows(Controls& controls, const commands::Navigation& camera, SceneView& view, bool reveal);

/// Colour by a picker and by temperature: runs `command` with color_name or kelvin.
void colour_rows(Actions& actions, const char* command, size_t item, const char* color_name, const vec3& tint,
                 const std::string& note = "");
/// Strength of a material's emission, in the chosen unit if it has that one.
void emission_slider(Controls& controls, uint32_t index);
/// The unit of emission_slider().
void emission_unit(Controls& controls, uint32_t index);

}  // namespace lucerna::ui
