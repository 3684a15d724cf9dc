// The structure of a glTF document, checked before a byte of its buffers is touched (glTF 2.0, sections 3 and
// 5).
#include <array>
#include <set>
#include <string_view>

#include "scene/io/accessor.h"
#include "scene/io/document.h"

namespace lucerna::scene {
namespace {

constexpr int64_t k_max_bytes = int64_t{1} << 40;
constexpr int64_t k_max_int = 0x7fffffff;  // tinygltf keeps the offsets of sparse accessors in an int
constexpr int64_t k_max_count = int64_t{1} << 31;
constexpr int64_t k_max_free_count = int64_t{1} << 24;  // of an accessor that no buffer view backs

const std::set<std::string_view> k_known_extensions{"KHR_materials_emissive_strength",
                                                    "KHR_materials_ior",
                                                    "KHR_materials_specular",
                                                    "KHR_materials_transmission",
                                                    "KHR_materials_volume",
                                                    "KHR_materials_unlit",
                                                    "EXT_lights_ies",
                                                    "KHR_lights_punctual",
                                                    "KHR_texture_transform",
                                                    "KHR_materials_diffuse_transmission",
                                                    "KHR_materials_clearcoat",
                                                    "KHR_materials_sheen",
                                                    "KHR_materials_anisotropy",
                                                    "KHR_materials_iridescence",
                                                    "KHR_materials_dispersion",
                                                    "EXT_materials_diffuse_roughness",
                                                    "KHR_materials_diffuse_roughness",
                                                    "KHR_materials_variants",
                                                    "KHR_mesh_quantization",
                                                    "KHR_node_visibility",
                                                    "EXT_mesh_gpu_instancing"};

size_t count_of(const Item& root, const char* list) {
  const auto found = root.find(list);
  return found ? found->size() : 0;
}

template <class Function>
void for_each(const Item& parent, const char* list, Function function) {
  const auto found = parent.find(list);
  if (!found) return;
  for (size_t i = 0; i < found->size(); ++i) {
    const Item item = found->at(i);
    item.object();
    function(item, i);
  }
}

void numbers(const Item& item, const char* key, size_t count) {
  const auto found = item.find(key);
  if (!found) return;
  if (found->size() != count) found->fail("expected {} numbers, found {}", count, found->size());
  for (size_t i = 0; i < count; ++i) found->at(i).number();
}

void optional_text(const Item& item, const char* key) {
  if (const auto found = item.find(key)) found->text();
}

void optional_index(const Item& item, const char* key, size_t size, const char* what) {
  if (const auto found = item.find(key)) found->index(size, what);
}

struct Sizes {
  int64_t view_length = 0, stride = 0;
};

void check_range(const Item& at, const Sizes& view, int64_t offset, int64_t count, int64_t element,
                 bool strided) {
  const int64_t stride = strided && view.stride != 0 ? view.stride : element;
  if (stride < element)
    at.fail("an element of {} bytes does not fit the view's byteStride of {}", element, stride);
  if (count > 0 && offset + stride * (count - 1) + element > view.view_length)
    at.fail("{} elements of {} bytes from offset {} go beyond the buffer view's {} bytes", count, element,
            offset, view.view_length);
}

void check_accessor(const Item& accessor, const std::vector<Sizes>& views) {
  const int64_t count = accessor.at("count").integer(0, k_max_count);
  const int64_t component = accessor.at("componentType").integer(0, 1 << 16);
  const int64_t component_size = bytes_of_component(static_cast<int>(component));
  if (component_size == 0) accessor.at("componentType").fail("{} is not a component type", component);
  const int components = components_of_type(accessor.at("type").text());
  if (components == 0) accessor.at("type").fail("'{}' is not an accessor type", accessor.at("type").text());
  const int64_t element = component_size * components;
  accessor.boolean("normalized", false);
  const int64_t offset = accessor.integer("byteOffset", 0, 0, k_max_bytes);
  if (const auto view = accessor.find("bufferView"))
    check_range(accessor, views[view->index(views.size(), "bufferViews")], offset, count, element, true);
  else if (count > k_max_free_count)
    accessor.fail("{} elements without a buffer view; at most {} are accepted", count, k_max_free_count);
  const auto sparse = accessor.find("sparse");
  if (!sparse) return;
  const int64_t entries = sparse->at("count").integer(0, count);
  const Item indices = sparse->at("indices"), values = sparse->at("values");
  const int64_t index_type = indices.at("componentType").integer(0, 1 << 16);
  if (index_type != 5121 && index_type != 5123 && index_type != 5125)
    indices.at("componentType").fail("{} is not an unsigned integer type", index_type);
  check_range(indices, views[indices.at("bufferView").index(views.size(), "bufferViews")],
              indices.integer("byteOffset", 0, 0, k_max_int), entries,
              bytes_of_component(static_cast<int>(index_type)), false);
  check_range(values, views[values.at("bufferView").index(views.size(), "bufferViews")],
              values.integer("byteOffset", 0, 0, k_max_int), entries, element, false);
}

void check_buffers(const Item& root) {
  std::vector<int64_t> lengths;
  for_each(root, "buffers", [&](const Item& buffer, size_t) {
    lengths.push_back(buffer.at("byteLength").integer(1, k_max_bytes));
    optional_text(buffer, "uri");
  });
  std::vector<Sizes> views;
  for_each(root, "bufferViews", [&](const Item& view, size_t) {
    const int64_t buffer_length = lengths[view.at("buffer").index(lengths.size(), "buffers")];
    const int64_t offset = view.integer("byteOffset", 0, 0, k_max_bytes);
    const int64_t length = view.at("byteLength").integer(1, k_max_bytes);
    if (offset + length > buffer_length)
      view.fail("bytes {} to {} are outside the buffer's {} bytes", offset, offset + length, buffer_length);
    const int64_t stride = view.integer("byteStride", 0, 4, 252);
    if (stride % 4 != 0) view.at("byteStride").fail("{} is not a multiple of 4", stride);
    views.push_back({length, stride});
  });
  for_each(root, "accessors", [&](const Item& accessor, size_t) { check_accessor(accessor, views); });
}

void check_meshes(const Item& root) {
  const size_t accessors = count_of(root, "accessors"), materials = count_of(root, "materials");
  for_each(root, "meshes", [&](const Item& mesh, size_t) {
    optional_text(mesh, "name");
    if (mesh.at("primitives").size() == 0) mesh.at("primitives").fail("expected at least one");
    for_each(mesh, "primitives", [&](const Item& primitive, size_t) {
      const Item attributes = primitive.at("attributes");
      for (const auto& [name, value] : attributes.object().json().items())
        attributes.at(name.c_str()).index(accessors, "accessors");
      optional_index(primitive, "indices", accessors, "accessors");
      optional_index(primitive, "material", materials, "materials");
      primitive.integer("mode", 4, 0, 6);
    });
  });
}

void check_nodes(const Item& root) {
  const size_t count = count_of(root, "nodes");
  std::vector<uint32_t> parent(count, k_none);
  for_each(root, "nodes", [&](const Item& node, size_t i) {
    optional_text(node, "name");
    optional_index(node, "mesh", count_of(root, "meshes"), "meshes");
    optional_index(node, "camera", count_of(root, "cameras"), "cameras");
    numbers(node, "matrix", 16);
    numbers(node, "translation", 3);
    numbers(node, "rotation", 4);
    numbers(node, "scale", 3);
    const auto children = node.find("children");
    for (size_t k = 0; children && k < children->size(); ++k) {
      const uint32_t child = children->at(k).index(count, "nodes");
      if (parent[child] != k_none)
        children->at(k).fail("node {} already is a child of node {}; a node has one parent", child,
                             parent[child]);
      parent[child] = static_cast<uint32_t>(i);
    }
  });
  // With one parent each, a node is on a cycle or below one exactly when walking up never ends. 1 = known to
  // end.
  std::vector<uint8_t> ends(count, 0);
  for (uint32_t i = 0; i < count; ++i) {
    size_t steps = 0;
    uint32_t at = i;
    for (; at != k_none && !ends[at]; at = parent[at])
      if (++steps > count) root.at("nodes").at(i).fail("the node graph is cyclic here; it must be a forest");
    for (uint32_t k = i; k != k_none && !ends[k]; k = parent[k]) ends[k] = 1;
  }
  const size_t scenes = count_of(root, "scenes");
  optional_index(root, "scene", scenes, "scenes");
  for_each(root, "scenes", [&](const Item& scene, size_t) {
    const auto nodes = scene.find("nodes");
    std::set<uint32_t> seen;
    for (size_t k = 0; nodes && k < nodes->size(); ++k) {
      const uint32_t node = nodes->at(k).index(count, "nodes");
      if (parent[node] != k_none)
        nodes->at(k).fail("node {} is a child of node {}, not a root", node, parent[node]);
      if (!seen.insert(node).second) nodes->at(k).fail("node {} is listed twice", node);
    }
  });
}

void check_textures(const Item& root) {
  for_each(root, "samplers", [&](const Item& sampler, size_t) {
    for (const char* key : {"wrapS", "wrapT"}) {
      const int64_t wrap = sampler.integer(key, 10497, 0, 1 << 16);
      if (wrap != 10497 && wrap != 33071 && wrap != 33648)
        sampler.at(key).fail("{} is not a wrap mode", wrap);
    }
    sampler.integer("magFilter", 9729, 0, 1 << 16);
    sampler.integer("minFilter", 9729, 0, 1 << 16);
  });
  for_each(root, "textures", [&](const Item& texture, size_t) {
    optional_index(texture, "sampler", count_of(root, "samplers"), "samplers");
    optional_index(texture, "source", count_of(root, "images"), "images");
  });
  for_each(root, "images", [&](const Item& image, size_t) {
    optional_text(image, "name");
    optional_text(image, "uri");
    optional_text(image, "mimeType");
    optional_index(image, "bufferView", count_of(root, "bufferViews"), "bufferViews");
    if (image.find("uri") && image.find("bufferView")) image.fail("both 'uri' and 'bufferView' are given");
  });
}

void check_asset(const Item& root) {
  const std::string& version = root.object().at("asset").at("version").text();
  if (version.rfind("2.", 0) != 0) root.at("asset").at("version").fail("'{}', expected 2.0", version);
  const std::string minimum = root.at("asset").text("minVersion", "2.0");
  if (minimum != "2.0") root.at("asset").at("minVersion").fail("'{}'; 2.0 is what can be read", minimum);
  for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
    const auto list = root.find(key);
    for (size_t i = 0; list && i < list->size(); ++i) {
      const std::string& name = list->at(i).text();
      if (key == std::string_view("extensionsRequired") && !is_known_extension(name))
        list->at(i).fail("the file requires {}, which is not known here", name);
    }
  }
}

}  // namespace

bool is_known_extension(const std::string& name) { return k_known_extensions.count(name) != 0; }

void check_structure(const Document& document) {
  const Item root = document.root();
  check_asset(root);
  check_buffers(root);
  check_meshes(root);
  for_each(root, "materials", [](const Item&, size_t) {});
  for_each(root, "cameras", [](const Item&, size_t) {});
  check_nodes(root);
  check_textures(root);
}

}  // namespace lucerna::scene
