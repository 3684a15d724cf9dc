#pragma once
// The commands of this module: each function registers those of one subject. What is passed must outlive the
// registry.
#include "commands/registry.h"

namespace lucerna::commands {

class Exposure;
class Navigation;
class OpenScene;
class SavedFiles;
class Workspace;

void add_setting_commands(Workspace& work);
void add_light_commands(Workspace& work);
void add_object_commands(Workspace& work);
void add_sun_commands(Registry& registry, OpenScene& open);
void add_material_commands(Registry& registry, OpenScene& open);
void add_environment_commands(Registry& registry, OpenScene& open);
void add_environment_file_commands(Registry& registry, OpenScene& open);
void add_shown_commands(Registry& registry, OpenScene& open);
void add_history_commands(Workspace& work);
void add_camera_commands(Registry& registry, const OpenScene& open, Navigation& camera);
void add_lens_commands(Registry& registry, const OpenScene& open, Navigation& camera);
void add_selection_commands(Workspace& work);
void add_walking_commands(Registry& registry, Navigation& camera);
void add_bookmark_commands(Workspace& work);
void add_exposure_commands(Registry& registry, const OpenScene& open, const Navigation& camera,
                           Exposure& exposure);
void add_mix_commands(Registry& registry, OpenScene& open);
void add_scene_commands(Workspace& work);
void add_save_commands(Workspace& work);
void add_render_commands(Workspace& work);
void add_script_commands(Workspace& work);
void add_session_test_commands(Workspace& work);
void add_wait_commands(Workspace& work);
void add_inspect_commands(Workspace& work);
void add_effect_commands(Registry& registry, const OpenScene& open);
void add_path_commands(Workspace& work);
void add_region_commands(Workspace& work);
void add_viewer_commands(Workspace& work);
void add_layer_commands(Workspace& work);
void add_ocio_commands(Workspace& work);
void add_compare_commands(Workspace& work);
void add_solver_commands(Registry& registry, const OpenScene& open, SavedFiles& files);

}  // namespace lucerna::commands
