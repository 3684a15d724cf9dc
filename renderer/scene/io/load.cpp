#include "scene/io/load.h"

#include <fstream>
#include <set>

#include "scene/io/document.h"

namespace lucerna::scene {
namespace {

const std::set<std::string> k_known_extensions{
    "KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_specular", "KHR_materials_transmission",
    "KHR_materials_volume", "KHR_materials_diffuse_transmission", "KHR_materials_unlit", "KHR_lights_punctual",
    "KHR_texture_transform", "KHR_mesh_quantization", "EXT_mesh_gpu_instancing"};

/// Keeps the file's bytes; OpenImageIO decodes them later.
bool keep_bytes(tinygltf::Image* image, const int, std::string*, std::string*, int, int, const unsigned char* bytes, int size, void*) {
  image->image.assign(bytes, bytes + std::max(size, 0));
  return true;
}

void parse(io::Document& d) {
  const std::string name = d.file.string();
  std::error_code error;
  if (!std::filesystem::exists(d.file, error)) throw Error(name, "no such file");
  if (!std::filesystem::is_regular_file(d.file, error)) throw Error(name, "is not a file");
  std::ifstream in(d.file, std::ios::binary);
  char magic[4] = {};
  in.read(magic, 4);
  if (!in && in.gcount() < 4) throw Error(name, "is too short to be glTF");
  const bool binary = std::string(magic, 4) == "glTF";
  tinygltf::TinyGLTF reader;
  reader.SetImageLoader(keep_bytes, nullptr);
  std::string problem, remark;
  bool good = false;
  try {
    good = binary ? reader.LoadBinaryFromFile(&d.model, &problem, &remark, name) : reader.LoadASCIIFromFile(&d.model, &problem, &remark, name);
  } catch (const std::exception& e) { problem = e.what(); }
  if (!good) {
    for (char& c : problem)
      if (c == '\n') c = ' ';
    while (!problem.empty() && problem.back() == ' ') problem.pop_back();
    throw Error(name, "is not valid glTF: " + (problem.empty() ? std::string("it cannot be parsed") : problem));
  }
}

void check_extensions(io::Document& d, Scene& scene) {
  for (const std::string& e : d.model.extensionsRequired)
    if (!k_known_extensions.count(e)) d.fail("extensionsRequired", fmt::format("'{}' is required, and this program does not know it", e));
  for (const std::string& e : std::set<std::string>(d.model.extensionsUsed.begin(), d.model.extensionsUsed.end()))
    if (!k_known_extensions.count(e)) scene.warnings.push_back(fmt::format("{}: extension '{}' is not known and ignored", d.file.filename().string(), e));
}

}  // namespace

Scene load(const std::filesystem::path& file, const LoadOptions& options, const LoadProgress& progress) {
  const auto report = [&](float fraction, const char* what) {
    if (progress && !progress(fraction, what)) throw Error("", "cancelled");
  };
  io::Document d;
  d.file = file;
  Scene scene;
  scene.name = file.stem().string();
  scene.file = file.string();
  report(0, "reading");
  parse(d);
  report(0.1f, "materials");
  check_extensions(d, scene);
  io::load_materials(d, scene);
  io::load_meshes(d, scene, progress);
  io::load_nodes(d, scene);
  io::load_images(d, scene, options, progress);
  io::load_settings(d, scene);
  for (const auto& [text, count] : d.counted)
    scene.warnings.push_back(fmt::format("{}: {}", file.filename().string(), fmt::format(fmt::runtime(text), count)));
  if (count_triangles(scene) == 0) scene.warnings.push_back(fmt::format("{}: has no triangles to show", file.filename().string()));
  report(1, "loaded");
  return scene;
}

}  // namespace lucerna::scene
