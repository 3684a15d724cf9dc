#include "solvers/irradiance_cache/records.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "gpu/kernel.h"
#include "solvers/irradiance_cache/smoothing.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

constexpr uint64_t k_place_bytes = 16 * k_record_texels, k_light_bytes = 16 * k_part_count * k_part_texels;

Record unpack(const vec4* place, const vec4* light) {
  Record r;
  r.place = {.position = vec3(place[0]), .normal = vec3(place[1])};
  r.place.medium = std::bit_cast<uint32_t>(place[5].x);
  r.radius = place[0].w;
  r.mean_distance = place[1].w;
  r.rays = std::bit_cast<uint32_t>(place[2].x);
  r.least_distance = place[2].y;
  const auto flags = std::bit_cast<uint32_t>(place[2].w);
  r.pass = flags & k_record_pass;
  r.place.facet = flags >> k_record_facet_shift;
  r.place.origin = flags >> k_record_origin_shift & 3u;
  r.error = place[2].z;
  const vec3 stretch(place[3]);
  r.lesser_radius = place[3].w;
  r.along = length(stretch) > 0 ? normalize(stretch) : vec3(0);
  const auto [t, b] = tangent_basis(r.place.normal);
  r.crowded = (flags & k_record_crowded) != 0;
  for (uint32_t p = 0; p < k_part_count && !r.crowded; ++p) {
    const float* f = &light[p * k_part_texels].x;
    Irradiance& e = r.parts[p];
    e.value = vec3(f[0], f[1], f[2]);
    for (int c = 0; c < 3; ++c) {
      e.rotation[c] = f[3 + c] * t + f[6 + c] * b;
      e.translation[c] = f[9 + c] * t + f[12 + c] * b;
    }
  }
  return r;
}

}  // namespace

std::array<vec3, 2> tangent_basis(const vec3& n) {
  const float s = n.z >= 0 ? 1.0f : -1.0f, a = -1 / (s + n.z), c = n.x * n.y * a;
  return {vec3(1 + s * n.x * n.x * a, s * c, -s * n.x), vec3(c, s + n.y * n.y * a, -n.y)};
}

uint32_t share_pack(vec3 share) {
  share = glm::clamp(share, vec3(0), vec3(1));
  const uint32_t most = std::bit_cast<uint32_t>(std::max({share.x, share.y, share.z})) >> 23;
  const uint32_t exponent = std::min(126 - std::min(most, 126u), 31u);
  const uvec3 m(glm::round(share * (std::ldexp(511.0f, int(exponent)))));
  return std::min(m.x, 511u) | std::min(m.y, 511u) << 9 | std::min(m.z, 511u) << 18 | exponent << 27;
}

vec3 share_unpack(uint32_t bits) {
  const vec3 m(float(bits & 511), float(bits >> 9 & 511), float(bits >> 18 & 511));
  return m * (std::ldexp(1.0f, -int(bits >> 27)) / 511.0f);
}

bool RawRecords::crowded(uint32_t record) const {
  return (std::bit_cast<uint32_t>(places[size_t{record} * k_record_texels + 2].w) & k_record_crowded) != 0;
}

void RawRecords::keep(std::span<const uint32_t> kept) {
  constexpr size_t k_lights = size_t{k_part_count} * k_part_texels;
  const size_t shares = size() > 0 ? groups.size() / size() : 0;
  for (size_t to = 0; to < kept.size(); ++to) {
    const size_t from = kept[to];
    assert(from >= to);
    std::copy_n(&places[from * k_record_texels], k_record_texels, &places[to * k_record_texels]);
    std::copy_n(&lights[from * k_lights], k_lights, &lights[to * k_lights]);
    spheres[to] = spheres[from];
    std::copy_n(groups.begin() + ptrdiff_t(from * shares), shares, groups.begin() + ptrdiff_t(to * shares));
  }
  groups.resize(kept.size() * shares);
  places.resize(kept.size() * k_record_texels), lights.resize(kept.size() * k_lights);
  spheres.resize(kept.size());
}

uint32_t Records::most_records(const gpu::Device& device) {
  return static_cast<uint32_t>(
      std::min<uint64_t>(device.info().limits.max_storage_buffer / k_light_bytes, 1u << 24));
}

Records::Records(gpu::Device& device, uint32_t capacity, uint32_t groups)
    : capacity_(capacity), groups_(std::max(groups, 1u)) {
  if (capacity > most_records(device))
    throw_error("irradiance cache", "{} records requested; this device can bind {}", capacity,
                most_records(device));
  records_ = gpu::Buffer(device, {.name = "cache records", .bytes = capacity * k_place_bytes, .texel = true});
  irradiance_ =
      gpu::Buffer(device, {.name = "cache irradiance", .bytes = capacity * k_light_bytes, .texel = true});
  read_ = gpu::Buffer(device,
                      {.name = "cache irradiance as read", .bytes = capacity * k_light_bytes, .texel = true});
  errors_ = gpu::Buffer(
      device, {.name = "cache errors", .bytes = capacity * uint64_t{k_lookup_lanes} * 4, .texel = true});
  spheres_ = gpu::Buffer(device, {.name = "cache spheres", .bytes = capacity * sizeof(vec4), .texel = true});
  if (groups_ < 2) return;
  const auto words = [&](const char* name) {
    return gpu::Buffer(device, {.name = name, .bytes = capacity * group_bytes(), .texel = true});
  };
  shares_ = words("cache shares of groups"), shares_read_ = words("cache shares of groups as read");
}

uint32_t Records::append(std::span<const Place> places, uint32_t pass) {
  const auto fitting = static_cast<uint32_t>(std::min<size_t>(places.size(), capacity_ - size_));
  std::vector<vec4> texels;
  texels.reserve(size_t{fitting} * k_record_texels);
  for (const Place& p : places.first(fitting)) {
    texels.emplace_back(p.position, 0.0f);
    texels.emplace_back(p.normal, 0.0f);
    const uint32_t flags =
        std::min(pass, k_record_pass) | p.origin << k_record_origin_shift | p.facet << k_record_facet_shift;
    texels.emplace_back(0.0f, 0.0f, 0.0f, std::bit_cast<float>(flags));
    texels.emplace_back(0.0f);
    texels.emplace_back(0.0f);
    texels.emplace_back(std::bit_cast<float>(p.medium), 0.0f, 0.0f, 0.0f);
  }
  records_.write(texels.data(), texels.size() * sizeof(vec4), size_ * k_place_bytes);
  const std::vector<vec4> dark(size_t{fitting} * k_part_count * k_part_texels, vec4(0));
  irradiance_.write(dark.data(), dark.size() * sizeof(vec4), size_ * k_light_bytes);
  const std::vector<uint8_t> none(fitting * group_bytes(), 0);
  if (!none.empty()) shares_.write(none.data(), none.size(), size_ * group_bytes());
  size_ += fitting;
  return fitting;
}

std::vector<Record> Records::read() const {
  std::vector<vec4> places(size_t{size_} * k_record_texels),
      lights(size_t{size_} * k_part_count * k_part_texels);
  records_.read(places.data(), places.size() * sizeof(vec4));
  irradiance_.read(lights.data(), lights.size() * sizeof(vec4));
  std::vector<Record> all;
  for (uint32_t i = 0; i < size_; ++i)
    all.push_back(
        unpack(&places[size_t{i} * k_record_texels], &lights[size_t{i} * k_part_count * k_part_texels]));
  return all;
}

Record Records::read(uint32_t index) const {
  vec4 place[k_record_texels], light[k_part_count * k_part_texels];
  records_.read(place, sizeof place, index * k_place_bytes);
  irradiance_.read(light, sizeof light, index * k_light_bytes);
  return unpack(place, light);
}

float Records::published_luminance(uint32_t index) const {
  vec4 place[k_record_texels], light[k_part_count * k_part_texels];
  records_.read(place, sizeof place, index * k_place_bytes);
  read_.read(light, sizeof light, index * k_light_bytes);
  float sum = 0;
  for (const Irradiance& part : unpack(place, light).parts) sum += luminance(part.value);
  return sum;
}

RawRecords Records::raw(uint32_t count) const {
  assert(count <= size_);
  RawRecords raw{std::vector<vec4>(size_t{count} * k_record_texels),
                 std::vector<vec4>(size_t{count} * k_part_count * k_part_texels), std::vector<vec4>(count),
                 std::vector<uvec4>(count * group_bytes() / sizeof(uvec4))};
  if (count == 0) return raw;
  records_.read(raw.places.data(), count * k_place_bytes);
  irradiance_.read(raw.lights.data(), count * k_light_bytes);
  spheres_.read(raw.spheres.data(), count * sizeof(vec4));
  if (!raw.groups.empty()) shares_.read(raw.groups.data(), count * group_bytes());
  return raw;
}

void Records::restore(const RawRecords& raw) {
  assert(raw.size() <= capacity_ && raw.places.size() == raw.size() * size_t{k_record_texels} &&
         raw.lights.size() == raw.size() * size_t{k_part_count} * k_part_texels);
  size_ = raw.size();
  if (size_ == 0) return;
  records_.write(std::span(raw.places));
  irradiance_.write(std::span(raw.lights));
  spheres_.write(std::span(raw.spheres));
  if (groups_ > 1) {
    std::vector<uvec4> shares(size_ * group_bytes() / sizeof(uvec4), uvec4(0));
    if (raw.groups.size() == shares.size()) shares = raw.groups;
    shares_.write(std::span(std::as_const(shares)));
  }
  publish(smooth(this->raw(size_), {.reach = 0}));
}

std::vector<Records::Figures> Records::figures() const {
  std::vector<vec4> places(size_t{size_} * k_record_texels);
  records_.read(places.data(), places.size() * sizeof(vec4));
  std::vector<Figures> all;
  for (uint32_t i = 0; i < size_; ++i) {
    const vec4* p = &places[size_t{i} * k_record_texels];
    all.push_back({float(std::bit_cast<uint32_t>(p[2].x)), p[1].w, p[2].z});
  }
  return all;
}

std::vector<float> Records::radii(uint32_t first) const {
  std::vector<vec4> spheres(size_ - first);
  spheres_.read(spheres.data(), spheres.size() * sizeof(vec4), first * sizeof(vec4));
  std::vector<float> all;
  for (const vec4& s : spheres) all.push_back(s.w);
  return all;
}

std::vector<float> Records::luminances() const {
  std::vector<vec4> lights(size_t{size_} * k_part_count * k_part_texels);
  irradiance_.read(lights.data(), lights.size() * sizeof(vec4));
  std::vector<float> all(size_, 0.0f);
  const std::vector<bool> crowd = crowded();
  for (size_t i = 0; i < size_; ++i)
    for (uint32_t p = 0; p < k_part_count && !crowd[i]; ++p)
      all[i] += luminance(vec3(lights[(i * k_part_count + p) * k_part_texels]));
  return all;
}

std::vector<vec4> Records::texels(uint32_t which) const {
  std::vector<vec4> places(size_t{size_} * k_record_texels), all;
  records_.read(places.data(), places.size() * sizeof(vec4));
  for (size_t at = which; at < places.size(); at += k_record_texels) all.push_back(places[at]);
  return all;
}

std::vector<float> Records::pilot_luminances() const {
  std::vector<float> all;
  for (const vec4& pilot : texels(4)) all.push_back(pilot.w);
  return all;
}

std::vector<bool> Records::crowded() const {
  std::vector<bool> all;
  for (const vec4& texel : texels(2))
    all.push_back((std::bit_cast<uint32_t>(texel.w) & k_record_crowded) != 0);
  return all;
}

void Records::keep(uint32_t first, std::span<const uint32_t> kept) {
  if (first == size_) return;
  std::vector<vec4> places(size_t{size_ - first} * k_record_texels), spheres(size_ - first);
  records_.read(places.data(), places.size() * sizeof(vec4), first * k_place_bytes);
  spheres_.read(spheres.data(), spheres.size() * sizeof(vec4), first * sizeof(vec4));
  for (size_t to = 0; to < kept.size(); ++to) {
    std::copy_n(&places[size_t{kept[to]} * k_record_texels], k_record_texels, &places[to * k_record_texels]);
    spheres[to] = spheres[kept[to]];
  }
  records_.write(places.data(), kept.size() * k_place_bytes, first * k_place_bytes);
  spheres_.write(spheres.data(), kept.size() * sizeof(vec4), first * sizeof(vec4));
  size_ = first + uint32_t(kept.size());
}

void Records::publish(gpu::Stream& stream) const {
  if (size_ == 0) return;
  stream.copy(irradiance_, read_, size_ * k_light_bytes);
  if (groups_ > 1) stream.copy(shares_, shares_read_, size_ * group_bytes());
  stream.run();
}

void Records::publish(const PublishedLight& light) {
  if (light.lights.empty()) return;
  read_.write(std::span(light.lights));
  errors_.write(std::span(light.errors));
  if (groups_ > 1) shares_read_.write(std::span(light.groups));
}

void Records::bind(gpu::Resources& resources, Use use) const {
  resources.set("record_texels", records_);
  resources.set("Records", records_);
  resources.set("irradiance_texels", use == Use::gather ? irradiance_ : read_);
  resources.set("Irradiance", irradiance_);
  resources.set("record_error_texels", errors_);
  resources.set("Spheres", spheres_);
  if (groups_ < 2) return;
  resources.set("record_group_texels", shares(use));
  resources.set("RecordGroups", shares_);
}

}  // namespace lucerna::irradiance_cache
