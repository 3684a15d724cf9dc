#include "scene/io/load.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "scene/io/document.h"
#include "scene/io/environment.h"
#include "scene/io/geometry.h"
#include "scene/io/materials.h"
#include "scene/io/nodes.h"
#include "scene/io/own_extras.h"
#include "scene/io/portals.h"
#include "scene/recentre.h"

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

void list_variants(const Document& document, Scene& scene) {
  const auto extensions = document.root().find("extensions");
  const auto e = extensions ? extensions->find("KHR_materials_variants") : std::nullopt;
  if (!e) return;
  const Item names = e->at("variants");
  for (size_t i = 0; i < names.size(); ++i) scene.variants.push_back(names.at(i).at("name").text());
}

void warn_of_motion(Document& document) {
  const auto animations = document.root().find("animations");
  if (animations && animations->json().is_array() && !animations->json().empty())
    document.warnings.add("{} animations are ignored: the scene is shown at rest", {}, animations->size());
}

// Meshes that instances use, each pose once, in glTF's order; instances of empty meshes vanish.
void load_meshes(Document& document, Scene& scene, Placement& placement, MaterialLoader& materials) {
  std::vector<uint32_t> order(placement.uses.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return placement.uses[a].mesh < placement.uses[b].mesh; });
  std::vector<Id> ids(order.size(), k_none);
  std::vector<uint8_t> shown_use(order.size(), 0);
  for (const Instance& instance : std::as_const(scene.instances)) shown_use[instance.mesh] = 1;
  std::map<uint32_t, std::vector<size_t>> portals_of;  // by use
  for (size_t i = 0; i < placement.portals.size(); ++i) portals_of[placement.portals[i].use].push_back(i);
  std::vector<glm::dvec3> origins(order.size(), glm::dvec3(0));
  size_t done = 0;
  for (const uint32_t use : order) {
    document.progress(0.15f + 0.35f * static_cast<float>(done++) / static_cast<float>(order.size()),
                      "geometry");
    const auto& [index, pose] = placement.uses[use];
    Mesh mesh = load_mesh(document, index, materials, pose, origins[use]);
    mesh.is_baked = pose.placed();
    for (const size_t portal : portals_of[use])
      take_corners(document, mesh, origins[use], placement.portals[portal]);
    if (mesh.primitives.empty() || !shown_use[use]) continue;
    ids[use] = static_cast<Id>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
  }
  std::vector<Instance> shown;
  std::vector<glm::dmat4> matrices;
  shown.reserve(scene.instances.size());
  matrices.reserve(scene.instances.size());
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    Instance& instance = scene.instances[i];
    const Id use = instance.mesh;
    if (ids[use] == k_none) continue;
    instance.mesh = ids[use];
    glm::dmat4 matrix = placement.instances[i];
    matrix[3] += glm::dvec4(glm::dmat3(matrix) * origins[use], 0);
    matrices.push_back(matrix);
    shown.push_back(std::move(instance));
  }
  scene.instances = std::move(shown);
  placement.instances = std::move(matrices);
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

std::vector<Box> mesh_boxes(const Scene& scene) {
  std::vector<Box> boxes(scene.meshes.size());
  for (size_t i = 0; i < boxes.size(); ++i)
    for (const Primitive& primitive : scene.meshes[i].primitives)
      for (const vec3& p : primitive.positions) boxes[i].grow(p);
  return boxes;
}

// The renderer works in world space, so what a matrix makes of the coordinates must be in range too.
void check_world(const Document& document, const Scene& scene, const Placement& placement,
                 const std::vector<Box>& boxes) {
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const Box& box = boxes[scene.instances[i].mesh];
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec4 p(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                         corner & 4 ? box.hi.z : box.lo.z, 1);
      const glm::dvec3 a = glm::abs(glm::dvec3(placement.instances[i] * p));
      if (!(std::max({a.x, a.y, a.z}) <= double{k_max_coordinate}))
        throw_error(document.file, "node '{}' places geometry beyond {} m from the origin",
                    scene.instances[i].name, k_max_coordinate);
    }
  }
}

// Cameras are checked when one is taken: a file may hold one that is never used.
void check_lights(const Document& document, const Scene& scene) {
  try {
    for (const Light& light : scene.lights) check_range(light);
  } catch (const Error& error) {
    throw Error(document.file, error.what());
  }
}

// The matrix in single precision: `known`, as it was saved, unless it is another one.
mat4 rounded(const glm::dmat4& matrix, const mat4& known) {
  double size = 0, linear = 0;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 3; ++r) {
      size = std::max(size, std::abs(matrix[c][r]));
      if (c < 3) linear = std::max(linear, std::abs(matrix[c][r]));
    }
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!(std::abs(double{known[c][r]} - matrix[c][r]) <= 1e-6 * (c < 3 ? linear : size)))
        return mat4(matrix);
  return known;
}

// Chooses the scene's origin and puts everything in its place.
void place(Scene& scene, Placement& placement, const std::vector<Box>& boxes, Document& document) {
  const auto is_lamp = [&scene](const Mesh& mesh) {
    return std::all_of(mesh.primitives.begin(), mesh.primitives.end(),
                       [&](const Primitive& p) { return scene.materials[p.material].emission != vec3(0); });
  };
  std::vector<Extent> extents, lamps;
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const glm::dmat4& matrix = placement.instances[i];
    const Id id = scene.instances[i].mesh;
    const Mesh& mesh = std::as_const(scene.meshes)[id];
    const glm::dvec3 lo(boxes[id].lo), hi(boxes[id].hi), half = 0.5 * (hi - lo);
    glm::dvec3 size(0);
    for (int axis = 0; axis < 3; ++axis) size += glm::abs(glm::dvec3(matrix[axis])) * half[axis];
    size_t triangles = 0;
    for (const Primitive& p : mesh.primitives) triangles += p.triangles.size();
    const double radius = glm::length(size);
    (is_lamp(mesh) ? lamps : extents)
        .push_back({glm::dvec3(matrix * glm::dvec4(0.5 * (lo + hi), 1)), radius,
                    radius * static_cast<double>(triangles)});
  }
  std::vector<glm::dvec3> cameras;
  for (const glm::dmat4& matrix : placement.cameras) cameras.emplace_back(matrix[3]);
  scene.origin = choose_origin(extents.empty() ? lamps : extents, cameras);
  const bool moved = scene.origin != glm::dvec3(0);
  if (moved)
    document.warnings.add(
        fmt::format("the geometry is far from the origin: all positions are counted from "
                    "{} {} {} m of the file",
                    scene.origin.x, scene.origin.y, scene.origin.z));

  // Meshes whose own coordinates are far from their origin are moved near it too: an exact difference.
  std::vector<glm::dvec3> shifts(scene.meshes.size(), glm::dvec3(0));
  for (size_t i = 0; i < shifts.size(); ++i) {
    const glm::dvec3 centre(boxes[i].centre());
    const double radius{boxes[i].radius()};
    if (glm::length(centre) > (moved ? k_far : k_far * k_far) * radius)
      shifts[i] = round_origin(centre, radius);
    if (shifts[i] == glm::dvec3(0)) continue;
    scene.meshes[i].shift = shifts[i];
    for (Primitive& primitive : scene.meshes[i].primitives)
      for (vec3& p : primitive.positions) p = vec3(glm::dvec3(p) - shifts[i]);
  }
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    glm::dmat4 matrix = placement.instances[i];
    matrix[3] += glm::dvec4(glm::dmat3(matrix) * shifts[scene.instances[i].mesh] - scene.origin, 0);
    mat4& to_world = scene.instances[i].to_world;
    to_world = rounded(matrix, to_world);
  }
  for (size_t i = 0; i < cameras.size(); ++i) {
    scene.cameras[i].to_world[3] = vec4(vec3(cameras[i] - scene.origin), 1);
    Section& section = scene.cameras[i].section;
    section.offset = static_cast<float>(section.offset - glm::dot(glm::dvec3(section.normal), scene.origin));
  }
  for (size_t i = 0; i < scene.lights.size(); ++i)
    scene.lights[i].position = vec3(placement.lights[i] - scene.origin);
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
    scene.document = document.text;
    list_extensions(document, scene);
    list_variants(document, scene);
    warn_of_motion(document);
    Placement placement = load_nodes(document, scene);
    MaterialLoader materials(document, scene);
    load_meshes(document, scene, placement, materials);
    check_instances(document, scene);
    const std::vector<Box> boxes = mesh_boxes(scene);
    check_world(document, scene, placement, boxes);
    place(scene, placement, boxes, document);
    load_portals(document, scene, placement.portals);
    check_lights(document, scene);
    document.progress(0.5f, "textures");
    materials.load_images(options.images);
    if (!options.settings || !load_settings(document, scene)) load_extras_environment(document, scene);
    if (options.settings) read_own_settings(document, scene);
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
