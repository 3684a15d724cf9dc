// Commands for moving about in rooms, and views with a name.
#include <algorithm>

#include "base/error.h"
#include "commands/command_list.h"
#include "commands/lens.h"
#include "commands/workspace.h"

namespace lucerna::commands {

void add_walking_commands(Registry& registry, Navigation& camera) {
  const Parameter through{.name = "through",
                          .type = Type::boolean,
                          .help = "true: passes through walls; default false",
                          .optional = true};
  const auto metres = [](const char* name) {
    return Parameter{.name = name, .type = Type::real, .lo = -1e4, .hi = 1e4, .unit = "m"};
  };
  registry.add({.name = "camera.walk",
                .help = "Walks along the floor, up and down stairs, with the eye camera.eye_height above it; "
                        "slides along walls.",
                .parameters = {metres("right"), metres("forward"), through},
                .run =
                    [&camera](const Arguments& a) {
                      camera.needs_view();
                      if (camera.view->camera.orthographic)
                        throw Error("", "an orthographic camera cannot walk");
                      camera.probe(true);
                      // In steps no longer than a stride, so that no stair is missed.
                      const vec2 way(a.number("right"), a.number("forward"));
                      const float length = glm::length(way);
                      const int steps =
                          std::clamp(static_cast<int>(length / (0.1f * camera.eye_height)) + 1, 1, 10000);
                      Viewpoint walked = *camera.view;
                      for (int i = 0; i < steps; ++i)
                        commands::walk(walked, camera.look(), way / static_cast<float>(steps),
                                       camera.eye_height, a.has("through") && a.boolean("through"));
                      camera.take_view(walked);
                    },
                .moves = true});
  registry.add({.name = "camera.walking",
                .help =
                    "W A S D walk along the floor instead of flying. Starts with the eye camera.eye_height "
                    "above the floor.",
                .parameters = {{.name = "on", .type = Type::boolean}},
                .run =
                    [&camera](const Arguments& a) {
                      camera.needs_view();
                      if (!a.boolean("on")) {
                        camera.walking = false;
                        return;
                      }
                      if (camera.view->camera.orthographic)
                        throw Error("", "an orthographic camera cannot walk");
                      camera.probe(true);
                      const auto floor = floor_below(camera.look(), eye_of(camera.view->camera),
                                                     0.5f * camera.eye_height, camera.view->extent);
                      if (!floor) throw Error("", "there is no floor below the camera to walk on");
                      Viewpoint standing = *camera.view;
                      const vec3 rise(0, camera.eye_height - *floor, 0);
                      const vec3 eye = eye_of(standing.camera);
                      standing.camera.to_world[3] =
                          vec4(step_straight(camera.look(), eye, rise, clearance(standing.extent)), 1);
                      camera.take_view(standing);
                      camera.walking = true;
                    },
                .moves = true});
  registry.add({.name = "camera.eye_height",
                .help = "Height of the eye above the floor when walking.",
                .parameters = {{.name = "height", .type = Type::real, .lo = 0.01, .hi = 100, .unit = "m"}},
                .run =
                    [&camera](const Arguments& a) {
                      camera.eye_height = a.number("height");
                      if (!camera.walking || !camera.view) return;
                      Viewpoint standing = *camera.view;
                      commands::walk(standing, camera.look(), vec2(0), camera.eye_height, false);
                      camera.take_view(standing);
                    },
                .moves = true});
}

namespace {

/// Bookmarks of the shown scene.
const Navigation::Bookmarks& bookmarks_here(const Workspace& work) {
  return work.camera.bookmarks_of(work.open.scene.get());
}

}  // namespace

void add_bookmark_commands(Workspace& work) {
  static constexpr size_t k_most = 100, k_longest = 64;
  const auto all_names = [&work] {
    std::vector<std::string> names;
    for (const auto& [name, line] : bookmarks_here(work)) names.push_back(name);
    return names;
  };
  const auto names = [all_names](const std::vector<std::string>&) { return all_names(); };
  const auto known = [&work, all_names](const std::string& name) {
    work.open.needs_scene();
    const Navigation::Bookmarks& here = bookmarks_here(work);
    const auto found = here.find(name);
    if (found != here.end()) return found->second;
    if (here.empty()) throw Error("", "this scene has no bookmarks; camera.bookmark NAME keeps a view");
    throw Error("", fmt::format("there is no bookmark '{}'{}; there are {}", name,
                                suggestion(name, all_names()), fmt::join(all_names(), ", ")));
  };
  work.registry.add(
      {.name = "camera.bookmark",
       .help = "Saves this view as a bookmark of the scene; without a name as 'View 1' and so on. Replaces a "
               "bookmark of that name.",
       .parameters = {{.name = "name", .help = "of the view", .optional = true, .names = names}},
       .run = [&work](const Arguments& a) {
         work.open.needs_scene(), work.camera.needs_view();
         Navigation::Bookmarks& here = work.camera.bookmarks_of(*work.open.scene);
         std::string name = a.has("name") ? a.text("name") : "";
         if (a.has("name") && name.find_first_not_of(" \t") == std::string::npos)
           throw Error("", "name: it is empty");
         if (name.size() > k_longest)
           throw Error("", fmt::format("name: {} bytes are too long; at most {}", name.size(), k_longest));
         for (int n = 1; name.empty(); ++n)
           if (const std::string next = fmt::format("View {}", n); !here.contains(next)) name = next;
         if (here.size() >= k_most && !here.contains(name))
           throw Error("", fmt::format("there are {} bookmarks; camera.forget takes one away", here.size()));
         const Viewpoint& view = *work.camera.view;
         std::string text = Navigation::place_line(view);
         if (!view.camera.orthographic) text += " " + named("fov", view.camera.yfov * 180 / k_pi).text;
         text += lens_words(view.camera);
         here[name] = text;
       }});
  work.registry.add({.name = "camera.go",
                     .help = "Goes to the view of a bookmark.",
                     .parameters = {{.name = "name", .help = "of a bookmark", .names = names}},
                     .run =
                         [&work, known](const Arguments& a) {
                           work.camera.needs_view();
                           work.run(known(a.text("name")));
                         },
                     .recorded = false});
  work.registry.add({.name = "camera.forget",
                     .help = "Deletes a bookmark.",
                     .parameters = {{.name = "name", .help = "of a bookmark", .names = names}},
                     .run = [&work, known](const Arguments& a) {
                       known(a.text("name"));
                       work.camera.bookmarks_of(*work.open.scene).erase(a.text("name"));
                     }});
}

}  // namespace lucerna::commands
