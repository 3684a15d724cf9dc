#pragma once
// Records on the device, made by tests from places and radii, in an octree, for kernels that look them up.
#include <functional>
#include <vector>

#include "kernels/gpu_support.h"
#include "solvers/irradiance_cache/cache.h"
#include "solvers/lookup/octree.h"

namespace lucerna::test {

/// Records of circles, or of ellipses with the major axis along their tangent.
struct RecordDisc {
  irradiance_cache::Place place;
  float radius;       ///< the lesser one of an ellipse [m]
  float nearest = 0;  ///< distance of the nearest hit of its rays [m]
  float stretch = 1;  ///< greater radius over the lesser
  vec3 light{0};      ///< irradiance of the secondary part, without gradients
  float error = 0;    ///< standard error of its luminance
};

struct RecordBed {
  SilentDevice silent;
  gpu::Device& device = silent.device;
  gpu::ShaderCompiler compiler;
  gpu::Stream stream{device};

  /// Runs `change`, which gets a function that binds lookup.glsl's resources, and returns the changed
  /// records; checks that the octree has every radius. `least`: minimum radius [m]; `frame`: non-zero values
  /// besides that.
  std::vector<irradiance_cache::Record> change(
      const std::vector<RecordDisc>& discs, float least, shared::CacheFrame frame,
      const std::function<void(const std::function<void(gpu::Resources&)>& bind)>& change) {
    const auto count = uint32_t(discs.size());
    irradiance_cache::Records records(device, count);
    std::vector<irradiance_cache::Place> places;
    for (const RecordDisc& d : discs) places.push_back(d.place);
    records.append(places);
    irradiance_cache::RawRecords raw = records.raw(count);
    for (uint32_t i = 0; i < count; ++i) {
      const float minor = discs[i].radius, major = minor * discs[i].stretch;
      vec4* const texels = &raw.places[i * shared::k_record_texels];
      texels[0].w = major;
      texels[2].y = discs[i].nearest;
      texels[2].z = discs[i].error;
      vec4* const light =
          &raw.lights[(i * shared::k_part_count + shared::k_part_secondary) * shared::k_part_texels];
      light[0] = vec4(discs[i].light, 0);
      texels[3] = vec4(std::sqrt(std::max(0.0f, 1 / (minor * minor) - 1 / (major * major))), 0, 0, minor);
      raw.spheres[i] = vec4(discs[i].place.position, major);
    }
    records.restore(raw);
    frame.record_count = count;
    frame.parallel = 1, frame.least_of_distance = least, frame.least_most = 1;
    gpu::Buffer block(device, {.name = "frame", .bytes = sizeof frame}),
        candidates(device, {.name = "candidates", .bytes = 16, .texel = true});
    block.write(&frame, sizeof frame);
    lookup::Octree octree(device, compiler,
                          {.spheres = count, .references = 64 * count, .copies = true, .discs = true});
    const lookup::Discs planes = records.discs(0.3f);
    octree.build(stream, records.spheres(), {.most = count}, &planes);
    change([&](gpu::Resources& to) {
      records.bind(to, irradiance_cache::Records::Use::look_up);
      to.set("CacheBlock", block);
      to.set("Candidates", candidates);
      octree.bind(to);
    });
    const std::vector<irradiance_cache::Record> all = records.read();
    const std::vector<float> radii = records.radii(0);
    const irradiance_cache::RawRecords after = records.raw(count);
    for (uint32_t i = 0; i < count; ++i) {
      CHECK(all[i].radius == radii[i]);
      CHECK(after.spheres[i].w == radii[i]);
      CHECK(vec3(after.spheres[i]) == discs[i].place.position);
    }
    return all;
  }
};

}  // namespace lucerna::test
