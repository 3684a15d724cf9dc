#pragma once
// The flattened scene and its tree in device memory, bound by name.
#include <vector>

#include "bvh/layout.h"
#include "gpu/kernel.h"
#include "upload/flatten.h"

namespace lucerna::upload {

class DeviceScene {
 public:
  DeviceScene(gpu::Device& device, const FlatScene& flat, const bvh::BvhData& tree);
  /// Uploads lights and environment again (sizes may differ). Binds anew: call bind() afterwards.
  void update_lights(gpu::Device& device, const FlatScene& flat);
  /// Uploads materials again, as update_lights().
  void update_materials(gpu::Device& device, const FlatScene& flat);
  /// Names: scene_*, texture_bucket_N, light_alias, PrimitiveLightPmf, environment_*, sun_*, bsdf_table,
  /// bvh_nodes, bvh_triangles.
  void bind(gpu::Resources& resources) const;
  /// #defines that compile in what the scene needs and nothing else.
  gpu::Defines defines() const;
  const Effects& effects() const { return effects_; }

 private:
  gpu::Buffer triangles_, vertices_, tangents_, extra_, materials_, lights_, light_alias_, light_pmf_,
      environment_texels_, environment_alias_, sun_cells_, sun_density_, tables_, nodes_, bvh_triangles_;
  std::vector<gpu::TextureArray> buckets_;
  Effects effects_;
};

}  // namespace lucerna::upload
