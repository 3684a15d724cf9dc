// The environment and the render settings: the scene's extras, then settings.json beside it.
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/io/document.h"

namespace lucerna::scene::io {
namespace {

using nlohmann::ordered_json;

ordered_json to_json(const tinygltf::Value& v) {
  if (v.IsBool()) return v.Get<bool>();
  if (v.IsNumber()) return v.GetNumberAsDouble();
  if (v.IsString()) return v.Get<std::string>();
  ordered_json out;
  if (v.IsArray()) {
    out = ordered_json::array();
    for (size_t i = 0; i < v.ArrayLen(); ++i) out.push_back(to_json(v.Get(int(i))));
  } else if (v.IsObject()) {
    out = ordered_json::object();
    for (const std::string& key : v.Keys()) out[key] = to_json(v.Get(key));
  }
  return out;
}

double number(const ordered_json& j, const std::string& where) {
  if (!j.is_number() || !std::isfinite(j.get<double>())) throw Error(where, "expected a number");
  return j.get<double>();
}

/// {"radiance": [r,g,b]} or {"file": "x.exr", "scale": 1, "rotation": 0}
void read_environment(const ordered_json& j, const std::filesystem::path& folder, const std::string& where, bool strict, Scene& scene) {
  if (!j.is_object()) throw Error(where, "expected an object with \"radiance\" or \"file\"");
  Environment e;
  std::string file;
  for (const auto& [key, value] : j.items()) {
    const std::string at = where + "." + key;
    if (key == "radiance") {
      if (!value.is_array() || value.size() != 3) throw Error(at, "expected [r, g, b]");
      for (int k = 0; k < 3; ++k) e.radiance[k] = float(number(value[size_t(k)], at));
      if (e.radiance.x < 0 || e.radiance.y < 0 || e.radiance.z < 0) throw Error(at, "radiance cannot be negative");
    } else if (key == "file") {
      if (!value.is_string()) throw Error(at, "expected the name of an image");
      file = value.get<std::string>();
    } else if (key == "scale") {
      e.scale = float(number(value, at));
      if (e.scale < 0) throw Error(at, "cannot be negative");
    } else if (key == "rotation") {
      e.rotation = float(number(value, at));
    } else if (strict) {
      throw_error(where, "unknown key '{}'; known are radiance, file, scale, rotation", key);
    }
  }
  if (file.empty() && !j.contains("radiance")) {
    if (strict) throw Error(where, "needs \"radiance\" or \"file\"");
    return;
  }
  if (!file.empty()) {
    Image image = read_float_image(folder / file);
    e.image = Id(scene.images.size());
    e.file = file;
    scene.images.push_back(std::move(image));
  }
  scene.environment = e;
}

/// {"film": {"ev": 1}} and {"film.ev": 1} both become ("film.ev", "1").
void flatten(const ordered_json& j, const std::string& prefix, const std::string& where, Scene& scene) {
  for (const auto& [key, value] : j.items()) {
    const std::string name = prefix.empty() ? key : prefix + "." + key;
    if (prefix.empty() && key == "environment") continue;
    if (value.is_object()) flatten(value, name, where, scene);
    else if (value.is_string()) scene.settings.emplace_back(name, value.get<std::string>());
    else if (value.is_number() || value.is_boolean()) scene.settings.emplace_back(name, value.dump());
    else throw Error(where + ": " + name, "expected a number, a string, true or false");
  }
}

}  // namespace

void load_settings(Document& d, Scene& scene) {
  const std::filesystem::path folder = d.file.parent_path();
  const std::filesystem::path settings = folder / "settings.json";
  ordered_json json;
  if (std::filesystem::is_regular_file(settings)) {
    std::ifstream in(settings);
    try {
      json = ordered_json::parse(in);
    } catch (const std::exception& e) { throw_error(settings.string(), "is not valid JSON: {}", e.what()); }
    if (!json.is_object()) throw Error(settings.string(), "expected a JSON object");
  }
  const int shown = d.model.defaultScene >= 0 ? d.model.defaultScene : 0;
  if (json.contains("environment")) {
    read_environment(json["environment"], folder, settings.string() + ": environment", true, scene);
  } else if (size_t(shown) < d.model.scenes.size()) {
    const tinygltf::Value& extras = d.model.scenes[shown].extras;
    if (extras.IsObject() && extras.Has("environment"))
      read_environment(to_json(extras.Get("environment")), folder, d.file.filename().string() + ": scenes[].extras.environment", false, scene);
  }
  if (!json.is_null()) flatten(json, "", settings.string(), scene);
}

}  // namespace lucerna::scene::io
