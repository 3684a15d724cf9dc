// Commands that move the camera, and the selection that it can be framed on.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "commands/command_list.h"
#include "commands/highlight.h"
#include "commands/lens.h"
#include "commands/workspace.h"
#include "session/pick.h"

namespace lucerna::commands {
namespace {

constexpr double k_degrees = 180.0 / 3.14159265358979323846;

Parameter real(const char* name, const char* help, const char* unit = "", double lo = -1e9, double hi = 1e9) {
  return {.name = name, .type = Type::real, .help = help, .lo = lo, .hi = hi, .unit = unit};
}
Parameter optional(Parameter p) {
  p.optional = true;
  return p;
}
Parameter vector(const char* name, const char* help, const char* unit) {
  return {.name = name, .type = Type::vector, .help = help, .lo = -1e9, .hi = 1e9, .unit = unit};
}

Parameter fov() { return real("fov", "from top to bottom", "degrees", 0.01, 179); }
Parameter height() { return real("height", "of what an orthographic camera sees", "m", 1e-6, 1e9); }

void set_fov(scene::Camera& camera, double degrees) {
  if (camera.orthographic) throw Error("", "the camera is orthographic; camera.height sets what it sees");
  camera.wide = scene::Wide::none;
  camera.yfov = static_cast<float>(degrees / k_degrees);
}

void set_height(scene::Camera& camera, float metres) {
  if (!camera.orthographic) throw Error("", "the camera is not orthographic; camera.fov sets what it sees");
  const float ratio = metres / (2 * camera.ymag);
  camera.ymag = 0.5f * metres, camera.xmag *= ratio;
}

int camera_index(const OpenScene& open, const Navigation& camera, const std::string& which) {
  open.needs_scene(), camera.needs_view();
  return static_cast<int>(index_of("camera", which, names_of(open.scene->cameras)));
}

Selection selection_of(const OpenScene& open, const std::string& kind, const std::string& which) {
  open.needs_scene();
  if (kind == "material")
    return {Kind::material, index_of("material", which, names_of(open.scene->materials))};
  if (kind == "light") return {Kind::light, index_of("light", which, names_of(open.lights()))};
  return {Kind::instance, index_of("object", which, names_of(open.scene->instances))};
}

/// Commands that move the camera.
class Motions {
 public:
  Motions(Registry& registry, const OpenScene& open, Navigation& camera)
      : registry_(registry), open_(open), camera_(camera) {}
  void add_motions();
  void add_lenses();

 private:
  /// `act` has the viewpoint that the camera starts from.
  void add(std::string name, std::string help, std::vector<Parameter> parameters,
           std::function<void(Viewpoint&, const Arguments&)> act);
  Registry& registry_;
  const OpenScene& open_;
  Navigation& camera_;
};

void Motions::add(std::string name, std::string help, std::vector<Parameter> parameters,
                  std::function<void(Viewpoint&, const Arguments&)> act) {
  registry_.add({.name = std::move(name),
                 .help = std::move(help),
                 .parameters = std::move(parameters),
                 .run =
                     [&camera = camera_, act = std::move(act)](const Arguments& a) {
                       camera.needs_view();
                       Viewpoint moving = *camera.view;
                       act(moving, a);
                       camera.take_view(moving);
                     },
                 .moves = true});
}

void Motions::add_motions() {
  std::vector<Parameter> placed = {
      vector("eye", "where it stands, from the scene's origin (lucerna info)", "m"),
      vector("target", "what it looks at", "m"), vector("up", "what is upwards in the picture", ""),
      optional(fov()), optional(height())};
  for (Parameter& p : lens_parameters()) placed.push_back(std::move(p));
  add("camera.orbit", "Turns the eye about what it looks at, or about any point.",
      {real("right", "counter-clockwise seen from above", "radians"), real("up", "raises the eye", "radians"),
       optional(vector("about", "a point of the scene", "m"))},
      [](Viewpoint& v, const Arguments& a) {
        const vec2 angles(a.number("right"), a.number("up"));
        if (a.has("about"))
          orbit_about(v, a.vector("about"), angles);
        else
          orbit(v, angles);
      });
  add("camera.look", "Turns the view about the eye.",
      {real("left", "to the left", "radians"), real("up", "upwards", "radians")},
      [](Viewpoint& v, const Arguments& a) {
        commands::look(v, {a.number("left"), a.number("up")});
      });
  add("camera.pan", "Moves sideways, as a drag across the picture does.",
      {real("right", "the picture moves to the right", "picture heights"),
       real("down", "the picture moves down", "picture heights")},
      [](Viewpoint& v, const Arguments& a) {
        pan(v, {a.number("right"), a.number("down")}, 1);
      });
  add("camera.dolly", "Comes closer by a tenth of the distance a step.",
      {real("steps", "negative: goes away", "steps", -1000, 1000)},
      [](Viewpoint& v, const Arguments& a) { dolly(v, a.number("steps")); });
  add("camera.fly", "Moves along the camera's own axes.",
      {real("right", "", "m"), real("up", "", "m"), real("forward", "", "m")},
      [](Viewpoint& v, const Arguments& a) {
        fly(v, {a.number("right"), a.number("up"), a.number("forward")});
      });
  add("camera.place",
      "Puts the camera at a place, looking at a point that it then orbits about. With fov it is a "
      "perspective camera, with height an orthographic one. Otherwise the lens stays as it is.",
      std::move(placed), [&camera = camera_, &open = open_](Viewpoint& v, const Arguments& a) {
        place_by_words(v, a, open, camera.aspect);
      });
  add("camera.frame",
      "Moves so that the selection, or else the whole scene, fills the picture; not into or behind a wall.",
      {}, [&camera = camera_, &open = open_](Viewpoint& v, const Arguments&) {
        camera.probe(true);
        const Box bounds = selection_bounds(open.scene.get(), open.lights(), camera.selection, camera.core);
        if (camera.selection.kind != Kind::none)
          frame_clear(v, bounds, camera.aspect, camera.look_past_selection());
        else if (!v.camera.orthographic && enclosed(camera.look(), eye_of(v.camera), v.extent))
          frame_inside(v, bounds, camera.aspect, camera.look());
        else
          frame(v, bounds, camera.aspect);
      });
}

void Motions::add_lenses() {
  add("camera.fov", "Sets the field of view of a perspective camera.", {fov()},
      [](Viewpoint& v, const Arguments& a) { set_fov(v.camera, a.real("fov")); });
  add("camera.projection",
      "Sets what a camera that is not orthographic shows: a plane before it, all directions by longitude and "
      "latitude (best in a picture twice as wide as high), or 180 degrees in a circle.",
      {{.name = "projection", .type = Type::choice, .choices = projection_names()}},
      [](Viewpoint& v, const Arguments& a) { set_projection(v.camera, a.text("projection")); });
  add("camera.height", "Sets what an orthographic camera sees.", {height()},
      [](Viewpoint& v, const Arguments& a) { set_height(v.camera, a.number("height")); });
  add("camera.lens", "Sets the field of view by a focal length, for a frame 36 mm wide.",
      {real("length", "focal length", "mm", 1, 2000)}, [&camera = camera_](Viewpoint& v, const Arguments& a) {
        set_fov(v.camera, k_degrees * yfov_from_focal_length(a.number("length"), camera.aspect));
      });
}

}  // namespace

void place_by_words(Viewpoint& v, const Arguments& a, const OpenScene& open, float aspect) {
  if (!place(v, a.vector("eye"), a.vector("target"), a.vector("up")))
    throw Error("", "eye and target must differ, and up must not point from one to the other");
  if (a.has("fov") && a.has("height")) throw Error("", "fov and height exclude each other: give one");
  if (a.has("fov")) {
    v.camera.orthographic = false;
    set_fov(v.camera, a.real("fov"));
  }
  if (a.has("height")) {
    if (!std::exchange(v.camera.orthographic, true)) v.camera.ymag = 1, v.camera.xmag = aspect;
    v.camera.wide = scene::Wide::none;
    set_height(v.camera, a.number("height"));
  }
  set_lens(v.camera, a);
  focus_somewhere(open, v, aspect);
}

void add_camera_commands(Registry& registry, const OpenScene& open, Navigation& camera) {
  Motions motions(registry, open, camera);
  motions.add_motions();
  motions.add_lenses();
  registry.add({.name = "camera.speed",
                .help = "Sets the speed of flight.",
                .parameters = {real("speed", "", "m/s", 1e-3, 1e4)},
                .run = [&camera](const Arguments& a) { camera.speed = a.number("speed"); }});
  registry.add({.name = "camera.select",
                .help = "Switches to a camera of the scene.",
                .parameters = {{.name = "camera",
                                .help = "its name, or its number from 1",
                                .names =
                                    [&open](const std::vector<std::string>&) {
                                      return open.scene ? given_names(open.scene->cameras)
                                                        : std::vector<std::string>{};
                                    }}},
                .run =
                    [&open, &camera](const Arguments& a) {
                      const int index = camera_index(open, camera, a.text("camera"));
                      camera.take_view(
                          make_viewpoint(open.scene->cameras[static_cast<size_t>(index)], camera.core),
                          index);
                    },
                .moves = true});
}

/// Light or emissive material whose highlight or reflection is at a point of the picture.
Selection light_at(Workspace& work, float right, float down) {
  const session::Probe* probe = work.camera.probe();
  if (!probe) return {};
  return light_in_highlight(*probe, work.open.lights(),
                            session::pick_ray(work.camera.view->camera, right, down, work.camera.aspect),
                            std::exp2(static_cast<float>(work.open.setting_real("film.ev"))));
}

void add_selection_commands(Workspace& work) {
  work.registry.add(
      {.name = "select",
       .help = "Selects an object, material or light of the scene.",
       .parameters = {{.name = "kind", .type = Type::choice, .choices = {"object", "material", "light"}},
                      {.name = "item",
                       .help = "its name, or its number from 1",
                       .names =
                           [&open = work.open](const std::vector<std::string>& before) {
                             std::vector<std::string> none;
                             if (!open.scene || before.empty()) return none;
                             if (before[0] == "material") return given_names(open.scene->materials);
                             return before[0] == "light" ? given_names(open.lights())
                                                         : given_names(open.scene->instances);
                           }}},
       .run = [&work](const Arguments& a) {
         work.camera.selection = selection_of(work.open, a.text("kind"), a.text("item"));
       }});
  work.registry.add(
      {.name = "pick",
       .help =
           "Selects the light whose highlight or reflection is at a point of the picture; without one, or "
           "if that is selected already, the object there, or its material if the object is selected "
           "already. Clears the selection if there is none.",
       .parameters = {{.name = "right", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture widths"},
                      {.name = "down", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture heights"}},
       .run =
           [&work](const Arguments& a) {
             const Navigation& camera = work.camera;
             work.open.needs_scene(), camera.needs_view();
             const float right = a.number("right"), down = a.number("down");
             const auto hit =
                 session::pick(*work.open.scene, camera.view->camera, right, down, camera.aspect);
             // Clicks at one place: the light, the object, its material, and the light again.
             if (hit && camera.selection == Selection{Kind::instance, hit->instance}) {
               work.run(line("select material", hit->material + 1));
               return;
             }
             const Selection lit = light_at(work, right, down);
             if (lit.kind != Kind::none && lit != camera.selection)
               work.run(line(lit.kind == Kind::light ? "select light" : "select material", lit.index + 1));
             else if (hit)
               work.run(line("select object", hit->instance + 1));
             else if (camera.selection.kind != Kind::none)
               work.run("select.none");
           },
       .recorded = false});
  work.registry.add({.name = "select.none",
                     .help = "Clears the selection.",
                     .parameters = {},
                     .run = [&work](const Arguments&) { work.camera.selection = {}; }});
}

}  // namespace lucerna::commands
