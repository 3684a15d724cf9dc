// Commands of the camera's lens: depth of field and shift.
#include <cmath>

#include "base/error.h"
#include "commands/command_list.h"
#include "commands/lens.h"
#include "commands/navigation.h"
#include "commands/open_scene.h"
#include "scene/range.h"
#include "session/pick.h"

namespace lucerna::commands {
namespace {

constexpr float k_degree = k_pi / 180;

/// Depth along the view axis of the surface at a place in the picture; nullopt: there is none.
std::optional<float> depth_at(const scene::Scene& scene, const scene::Camera& camera, float right, float down,
                              float aspect) {
  const auto hit = session::pick(scene, camera, right, down, aspect);
  if (!hit) return std::nullopt;
  return glm::dot(hit->position - eye_of(camera), forward_of(camera));
}

void needs_perspective(const scene::Camera& camera, const char* what) {
  if (camera.orthographic) throw Error("", fmt::format("the camera is orthographic, without {}", what));
  if (!camera.perspective())
    throw Error("", fmt::format("the camera is a {}, without {}",
                                scene::k_projection_names[size_t(camera.wide)], what));
}

}  // namespace

std::vector<Parameter> lens_parameters() {
  const auto real = [](const char* name, const char* help, double lo, double hi, const char* unit) {
    return Parameter{
        .name = name, .type = Type::real, .help = help, .lo = lo, .hi = hi, .unit = unit, .optional = true};
  };
  return {
      real("f_number", "of a lens, for depth of field", scene::k_least_f_number, scene::k_max_f_number, ""),
      real("focus", "from the eye to the plane of focus, along the view axis", scene::k_least_focus,
           scene::k_max_coordinate, "m"),
      {.name = "blades",
       .type = Type::integer,
       .help = "corners of the aperture, at least 3; 0: round",
       .lo = 0,
       .hi = scene::k_max_blades,
       .optional = true},
      real("rotation", "of the aperture", -360, 360, "degrees"),
      {.name = "pinhole",
       .type = Type::boolean,
       .help = "true: no lens, everything is sharp",
       .optional = true},
      real("shift_right", "of the lens", -scene::k_max_shift, scene::k_max_shift, "picture widths"),
      real("shift_up", "of the lens", -scene::k_max_shift, scene::k_max_shift, "picture heights"),
      {.name = "section_normal",
       .type = Type::vector,
       .help = "of the plane that cuts the view, into the part that stays visible; 0,0,0: none",
       .lo = -1e9,
       .hi = 1e9,
       .optional = true},
      real("section_offset", "of that plane from the scene's origin, along its normal", -1e9, 1e9, "m"),
      {.name = "projection",
       .type = Type::choice,
       .help = "of a camera that is not orthographic",
       .choices = projection_names(),
       .optional = true}};
}

std::vector<std::string> projection_names() {
  return {std::begin(scene::k_projection_names), std::end(scene::k_projection_names)};
}

void set_projection(scene::Camera& camera, const std::string& name) {
  if (camera.orthographic)
    throw Error("", "the camera is orthographic; camera.place with fov makes it another");
  const std::vector<std::string> names = projection_names();
  camera.wide = scene::Wide(std::find(names.begin(), names.end(), name) - names.begin());
}

void set_lens(scene::Camera& camera, const Arguments& a) {
  scene::Lens& lens = camera.lens;
  if (a.has("blades") && (a.integer("blades") == 1 || a.integer("blades") == 2))
    throw Error("",
                fmt::format("blades: {}; expected 0, or 3 to {}", a.integer("blades"), scene::k_max_blades));
  const bool pinhole = a.has("pinhole") && a.boolean("pinhole");
  if (pinhole && a.has("f_number")) throw Error("", "pinhole and f_number exclude each other: give one");
  if (a.has("f_number")) lens.f_number = a.number("f_number");
  if (a.has("focus")) lens.focus_distance = a.number("focus");
  if (a.has("blades")) lens.blades = uint32_t(a.integer("blades"));
  if (a.has("rotation")) lens.rotation = k_degree * a.number("rotation");
  if (pinhole) lens.f_number = 0;
  if (a.has("projection")) set_projection(camera, a.text("projection"));
  if (a.has("shift_right")) camera.shift.x = a.number("shift_right");
  if (a.has("shift_up")) camera.shift.y = a.number("shift_up");
  if (a.has("section_offset")) camera.section.offset = a.number("section_offset");
  if (a.has("section_normal")) {
    const vec3 normal = a.vector("section_normal");
    if (glm::length(normal) > 1e-6f)
      camera.section.normal = glm::normalize(normal);
    else
      camera.section = {};
  }
}

void focus_somewhere(const OpenScene& open, Viewpoint& view, float aspect) {
  scene::Lens& lens = view.camera.lens;
  if (lens.f_number == 0 || lens.focus_distance > 0) return;
  const auto depth = open.scene ? depth_at(*open.scene, view.camera, 0.5f, 0.5f, aspect) : std::nullopt;
  lens.focus_distance = std::max(depth.value_or(view.distance), scene::k_least_focus);
}

std::string lens_words(const scene::Camera& camera) {
  const scene::Lens& lens = camera.lens;
  std::string text =
      " " + named("shift_right", camera.shift.x).text + " " + named("shift_up", camera.shift.y).text;
  text += " " + named("section_normal", camera.section.normal).text;
  if (camera.section.cuts()) text += " " + named("section_offset", camera.section.offset).text;
  if (camera.orthographic) return text;
  text += " " + named("projection", scene::k_projection_names[size_t(camera.wide)]).text;
  if (lens.f_number == 0) return text + " pinhole=true";
  text += " " + named("f_number", lens.f_number).text + " " + named("focus", lens.focus_distance).text;
  text += " " + named("blades", lens.blades).text;
  if (lens.blades != 0) text += " " + named("rotation", lens.rotation / k_degree).text;
  return text;
}

void add_lens_commands(Registry& registry, const OpenScene& open, Navigation& camera) {
  const auto add = [&](const char* name, const char* help, std::vector<Parameter> parameters,
                       std::function<void(Viewpoint&, const Arguments&)> act) {
    for (Parameter& p : parameters) p.optional = p.name == "rotation";
    registry.add({.name = name,
                  .help = help,
                  .parameters = std::move(parameters),
                  .run =
                      [&open, &camera, act = std::move(act)](const Arguments& a) {
                        camera.needs_view();
                        Viewpoint view = *camera.view;
                        needs_perspective(view.camera, "depth of field");
                        act(view, a);
                        focus_somewhere(open, view, camera.aspect);
                        camera.take_view(view);
                      },
                  .moves = true});
  };
  const std::vector<Parameter> all = lens_parameters();
  const auto set = [](Viewpoint& v, const Arguments& a) { set_lens(v.camera, a); };
  add("camera.f_number",
      "Gives the camera a lens: surfaces before and behind the plane of focus blur, the more the smaller the "
      "number. Focuses on the middle of the picture if no focus was set. The film is 36 mm wide.",
      {all[0]}, set);
  add("camera.pinhole", "Takes the camera's lens away: everything is sharp.", {},
      [](Viewpoint& v, const Arguments&) { v.camera.lens.f_number = 0; });
  add("camera.focus_distance", "Sets the distance of the plane of focus.", {all[1]}, set);
  add("camera.blades", "Sets the shape of the aperture: 0 is round, otherwise a regular polygon.",
      {all[2], all[3]}, set);
  add("camera.focus", "Focuses on the surface at a point of the picture.",
      {{.name = "right", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture widths"},
       {.name = "down", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture heights"}},
      [&open, &camera](Viewpoint& v, const Arguments& a) {
        open.needs_scene();
        const auto depth =
            depth_at(*open.scene, v.camera, a.number("right"), a.number("down"), camera.aspect);
        if (!depth) throw Error("", "there is no surface at that point to focus on");
        v.camera.lens.focus_distance = std::max(*depth, scene::k_least_focus);
      });
  const auto shift = [](Parameter p, const char* name) {
    p.name = name, p.optional = false;
    return p;
  };
  registry.add(
      {.name = "camera.shift",
       .help = "Shifts the lens: the picture's middle moves away from the view axis, and vertical lines stay "
               "parallel.",
       .parameters = {shift(all[5], "right"), shift(all[6], "up")},
       .run =
           [&camera](const Arguments& a) {
             camera.needs_view();
             Viewpoint view = *camera.view;
             view.camera.shift = {a.number("right"), a.number("up")};
             camera.take_view(view);
           },
       .moves = true});
  registry.add(
      {.name = "camera.upright",
       .help =
           "Levels the camera, so that vertical lines are vertical in the picture, and shifts the lens so "
           "that the picture's middle stays: two-point perspective.",
       .parameters = {},
       .run =
           [&camera](const Arguments&) {
             camera.needs_view();
             Viewpoint view = *camera.view;
             needs_perspective(view.camera, "a lens shift that levels it");
             if (!upright(view, camera.aspect))
               throw Error("", "the camera looks too steeply up or down, by more than 80 degrees");
             camera.take_view(view);
           },
       .moves = true});
  const auto part = [](const char* name, const char* help, const char* unit) {
    return Parameter{.name = name, .type = Type::vector, .help = help, .lo = -1e9, .hi = 1e9, .unit = unit};
  };
  registry.add(
      {.name = "camera.section",
       .help = "Cuts the view by a plane: the camera sees only what lies behind it. Light is not cut.",
       .parameters = {part("point", "of the plane", "m"),
                      part("normal", "of the plane, into the part that stays visible; any length", "")},
       .run =
           [&camera](const Arguments& a) {
             camera.needs_view();
             const vec3 normal = a.vector("normal");
             if (!(glm::length(normal) > 1e-6f)) throw Error("", "normal: its length is 0");
             Viewpoint view = *camera.view;
             scene::Section& section = view.camera.section;
             section.normal = glm::normalize(normal);
             section.offset = glm::dot(section.normal, a.vector("point"));
             camera.take_view(view);
           },
       .moves = true});
  registry.add({.name = "camera.no_section",
                .help = "Shows the whole view again, without a plane that cuts it.",
                .parameters = {},
                .run =
                    [&camera](const Arguments&) {
                      camera.needs_view();
                      Viewpoint view = *camera.view;
                      view.camera.section = {};
                      camera.take_view(view);
                    },
                .moves = true});
}

}  // namespace lucerna::commands
