// The command that saves the scene.
#include "base/error.h"
#include "commands/command_list.h"
#include "commands/lens.h"
#include "commands/workspace.h"

namespace lucerna::commands {
namespace {

/// The bookmarks of the scene as cameras; `view`: the present view as one more, if not empty.
std::vector<scene::Camera> cameras_to_save(Workspace& work, const std::string& view) {
  std::vector<scene::Camera> cameras;
  const auto add = [&](const std::string& name, scene::Camera camera) {
    camera.name = name, camera.aspect = 0;
    cameras.push_back(std::move(camera));
  };
  for (const auto& [name, line] : work.camera.bookmarks_of(work.open.scene.get())) {
    if (name == view || !work.camera.view) continue;
    Viewpoint place = *work.camera.view;
    place_by_words(place, work.registry.parse(line).arguments, work.open, work.camera.aspect);
    add(name, place.camera);
  }
  if (!view.empty()) work.camera.needs_view(), add(view, work.camera.view->camera);
  return cameras;
}

}  // namespace

void add_save_commands(Workspace& work) {
  Parameter file = file_to_write({".gltf", ".glb"});
  file.help = "without one, the file that was saved last, else the scene's own";
  file.optional = true;
  work.registry.add(
      {.name = "scene.save",
       .help =
           "Saves the scene with its edits: lights, materials' factors, environment, light groups, exposure, "
           "and bookmarks as cameras. All else in the file is kept. A script waits for it, and fails if it "
           "fails.",
       .parameters = {file,
                      {.name = "view",
                       .help = "also saves the present view as a camera of that name",
                       .optional = true},
                      {.name = "replace",
                       .type = Type::boolean,
                       .help = "replaces another file, or one that has changed on disk since; default false",
                       .optional = true}},
       .run =
           [&work](const Arguments& a) {
             work.open.needs_scene();
             const std::string name = a.has("file") ? a.text("file") : work.scene_file.file();
             const std::string view = a.has("view") ? a.text("view") : "";
             work.files.add(work.scene_file.save(name, a.has("replace") && a.boolean("replace"),
                                                 cameras_to_save(work, view)),
                            name);
           },
       .done = [&work](const Arguments&) { return work.files.latest_written(); },
       .needs_outcome = true});
}

}  // namespace lucerna::commands
