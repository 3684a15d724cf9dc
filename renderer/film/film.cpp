#include "film/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "shaders/shared/group_sums.h"

namespace lucerna::film {

namespace {

// Bytes of a pixel and component: two halves.
constexpr uint64_t k_sum_bytes = 2 * sizeof(shared::FilmHalf);
// Other bytes of a pixel: albedo and normal, counts, vertices and the picture.
constexpr uint64_t k_pixel_bytes = 2 * 16 + 3 * 4;
// Beside the film: the coarse picture, and paths in flight at their fewest.
constexpr uint64_t k_coarse_pixels = shared::k_coarse_step * shared::k_coarse_step, k_paths_bytes = 48 << 20;

}  // namespace

uint64_t sum_bytes(uint32_t groups, GroupStorage kept, uint32_t layers) {
  constexpr uint64_t k_all = shared::k_component_count * k_sum_bytes;
  // As in the help of relight.enabled and in README.md.
  static_assert(k_all == 192 && k_all + sizeof(shared::GroupLight) == 200 && sizeof(shared::GroupSums) == 16);
  const uint64_t own = k_all + layers * k_sum_bytes;
  if (groups <= 1) return own;
  return own + groups * (kept == GroupStorage::compact ? sizeof(shared::GroupSums)
                                                       : k_all + sizeof(shared::GroupLight));
}

void check_size(const gpu::DeviceInfo& device, uint32_t width, uint32_t height, uint32_t groups,
                GroupStorage kept, uint32_t layers) {
  const gpu::Limits& limits = device.limits;
  const uint64_t pixels = uint64_t(width) * height;
  if (pixels == 0) throw Error("size", "a picture needs at least one pixel");
  if (width > k_max_side || height > k_max_side)
    throw_error("size", "{}x{}: no side may be longer than {} pixels", width, height, k_max_side);
  // Texels of a pixel and component; four bytes a pixel in the storage buffers.
  const uint64_t memory = device.memory_bytes - std::min(device.memory_bytes, k_paths_bytes);
  const uint64_t coarse = (k_pixel_bytes + sum_bytes(1)) / k_coarse_pixels;
  const uint64_t texels =
      std::max<uint64_t>(k_sum_bytes / 16, groups > 1 && kept == GroupStorage::compact ? groups : 0);
  const uint64_t largest = std::min({limits.max_texel_elements / texels, limits.max_storage_buffer / 4,
                                     memory / (k_pixel_bytes + sum_bytes(groups, kept, layers) + coarse)});
  if (pixels > largest)
    throw_error(
        "size", "{}x{} is {} pixels; this device can hold at most {} (for example {}x{}){}", width, height,
        pixels, largest, uint32_t(std::sqrt(largest * 16.0 / 9)), uint32_t(std::sqrt(largest * 9.0 / 16)),
        groups > 1 ? fmt::format(" with {} separate light groups; more with relight.enabled=off", groups)
                   : std::string());
}

Film::Sums Film::make_sums() const {
  constexpr ByComponent<const char*> names = {"film primary", "film secondary", "film tertiary",
                                              "film caustic"};
  Sums sums;
  for (const size_t c : k_components)
    sums[c] = gpu::Buffer(
        device_, {.name = names[c], .bytes = uint64_t{width_} * height_ * k_sum_bytes, .texel = true});
  return sums;
}

Film::Film(gpu::Device& device, uint32_t width, uint32_t height, uint32_t groups, GroupStorage kept,
           uint32_t layers)
    : width_(width), height_(height), groups_(std::max(1u, groups)), kept_(kept), device_(device) {
  const gpu::Limits& limits = device.info().limits;
  const uint64_t pixels = uint64_t(width) * height;
  check_size(device.info(), width, height, groups, kept, layers);
  const uint64_t short_sums = is_compact() ? pixels * groups * sizeof(shared::GroupSums) : 0;
  fits_storage_buffers_ = std::max(pixels * k_sum_bytes, short_sums) <= limits.max_storage_buffer;
  sums_ = make_sums();
  for (uint32_t l = 0; l < layers; ++l)
    layers_.emplace_back(device,
                         gpu::BufferDesc{.name = "film layer", .bytes = pixels * k_sum_bytes, .texel = true});
  for (uint32_t g = 0; groups > 1 && !is_compact() && g < groups; ++g) group_sums_.push_back(make_sums());
  group_short_ = gpu::Buffer(device, {.name = "sums by group", .bytes = short_sums, .texel = true});
  light_mix_ = gpu::Buffer(
      device,
      {.name = "light mix", .bytes = sizeof(shared::GroupMix), .memory = gpu::Memory::host, .texel = true});
  set_mix({});
  // Two groups to a texel.
  const uint64_t light =
      group_sums_.empty() ? 0 : pixels * ((groups + 1) / 2) * 2 * sizeof(shared::GroupLight);
  quick_ = light <= limits.max_storage_buffer;
  group_light_ = gpu::Buffer(device, {.name = "light by group", .bytes = quick_ ? light : 0, .texel = true});
  albedo_ = gpu::Buffer(device, {.name = "film albedo", .bytes = pixels * 16, .texel = true});
  normal_ = gpu::Buffer(device, {.name = "film normals", .bytes = pixels * 16, .texel = true});
  count_ = gpu::Buffer(device, {.name = "film counts", .bytes = pixels * 4});
  vertices_ = gpu::Buffer(device, {.name = "film vertices", .bytes = pixels * 4});
  picture_ = gpu::Buffer(device, {.name = "picture", .bytes = pixels * 4, .memory = gpu::Memory::host});
  const gpu::BufferDesc block_errors{
      .name = "block errors", .bytes = blocks() * sizeof(shared::BlockError), .memory = gpu::Memory::host};
  errors_ = gpu::Buffer(device, block_errors);
  for (uint32_t l = 0; l < layers; l += shared::k_error_layers)
    layer_errors_.emplace_back(device, block_errors);
  tile_marks_ = gpu::Buffer(
      device,
      {.name = "tile marks", .bytes = blocks() * sizeof(shared::TileMark), .memory = gpu::Memory::host});
  lookups_ = gpu::Buffer(device, {.name = "no lookups", .bytes = 0});
  block_lookups_ = gpu::Buffer(device, {.name = "no lookups", .bytes = 0});
  for (gpu::Buffer& b : lookup_bias_) b = gpu::Buffer(device, {.name = "no bias of lookups", .bytes = 0});
}

void Film::make_room_for_lookup_errors() {
  gpu::make_room(device_, lookups_,
                 {.name = "lookup errors", .bytes = uint64_t{width_} * height_ * sizeof(vec2)});
  gpu::make_room(device_, block_lookups_,
                 {.name = "lookup errors of blocks",
                  .bytes = blocks() * sizeof(shared::BlockLookups),
                  .memory = gpu::Memory::host});
}

void Film::make_room_for_lookup_bias(gpu::Stream& stream) {
  if (std::exchange(lookup_bias_known_, true)) return;
  for (gpu::Buffer& b : lookup_bias_) {
    gpu::make_room(device_, b, {.name = "bias of lookups", .bytes = uint64_t{width_} * height_ * 4});
    stream.fill(b, 0);
  }
}

std::array<std::vector<float>, 2> Film::read_lookup_bias() const {
  std::array<std::vector<float>, 2> means;
  if (!lookup_bias_known_) return means;
  const size_t n = size_t{width_} * height_;
  std::vector<uint32_t> samples(n);
  count_.read(samples.data(), n * 4);
  for (uint32_t half = 0; half < 2; ++half) {
    means[half].resize(n);
    lookup_bias_[half].read(means[half].data(), n * 4);
    for (size_t i = 0; i < n; ++i) means[half][i] /= float(std::max(1u, (samples[i] + 1 - half) / 2));
  }
  return means;
}

std::span<const shared::BlockLookups> Film::lookup_errors() const {
  if (!lookup_errors_complete_) return {};
  return {static_cast<const shared::BlockLookups*>(block_lookups_.mapped()), blocks()};
}

std::span<const shared::BlockError> Film::errors() const {
  return {static_cast<const shared::BlockError*>(errors_.mapped()), blocks()};
}

std::span<const shared::BlockError> Film::layer_errors(uint32_t first) const {
  if (first >= layers()) return {};
  return {static_cast<const shared::BlockError*>(layer_errors_.at(first / shared::k_error_layers).mapped()),
          blocks()};
}

void Film::clear(gpu::Stream& stream) {
  for (gpu::Buffer& b : sums_) stream.fill(b, 0);
  for (gpu::Buffer& b : layers_) stream.fill(b, 0);
  for (Sums& sums : group_sums_)
    for (gpu::Buffer& b : sums) stream.fill(b, 0);
  if (is_compact()) stream.fill(group_short_, 0);
  stream.fill(albedo_, 0);
  stream.fill(normal_, 0);
  stream.fill(count_, 0);
  stream.fill(vertices_, 0);
  stream.fill(errors_, 0);
  for (gpu::Buffer& b : layer_errors_) stream.fill(b, 0);
  stream.run();
  lookup_errors_complete_ = lookup_errors_current_ = lookup_bias_known_ = false;
}

void Film::bind(gpu::Resources& r) const {
  // Read as texels, written as a storage buffer or an image (shaders/lib/film.glsl).
  const auto plane = [&](const std::string& name, const char* block, const gpu::Buffer& buffer) {
    r.set(name, buffer);
    r.set(name + "_out", buffer);
    r.set(block, buffer);
  };
  plane("film_primary", "FilmPrimary", sums_[0]);
  plane("film_secondary", "FilmSecondary", sums_[1]);
  plane("film_tertiary", "FilmTertiary", sums_[2]);
  plane("film_caustic", "FilmCaustic", sums_[3]);
  plane("film_albedo", "FilmAlbedo", albedo_);
  plane("film_normal", "FilmNormal", normal_);
  r.set("FilmCount", count_);
  r.set("FilmVertices", vertices_);
  r.set("Picture", picture_);
  r.set("TileMarks", tile_marks_);
  r.set("BlockErrors", errors_);
  r.set("FilmLookups", lookups_);
  r.set("BlockLookupSums", block_lookups_);
  r.set("FilmBiasEven", lookup_bias_[0]);
  r.set("FilmBiasOdd", lookup_bias_[1]);
  r.set("light_mix", light_mix_);
  r.set("GroupLights", group_light_);
  r.set("group_lights", group_light_);
  r.set("group_sums", group_short_);
  r.set("group_sums_out", group_short_);
  r.set("GroupSumTexels", group_short_);
}

void Film::bind_group(gpu::Resources& r, uint32_t group) const {
  constexpr const char* names[shared::k_component_count][2] = {{"group_primary", "GroupPrimary"},
                                                               {"group_secondary", "GroupSecondary"},
                                                               {"group_tertiary", "GroupTertiary"},
                                                               {"group_caustic", "GroupCaustic"}};
  for (const size_t c : k_components) {
    const gpu::Buffer& sums = group_sums_.at(group)[c];
    r.set(names[c][0], sums);
    r.set(names[c][0] + std::string("_out"), sums);
    r.set(names[c][1], sums);
  }
}

void Film::bind_layer(gpu::Resources& r, uint32_t layer) const {
  for (const char* name : {"film_layer", "film_layer_out", "FilmLayer"}) r.set(name, layers_.at(layer));
}

void Film::bind_layer_errors(gpu::Resources& r, uint32_t first) const {
  for (uint32_t i = 0; i < shared::k_error_layers; ++i)
    r.set(fmt::format("film_layer_{}", i), layers_.at(std::min(first + i, layers() - 1)));
  r.set("LayerBlockErrors", layer_errors_.at(first / shared::k_error_layers));
}

void Film::set_mix(std::span<const vec3> weights) {
  mix_ = {.groups = 0, .pixels = width_ * height_, .pad0 = 0, .pad1 = 0, .whole = vec4(1), .weight = {}};
  if (weights.size() == 1) mix_.whole = vec4(weights[0], 1);
  for (vec4& w : mix_.weight) w = vec4(1);
  for (size_t g = 0; g < std::min<size_t>(weights.size(), shared::k_most_groups); ++g) {
    mix_.weight[g] = vec4(weights[g], 1);
    if (is_compact() && weights[g] != vec3(1)) mix_.groups = groups_;
  }
  light_mix_.write(&mix_, sizeof mix_);
}

void Film::copy_surfaces(gpu::Stream& stream, const Film& from) {
  const uint64_t pixels = uint64_t{width_} * height_;
  stream.copy(from.albedo_, albedo_, pixels * 16);
  stream.copy(from.normal_, normal_, pixels * 16);
  stream.copy(from.count_, count_, pixels * 4);
  stream.copy(from.vertices_, vertices_, pixels * 4);
}

void Film::bind_coarse(gpu::Resources& r) const {
  r.set("coarse_albedo", albedo_);
  r.set("coarse_normal", normal_);
  r.set("CoarseCount", count_);
}

void Film::mark_tiles(std::span<const shared::TileMark> marks) { tile_marks_.write(marks); }

namespace {

/// Means of all samples and of the odd ones, `halves` two a pixel, each times its ratio; none: 1.
void take_means(const std::vector<shared::FilmHalf>& halves, const std::vector<vec3>& ratios,
                const std::vector<uint32_t>& samples, std::vector<vec3>& all, std::vector<vec3>* odd_half) {
  const auto total = [&](size_t k) {
    const glm::dvec3 sum = glm::dvec3(halves[k].sum) + glm::dvec3(halves[k].compensation);
    return ratios.empty() ? sum : sum * glm::dvec3(ratios[k]);
  };
  all.resize(samples.size());
  if (odd_half) odd_half->resize(samples.size());
  for (size_t i = 0; i < samples.size(); ++i) {
    const double n = std::max(1u, samples[i]), odd = std::max(1u, samples[i] / 2);
    all[i] = vec3((total(2 * i) + total(2 * i + 1)) / n);
    if (odd_half) (*odd_half)[i] = vec3(total(2 * i + 1) / odd);
  }
}

}  // namespace

ByComponent<std::vector<vec3>> Film::read_group(uint32_t group) const {
  const size_t n = size_t{width_} * height_;
  std::vector<uint32_t> samples(n);
  count_.read(samples.data(), n * 4);
  ByComponent<std::vector<vec3>> means;
  std::vector<shared::FilmHalf> halves(2 * n);
  for (const size_t c : k_components) {
    group_sums_.at(group)[c].read(halves.data(), halves.size() * sizeof(shared::FilmHalf));
    take_means(halves, {}, samples, means[c], nullptr);
  }
  return means;
}

std::vector<shared::GroupSums> Film::read_group_sums() const {
  std::vector<shared::GroupSums> sums(is_compact() ? size_t{groups_} * width_ * height_ : 0);
  if (!sums.empty()) group_short_.read(sums.data(), sums.size() * sizeof(shared::GroupSums));
  return sums;
}

std::vector<vec3> Film::read_group_sum(uint32_t group) const {
  const size_t n = size_t{width_} * height_;
  std::vector<uint32_t> samples(n);
  count_.read(samples.data(), n * 4);
  const std::vector<shared::GroupSums> sums = read_group_sums();
  std::vector<vec3> means(n);
  for (size_t i = 0; i < n; ++i) {
    const shared::GroupSums& s = sums.at(group * n + i);
    means[i] =
        (shared::group_sum_value(s.even) + shared::group_sum_value(s.odd)) / float(std::max(1u, samples[i]));
  }
  return means;
}

std::vector<vec3> Film::mix_ratios() const {
  const size_t n = size_t{width_} * height_;
  const vec3 whole(mix_.whole);
  if (mix_.groups == 0) return whole == vec3(1) ? std::vector<vec3>{} : std::vector<vec3>(2 * n, whole);
  const std::vector<shared::GroupSums> sums = read_group_sums();
  std::vector<vec3> ratios(2 * n);
  for (size_t i = 0; i < n; ++i) {
    vec3 all[2] = {}, mixed[2] = {};
    for (uint32_t g = 0; g < groups_; ++g) {
      const shared::GroupSums& s = sums[g * n + i];
      const vec3 w = vec3(mix_.weight[g]),
                 light[2] = {shared::group_sum_value(s.even), shared::group_sum_value(s.odd)};
      for (int half = 0; half < 2; ++half) all[half] += light[half], mixed[half] += w * light[half];
    }
    for (size_t half = 0; half < 2; ++half)
      ratios[2 * i + half] = shared::group_ratio(mixed[half], all[half]);
  }
  return ratios;
}

Image Film::read() const {
  Image image;
  image.width = width_;
  image.height = height_;
  const size_t n = size_t(width_) * height_;
  image.samples.resize(n);
  count_.read(image.samples.data(), n * 4);
  std::vector<shared::FilmHalf> halves(2 * n);
  const std::vector<vec3> ratios = mix_ratios();
  for (const int c : k_components) {
    sums_[c].read(halves.data(), halves.size() * sizeof(shared::FilmHalf));
    take_means(halves, ratios, image.samples, image.components[c], &image.odd_half[c]);
  }
  image.layers.resize(layers_.size()), image.odd_layers.resize(layers_.size());
  for (size_t l = 0; l < layers_.size(); ++l) {
    layers_[l].read(halves.data(), halves.size() * sizeof(shared::FilmHalf));
    take_means(halves, ratios, image.samples, image.layers[l], &image.odd_layers[l]);
  }
  std::vector<vec4> plane(n);
  albedo_.read(plane.data(), n * 16);
  std::vector<float> hits(n);
  image.albedo.resize(n);
  for (size_t i = 0; i < n; ++i) {
    image.albedo[i] = vec3(plane[i]) / float(std::max(1u, image.samples[i]));
    hits[i] = plane[i].w;
  }
  normal_.read(plane.data(), n * 16);
  image.normal.resize(n);
  image.depth.resize(n);
  for (size_t i = 0; i < n; ++i) {
    const float length = glm::length(vec3(plane[i]));
    image.normal[i] = length > 0 ? vec3(plane[i]) / length : vec3(0);
    image.depth[i] = hits[i] > 0 ? plane[i].w / hits[i] : 0;
  }
  return image;
}

namespace {
/// Mean of a layer over the pixels with samples.
vec3 mean_of(const std::vector<vec3>& layer, const std::vector<uint32_t>& samples) {
  glm::dvec3 sum(0);
  size_t pixels = 0;
  for (size_t i = 0; i < samples.size(); ++i)
    if (samples[i]) sum += glm::dvec3(layer[i]), ++pixels;
  return vec3(sum / double(std::max<size_t>(1, pixels)));
}
}  // namespace

ByComponent<vec3> Film::means(const Image& image) {
  ByComponent<vec3> means{};
  for (const int c : k_components) means[c] = mean_of(image.components[c], image.samples);
  return means;
}

std::vector<vec3> Film::layer_means(const Image& image) {
  std::vector<vec3> means;
  for (const auto& layer : image.layers) means.push_back(mean_of(layer, image.samples));
  return means;
}

std::vector<uint8_t> Film::read_picture() const {
  std::vector<uint8_t> bytes(size_t(width_) * height_ * 4);
  picture_.read(bytes.data(), bytes.size());
  return bytes;
}

}  // namespace lucerna::film
