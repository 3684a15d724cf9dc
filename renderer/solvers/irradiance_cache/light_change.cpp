#include "solvers/irradiance_cache/light_change.h"

#include <algorithm>

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

/// The ten bits of a coordinate, two places free behind each.
uint32_t spread_bits(uint32_t x) {
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}

}  // namespace

std::vector<uint32_t> by_place(std::vector<uint32_t> records, const std::vector<vec4>& spheres) {
  Box box;
  for (const uint32_t r : records) box.grow(vec3(spheres[r]));
  const vec3 size = box.size();
  const float cells = 1023 / std::max({size.x, size.y, size.z, 1e-20f});
  std::vector<std::pair<uint32_t, uint32_t>> codes;
  for (const uint32_t r : records) {
    const vec3 at = (vec3(spheres[r]) - box.lo) * cells;
    codes.emplace_back(
        spread_bits(uint32_t(at.x)) | spread_bits(uint32_t(at.y)) << 1 | spread_bits(uint32_t(at.z)) << 2, r);
  }
  std::sort(codes.begin(), codes.end());
  for (size_t i = 0; i < codes.size(); ++i) records[i] = codes[i].second;
  return records;
}

std::vector<float> ray_noise(const Records& records) {
  const std::vector<float> light = records.luminances();
  std::vector<float> noise;
  for (const Records::Figures& told : records.figures()) {
    const float y = light[noise.size()];
    noise.push_back(y > 0 ? std::clamp(told.rays * told.error * told.error / (y * y), 1.0f, 1e4f) : 1.0f);
  }
  return noise;
}

LightChange::LightChange(gpu::Device& device, gpu::ShaderCompiler& compiler)
    : device_(device), kernel_(device, compiler, "irradiance_cache/light_change.comp") {}

void LightChange::make_room(uint32_t count) {
  const uint32_t clusters = gpu::groups_for(std::max(count, 1u), k_light_cluster);
  const auto make = [&](gpu::Buffer& to, const char* name, uint64_t bytes) {
    gpu::make_texel_room(device_, to, name, bytes);
  };
  const uint64_t bytes = (uint64_t{count} / 4 + 1) * sizeof(uvec4);
  make(order_, "records in clusters", bytes);
  make(places_, "places in clusters", bytes);
  make(noise_, "noise of records' rays", bytes);
  make(sums_, "light of clusters", (clusters + 1) * uint64_t{k_light_sums_texels * sizeof(vec4)});
}

void LightChange::set(const std::vector<uint32_t>& ordered, const std::vector<float>& noise) {
  ordered_ = uint32_t(ordered.size());
  if (ordered.empty()) return;
  // Those that tell nothing are of the cluster that is all of them.
  std::vector<uint32_t> places(noise.size(), clusters() * k_light_cluster);
  for (uint32_t i = 0; i < ordered.size(); ++i) places[ordered[i]] = i;
  order_.write(ordered.data(), ordered.size() * 4);
  places_.write(places.data(), places.size() * 4);
  noise_.write(noise.data(), noise.size() * 4);
}

uint32_t LightChange::clusters() const { return gpu::groups_for(ordered_, k_light_cluster); }

void LightChange::measure(gpu::Stream& stream, gpu::Resources& resources, const vec3& factor, uint32_t parts,
                          uint32_t rays, bool leading) const {
  resources.set("clustered", order_);
  resources.set("place_of_record", places_);
  resources.set("ray_noise_texels", noise_);
  resources.set("Sums", sums_);
  resources.set("light_sums_texels", sums_);
  if (ordered_ == 0 || rays == 0) return;
  stream.dispatch(kernel_, resources, LightChangePush{factor, ordered_, parts, rays, leading, 0}, clusters());
  stream.dispatch(kernel_, resources, LightChangePush{factor, ordered_, parts, rays, leading, clusters()}, 1);
}

}  // namespace lucerna::irradiance_cache
