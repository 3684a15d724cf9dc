// The verb convert: a scene as another .gltf or .glb file, without a device.
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "app/verbs.h"
#include "base/error.h"
#include "scene/io/save.h"

namespace lucerna::app {
namespace {

/// All settings that the scene's files set; the last one of a key counts.
std::vector<std::pair<std::string, std::string>> settings_of(const scene::Scene& scene) {
  std::map<std::string, std::string> all;
  for (const auto* list : {&scene.settings, &scene.own_settings})
    for (const auto& [key, value] : *list) all[key] = value;
  return {all.begin(), all.end()};
}

}  // namespace

int convert(const ConvertArguments& a) {
  std::error_code error;
  const bool same = std::filesystem::equivalent(a.scene, a.output, error) && !error;
  if (same && !a.replace) throw Error(a.output, "is the scene itself; --replace writes over it");
  const auto scene = std::make_shared<const scene::Scene>(scene::load(a.scene, a.scenes));
  const scene::SavedScene saved = scene::save({.loaded = scene,
                                               .edited = scene,
                                               .settings = settings_of(*scene),
                                               .file = a.output,
                                               .replace = true,
                                               .outside = a.scenes.outside});
  for (const std::string& note : saved.notes) std::fprintf(stderr, "lucerna: %s\n", note.c_str());
  return 0;
}

}  // namespace lucerna::app
