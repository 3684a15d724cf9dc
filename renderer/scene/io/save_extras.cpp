#include <algorithm>
#include <map>

#include "base/file.h"
#include "scene/io/own_extras.h"
#include "scene/io/save_parts.h"

namespace lucerna::scene {
namespace {

bool same_environment(const Environment& a, const Environment& b) {
  return a.radiance == b.radiance && a.image == b.image && a.scale == b.scale && a.rotation == b.rotation &&
         a.file == b.file && a.sky == b.sky;
}

EditedJson environment_json(const Environment& e, const Environment& loaded, const Folders& folders) {
  EditedJson json = EditedJson::object();
  if (e.sky)
    json["sky"] = {{"kind", name_of(e.sky->kind)},
                   {"turbidity", number_json(e.sky->turbidity)},
                   {"ground", number_json(e.sky->ground)},
                   {"to_sun", vector_json(e.sky->to_sun)},
                   {"unit", "cd/m2"}};
  else if (e.image != k_none && e.image == loaded.image)
    json["file"] = moved_uri(e.file, folders);  // as the scene names it
  else if (e.image != k_none)
    json["file"] = uri_of(absolute_path(e.file), folders.to);
  else
    json["radiance"] = vector_json(e.radiance);
  json["scale"] = number_json(e.scale);
  json["rotation"] = number_json(e.rotation);
  return json;
}

/// True if the file itself says the same, in a way that holds in every folder.
bool says(const EditedJson& scene, const EditedJson& environment) {
  const auto extras = scene.find("extras");
  if (extras == scene.end() || !extras->is_object()) return false;
  const auto own = extras->find("lucerna");
  const bool ours = own != extras->end() && own->is_object() && own->contains("environment");
  const EditedJson& holder = ours ? *own : *extras;
  if (!holder.contains("environment")) return false;
  EditedJson named = holder["environment"];
  if (!named.is_object() || named.contains("file")) return false;
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
    EditedJson environment = environment_json(after, before, folders);
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
