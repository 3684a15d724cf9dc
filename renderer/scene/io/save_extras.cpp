#include <algorithm>
#include <map>

#include "base/base64.h"
#include "base/file.h"
#include "scene/io/own_extras.h"
#include "scene/io/save_parts.h"

namespace lucerna::scene {
namespace {

bool same_environment(const Environment& a, const Environment& b) {
  return a.radiance == b.radiance && a.image == b.image && a.scale == b.scale && a.rotation == b.rotation &&
         a.file == b.file && a.sky == b.sky;
}

/// `own`: what the file has; `embeds`: an image becomes data.
EditedJson environment_json(const Environment& e, const Environment& loaded, const Folders& folders,
                            const EditedJson& own, bool embeds) {
  EditedJson json = EditedJson::object();
  const bool image = !e.sky && e.image != k_none,
             is_data = image && e.image == loaded.image && e.file.empty();
  if (is_data)
    json["file"] = own.at("file");
  else if (image && embeds)
    json["file"] = "data:application/octet-stream;base64," +
                   base64(lucerna::read_file(e.image == loaded.image ? file_of(e.file, folders.from)
                                                                     : std::filesystem::path(e.file)));
  else if (e.sky)
    json["sky"] = {{"kind", name_of(e.sky->kind)},
                   {"turbidity", number_json(e.sky->turbidity)},
                   {"ground", number_json(e.sky->ground)},
                   {"to_sun", vector_json(e.sky->to_sun)},
                   {"unit", "cd/m2"}};
  else if (image && e.image == loaded.image)
    json["file"] = moved_uri(e.file, folders);  // as the scene names it
  else if (image)
    json["file"] = uri_of(absolute_path(e.file), folders.to);
  else
    json["radiance"] = vector_json(e.radiance);
  json["scale"] = number_json(e.scale);
  json["rotation"] = number_json(e.rotation);
  return json;
}

/// The environment that the file names; an empty object: none.
EditedJson own_environment(const EditedJson& scene) {
  for (const char* path : {"/extras/lucerna/environment", "/extras/environment"})
    if (const EditedJson::json_pointer pointer(path); scene.contains(pointer) && scene[pointer].is_object())
      return scene[pointer];
  return EditedJson::object();
}

/// True if the file itself says the same, in a way that holds in every folder.
bool says(const EditedJson& scene, const EditedJson& environment) {
  EditedJson named = own_environment(scene);
  if (named.empty() || named.contains("file")) return false;
  if (!named.contains("scale")) named["scale"] = 1;
  if (!named.contains("rotation")) named["rotation"] = 0;
  return std::all_of(environment.items().begin(), environment.items().end(), [&](const auto& item) {
    return named.contains(item.key()) && named[item.key()] == item.value();
  });
}

/// The settings that reading gives without extras.lucerna.settings.
std::map<std::string, std::string> settings_beside(const SaveRequest& request, const Folders& folders) {
  std::map<std::string, std::string> all;
  if (folders.same())
    for (const auto& [key, value] : request.loaded->settings) all[key] = value;
  return all;
}

}  // namespace

void write_scene_extras(EditedJson& root, const SaveRequest& request, const Folders& folders) {
  const Environment &before = request.loaded->environment, &after = request.edited->environment;
  // Elsewhere there is no settings.json to name it.
  const bool elsewhere = after.given && !folders.same();
  if (elsewhere || !same_environment(before, after)) {
    EditedJson environment = environment_json(after, before, folders, own_environment(default_scene(root)),
                                              request.file.extension() == ".glb");
    if (!elsewhere || !says(default_scene(root), environment))
      set_own(default_scene(root), "environment", std::move(environment));
  }
  const auto beside = settings_beside(request, folders);
  EditedJson settings = EditedJson::object();
  for (const auto& [key, value] : request.settings)
    if (const auto found = beside.find(key); found == beside.end() || found->second != value)
      settings[key] = value;
  const auto& had = request.loaded->own_settings;
  const bool same = had.size() == settings.size() && std::all_of(had.begin(), had.end(), [&](const auto& s) {
                      const auto found = settings.find(s.first);
                      return found != settings.end() && *found == s.second;
                    });
  if (same) return;
  if (settings.empty())
    remove_own(default_scene(root), "settings");
  else
    set_own(default_scene(root), "settings", std::move(settings));
}

}  // namespace lucerna::scene
