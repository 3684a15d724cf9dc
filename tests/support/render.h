#pragma once
// Renders a scene through the real renderer, for tests: one renderer per call, small pictures, fixed samples;
// and comparisons of pictures.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <map>
#include <string>

#include "support/device.h"
#include "support/solver.h"

namespace lucerna::test {

using Settings = std::map<std::string, std::string>;

/// Maximum of samples with validation: more samples repeat the same commands, and the validation layers take
/// half of the time. Pictures that another test case renders with validation need none either.
inline constexpr uint32_t k_validated_samples = 16;

struct Render {
  std::string scene;  ///< "cornell": scenes/cornell/cornell.gltf
  uint32_t width = 64, height = 64, samples = 16;
  Settings settings;
  gpu::Defines defines;
  std::string camera;
  bool validated = true;  ///< if there are at most k_validated_samples
};

struct Result {
  film::Image image;
  film::ImageError error;
  transport::TransportStats stats;
  uint64_t prepared_rays = 0;  ///< part of stats.rays before the first sample: of records
  uint64_t validation_messages = 0;
  std::string tracer;
  irradiance_cache::CacheStatus cache;  ///< of the cache in use, if any
  std::array<bool, 4> bias_known{};
};

/// Paths in flight and records sufficient for small pictures, which do not depend on them. With the defaults
/// every new renderer fills (MALLOC_PERTURB_) half a gigabyte for records and a fifth for paths, which takes
/// longer than the picture.
inline constexpr const char *k_batch = "32768", *k_room = "20000";

/// Dense, low-noise records with gathering along edges: small pictures use more of the cache than with its
/// defaults, which place few records at first.
inline const Settings k_dense_records{{"cache.gather", "true"},
                                      {"cache.metric", "hessian"},
                                      {"cache.min_radius", "3"},
                                      {"cache.noise", "0.03"},
                                      {"cache.stop", "0.002"}};

/// These settings, and those of dense records where they are not set.
inline Settings dense_records(Settings settings) {
  settings.insert(k_dense_records.begin(), k_dense_records.end());
  return settings;
}

inline void set(session::Renderer& renderer, const Settings& settings) {
  for (const auto& [key, value] : settings) renderer.settings().set(key, value);
  renderer.apply_settings();
}

inline film::Image finish(session::Renderer& renderer) {
  while (renderer.step()) {
  }
  return renderer.image();
}

/// `made`: the scene, instead of the named one.
inline Result render(const Render& r, const scene::Scene* made = nullptr) {
  session::Renderer renderer(
      test::renderer_options(r.validated && r.samples <= k_validated_samples, r.defines));
  renderer.settings().set("path.batch", k_batch);
  for (const char* key : {"tracer", "path.batch", "path.classes"})
    if (const auto at = r.settings.find(key); at != r.settings.end())
      renderer.settings().set(key, at->second);
  renderer.set_size(r.width, r.height);
  if (made)
    renderer.set_scene(std::make_shared<scene::Scene>(*made));
  else
    renderer.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + r.scene + "/" + r.scene + ".gltf");
  Settings settings = dense_records(r.settings);
  settings["samples"] = std::to_string(r.samples);
  settings.try_emplace("cache.max_records", k_room);
  set(renderer, settings);
  if (!r.camera.empty()) renderer.choose_camera(r.camera);
  Result result;
  result.image = finish(renderer);
  result.error = renderer.image_error();
  renderer.finish_ledger();
  result.stats = renderer.stats();
  result.prepared_rays = renderer.progress().ledger().entries().back().prepared_rays;
  result.validation_messages = renderer.device().validation_messages();
  result.tracer = renderer.tracer_name();
  if (test::cache(renderer)) result.cache = test::cache(renderer)->status();
  for (size_t c = 0; c < 4; ++c) result.bias_known[c] = renderer.progress().bias(c).has_value();
  return result;
}

/// A scene made by the test, in a square picture; checks that nothing is dropped, and that there are no
/// validation messages (up to k_validated_samples).
inline Result render(const scene::Scene& scene, const Settings& settings, uint32_t samples, uint32_t size,
                     bool validated = true) {
  const Result r = render({.scene = {},
                           .width = size,
                           .height = size,
                           .samples = samples,
                           .settings = settings,
                           .validated = validated},
                          &scene);
  CHECK(r.validation_messages == 0);
  CHECK(r.stats.dropped == 0);
  return r;
}

/// The sum of all components at a pixel.
inline vec3 sum_at(const film::Image& image, size_t pixel) {
  vec3 sum(0);
  for (const auto& c : image.components) sum += c[pixel];
  return sum;
}

/// Compares bit for bit.
inline bool identical(const std::vector<vec3>& a, const std::vector<vec3>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(vec3)) == 0;
}
inline bool identical(const film::Image& a, const film::Image& b) {
  for (const int c : k_components)
    if (!identical(a.components[c], b.components[c]) || !identical(a.odd_half[c], b.odd_half[c]))
      return false;
  return a.samples == b.samples && identical(a.albedo, b.albedo) && identical(a.normal, b.normal);
}

/// Mean luminance of a layer.
inline double mean(const std::vector<vec3>& layer) {
  double sum = 0;
  for (const vec3& v : layer) sum += luminance(v);
  return sum / double(layer.size());
}

struct Mean {
  double value = 0, noise = 0;  ///< standard error, from the two halves
};

/// Mean luminance of a component over a block of 8x8 pixels, without the `middle` columns on either side of
/// the picture's centre.
inline Mean block_mean(const film::Image& image, int component, uint32_t across, uint32_t down,
                       uint32_t middle = 0) {
  Mean m;
  int count = 0;
  for (uint32_t i = 0; i < 64; ++i) {
    const uint32_t x = across * 8 + i % 8;
    if (x + middle >= image.width / 2 && x < image.width / 2 + middle) continue;
    const size_t pixel = size_t{down * 8 + i / 8} * image.width + x;
    const double y = luminance(image.components[component][pixel]),
                 odd = luminance(image.odd_half[component][pixel]);
    m.value += y, m.noise += (y - odd) * (y - odd), ++count;
  }
  m.value /= count, m.noise = std::sqrt(m.noise) / count;
  return m;
}

}  // namespace lucerna::test
