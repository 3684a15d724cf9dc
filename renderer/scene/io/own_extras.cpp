#include "scene/io/own_extras.h"

#include <array>
#include <cmath>

#include "base/json_text.h"
#include "scene/io/nodes.h"
#include "scene/lamp.h"
#include "scene/range.h"
#include "scene/sky_image.h"
#include "scene/solar.h"

namespace lucerna::scene {
namespace {

constexpr std::array<const char*, 3> k_sky_names{"preetham", "cie_clear", "cie_overcast"};

/// extras.lucerna, if it is an object.
std::optional<Item> own_extras(const Item& item) {
  const auto extras = item.find("extras");
  if (!extras || !extras->json().is_object()) return std::nullopt;
  auto own = extras->find("lucerna");
  if (!own || !own->json().is_object()) return std::nullopt;
  return own;
}

vec3 finite_not_negative(const Item& item) {
  const vec3 value = item.rgb();
  for (int i = 0; i < 3; ++i)
    if (!(value[i] >= 0 && value[i] < k_infinity)) item.fail("{} is not positive and finite", value[i]);
  return value;
}

SunTime read_sun(const Item& item) {
  SunTime time;
  parse_date(item.at("date").text(), item.at("date").where(), time);
  time.hours = item.at("time").number();
  time.zone = item.number("zone", 0);
  time.latitude = item.at("latitude").number();
  time.longitude = item.at("longitude").number();
  time.north = item.number("north", 0);
  check_range(time, item.where());
  return time;
}

}  // namespace

const char* name_of(SkyKind kind) { return k_sky_names[static_cast<size_t>(kind)]; }

std::optional<glm::dmat4> own_matrix(const Item& node, const char* key) {
  const auto own = own_extras(node);
  const auto found = own ? own->find(key) : std::nullopt;
  if (!found) return std::nullopt;
  if (found->size() != 16) found->fail("{} numbers, expected 16", found->size());
  glm::dmat4 m;
  for (size_t i = 0; i < 16; ++i) {
    const double value = found->at(i).number();
    if (!std::isfinite(value)) found->at(i).fail("{} is not finite", value);
    m[glm::length_t(i / 4)][glm::length_t(i % 4)] = value;
  }
  const glm::dvec4 last(m[0][3], m[1][3], m[2][3], m[3][3] - 1);
  if (glm::length(last) > 1e-4) found->fail("the last row is not 0 0 0 1");
  return m;
}

void read_own_shape(const Item& definition, Light& light) {
  const auto own = own_extras(definition);
  const auto shape = own ? own->find("shape") : std::nullopt;
  if (!shape) return;
  const std::string& name = shape->text();
  LightKind kind = LightKind::sphere;
  while (kind <= LightKind::tube && name != kind_name(kind))
    kind = static_cast<LightKind>(static_cast<uint32_t>(kind) + 1);
  if (kind > LightKind::tube) shape->fail("'{}', expected sphere, rectangle, disk or tube", name);
  const auto size = [&](const char* key) {
    const double value = own->at(key).number();
    if (!(value >= double{k_least_lamp} && value <= double{k_max_lamp}))
      own->at(key).fail("{} m is not between {:g} and {:g}", value, k_least_lamp, k_max_lamp);
    return static_cast<float>(value);
  };
  Light shaped = light;
  shaped.kind = kind;
  if (kind == LightKind::rectangle)
    shaped.width = size("width"), shaped.height = size("height");
  else
    shaped.radius = size("radius");
  if (kind == LightKind::tube) shaped.width = size("length");
  shaped.two_sided = own->boolean("two_sided", false);
  shaped.visible = own->boolean("visible", true);
  light = shaped;
}

std::optional<Item> own_picture(const Item& definition) {
  const auto own = own_extras(definition);
  return own ? own->find("picture") : std::nullopt;
}

std::optional<Item> own_height(const Item& item) {
  const auto own = own_extras(item);
  return own ? own->find("height") : std::nullopt;
}

void read_own_catcher(const Item& item, Material& material) {
  const auto own = own_extras(item);
  if (own) material.shadow_catcher = own->boolean("shadow_catcher", false);
}

void read_own_emission(const Item& item, Material& material) {
  const auto own = own_extras(item);
  const auto off = own ? own->find("off_emission") : std::nullopt;
  if (!off) return;
  const vec3 value = finite_not_negative(*off);
  if (material.emission == vec3(0)) material.off_emission = value;
}

void read_own_extras(const Item& node, Light& light) {
  const auto own = own_extras(node);
  if (!own) return;
  light.enabled = own->boolean("enabled", light.enabled);
  if (const auto off = own->find("off_intensity"); off && !light.enabled) {
    const vec3 value = finite_not_negative(*off);
    if (light.intensity == vec3(0)) light.intensity = value;
  }
  if (const auto right = own->find("right"); right && can_roll(light)) {
    const vec3 value = right->rgb();
    if (glm::distance(value, light.right) < glm::radians(0.01f)) light.right = value;
  }
  const auto sun = own->find("sun");
  if (!sun || light.kind != LightKind::directional) return;
  const SunTime time = read_sun(*sun);
  if (glm::distance(sun_direction(time), light.direction) < glm::radians(0.01f)) light.sun = time;
}

void read_own_section(const Item& camera, Camera& result) {
  const auto own = own_extras(camera);
  const auto section = own ? own->find("section") : std::nullopt;
  if (!section) return;
  const vec3 normal = section->at("normal").rgb();
  const float length = glm::length(normal);
  if (!(length > 0 && std::isfinite(length))) section->at("normal").fail("its length is not above 0");
  result.section = {normal / length, static_cast<float>(section->at("offset").number())};
}

SkyModel read_sky(const Item& item) {
  SkyModel sky;
  const std::string& kind = item.at("kind").text();
  size_t index = 0;
  while (index < k_sky_names.size() && kind != k_sky_names[index]) ++index;
  if (index == k_sky_names.size())
    item.at("kind").fail("'{}', expected {}, {} or {}", kind, k_sky_names[0], k_sky_names[1], k_sky_names[2]);
  sky.kind = static_cast<SkyKind>(index);
  sky.turbidity = static_cast<float>(item.number("turbidity", double{sky.turbidity}));
  sky.ground = static_cast<float>(item.number("ground", double{sky.ground}));
  sky.to_sun = item.at("to_sun").rgb();
  check_range(sky, item.where());
  return sky;
}

float sky_unit(const Item& item) {
  const auto unit = item.find("unit");
  if (!unit || unit->text() == "kcd/m2") return 0.001f;
  if (unit->text() != "cd/m2") unit->fail("'{}', expected cd/m2 or kcd/m2", unit->text());
  return 1;
}

std::optional<Item> own_environment(const Document& document) {
  const auto source = default_scene(document);
  const auto own = source ? own_extras(*source) : std::nullopt;
  return own ? own->find("environment") : std::nullopt;
}

void read_own_settings(const Document& document, Scene& scene) {
  const auto source = default_scene(document);
  const auto own = source ? own_extras(*source) : std::nullopt;
  const auto settings = own ? own->find("settings") : std::nullopt;
  if (!settings) return;
  for (const auto& [key, value] : settings->object().json().items()) {
    const Item item = settings->at(key.c_str());
    if (value.is_string())
      scene.own_settings.emplace_back(key, value.get<std::string>());
    else if (value.is_boolean() || value.is_number())
      scene.own_settings.emplace_back(key, json_text(value));
    else
      item.fail("expected a number, a text, true or false, found {}", value.type_name());
  }
}

}  // namespace lucerna::scene
