#pragma once
// Renders a scene through the real program, for tests: one renderer a call, small pictures, fixed samples.
#include <map>
#include <string>

#include "session/renderer.h"

namespace lucerna::test {

struct Render {
  std::string scene;  ///< "cornell": scenes/cornell/cornell.gltf
  uint32_t width = 64, height = 64, samples = 16;
  std::map<std::string, std::string> settings;
  gpu::Defines defines;
  std::string camera;
};

struct Result {
  film::Image image;
  transport::TransportStats stats;
  uint64_t validation_messages = 0;
  std::string tracer;
};

inline Result render(const Render& r) {
  session::Renderer renderer({.device = "cpu", .validation = true, .shaders = {}, .defines = r.defines});
  for (const char* key : {"tracer", "path.batch"})
    if (const auto at = r.settings.find(key); at != r.settings.end())
      renderer.settings().set(key, at->second);
  renderer.set_size(r.width, r.height);
  renderer.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + r.scene + "/" + r.scene + ".gltf");
  for (const auto& [key, value] : r.settings) renderer.settings().set(key, value);
  renderer.settings().set("samples", std::to_string(r.samples));
  renderer.apply_settings();
  if (!r.camera.empty()) renderer.choose_camera(r.camera);
  while (renderer.step()) {
  }
  return {renderer.image(), renderer.stats(), renderer.device().validation_messages(),
          renderer.tracer_name()};
}

/// The sum of all components at a pixel.
inline vec3 sum_at(const film::Image& image, size_t pixel) {
  vec3 sum(0);
  for (const auto& c : image.components) sum += c[pixel];
  return sum;
}

}  // namespace lucerna::test
