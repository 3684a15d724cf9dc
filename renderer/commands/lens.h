#pragma once
// Parameters of commands for the camera's lens.
#include <string>
#include <vector>

#include "commands/camera_control.h"
#include "commands/registry.h"

namespace lucerna::commands {

class OpenScene;

/// Optional parameters f_number, focus [m], blades, rotation [degrees], pinhole, projection, shift_right,
/// shift_up, section_normal, section_offset [m].
std::vector<Parameter> lens_parameters();
/// Sets what the arguments name; the rest stays. Throws Error: 1 or 2 blades, a pinhole with an f-number.
void set_lens(scene::Camera& camera, const Arguments& arguments);
/// By scene::k_projection_names. Throws Error: the camera is orthographic.
void set_projection(scene::Camera& camera, const std::string& name);
std::vector<std::string> projection_names();
/// If a lens has no plane of focus: puts it at the surface in the middle of the picture, else at the pivot.
void focus_somewhere(const OpenScene& open, Viewpoint& view, float aspect);
/// The lens as parameters of a command line, each after a blank.
std::string lens_words(const scene::Camera& camera);

/// Places the view by the arguments of camera.place. Throws Error if they contradict each other.
void place_by_words(Viewpoint& view, const Arguments& a, const OpenScene& open, float aspect);

}  // namespace lucerna::commands
