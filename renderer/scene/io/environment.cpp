#include "scene/io/environment.h"

#include <cmath>

#include "base/json_text.h"
#include "scene/io/images.h"
#include "scene/io/nodes.h"
#include "scene/io/own_extras.h"
#include "scene/sky_image.h"

namespace lucerna::scene {
namespace {

void read_environment(Document& document, Scene& scene, const Item& item, bool strict) {
  const auto file = item.find("file");
  const auto radiance = item.find("radiance");
  const auto sky = item.find("sky");
  if (strict) {
    for (const auto& [key, value] : item.json().items())
      if (key != "file" && key != "radiance" && key != "sky" && key != "scale" && key != "rotation")
        item.at(key.c_str()).fail("unknown key; known are radiance, file, sky, scale, rotation");
    if (int(file.has_value()) + int(radiance.has_value()) + int(sky.has_value()) > 1)
      item.fail("'radiance', 'file' and 'sky' exclude each other");
    if (!file && !radiance && !sky) item.fail("expected 'radiance', 'file' or 'sky'");
  } else if (!file && !radiance && !sky) {
    document.warnings.add("{} environment with neither 'file' nor 'radiance': ignored", item.path());
    return;
  }
  Environment environment;
  environment.scale = static_cast<float>(item.number("scale", 1));
  if (environment.scale < 0) item.at("scale").fail("{} is negative", environment.scale);
  environment.rotation = static_cast<float>(std::remainder(item.number("rotation", 0), 360.0));
  if (file) {
    if (!is_data_uri(file->text())) environment.file = file->text();
    document.progress(0.95f, "environment");
    Image image = decode_image(uri_bytes(document, *file), environment.file, file->where(),
                               Precision::linear_floats, document.budget);
    check_environment_shape(image, file->where());
    image.name = environment.file.empty() ? "environment" : environment.file;
    if (const size_t mended = mend_texels(image))
      document.warnings.add("{} texel values of the environment that are negative or not finite: replaced",
                            image.name, mended);
    environment.image = static_cast<Id>(scene.images.size());
    scene.images.push_back(std::move(image));
  } else if (sky) {
    environment.sky = read_sky(*sky);
    environment.scale *= sky_unit(*sky);
    environment.image = static_cast<Id>(scene.images.size());
    scene.images.push_back(sky_image(*environment.sky));
  } else {
    environment.radiance = radiance->rgb();
    if (glm::any(glm::lessThan(environment.radiance, vec3(0)))) radiance->fail("radiance is negative");
  }
  environment.given = true;
  scene.environment = std::move(environment);
}

// {"film": {"ev": 1}} and {"film.ev": 1} both become ("film.ev", "1").
void flatten(const nlohmann::ordered_json& object, const std::string& prefix, const std::string& file,
             Scene& scene) {
  for (const auto& [key, value] : object.items()) {
    if (prefix.empty() && key == "environment") continue;
    const std::string name = prefix.empty() ? key : prefix + "." + key;
    if (value.is_object())
      flatten(value, name, file, scene);
    else if (value.is_string())
      scene.settings.emplace_back(name, value.get<std::string>());
    else if (value.is_boolean() || value.is_number())
      scene.settings.emplace_back(name, json_text(value));
    else
      throw_error(file + ": " + name, "expected a number, a string, true or false, found {}",
                  value.type_name());
  }
}

}  // namespace

bool load_settings(Document& document, Scene& scene) {
  const std::filesystem::path path = document.folder / "settings.json";
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return false;
  const std::string file = path.string();
  require_inside(document, path, file);
  const std::vector<uint8_t> bytes = read_file(document, path, file);
  const char* text = reinterpret_cast<const char*>(bytes.data());
  const nlohmann::json json = parse_json(file, text, text + bytes.size());
  const Item root(file, json);
  root.object();
  // Once more, keeping the order of keys: settings are applied in it.
  flatten(nlohmann::ordered_json::parse(bytes.begin(), bytes.end()), {}, file, scene);
  const auto environment = own_environment(document) ? std::nullopt : root.find("environment");
  if (environment) read_environment(document, scene, environment->object(), true);
  return environment.has_value();
}

void load_extras_environment(Document& document, Scene& scene) {
  if (const auto own = own_environment(document)) return read_environment(document, scene, *own, true);
  const auto source = default_scene(document);
  const auto extras = source ? source->find("extras") : std::nullopt;
  if (!extras || !extras->json().is_object()) return;
  if (const auto environment = extras->find("environment"))
    read_environment(document, scene, environment->object(), false);
}

}  // namespace lucerna::scene
