#pragma once
// Records of an irradiance cache in a scene of scenes/, evaluated through the wavefront.
#include <cmath>
#include <memory>
#include <numeric>
#include <string>

#include "bvh/embree/build.h"
#include "gpu/kernel.h"
#include "scene/io/load.h"
#include "shaders/shared/facet.h"
#include "solvers/irradiance_cache/evaluate.h"
#include "support/device_name.h"
#include "transport/frame.h"
#include "upload/device_scene.h"

namespace lucerna::test {

class CacheBed {
 public:
  explicit CacheBed(const scene::Scene& scene, uint32_t slots = 65536)
      : device({device_name(), true}),
        compiler(gpu::ShaderCompiler::default_root()),
        automaton(paths::compile_components()),
        flat(upload::flatten(scene)),
        device_scene(device, flat, bvh::build({flat.positions, flat.non_opaque})),
        wavefront(device, compiler, device_scene, slots, {}),
        evaluator(device, compiler, slots) {}
  static scene::Scene load(const std::string& name) {
    return scene::load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + name + "/" + name + ".gltf");
  }

  /// The same places, with facets of their normals.
  static std::vector<irradiance_cache::Place> on_facets(std::vector<irradiance_cache::Place> places) {
    for (irradiance_cache::Place& p : places) p.facet = shared::facet_pack(p.normal);
    return places;
  }

  /// `enabled`: components that the records' paths may contribute to.
  void set_frame(uint32_t enabled, transport::FrameOptions options = {}) {
    options.enabled = enabled;
    wavefront.set_frame(transport::make_frame(flat, {}, automaton, options), enabled);
  }
  std::vector<irradiance_cache::Record> evaluate(const std::vector<irradiance_cache::Place>& places,
                                                 const irradiance_cache::EvaluateOptions& options) {
    irradiance_cache::Records records(device, static_cast<uint32_t>(places.size()));
    records.append(on_facets(places));
    evaluate(records, options);
    return records.read();
  }
  void evaluate(irradiance_cache::Records& records, const irradiance_cache::EvaluateOptions& options) {
    std::vector<uint32_t> all(records.size());
    std::iota(all.begin(), all.end(), 0u);
    evaluator.evaluate(wavefront, automaton, records, all, options);
  }

  gpu::Device device;
  gpu::ShaderCompiler compiler;
  paths::Automaton automaton;
  upload::FlatScene flat;
  upload::DeviceScene device_scene;
  transport::Wavefront wavefront;
  irradiance_cache::Evaluator evaluator;
};

/// Irradiance (red) from scenes/furnace-disk: a disk of radius 1 and radiance 10, 2 m above the floor, at a
/// distance d from its axis.
inline double disk_irradiance(double d) {
  const double h = 2, r = 1, t = h * h + d * d + r * r;
  return double{k_pi} * 10 / 2 * (1 - (h * h + d * d - r * r) / std::sqrt(t * t - 4 * d * d * r * r));
}

struct Moments {
  double mean = 0, deviation = 0;  ///< of the mean
};
/// Moments of a figure over `count` records.
template <class Value>
Moments moments(const std::vector<irradiance_cache::Record>& records, size_t first, size_t count,
                const Value& value) {
  double sum = 0, squares = 0;
  for (size_t i = first; i < first + count; ++i) {
    const double v = value(records[i]);
    sum += v, squares += v * v;
  }
  const double mean = sum / double(count);
  return {mean, std::sqrt(std::max(0.0, squares / double(count) - mean * mean) / double(count - 1))};
}

}  // namespace lucerna::test
