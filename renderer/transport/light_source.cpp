#include "transport/light_source.h"

#include <algorithm>

#include "upload/alias_table.h"

namespace lucerna::transport {

LightSource::LightSource(gpu::Device& device, const upload::FlatLights& lights, const vec3& scene_centre,
                         float scene_radius) {
  std::vector<double> power = lights.light_power;
  // The disk covers the scene's outermost points in spite of rounding.
  table_ = {.centre = scene_centre,
            .radius = 1.0001f * scene_radius,
            .count = 0,
            .sky = shared::k_no_sky_entry,
            .sun_pmf = lights.light_alias.empty() ? 0 : lights.light_alias.back().z,
            .pad0 = 0};
  if (lights.sky_power > 0) {
    table_.sky = uint32_t(power.size());
    power.push_back(lights.sky_power);
  }
  for (const double p : power) power_ += p;
  const std::vector<vec4> alias = upload::build_alias_table(power);
  table_.count = uint32_t(alias.size());
  if (alias.empty()) power_ = 0;
  alias_ = gpu::Buffer(device, {.name = "table of emission",
                                .bytes = std::max<uint64_t>(16, alias.size() * sizeof(vec4)),
                                .texel = true});
  if (!alias.empty()) alias_.write(std::span<const vec4>(alias));
  block_ = gpu::Buffer(device, {.name = "emission", .bytes = sizeof table_});
  block_.write(&table_, sizeof table_);
}

void LightSource::bind(gpu::Resources& resources) const {
  resources.set("emission_alias", alias_);
  resources.set("EmissionBlock", block_);
}

}  // namespace lucerna::transport
