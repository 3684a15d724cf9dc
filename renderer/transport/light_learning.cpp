#include "transport/light_learning.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace lucerna::transport {

using namespace shared;

namespace {

/// Memory for the generations that can be replayed.
constexpr uint64_t k_most_kept_bytes = uint64_t{64} << 20;

template <class T>
void put(gpu::Device& device, gpu::Buffer& buffer, const char* name, std::vector<T> values) {
  values.resize((values.size() * sizeof(T) + 15) / 16 * 16 / sizeof(T));
  gpu::make_texel_room(device, buffer, name, std::max<uint64_t>(16, values.size() * sizeof(T)));
  if (!values.empty()) buffer.write(std::span<const T>(values));
}

}  // namespace

LightLearning::LightLearning(gpu::Device& device, upload::LightClusters clusters, uint32_t most_paths)
    : device_(device),
      clusters_(std::move(clusters)),
      most_paths_(most_paths),
      records_(device, {.name = "light records",
                        .bytes = uint64_t{most_paths} * k_learned_vertices * sizeof(LightRecord),
                        .memory = gpu::Memory::host}) {
  upload_clusters();
  take(plain_lights(clusters_));
}

void LightLearning::upload_clusters() {
  // Now on the device.
  put(device_, cluster_texels_, "light clusters", std::exchange(clusters_.clusters, {}));
  put(device_, members_, "lights of clusters", std::exchange(clusters_.members, {}));
  put(device_, primitives_, "clusters of emissive triangles", std::exchange(clusters_.primitives, {}));
  put(device_, shapes_, "clusters of lamps with a shape", std::exchange(clusters_.shapes, {}));
  put(device_, tiles_, "clusters of the sky", std::exchange(clusters_.tiles, {}));
  put(device_, facets_, "emissive triangles", std::exchange(clusters_.facets, {}));
}

void LightLearning::take(LearnedLights lights) {
  put(device_, grid_, "learned cells", lights.grid);
  put(device_, rows_, "learned lights", lights.rows);
  row_count_ = lights.row_count;
  row_arrived_ = lights.arrived;
  row_arrived_.resize(row_count_, -1.f);
  lights_ = std::move(lights);
  ++version_;
}

void LightLearning::bind(gpu::Resources& r) const {
  r.set("learned_grid", grid_);
  r.set("learned_rows", rows_);
  r.set("light_clusters", cluster_texels_);
  r.set("cluster_members", members_);
  r.set("primitive_clusters", primitives_);
  r.set("shape_clusters", shapes_);
  r.set("sky_tiles", tiles_);
  r.set("light_facets", facets_);
  r.set("LightRecords", records_);
}

void LightLearning::describe(Frame& frame) const {
  frame.learned_origin = lights_.cells.origin;
  frame.learned_scale = lights_.cells.scale;
  frame.light_clusters = clusters_.count();
  frame.sky_clusters = clusters_.sky;
  frame.learning = recording_ ? 1 : 0;
}

void LightLearning::take(const Generation& generation) {
  take(generation.lights);
  record_count_ = generation.records;
  pays_ = generation.pays;
  gain_ = generation.gain, arrived_ = generation.arrived;
  ++generations_;
}

void LightLearning::begin_generation(const Frame& pilot) {
  fresh_.clear();
  pilot_.resize(sizeof pilot);
  std::memcpy(pilot_.data(), &pilot, sizeof pilot);
  if (generations_ == 0) take(exploring_lights(clusters_));
}

void LightLearning::begin_recording() {
  const std::vector<std::byte> none(records_.bytes());
  records_.write(std::span<const std::byte>(none));
  recording_ = true;
}

void LightLearning::end_recording(uint32_t paths) {
  recording_ = false;
  std::vector<LightRecord> all(size_t{std::min(paths, most_paths_)} * k_learned_vertices);
  records_.read(all.data(), all.size() * sizeof(LightRecord));
  std::erase_if(all, [](const LightRecord& r) { return r.full == 0; });
  fresh_.insert(fresh_.end(), all.begin(), all.end());
}

void LightLearning::abandon_generation() {
  fresh_.clear();
  if (generations_ == 0) take(plain_lights(clusters_));
}

void LightLearning::finish_generation() {
  size_t arrived = 0;
  for (const LightRecord& r : fresh_) arrived += r.arrived > 0;
  Generation next;
  next.arrived = fresh_.empty() ? 0 : double(arrived) / double(fresh_.size());
  next.gain = generations_ > 0 ? measured_gain(clusters_, lights_, fresh_) : 1;
  next.pays = generations_ == 0 || arrived == 0 || next.gain >= k_least_gain;
  const LearnedCells cells = lights_.cells.scale > 0 ? lights_.cells : learned_cells(fresh_);
  if (generations_ == 0) samples_.clear();
  samples_.insert(samples_.end(), fresh_.begin(), fresh_.end());
  next.records = samples_.size();
  next.lights = learn_lights(clusters_, cells, samples_, fresh_.size());
  fresh_.clear();
  take(next);
  if (learned_.size() + 1 == generations_) learned_.push_back(std::move(next));
  if (kept_bytes() > k_most_kept_bytes) learned_.clear();
}

void LightLearning::end() {
  samples_ = {}, fresh_ = {};
  lights_.grid = {}, lights_.rows = {};
}

void LightLearning::learn(std::vector<LightRecord> records) {
  fresh_ = std::move(records);
  finish_generation();
}

void LightLearning::forget(upload::LightClusters clusters) {
  clusters_ = std::move(clusters);
  upload_clusters();
  forget();
}

void LightLearning::forget() {
  end();
  learned_.clear();
  rewind();
}

void LightLearning::rewind() {
  fresh_.clear();
  record_count_ = 0;
  gain_ = 1, arrived_ = 0, pays_ = true;
  recording_ = false;
  generations_ = replayed_ = 0;
  take(plain_lights(clusters_));
}

bool LightLearning::replay(const Frame& pilot) {
  if (generations_ >= learned_.size()) return false;
  if (std::memcmp(pilot_.data(), &pilot, sizeof pilot) != 0) {
    forget();
    return false;
  }
  take(learned_[generations_]);
  ++replayed_;
  return true;
}

std::vector<float> LightLearning::row(uint32_t row) const {
  std::vector<vec4> texels(clusters_.count());
  rows_.read(texels.data(), texels.size() * sizeof(vec4), uint64_t{row} * texels.size() * sizeof(vec4));
  std::vector<float> p;
  for (size_t c = 0; c < texels.size(); ++c) p.push_back(texels[c].z * clusters_.plain[c]);
  return p;
}

uint64_t LightLearning::kept_bytes() const {
  uint64_t kept = 0;
  for (const Generation& g : learned_)
    kept += g.lights.grid.capacity() * sizeof(uint32_t) + g.lights.rows.capacity() * sizeof(vec4);
  return kept;
}

uint64_t LightLearning::bytes() const {
  return kept_bytes() + grid_.bytes() + rows_.bytes() + cluster_texels_.bytes() + members_.bytes() +
         primitives_.bytes() + shapes_.bytes() + tiles_.bytes() + facets_.bytes() + records_.bytes() +
         (samples_.capacity() + fresh_.capacity()) * sizeof(LightRecord) +
         lights_.grid.capacity() * sizeof(uint32_t) + lights_.rows.capacity() * sizeof(vec4);
}

}  // namespace lucerna::transport
