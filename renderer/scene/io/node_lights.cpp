#include "scene/io/node_lights.h"

#include <algorithm>
#include <cmath>

#include "scene/io/light_picture_file.h"
#include "scene/io/light_profile_file.h"
#include "scene/io/node_matrix.h"
#include "scene/io/own_extras.h"
#include "scene/lamp.h"

namespace lucerna::scene {
namespace {

/// Direction and `right` of the node.
void set_frame(Light& light, const glm::dmat4& world) {
  glm::dvec3 forward = -axis(world, 2);
  // What rotations as quaternions leave of 0 is 0.
  for (int k = 0; k < 3; ++k)
    if (std::abs(forward[k]) < 1e-12) forward[k] = 0;
  light.direction = vec3(forward);
  if (can_roll(light)) light.right = right_across(light.direction, vec3(axis(world, 0)));
}

/// The list of lights of a file's extension, for a node that refers to it.
Item lights_of(const Item& root, const char* extension, const Item& reference) {
  const auto extensions = root.find("extensions");
  const auto own = extensions ? extensions->find(extension) : std::nullopt;
  const auto lights = own ? own->find("lights") : std::nullopt;
  if (!lights) reference.fail("the file has no extensions.{}.lights", extension);
  return *lights;
}

/// The intensity: `strength` times the colour of an item, white without.
void set_intensity(Light& light, const Item& item, double strength, Document& document) {
  const auto color = item.find("color");
  const vec3 value = (color ? color->rgb() : vec3(1)) * static_cast<float>(strength);
  light.intensity = glm::clamp(value, vec3(0), vec3(1e30f));
  if (value != light.intensity)
    document.warnings.add("{} lights with a negative or endless intensity: clamped", item.path());
}

/// The bytes that a URI has or whose file it names; `name` becomes that of the file.
std::vector<uint8_t> read_uri(const Document& document, const Item& uri, std::string& name) {
  if (!is_data_uri(uri.text())) name = resolve_uri(document, uri).filename().string();
  return uri_bytes(document, uri);
}

/// Where errors of such a file are located.
std::string where_of(const Item& item, const std::string& name) {
  return name.empty() ? item.where() : fmt::format("{} ({})", item.where(), name);
}

}  // namespace

// Each is read once.
std::shared_ptr<const LightProfile> NodeLights::profile_of(const Item& reference) {
  const Item lights = lights_of(root_, "EXT_lights_ies", reference);
  const auto number = reference.at("light").index(lights.size(), "lights");
  const auto [place, fresh] = profiles_.try_emplace(number);
  if (!fresh) return place->second;
  const Item item = lights.at(number);
  std::string name = item.text("name", "");
  const auto uri = item.find("uri");
  const std::vector<uint8_t> bytes =
      uri ? read_uri(document_, *uri, name) : view_bytes(document_, item.at("bufferView"));
  place->second = light_profile_of({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name,
                                   where_of(item, name));
  return place->second;
}

// Each is read once.
std::shared_ptr<const LightPicture> NodeLights::picture_of(const Item& definition, size_t number) {
  const auto [place, fresh] = pictures_.try_emplace(number);
  if (!fresh) return place->second;
  try {
    const std::optional<Item> item = own_picture(definition);
    if (!item) return nullptr;
    std::string name = item->text("name", "");
    std::vector<uint8_t> bytes = read_uri(document_, item->at("uri"), name);
    size_t mended = 0;
    place->second = light_picture_of(std::move(bytes), name, where_of(*item, name), document_.budget, mended);
    if (mended > 0)
      document_.warnings.add("{} pictures of spots with texels that are negative or not finite: mended",
                             item->path());
  } catch (const OverBudget&) {
    throw;
  } catch (const OutsideFolder&) {
    throw;
  } catch (const Error& error) {
    document_.warnings.add("{} pictures of spots that cannot be read: spots without one", error.what());
  }
  return place->second;
}

Light NodeLights::punctual(const Item& reference, const Place& place) {
  const Item lights = lights_of(root_, "KHR_lights_punctual", reference);
  const auto number = reference.at("light").index(lights.size(), "lights");
  const Item item = lights.at(number);
  Light light;
  light.name = item.text("name", place.name);
  if (light.name.empty()) light.name = place.name;
  light.group = place.group.empty() ? light_group(item) : place.group;
  light.id = place.node;
  light.enabled = !place.hidden;
  const std::string& type = item.at("type").text();
  if (type == "point") {
    light.kind = LightKind::point;
  } else if (type == "spot") {
    light.kind = LightKind::spot;
  } else if (type == "directional") {
    light.kind = LightKind::directional;
  } else {
    item.at("type").fail("'{}', expected point, spot or directional", type);
  }
  set_intensity(light, item, item.number("intensity", 1), document_);
  set_frame(light, place.world);
  if (const auto spot = item.find("spot"); spot && light.kind == LightKind::spot) {
    const double outer = spot->number("outerConeAngle", glm::radians(45.0));
    const double inner = spot->number("innerConeAngle", 0);
    const double half_turn = glm::radians(90.0);
    light.outer_cone = static_cast<float>(std::clamp(outer, 1e-4, half_turn));
    light.inner_cone = std::clamp(static_cast<float>(inner), 0.0f, light.outer_cone);
    // A float pi / 2 written in decimal may lie a rounding above pi / 2.
    if (outer <= 0 || outer > half_turn + 1e-6 || inner < 0 || inner > outer)
      document_.warnings.add("{} spot lights whose cone angles are not 0 <= inner < outer <= pi/2: clamped",
                             spot->path());
  }
  try {
    read_own_shape(item, light);
  } catch (const Error& error) {
    document_.warnings.add("{} shapes of lamps that cannot be used: lamps without a shape", error.what());
  }
  if (light.kind == LightKind::spot) light.picture = picture_of(item, number);
  if (light.picture && light.outer_cone > k_widest_picture) {
    document_.warnings.add("{} spots with a picture and a cone of more than 80 degrees: without the picture",
                           item.path());
    light.picture.reset();
  }
  if (light.picture) set_frame(light, place.world);
  if (has_shape(light.kind)) {
    light.inner_cone = Light().inner_cone, light.outer_cone = Light().outer_cone;
    set_frame(light, place.world);
  }
  read_own_extras(root_.at("nodes").at(place.node), light);
  return light;
}

std::optional<Light> NodeLights::with_profile(const Item& reference, const Place& place) {
  Light light{.name = place.name,
              .kind = LightKind::profile,
              .enabled = !place.hidden,
              .group = place.group,
              .id = place.node};
  try {
    light.profile = profile_of(reference);
  } catch (const OverBudget&) {
    throw;
  } catch (const OutsideFolder&) {
    throw;
  } catch (const Error& error) {
    document_.warnings.add("{} lamps whose distribution cannot be read: left out", error.what());
  }
  if (!light.profile) return std::nullopt;
  set_intensity(light, reference, reference.number("multiplier", 1) * light.profile->peak, document_);
  set_frame(light, place.world);
  read_own_extras(root_.at("nodes").at(place.node), light);
  return light;
}

}  // namespace lucerna::scene
