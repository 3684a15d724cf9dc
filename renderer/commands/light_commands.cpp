// Undoable commands that change lights, and the list of lights.
#include <algorithm>

#include "base/error.h"
#include "base/log.h"
#include "commands/command_list.h"
#include "commands/highlight.h"
#include "commands/light_placement.h"
#include "commands/light_words.h"
#include "commands/sky_follow.h"
#include "commands/workspace.h"
#include "scene/lamp.h"
#include "scene/light_groups.h"

namespace lucerna::commands {
namespace {

constexpr size_t k_most_lights = 4096, k_longest_name = 64;

Parameter which_light(const OpenScene& open) {
  return {.name = "light",
          .help = "its name, or its number from 1",
          .which = true,
          .names = [&open](const std::vector<std::string>&) { return given_names(open.lights()); }};
}

Parameter name_parameter(const char* help, bool optional) {
  return {.name = "name", .help = help, .optional = optional};
}

Parameter point(const char* name, const char* help) {
  return {
      .name = name, .type = Type::vector, .help = help, .lo = -1e6, .hi = 1e6, .unit = "m", .optional = true};
}

bool has_name(const std::vector<scene::Light>& lights, const std::string& name) {
  return std::any_of(lights.begin(), lights.end(), [&](const scene::Light& l) { return l.name == name; });
}

/// The name, or the name with the first free number.
std::string free_name(const std::vector<scene::Light>& lights, const std::string& base) {
  if (!has_name(lights, base)) return base;
  for (int n = 2;; ++n)
    if (std::string name = fmt::format("{} {}", base, n); !has_name(lights, name)) return name;
}

void check_name(const std::vector<scene::Light>& lights, const std::string& name) {
  if (name.find_first_not_of(" \t") == std::string::npos) throw Error("", "name: it is empty");
  if (name.size() > k_longest_name)
    throw Error("", fmt::format("name: {} bytes are too long; at most {}", name.size(), k_longest_name));
  if (has_name(lights, name)) throw Error("", fmt::format("name: there is a light '{}' already", name));
}

/// Appends a light with a new id and selects it.
void append(Workspace& work, scene::Light light) {
  std::vector<scene::Light>& lights = work.open.edit().lights;
  if (lights.size() >= k_most_lights)
    throw Error("", fmt::format("the scene has {} lights, and at most that many", lights.size()));
  light.id = work.open.new_light_id();
  lights.push_back(std::move(light));
  work.camera.selection = {Kind::light, static_cast<uint32_t>(lights.size() - 1)};
}

/// What the view shows, for placing lights. Throws Error without a picture.
Room room_of(Workspace& work) {
  work.camera.needs_view();
  work.camera.probe(true);
  return {*work.camera.view, work.camera.look(), work.camera.core,
          static_cast<float>(work.open.setting_real("film.ev"))};
}

/// A kind of light in light.add, and the name of the first one.
struct NewKind {
  const char* word;
  scene::LightKind kind;
  const char* name;
};
constexpr NewKind k_new_kinds[] = {{"point", scene::LightKind::point, "Lamp"},
                                   {"spot", scene::LightKind::spot, "Spot"},
                                   {"sun", scene::LightKind::directional, "Sun"},
                                   {"sphere", scene::LightKind::sphere, "Globe"},
                                   {"rectangle", scene::LightKind::rectangle, "Panel"},
                                   {"disk", scene::LightKind::disk, "Disk"},
                                   {"tube", scene::LightKind::tube, "Tube"},
                                   {"profile", scene::LightKind::point, "Fixture"}};

scene::Light new_light(Workspace& work, const Arguments& a) {
  scene::Light light;
  const NewKind& kind = *std::find_if(std::begin(k_new_kinds), std::end(k_new_kinds),
                                      [&](const NewKind& k) { return a.text("kind") == k.word; });
  light.kind = kind.kind;
  const std::vector<scene::Light>& lights = work.open.edit().lights;
  light.name = free_name(lights, kind.name);
  if (a.has("name")) check_name(lights, a.text("name")), light.name = a.text("name");
  const Room room = room_of(work);
  place_new(room, lights, light);
  if (a.text("kind") == "profile") {
    if (!a.has("profile")) throw Error("", "profile: its file is missing");
    const vec3 way = looked_at(room).point - light.position;
    if (glm::length(way) > 0) light.direction = vec3(glm::normalize(glm::dvec3(way)));
  }
  apply_light_words(a, light, work.open.light_unit.distance);
  return light;
}

void add_light_list_commands(Workspace& work) {
  std::vector<Parameter> parameters = light_parameters();
  std::vector<std::string> kinds;
  for (const NewKind& kind : k_new_kinds) kinds.emplace_back(kind.word);
  parameters.insert(parameters.begin(), {{.name = "kind", .type = Type::choice, .choices = std::move(kinds)},
                                         name_parameter("of the light; without one, it is numbered", true)});
  work.registry.add(
      {.name = "light.add",
       .help =
           "Adds a light and selects it. A lamp appears at the surface in the middle of the picture, some "
           "distance off, a spot or a shape aimed at it; its power suits the room and the exposure.",
       .parameters = std::move(parameters),
       .check = check_light_words,
       .run =
           [&work](const Arguments& a) {
             work.open.needs_scene();
             append(work, new_light(work, a));
           },
       .undoable = true});
  work.registry.add(
      {.name = "light.duplicate",
       .help = "Adds a copy of a light beside it and selects it.",
       .parameters = {which_light(work.open),
                      name_parameter("of the copy; without one, it is numbered", true),
                      point("by", "from the light to its copy; without it, to the right of the view")},
       .run =
           [&work](const Arguments& a) {
             scene::Light copy = work.open.edit().lights[work.open.light_index(a.text("light"))];
             const std::vector<scene::Light>& lights = work.open.edit().lights;
             if (a.has("name")) check_name(lights, a.text("name"));
             copy.name = a.has("name") ? a.text("name") : free_name(lights, scene::kind_of_light(copy.name));
             const bool sun = copy.kind == scene::LightKind::directional;
             if (a.has("by") && sun) throw Error("", "by: a sun is infinitely far");
             if (!sun) copy.position += a.has("by") ? a.vector("by") : beside(room_of(work));
             append(work, std::move(copy));
           },
       .undoable = true});
  work.registry.add({.name = "light.delete",
                     .help = "Removes a light from the scene.",
                     .parameters = {which_light(work.open)},
                     .run =
                         [&work](const Arguments& a) {
                           const uint32_t index = work.open.light_index(a.text("light"));
                           std::vector<scene::Light>& lights = work.open.edit().lights;
                           lights.erase(lights.begin() + index);
                         },
                     .undoable = true});
}

void add_light_label_commands(Registry& registry, OpenScene& open) {
  registry.add({.name = "light.rename",
                .help = "Gives a light another name.",
                .parameters = {which_light(open), name_parameter("its new name", false)},
                .run =
                    [&open](const Arguments& a) {
                      scene::Light& light = open.edit().lights[open.light_index(a.text("light"))];
                      if (light.name == a.text("name")) return;
                      check_name(open.edit().lights, a.text("name"));
                      light.name = a.text("name");
                    },
                .undoable = true});
  registry.add({.name = "light.group",
                .help = "Puts a light into a light group; without a group, into that of its kind.",
                .parameters = {which_light(open),
                               {.name = "group",
                                .help = "name of the group, which need not exist",
                                .optional = true,
                                .names =
                                    [&open](const std::vector<std::string>&) {
                                      return names_of(open.light_groups().groups);
                                    }}},
                .run =
                    [&open](const Arguments& a) {
                      open.edit().lights[open.light_index(a.text("light"))].group =
                          a.has("group") ? scene::group_name(a.text("group")) : "";
                    },
                .undoable = true});
}

/// The unit of the window and of 'light LIGHT lx'. No light changes.
void add_unit_command(Registry& registry, OpenScene& open) {
  std::vector<std::string> words;
  for (const scene::LightUnitInfo& info : scene::k_unit_table) words.emplace_back(info.word);
  registry.add({.name = "light.unit",
                .help = "Chooses the unit in which strengths of lights are shown; lights without it show "
                        "another. Changes no light.",
                .parameters = {{.name = "unit", .type = Type::choice, .choices = std::move(words)},
                               {.name = "distance",
                                .type = Type::real,
                                .help = "at which lx are shown, from the lamp's middle",
                                .lo = 1e-3,
                                .hi = 1e4,
                                .unit = "m",
                                .optional = true}},
                .run = [&open](const Arguments& a) {
                  open.light_unit.unit = *scene::unit_named(a.text("unit"));
                  take(a, "distance", open.light_unit.distance);
                }});
}

void add_light_place_commands(Workspace& work) {
  work.registry.add(
      {.name = "light.aim_at",
       .help = "Points a spot, rectangle, disk or profile at a point; without one, at the surface in the "
               "middle of "
               "the picture.",
       .parameters = {which_light(work.open), point("at", "a point of the scene")},
       .run =
           [&work](const Arguments& a) {
             scene::Light& light = work.open.edit().lights[work.open.light_index(a.text("light"))];
             if (!can_be_aimed(light))
               throw Error("", fmt::format("a {} cannot be aimed at a point", kind_of(light)));
             const glm::dvec3 way((a.has("at") ? a.vector("at") : looked_at(room_of(work)).point) -
                                  light.position);
             if (!(glm::length(way) > 1e-6)) throw Error("", "at: the light is there itself");
             turn_to(light, vec3(glm::normalize(way)));
           },
       .undoable = true});
  work.registry.add(
      {.name = "light.move",
       .help = "Moves a lamp by a way, or to a point; without either, to the surface in the middle of the "
               "picture, some distance off.",
       .parameters = {which_light(work.open), point("by", "way of the move"), point("to", "its new place")},
       .check = [](const Arguments& a) { exclude(a, "by", "to"); },
       .run =
           [&work](const Arguments& a) {
             scene::Light& light = work.open.edit().lights[work.open.light_index(a.text("light"))];
             if (light.kind == scene::LightKind::directional)
               throw Error("", "a sun is infinitely far: azimuth and elevation say where");
             if (a.has("by"))
               light.position += a.vector("by");
             else
               light.position = a.has("to") ? a.vector("to") : off_surface(room_of(work));
           },
       .undoable = true});
  const auto place = [](const char* name, const char* unit) {
    return Parameter{.name = name, .type = Type::real, .lo = 0, .hi = 1, .unit = unit};
  };
  work.registry.add(
      {.name = "light.highlight",
       .help = "Moves a light so that its highlight is at a point of the picture: a lamp keeps its distance "
               "from the surface there if the room has it, a sun loses its date. A light with a direction is "
               "aimed at the surface.",
       .parameters = {which_light(work.open), place("right", "picture widths"),
                      place("down", "picture heights")},
       .run =
           [&work](const Arguments& a) {
             scene::Light& light = work.open.edit().lights[work.open.light_index(a.text("light"))];
             work.camera.needs_view();
             const session::Probe* probe = work.camera.probe(true);
             if (!probe) throw Error("", "the scene's surfaces are not known");
             const scene::Light before = light;
             const bool free = place_highlight(*probe,
                                               session::pick_ray(work.camera.view->camera, a.number("right"),
                                                                 a.number("down"), work.camera.aspect),
                                               light);
             if (!free)
               log::info("light '{}' is nearer to its highlight now: something is in the way", light.name);
             if (light.kind == scene::LightKind::directional && light.direction.y > 0)
               log::warning("sun '{}' shines from below the horizon", light.name);
             follow_sun(work.open, before, light);
           },
       .undoable = true});
}

}  // namespace

void add_light_commands(Workspace& work) {
  std::vector<Parameter> parameters = light_parameters();
  parameters.insert(parameters.begin(), which_light(work.open));
  work.registry.add({.name = "light.set",
                     .help = "Changes a light of the scene. Omitted values stay unchanged.",
                     .parameters = std::move(parameters),
                     .check = check_light_words,
                     .run =
                         [&open = work.open](const Arguments& a) {
                           scene::Light& light = open.edit().lights[open.light_index(a.text("light"))];
                           const scene::Light before = light;
                           apply_light_words(a, light, open.light_unit.distance);
                           follow_sun(open, before, light);
                         },
                     .undoable = true});
  add_light_list_commands(work);
  add_light_label_commands(work.registry, work.open);
  add_unit_command(work.registry, work.open);
  add_light_place_commands(work);
}

}  // namespace lucerna::commands
