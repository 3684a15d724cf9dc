#pragma once
// Shared by the tests of light sampling: shaders/lib/lights.glsl with the program's tables.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <random>

#include "gpu/stream.h"
#include "kernels/statistics_support.h"
#include "upload/device_scene.h"

namespace lucerna::test {

inline constexpr double k_tau = 6.283185307179586;

struct Draw {
  vec3 direction;
  float distance;
  vec3 radiance;
  float pdf;
  vec3 target;
  uint32_t primitive;
  vec3 normal;
  uint32_t delta;  ///< 2: of the sky, if separate from the sun
  vec2 uv;
};
struct Answer {
  vec3 value;
  float pdf;
};

inline gpu::Device& device() {
  static gpu::Device instance({"", true});
  return instance;
}

/// A flattened scene on the device, and the kernel in the scene's variant.
class Lights {
 public:
  explicit Lights(const scene::Scene& scene, float sun_threshold = 0)
      : Lights(upload::flatten(scene, sun_threshold)) {}
  explicit Lights(upload::FlatScene flattened) : flat(std::move(flattened)), scene_(device(), flat, {}) {
    frame.light_count = static_cast<uint32_t>(flat.lights.size() / shared::k_light_texels);
    frame.first_lamp = flat.first_lamp, frame.lamp_count = static_cast<uint32_t>(flat.lamp_alias.size());
    frame.first_shape = flat.first_shape, frame.shape_count = flat.shape_count;
    frame.lamp_pmf = flat.lamp_pmf;
    frame.environment_radiance = flat.environment_radiance;
    frame.environment_width = flat.environment_width;
    frame.environment_height = flat.environment_height;
    frame.environment_rotation = flat.environment_rotation;
    frame.environment_light_pmf = flat.environment_light_pmf;
    frame_.write(&frame, sizeof frame);
    scene_.bind(resources_);
    resources_.set("FrameBlock", frame_);
  }

  std::vector<Draw> draw(const vec3& position, uint32_t count, uint32_t seed) {
    return run<Draw>("0", "Draws", {count, seed, position});
  }
  /// `sun`: of the sun, if separate.
  std::vector<Answer> environment(const std::vector<vec3>& directions, bool sun = false) {
    std::vector<vec4> questions;
    for (const vec3& d : directions) questions.emplace_back(d, sun ? 1 : 0);
    return query("1", questions);
  }
  std::vector<Answer> triangle_pdf(const std::vector<vec4>& questions) { return query("2", questions); }
  /// Distances and densities of directions (xyz) to the lamp with a shape of that number (w).
  std::vector<Answer> shapes(const vec3& position, const std::vector<vec4>& questions) {
    return query("4", questions, position);
  }
  /// Draws entries of a given table.
  std::vector<Answer> choose(const std::vector<vec4>& table, uint32_t count, uint32_t seed) {
    gpu::Buffer buffer(device(), {"table", table.size() * sizeof(vec4), gpu::Memory::device, true});
    buffer.write(std::span<const vec4>(table));
    shared::Frame own = frame;
    own.light_count = static_cast<uint32_t>(table.size());
    frame_.write(&own, sizeof own);
    resources_.set("light_alias", buffer);
    questions_ = gpu::Buffer(device(), {"questions", count * sizeof(vec4)});
    resources_.set("Questions", questions_);
    return run<Answer>("3", "Answers", {count, seed, vec3(0)});
  }

  upload::FlatScene flat;
  shared::Frame frame{};

 private:
  struct Push {
    uint32_t count, seed;
    vec3 position;
  };
  std::vector<Answer> query(const char* what, const std::vector<vec4>& questions,
                            const vec3& position = vec3(0)) {
    questions_ = gpu::Buffer(device(), {"questions", questions.size() * sizeof(vec4)});
    questions_.write(std::span<const vec4>(questions));
    resources_.set("Questions", questions_);
    return run<Answer>(what, "Answers", {static_cast<uint32_t>(questions.size()), 0, position});
  }
  template <class Result>
  std::vector<Result> run(const char* what, const char* name, const Push& push) {
    static gpu::ShaderCompiler compiler;
    gpu::Defines defines = scene_.defines();
    defines["TEST_ASK"] = what;
    const gpu::Kernel kernel(device(), compiler,
                             std::string(LUCERNA_SOURCE_DIR) + "/tests/kernels/shaders/light_probe.comp",
                             defines);
    const gpu::Buffer results(device(), {name, push.count * sizeof(Result)});
    resources_.set(name, results);
    gpu::Stream stream(device());
    stream.dispatch(kernel, resources_, push, gpu::groups_for(push.count, 64));
    stream.run();
    return results.read_all<Result>();
  }

  upload::DeviceScene scene_;
  gpu::Buffer frame_{device(), {"frame", sizeof(shared::Frame)}};
  gpu::Buffer questions_;
  gpu::Resources resources_;
};

inline void add_triangle(scene::Scene& scene, const vec3& a, const vec3& b, const vec3& c,
                         const vec3& emission) {
  scene::Material material;
  material.emission = emission;
  scene::Primitive primitive;
  primitive.positions = {a, b, c};
  primitive.normals.assign(3, glm::normalize(glm::cross(b - a, c - a)));
  primitive.triangles = {{0, 1, 2}};
  primitive.material = static_cast<scene::Id>(scene.materials.size());
  scene::Mesh mesh;
  mesh.primitives.push_back(primitive);
  scene::Instance instance;
  instance.mesh = static_cast<scene::Id>(scene.meshes.size());
  scene.materials.push_back(material);
  scene.meshes.push_back(mesh);
  scene.instances.push_back(instance);
}

/// A map with a sun, a dark floor, a gradient and noise.
inline scene::Scene sky(uint32_t width, uint32_t height, float rotation) {
  scene::Scene scene;
  scene::Image image;
  image.width = width, image.height = height;
  std::mt19937 random(3);
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      const float noise = static_cast<float>(random() >> 8) * 0x1p-24f;
      float value =
          y > height / 2 ? 0 : 0.2f + noise + 2.0f * static_cast<float>(x) / static_cast<float>(width);
      if (x == width / 3 && y == height / 4) value = 500;
      image.floats.insert(image.floats.end(), {value, 0.9f * value, 0.5f * value + 0.1f * noise, 1});
    }
  scene.images.push_back(image);
  scene.environment.image = 0;
  scene.environment.rotation = rotation;
  scene.environment.scale = 2;
  return scene;
}

}  // namespace lucerna::test
