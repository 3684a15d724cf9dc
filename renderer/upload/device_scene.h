#pragma once
// The flattened scene and its tree in device memory, bound by name.
#include <vector>

#include "bvh/layout.h"
#include "gpu/kernel.h"
#include "upload/flatten.h"

namespace lucerna::upload {

/// The environment's texels and tables on the device.
struct EnvironmentBuffers {
  EnvironmentBuffers(gpu::Device& device, const FlatLights& flat);
  bool holds(const FlatLights& flat) const;
  gpu::Buffer texels, alias, sun_cells;

 private:
  SharedVector<vec3> of_texels_;
  EnvironmentTables of_;
};

/// A table on the device that rarely changes.
struct SharedTable {
  SharedTable(gpu::Device& device, const char* name, const SharedVector<vec4>& values);
  gpu::Buffer texels;
  SharedVector<vec4> of;
};

/// Lights and environment on the device.
struct LightBuffers {
  LightBuffers() = default;
  /// `before`: provides the environment, distributions and pictures of lamps if they are equal.
  LightBuffers(gpu::Device& device, const FlatLights& flat, const LightBuffers& before = {});
  explicit operator bool() const { return bool(lights); }
  gpu::Buffer lights, alias, pmf, groups, sun_density, portals, portal_sums;
  std::shared_ptr<const EnvironmentBuffers> environment;
  std::shared_ptr<const SharedTable> irradiance, profiles, pictures;
};

/// Materials on the device, with the albedo tables of their glasses and the volumes of their solids.
struct MaterialBuffers {
  MaterialBuffers() = default;
  MaterialBuffers(gpu::Device& device, const FlatMaterials& flat);
  explicit operator bool() const { return bool(materials); }
  gpu::Buffer materials, tables, media;
};

class DeviceScene {
 public:
  DeviceScene(gpu::Device& device, const FlatScene& flat, const bvh::BvhData& tree);
  /// Exchanges the buffers for others, of any size, and returns the old ones. Invalidates earlier bindings:
  /// call bind() afterwards.
  LightBuffers exchange(LightBuffers lights, const Effects& effects) noexcept;
  const LightBuffers& lights() const { return lights_; }
  MaterialBuffers exchange(MaterialBuffers materials, const Effects& effects) noexcept;
  /// Names: scene_*, texture_bucket_N, light_alias, PrimitiveLightPmf, environment_*, sun_*, portal_sums,
  /// bsdf_table, bvh_nodes, bvh_triangles.
  void bind(gpu::Resources& resources) const;
  /// #defines that compile in only the features of the scene.
  gpu::Defines defines() const;
  const Effects& effects() const { return effects_; }

 private:
  gpu::Buffer triangles_, vertices_, tangents_, extra_, nodes_, bvh_triangles_;
  MaterialBuffers materials_;
  LightBuffers lights_;
  std::vector<gpu::TextureArray> buckets_;
  Effects effects_;
};

}  // namespace lucerna::upload
