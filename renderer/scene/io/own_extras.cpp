#include "scene/io/own_extras.h"

#include <array>
#include <cmath>

#include "base/json_text.h"
#include "scene/io/nodes.h"
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

void read_own_extras(const Item& node, Light& light) {
  const auto own = own_extras(node);
  if (!own) return;
  light.enabled = own->boolean("enabled", true);
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
