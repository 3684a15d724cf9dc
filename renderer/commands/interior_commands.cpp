// Commands for moving about in rooms, and views with a name.
#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "commands/workspace.h"

namespace lucerna::commands {

void Workspace::add_interior_commands() {
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
                    [this](const Arguments& a) {
                      needs_view();
                      if (view->camera.orthographic) throw Error("", "an orthographic camera cannot walk");
                      probe(true);
                      // In steps no longer than a stride, so that no stair is missed.
                      const vec2 way(a.number("right"), a.number("forward"));
                      const float length = glm::length(way);
                      const int steps =
                          std::clamp(static_cast<int>(length / (0.1f * eye_height)) + 1, 1, 10000);
                      Viewpoint walked = *view;
                      for (int i = 0; i < steps; ++i)
                        commands::walk(walked, look(), way / static_cast<float>(steps), eye_height,
                                       a.has("through") && a.boolean("through"));
                      take_view(walked);
                    },
                .moves = true});
  registry.add(
      {.name = "camera.walking",
       .help = "W A S D walk along the floor instead of flying. Starts with the eye camera.eye_height "
               "above the floor.",
       .parameters = {{.name = "on", .type = Type::boolean}},
       .run =
           [this](const Arguments& a) {
             needs_view();
             if (!a.boolean("on")) {
               walking = false;
               return;
             }
             if (view->camera.orthographic) throw Error("", "an orthographic camera cannot walk");
             probe(true);
             const auto floor = floor_below(look(), eye_of(view->camera), 0.5f * eye_height, view->extent);
             if (!floor) throw Error("", "there is no floor below the camera to walk on");
             Viewpoint standing = *view;
             const vec3 rise(0, eye_height - *floor, 0);
             const vec3 eye = eye_of(standing.camera);
             standing.camera.to_world[3] =
                 vec4(step_straight(look(), eye, rise, clearance(standing.extent)), 1);
             take_view(standing);
             walking = true;
           },
       .moves = true});
  registry.add({.name = "camera.eye_height",
                .help = "Height of the eye above the floor when walking.",
                .parameters = {{.name = "height", .type = Type::real, .lo = 0.01, .hi = 100, .unit = "m"}},
                .run =
                    [this](const Arguments& a) {
                      eye_height = a.number("height");
                      if (!walking || !view) return;
                      Viewpoint standing = *view;
                      commands::walk(standing, look(), vec2(0), eye_height, false);
                      take_view(standing);
                    },
                .moves = true});
}

namespace {

/// By which a scene's bookmarks are kept: its file, the same from any folder.
std::string bookmarks_key(const scene::Scene& scene) {
  return scene.file.empty() ? "" : absolute_path(scene.file).string();
}

}  // namespace

const Workspace::Bookmarks& Workspace::bookmarks_here() const {
  static const Bookmarks none;
  if (!scene) return none;
  const auto found = bookmarks.find(bookmarks_key(*scene));
  return found == bookmarks.end() ? none : found->second;
}

std::vector<std::string> Workspace::bookmark_names() const {
  std::vector<std::string> names;
  for (const auto& [name, line] : bookmarks_here()) names.push_back(name);
  return names;
}

void Workspace::add_bookmark_commands() {
  static constexpr size_t k_most = 100, k_longest = 64;
  const auto names = [this](const std::vector<std::string>&) { return bookmark_names(); };
  const auto known = [this](const std::string& name) {
    needs_scene();
    const Bookmarks& here = bookmarks_here();
    const auto found = here.find(name);
    if (found != here.end()) return found->second;
    if (here.empty()) throw Error("", "this scene has no bookmarks; camera.bookmark NAME keeps a view");
    throw Error("", fmt::format("there is no bookmark '{}'{}; there are {}", name,
                                suggestion(name, bookmark_names()), fmt::join(bookmark_names(), ", ")));
  };
  registry.add(
      {.name = "camera.bookmark",
       .help = "Saves this view as a bookmark of the scene; without a name as 'View 1' and so on. Replaces a "
               "bookmark of that name.",
       .parameters = {{.name = "name", .help = "of the view", .optional = true, .names = names}},
       .run = [this](const Arguments& a) {
         needs_scene(), needs_view();
         Bookmarks& here = bookmarks[bookmarks_key(*scene)];
         std::string name = a.has("name") ? a.text("name") : "";
         if (a.has("name") && name.find_first_not_of(" \t") == std::string::npos)
           throw Error("", "name: it is empty");
         if (name.size() > k_longest)
           throw Error("", fmt::format("name: {} bytes are too long; at most {}", name.size(), k_longest));
         for (int n = 1; name.empty(); ++n)
           if (const std::string next = fmt::format("View {}", n); !here.contains(next)) name = next;
         if (here.size() >= k_most && !here.contains(name))
           throw Error("", fmt::format("there are {} bookmarks; camera.forget takes one away", here.size()));
         std::string text = place_line(*view);
         if (!view->camera.orthographic) text += " " + named("fov", view->camera.yfov * 180 / k_pi).text;
         here[name] = text;
       }});
  registry.add({.name = "camera.go",
                .help = "Goes to the view of a bookmark.",
                .parameters = {{.name = "name", .help = "of a bookmark", .names = names}},
                .run =
                    [this, known](const Arguments& a) {
                      needs_view();
                      run(known(a.text("name")));
                    },
                .recorded = false});
  registry.add({.name = "camera.forget",
                .help = "Deletes a bookmark.",
                .parameters = {{.name = "name", .help = "of a bookmark", .names = names}},
                .run = [this, known](const Arguments& a) {
                  known(a.text("name"));
                  bookmarks[bookmarks_key(*scene)].erase(a.text("name"));
                }});
}

}  // namespace lucerna::commands
