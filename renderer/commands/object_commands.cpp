// Undoable commands that move, turn, size and hide objects.
#include <algorithm>

#include "base/error.h"
#include "commands/command_list.h"
#include "commands/light_words.h"
#include "commands/object_drop.h"
#include "commands/workspace.h"

namespace lucerna::commands {
namespace {

using scene::ObjectPlace;

Parameter which_object(const OpenScene& open) {
  return {.name = "object",
          .help = "its name, or its number from 1",
          .which = true,
          .names = [&open](const std::vector<std::string>&) {
            return open.scene ? given_names(open.scene->instances) : std::vector<std::string>();
          }};
}

Parameter three(const char* name, const char* help, const char* unit, double most) {
  return {.name = name,
          .type = Type::vector,
          .help = help,
          .lo = -most,
          .hi = most,
          .unit = unit,
          .optional = true};
}
Parameter metres(const char* name, const char* help) {
  return three(name, help, "m", double{scene::k_most_way});
}
Parameter degrees(const char* name, const char* help) { return three(name, help, "degrees", 36000); }
Parameter factors(const char* name, const char* help) {
  return three(name, help, "", double{scene::k_most_factor});
}

/// Throws Error if several of them are given, or none when the command runs.
void needs_one(const Arguments& a, std::initializer_list<const char*> names, bool runs) {
  std::string all;
  size_t given = 0;
  for (const char* name : names) given += a.has(name), all += (all.empty() ? "" : " or ") + std::string(name);
  if (given > 1 || (runs && given == 0))
    throw Error("", "expected " + all + (given == 0 ? "" : ", not several"));
}

/// Middle of its box where the file has it.
vec3 loaded_middle(const OpenScene& open, uint32_t index) {
  return scene::middle_of(open.object_box(index), open.loaded->instances[index].to_world);
}

void turn_to(ObjectPlace& place, const glm::dmat3& rotation) {
  place.turned = scene::angles_of(rotation, place.turned);
}

/// Changes the place of the object that the arguments name.
template <class Change>
auto changing(OpenScene& open, Change change) {
  return [&open, change = std::move(change)](const Arguments& a) {
    const uint32_t index = open.object_index(a.text("object"));
    ObjectPlace place = open.edited_object(index);
    change(a, index, place);
    open.put_object(index, place);
  };
}

void add_place_commands(Registry& registry, OpenScene& open) {
  registry.add(
      {.name = "object.set",
       .help = "Puts an object somewhere, turns, sizes or hides it. Omitted values stay unchanged.",
       .parameters = {which_object(open),
                      metres("position", "where the middle of its box is"),
                      degrees("rotation", "about x, y (up) and z, relative to its file: z first, y last"),
                      factors("scale", "along its own axes, relative to its file"),
                      {.name = "visible", .type = Type::boolean, .optional = true}},
       .run = changing(open,
                       [&open](const Arguments& a, uint32_t index, ObjectPlace& place) {
                         if (a.has("position"))
                           place.moved = a.vector("position") - loaded_middle(open, index);
                         take(a, "rotation", place.turned);
                         take(a, "scale", place.scaled);
                         if (a.has("visible")) place.hidden = !a.boolean("visible");
                       }),
       .undoable = true});
  registry.add(
      {.name = "object.move",
       .help = "Moves an object by a way, or the middle of its box to a point.",
       .parameters = {which_object(open), metres("by", "way of the move"), metres("to", "its new place")},
       .check =
           [](const Arguments& a) {
             needs_one(a, {"by", "to"}, false);
           },
       .run = changing(open,
                       [&open](const Arguments& a, uint32_t index, ObjectPlace& place) {
                         needs_one(a, {"by", "to"}, true);
                         if (a.has("by"))
                           place.moved += a.vector("by");
                         else
                           place.moved = a.vector("to") - loaded_middle(open, index);
                       }),
       .undoable = true});
  registry.add(
      {.name = "object.turn",
       .help = "Turns an object about the middle of its box: by angles about the world's axes, or to "
               "angles relative to its file.",
       .parameters = {which_object(open), degrees("by", "about x, y (up) and z: z first, y last"),
                      degrees("to", "likewise")},
       .check =
           [](const Arguments& a) {
             needs_one(a, {"by", "to"}, false);
           },
       .run = changing(open,
                       [](const Arguments& a, uint32_t, ObjectPlace& place) {
                         needs_one(a, {"by", "to"}, true);
                         if (a.has("to"))
                           place.turned = a.vector("to");
                         else
                           turn_to(place,
                                   scene::rotation_of(a.vector("by")) * scene::rotation_of(place.turned));
                       }),
       .undoable = true});
  registry.add({.name = "object.scale",
                .help =
                    "Sizes an object about the middle of its box: by one factor, by factors along its own "
                    "axes, or to factors relative to its file. Negative ones mirror it.",
                .parameters = {which_object(open),
                               factors("by", ""),
                               factors("to", ""),
                               {.name = "factor",
                                .type = Type::real,
                                .help = "along all axes",
                                .lo = -double{scene::k_most_factor},
                                .hi = double{scene::k_most_factor},
                                .optional = true}},
                .check =
                    [](const Arguments& a) {
                      needs_one(a, {"by", "to", "factor"}, false);
                    },
                .run = changing(open,
                                [](const Arguments& a, uint32_t, ObjectPlace& place) {
                                  needs_one(a, {"by", "to", "factor"}, true);
                                  if (a.has("factor"))
                                    place.scaled *= a.number("factor");
                                  else if (a.has("by"))
                                    place.scaled *= a.vector("by");
                                  else
                                    place.scaled = a.vector("to");
                                }),
                .undoable = true});
}

void add_drop_command(Workspace& work) {
  work.registry.add({.name = "object.drop",
                     .help = "Lowers an object onto the surface below it.",
                     .parameters = {which_object(work.open)},
                     .run = changing(work.open,
                                     [&work](const Arguments&, uint32_t index, ObjectPlace& place) {
                                       const session::Probe* probe = work.camera.probe(true);
                                       if (!probe) throw Error("", "the scene cannot be traced for it");
                                       const auto way =
                                           way_down(*probe, index, work.open.object_matrix(index, place));
                                       if (!way) throw Error("", "there is no surface below it");
                                       place.moved.y -= *way;
                                     }),
                     .undoable = true,
                     .needs_outcome = true});
}

void add_visibility_commands(Registry& registry, OpenScene& open) {
  registry.add(
      {.name = "object.hide",
       .help = "Hides an object: it has no surface until it is shown.",
       .parameters = {which_object(open)},
       .run = changing(open, [](const Arguments&, uint32_t, ObjectPlace& place) { place.hidden = true; }),
       .undoable = true});
  Parameter one = which_object(open);
  one.optional = true;
  registry.add({.name = "object.show",
                .help = "Shows a hidden object; without one, all of them.",
                .parameters = {one},
                .run =
                    [&open](const Arguments& a) {
                      open.needs_scene();
                      const auto count = static_cast<uint32_t>(open.scene->instances.size());
                      const uint32_t first = a.has("object") ? open.object_index(a.text("object")) : 0;
                      for (uint32_t i = first; i < (a.has("object") ? first + 1 : count); ++i) {
                        ObjectPlace place = open.edited_object(i);
                        if (!std::exchange(place.hidden, false)) continue;
                        open.put_object(i, place);
                      }
                    },
                .undoable = true});
  registry.add(
      {.name = "object.reset",
       .help = "Puts an object back as its file has it.",
       .parameters = {which_object(open)},
       .run = [&open](const Arguments& a) { open.edit().objects.erase(open.object_index(a.text("object"))); },
       .undoable = true});
}

}  // namespace

void add_object_commands(Workspace& work) {
  add_place_commands(work.registry, work.open);
  add_drop_command(work);
  add_visibility_commands(work.registry, work.open);
}

}  // namespace lucerna::commands
