#include "scene/io/load.h"

#include <algorithm>
#include <set>

#include "scene/io/document.h"
#include "scene/io/environment.h"
#include "scene/io/geometry.h"
#include "scene/io/materials.h"
#include "scene/io/nodes.h"

namespace lucerna::scene {
namespace {

// Names used anywhere, declared or not, and how often.
void collect_extensions(const nlohmann::json& value, std::map<std::string, size_t>& uses) {
  if (!value.is_structured()) return;
  if (value.is_object())
    if (const auto found = value.find("extensions"); found != value.end() && found->is_object())
      for (const auto& [name, content] : found->items()) ++uses[name];
  for (const auto& [key, child] : value.items())
    if (key != "extras") collect_extensions(child, uses);
}

void list_extensions(Document& document, Scene& scene) {
  std::map<std::string, size_t> uses;
  collect_extensions(document.json, uses);
  if (const auto declared = document.root().find("extensionsUsed"))
    for (size_t i = 0; i < declared->size(); ++i) uses.try_emplace(declared->at(i).text(), 0);
  for (const auto& [name, count] : uses) {
    (is_known_extension(name) ? scene.extensions : scene.unknown_extensions).push_back(name);
    if (!is_known_extension(name))
      document.warnings.add(fmt::format("extension {} is not known and ignored", name),
                            count == 0 ? "declared, not used" : fmt::format("used {} times", count));
  }
}

void warn_of_motion(Document& document) {
  const Item root = document.root();
  const auto animations = root.find("animations");
  if (animations && animations->json().is_array() && !animations->json().empty())
    document.warnings.add("{} animations are ignored: the scene is shown at rest", {}, animations->size());
  const auto meshes = root.find("meshes");
  for (size_t i = 0; meshes && i < meshes->size(); ++i) {
    const Item primitives = meshes->at(i).at("primitives");
    for (size_t k = 0; k < primitives.size(); ++k)
      if (const auto targets = primitives.at(k).find("targets"))
        document.warnings.add("{} primitives have morph targets; they are shown without",
                              primitives.at(k).path());
  }
}

// Meshes that instances use, each once, in glTF's order; instances of empty meshes vanish.
void load_meshes(Document& document, Scene& scene, MaterialLoader& materials) {
  std::map<Id, Id> ids;
  for (const Instance& instance : scene.instances) ids[instance.mesh] = k_none;
  size_t done = 0;
  for (auto& [index, id] : ids) {
    document.progress(0.15f + 0.35f * static_cast<float>(done++) / static_cast<float>(ids.size()),
                      "geometry");
    Mesh mesh = load_mesh(document, index, materials);
    if (mesh.primitives.empty()) continue;
    id = static_cast<Id>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
  }
  for (Instance& instance : scene.instances) instance.mesh = ids[instance.mesh];
  scene.instances.erase_if([](const Instance& instance) { return instance.mesh == k_none; });
}

// About what a triangle and a vertex take in the world, with the tree over them and the device's copy.
constexpr uint64_t k_triangle_bytes = 256, k_vertex_bytes = 128;

// Geometry is in memory once for every instance that shows it.
void check_instances(const Document& document, const Scene& scene) {
  for (const Instance& instance : scene.instances) {
    uint64_t triangles = 0, vertices = 0;
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (const Primitive& p : mesh.primitives)
      triangles += p.triangles.size(), vertices += p.positions.size();
    document.budget.take(triangles * k_triangle_bytes + vertices * k_vertex_bytes, document.file,
                         "node '{}', another instance of mesh '{}' with {} triangles,", instance.name,
                         mesh.name, triangles);
  }
}

// The renderer works in world space, so what a matrix makes of the coordinates must be in range too. Cameras
// are checked when one is taken: a file may hold one that is never used.
void check_world(const Document& document, const Scene& scene) {
  std::vector<Box> boxes(scene.meshes.size());
  for (size_t i = 0; i < boxes.size(); ++i)
    for (const Primitive& primitive : scene.meshes[i].primitives)
      for (const vec3& p : primitive.positions) boxes[i].grow(p);
  for (const Instance& instance : scene.instances) {
    const Box& box = boxes[instance.mesh];
    for (int corner = 0; corner < 8; ++corner) {
      const vec3 p(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                   corner & 4 ? box.hi.z : box.lo.z);
      const vec3 a = glm::abs(vec3(instance.to_world * vec4(p, 1)));
      if (!(std::max({a.x, a.y, a.z}) <= k_max_coordinate))
        throw_error(document.file, "node '{}' places geometry beyond {} m from the origin", instance.name,
                    k_max_coordinate);
    }
  }
  try {
    for (const Light& light : scene.lights) check_range(light);
  } catch (const Error& error) {
    throw Error(document.file, error.what());
  }
}

}  // namespace

Scene load(const std::filesystem::path& path, const LoadOptions& options, const LoadProgress& progress) {
  Document document(options);
  document.progress = [&progress](float fraction, const char* what) {
    if (progress && !progress(fraction, what)) throw Cancelled();
  };
  Scene scene;
  scene.file = path.string();
  scene.name = path.stem().string();
  try {
    document.progress(0, "file");
    open_document(document, path);
    list_extensions(document, scene);
    warn_of_motion(document);
    load_nodes(document, scene);
    MaterialLoader materials(document, scene);
    load_meshes(document, scene, materials);
    check_instances(document, scene);
    check_world(document, scene);
    document.progress(0.5f, "textures");
    materials.load_images(options.images);
    if (!options.settings || !load_settings(document, scene)) load_extras_environment(document, scene);
    document.progress(1, "done");
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(path.string(), "not enough memory to load this scene");
  } catch (const std::length_error&) {
    throw Error(path.string(), "not enough memory to load this scene");
  } catch (const std::exception& error) {
    throw Error(path.string(), error.what());
  }
  if (scene.instances.empty()) document.warnings.add("the scene has no triangles");
  scene.warnings = document.warnings.lines();
  return scene;
}

}  // namespace lucerna::scene
