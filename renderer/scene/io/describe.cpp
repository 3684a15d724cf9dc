#include <nlohmann/json.hpp>
#include <set>

#include "scene/io/load.h"

namespace lucerna::scene {
namespace {

nlohmann::ordered_json triple(const vec3& v) { return {v.x, v.y, v.z}; }
const char* kind_name(LightKind k) { return k == LightKind::point ? "point" : k == LightKind::spot ? "spot" : "directional"; }

std::string kind_of(const Material& m) {
  std::string kind = m.unlit ? "unlit" : m.transmission > 0 ? (m.thickness > 0 ? "glass" : "thin glass") : m.metallic > 0.5f ? "metal" : m.specular > 0 ? "dielectric" : "Lambertian";
  if (luminance(m.emission) > 0) kind += ", emits";
  if (m.alpha_mode == AlphaMode::mask) kind += ", mask";
  if (m.alpha_mode == AlphaMode::blend) kind += ", blend";
  if (m.diffuse_transmission > 0) kind += ", translucent";
  return kind;
}

}  // namespace

nlohmann::ordered_json describe(const Scene& scene) {
  nlohmann::ordered_json j;
  j["file"] = scene.file;
  j["triangles"] = count_triangles(scene);
  uint64_t unique = 0, vertices = 0;
  for (const Mesh& m : scene.meshes)
    for (const Primitive& p : m.primitives) unique += p.triangles.size(), vertices += p.positions.size();
  j["unique_triangles"] = unique;
  j["vertices"] = vertices;
  j["meshes"] = scene.meshes.size();
  j["instances"] = scene.instances.size();
  const Box box = bounds(scene);
  if (!box.empty()) j["bounds"] = {triple(box.lo), triple(box.hi)};
  j["materials"] = nlohmann::ordered_json::array();
  std::set<Id> used;
  for (const Mesh& m : scene.meshes)
    for (const Primitive& p : m.primitives) used.insert(p.material);
  for (Id i : used) j["materials"].push_back({{"name", scene.materials[i].name}, {"kind", kind_of(scene.materials[i])}});
  j["textures"] = scene.textures.size();
  uint64_t bytes = 0;
  j["images"] = nlohmann::ordered_json::array();
  for (const Image& i : scene.images) {
    if (i.name == "white") continue;
    bytes += i.bytes.size() + 4 * i.floats.size();
    j["images"].push_back({{"name", i.name}, {"width", i.width}, {"height", i.height}});
  }
  j["image_mb"] = double(bytes) / (1 << 20);
  j["lights"] = nlohmann::ordered_json::array();
  for (const Light& l : scene.lights) j["lights"].push_back({{"name", l.name}, {"kind", kind_name(l.kind)}, {"intensity", triple(l.intensity)}});
  j["cameras"] = nlohmann::ordered_json::array();
  for (const Camera& c : scene.cameras)
    j["cameras"].push_back({{"name", c.name}, {"kind", c.orthographic ? "orthographic" : "perspective"}, {"yfov_degrees", c.yfov * 180 / k_pi}});
  if (scene.environment.image != k_none) j["environment"] = {{"file", scene.environment.file}, {"scale", scene.environment.scale}, {"rotation", scene.environment.rotation}};
  else j["environment"] = {{"radiance", triple(scene.environment.radiance)}};
  for (const auto& [key, value] : scene.settings) j["settings"][key] = value;
  j["warnings"] = scene.warnings;
  return j;
}

std::string describe_text(const Scene& scene) {
  const nlohmann::ordered_json j = describe(scene);
  std::string out = fmt::format("{}\n  {} triangles ({} unique), {} vertices, {} meshes, {} instances\n", scene.file, j["triangles"].get<uint64_t>(),
                                j["unique_triangles"].get<uint64_t>(), j["vertices"].get<uint64_t>(), scene.meshes.size(), scene.instances.size());
  if (const Box box = bounds(scene); !box.empty())
    out += fmt::format("  {:.2f} x {:.2f} x {:.2f} m, from ({:.2f}, {:.2f}, {:.2f})\n", box.size().x, box.size().y, box.size().z, box.lo.x, box.lo.y, box.lo.z);
  for (const auto& m : j["materials"]) out += fmt::format("  material  {}: {}\n", m["name"].get<std::string>(), m["kind"].get<std::string>());
  for (const auto& i : j["images"]) out += fmt::format("  image     {}: {}x{}\n", i["name"].get<std::string>(), i["width"].get<int>(), i["height"].get<int>());
  for (const Light& l : scene.lights)
    out += fmt::format("  light     {}: {}, intensity ({:.3g}, {:.3g}, {:.3g})\n", l.name, kind_name(l.kind), l.intensity.x, l.intensity.y, l.intensity.z);
  for (const Camera& c : scene.cameras) out += fmt::format("  camera    {}: {}\n", c.name, c.orthographic ? "orthographic" : fmt::format("perspective, {:.1f} degrees", c.yfov * 180 / k_pi));
  const Environment& e = scene.environment;
  if (e.image != k_none) out += fmt::format("  environment {}, scale {}, rotation {} degrees\n", e.file, e.scale, e.rotation);
  else out += fmt::format("  environment radiance ({:.3g}, {:.3g}, {:.3g})\n", e.radiance.x, e.radiance.y, e.radiance.z);
  for (const auto& [key, value] : scene.settings) out += fmt::format("  setting   {} = {}\n", key, value);
  for (const std::string& w : scene.warnings) out += fmt::format("  warning   {}\n", w);
  return out;
}

}  // namespace lucerna::scene
