#include <algorithm>
#include <nlohmann/json.hpp>

#include "scene/io/load.h"
#include "scene/io/own_extras.h"
#include "scene/lamp.h"
#include "scene/light_groups.h"

namespace lucerna::scene {
namespace {

using Json = nlohmann::ordered_json;

Json rgb(const vec3& v) { return {v.x, v.y, v.z}; }

// Common name of the kind of material.
std::string kind_of(const Material& m) {
  if (m.unlit) return "unlit";
  std::string kind;
  if (m.transmission > 0)
    kind = m.thickness > 0 ? "glass, solid" : "glass, thin wall";
  else if (m.metallic >= 1 && !m.metallic_roughness_texture)
    kind = "metal";
  else if (m.metallic > 0)
    kind = m.metallic_roughness_texture ? "metal or dielectric by texture" : "metal and dielectric mixed";
  else if (m.diffuse_transmission > 0)
    kind = "diffuse transmission";
  else if (m.specular == 0 && m.roughness >= 1)
    kind = "matt";
  else
    kind = "dielectric";
  if (m.clearcoat > 0) kind += ", clear coat";
  if (m.sheen_color != vec3(0)) kind += ", sheen";
  if (m.anisotropy > 0) kind += ", anisotropic";
  if (m.shadow_catcher) kind += ", shadow catcher";
  if (m.diffuse_roughness > 0) kind += ", rough diffuse";
  if (has_relief(m)) kind += m.deep_relief ? ", deep relief" : ", relief";
  if (m.dispersion > 0) kind += ", dispersive";
  if (m.iridescence > 0) kind += ", iridescent";
  if (m.emission != vec3(0)) kind += ", emitter";
  if (m.alpha_mode == AlphaMode::mask) kind += ", alpha mask";
  if (m.alpha_mode == AlphaMode::blend) kind += ", alpha blend";
  return kind;
}

size_t bytes_of(const Image& image) { return image.bytes.size() + image.floats.size() * sizeof(float); }

const char* wrap_name(Wrap wrap) {
  return wrap == Wrap::clamp ? "clamp" : wrap == Wrap::mirror ? "mirror" : "repeat";
}

Json describe_materials(const Scene& scene) {
  Json list = Json::array();
  for (const Material& m : scene.materials) {
    Json item{{"name", m.name}, {"kind", kind_of(m)}};
    Json textures = Json::object();
    for (const TextureSlot& slot : k_texture_slots)
      if (m.*slot.use) textures[slot.name] = (m.*slot.use).texture;
    if (!textures.empty()) item["textures"] = textures;
    if (m.emission != vec3(0)) item["emission"] = rgb(m.emission);
    list.push_back(item);
  }
  return list;
}

Json describe_lights(const Scene& scene) {
  Json list = Json::array();
  for (const Light& light : scene.lights) {
    Json item{{"name", light.name}, {"kind", kind_name(light.kind)}, {"intensity", rgb(light.intensity)}};
    if (light.kind != LightKind::directional) item["position"] = rgb(light.position);
    if (light.kind != LightKind::point && light.kind != LightKind::sphere)
      item["direction"] = rgb(light.direction);
    if (light.profile) {
      item["profile"] = light.profile->name;
      item["profile_lumens"] = light.profile->lumens();
    }
    if (light.picture) item["picture"] = light.picture->name;
    if (has_shape(light.kind)) item["size"] = {2 * half_size(light).x, 2 * half_size(light).y};
    if (light.kind == LightKind::spot)
      item["cone_degrees"] = {glm::degrees(light.inner_cone), glm::degrees(light.outer_cone)};
    list.push_back(item);
  }
  return list;
}

Json describe_portals(const Scene& scene) {
  Json list = Json::array();
  for (const Portal& portal : scene.portals)
    list.push_back({{"name", portal.name},
                    {"centre", rgb(portal.centre)},
                    {"size", {2 * glm::length(portal.half_width), 2 * glm::length(portal.half_height)}},
                    {"normal", rgb(normal_of(portal))}});
  return list;
}

/// Groups by the scene's own rules; invalid rules are not reported here.
LightGroups groups_of(const Scene& scene) {
  std::string rules;
  for (const auto* settings : {&scene.settings, &scene.own_settings})
    for (const auto& [key, value] : *settings)
      if (key == "relight.groups") rules = value;
  try {
    return group_lights(scene, parse_group_rules(rules));
  } catch (const Error&) {
    return group_lights(scene);
  }
}

Json describe_groups(const LightGroups& groups) {
  Json list = Json::array();
  for (const LightGroup& group : groups.groups) {
    Json item{{"name", group.name}, {"lamps", group.lamps}, {"surfaces", group.surfaces}};
    if (group.sky) item["sky"] = true;
    if (group.sun) item["sun"] = true;
    list.push_back(item);
  }
  return list;
}

/// "sky, 3 lamps".
std::string members(const Json& group) {
  std::vector<std::string> parts;
  if (group.contains("sky")) parts.emplace_back("sky");
  if (group.contains("sun")) parts.emplace_back("sun");
  const auto count = [&](const char* key, const char* what) {
    const auto n = group[key].get<uint32_t>();
    if (n > 0) parts.push_back(fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"));
  };
  count("lamps", "lamp"), count("surfaces", "surface");
  return parts.empty() ? "nothing" : fmt::format("{}", fmt::join(parts, ", "));
}

Json describe_cameras(const Scene& scene) {
  Json list = Json::array();
  for (const Camera& camera : scene.cameras) {
    Json item{{"name", camera.name},
              {"kind", camera.orthographic ? "orthographic" : k_projection_names[size_t(camera.wide)]}};
    if (camera.orthographic)
      item["half_size"] = {camera.xmag, camera.ymag};
    else if (camera.wide == Wide::none)
      item["yfov_degrees"] = glm::degrees(camera.yfov);
    if (camera.aspect > 0) item["aspect"] = camera.aspect;
    if (camera.shift != vec2(0)) item["shift"] = {camera.shift.x, camera.shift.y};
    if (const Lens& lens = camera.lens; camera.perspective() && lens.f_number > 0) {
      item["f_number"] = lens.f_number, item["focus_distance"] = lens.focus_distance;
      item["aperture_blades"] = lens.blades;
      if (lens.blades > 0) item["aperture_rotation_degrees"] = glm::degrees(lens.rotation);
    }
    item["position"] = rgb(vec3(camera.to_world[3]));
    list.push_back(item);
  }
  return list;
}

}  // namespace

nlohmann::ordered_json describe(const Scene& scene) {
  Json out;
  out["name"] = scene.name;
  out["file"] = scene.file;
  uint64_t vertices = 0, emissive = 0;
  size_t primitives = 0;
  for (const Mesh& mesh : scene.meshes) {
    primitives += mesh.primitives.size();
    for (const Primitive& primitive : mesh.primitives) vertices += primitive.positions.size();
  }
  for (const Instance& instance : scene.instances)
    for (const Primitive& primitive : shown_parts(scene, instance)) {
      const Material& m = scene.materials[primitive.material];
      if (m.emission != vec3(0) && !m.unlit) emissive += primitive.triangles.size();
    }
  out["triangles"] = count_triangles(scene);
  out["emissive_triangles"] = emissive;
  out["vertices"] = vertices;
  out["instances"] = scene.instances.size();
  const auto hidden = std::count_if(scene.instances.begin(), scene.instances.end(),
                                    [](const Instance& instance) { return instance.hidden; });
  if (hidden > 0) out["hidden_instances"] = hidden;
  out["meshes"] = scene.meshes.size();
  out["primitives"] = primitives;
  out["materials"] = describe_materials(scene);
  out["images"] = Json::array();
  size_t memory = 0;
  for (const Image& image : scene.images) {
    memory += bytes_of(image);
    out["images"].push_back({{"name", image.name},
                             {"width", image.width},
                             {"height", image.height},
                             {"format", image.floats.empty() ? "8 bit" : "float"},
                             {"bytes", bytes_of(image)}});
  }
  out["image_bytes"] = memory;
  out["textures"] = Json::array();
  for (const Texture& texture : scene.textures)
    out["textures"].push_back({{"image", texture.image},
                               {"srgb", texture.srgb},
                               {"wrap", {wrap_name(texture.wrap_u), wrap_name(texture.wrap_v)}},
                               {"nearest", texture.nearest}});
  out["lights"] = describe_lights(scene);
  out["portals"] = describe_portals(scene);
  const LightGroups groups = groups_of(scene);
  out["light_groups"] = describe_groups(groups);
  out["cameras"] = describe_cameras(scene);
  const Environment& e = scene.environment;
  if (e.image != k_none)
    out["environment"] = {{"file", e.file},
                          {"scale", e.scale},
                          {"rotation", e.rotation},
                          {"width", scene.images[e.image].width},
                          {"height", scene.images[e.image].height}};
  else if (e.radiance != vec3(0))
    out["environment"] = {{"radiance", rgb(e.radiance)}, {"scale", e.scale}};
  else
    out["environment"] = nullptr;
  out["extensions"] = scene.extensions;
  if (!scene.variants.empty()) out["variants"] = scene.variants;
  out["unknown_extensions"] = scene.unknown_extensions;
  const Box box = bounds(scene);
  if (box.empty())
    out["bounds"] = nullptr;
  else
    out["bounds"] = {{"lo", rgb(box.lo)}, {"hi", rgb(box.hi)}};
  out["origin"] = {scene.origin.x, scene.origin.y, scene.origin.z};
  out["settings"] = Json::object();
  for (const auto* settings : {&scene.settings, &scene.own_settings})
    for (const auto& [key, value] : *settings) out["settings"][key] = value;
  out["warnings"] = scene.warnings;
  for (const std::string& message : groups.messages) out["warnings"].push_back(message);
  return out;
}

std::string describe_text(const Scene& scene) {
  const Json d = describe(scene);
  std::string text;
  const auto line = [&text]<class... A>(fmt::format_string<A...> f, A&&... a) {
    text += fmt::format(f, std::forward<A>(a)...) + "\n";
  };
  const auto number = [&d](const char* key) { return d[key].get<uint64_t>(); };
  const auto name = [](const Json& item) { return item["name"].get<std::string>(); };
  const auto kind = [](const Json& item) { return item["kind"].get<std::string>(); };
  const auto triple = [](const Json& v) {
    return fmt::format("{:.4g} {:.4g} {:.4g}", v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
  };
  line("{}", scene.file);
  line("triangles    {} ({} emissive), from {} vertices in {} meshes ({} primitives), {} instances{}",
       number("triangles"), number("emissive_triangles"), number("vertices"), number("meshes"),
       number("primitives"), number("instances"),
       d.contains("hidden_instances") ? fmt::format(" ({} hidden)", number("hidden_instances")) : "");
  if (!d["bounds"].is_null())
    line("bounds       {} to {} m", triple(d["bounds"]["lo"]), triple(d["bounds"]["hi"]));
  if (scene.origin != glm::dvec3(0))
    line("origin       {} {} {} m of the file; bounds and all other positions are counted from there",
         scene.origin.x, scene.origin.y, scene.origin.z);
  line("materials    {}", d["materials"].size());
  for (const Json& m : d["materials"]) line("  {}: {}", name(m), kind(m));
  line("images       {}, {:.1f} MiB; {} textures", d["images"].size(),
       static_cast<double>(number("image_bytes")) / (1 << 20), d["textures"].size());
  for (const Json& image : d["images"])
    line("  {}: {} x {}, {}, {:.2f} MiB", name(image), image["width"].get<int>(), image["height"].get<int>(),
         image["format"].get<std::string>(), image["bytes"].get<double>() / (1 << 20));
  line("lights       {}", d["lights"].size());
  for (const Json& light : d["lights"])
    line("  {}: {}, {}", name(light), kind(light), triple(light["intensity"]));
  if (!d["portals"].empty()) line("portals      {}", d["portals"].size());
  for (const Json& portal : d["portals"])
    line("  {}: {:.4g} x {:.4g} m at {}, lights towards {}", name(portal), portal["size"][0].get<double>(),
         portal["size"][1].get<double>(), triple(portal["centre"]), triple(portal["normal"]));
  line("light groups {}", d["light_groups"].size());
  for (const Json& group : d["light_groups"]) line("  {}: {}", name(group), members(group));
  line("cameras      {}", d["cameras"].size());
  for (const Json& camera : d["cameras"]) line("  {}: {}", name(camera), kind(camera));
  const Environment& e = scene.environment;
  if (e.image != k_none)
    line("environment  {} ({} x {}), scale {}, rotation {}", e.sky ? name_of(e.sky->kind) : e.file,
         scene.images[e.image].width, scene.images[e.image].height, e.scale, e.rotation);
  else
    line("environment  {}",
         d["environment"].is_null() ? "none" : "radiance " + triple(d["environment"]["radiance"]));
  line("extensions   {}",
       scene.extensions.empty() ? "none" : fmt::format("{}", fmt::join(scene.extensions, ", ")));
  if (!scene.variants.empty()) line("variants     {}", fmt::join(scene.variants, ", "));
  if (!scene.unknown_extensions.empty()) line("unknown      {}", fmt::join(scene.unknown_extensions, ", "));
  for (const auto& [key, value] : d["settings"].items())
    line("setting      {} = {}", key, value.get<std::string>());
  for (const Json& warning : d["warnings"]) line("warning      {}", warning.get<std::string>());
  return text;
}

}  // namespace lucerna::scene
