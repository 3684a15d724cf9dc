#pragma once
// The records of an irradiance cache, in device memory. Layout: shaders/shared/irradiance_cache/records.h.
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "base/math.h"
#include "gpu/kernel.h"
#include "gpu/stream.h"
#include "shaders/shared/irradiance_cache/records.h"
#include "solvers/lookup/octree.h"

namespace lucerna::irradiance_cache {

/// Where a record is to be: world space; `position` off its surface by the error bound, `normal` unit, on the
/// side from which light is gathered.
struct Place {
  vec3 position{0}, normal{0, 1, 0};
  uint32_t facet = 0;                         ///< geometric normal, shared::facet_pack()
  uint32_t origin = shared::k_origin_screen;  ///< shared::k_origin_*: what asked for it
  uint32_t medium = 0;                        ///< that it lies in, as shared::PathState::media
  float reach = 0;  ///< of a candidate: within that distance it stands for others [m]; records have none
};

/// One part of a record's irradiance, gradients in world space.
struct Irradiance {
  vec3 value{0};  ///< rgb; radiance times sr
  /// Change by channel as the normal n_i turns to n: dot(n_i x n, rotation[channel]).
  std::array<vec3, 3> rotation{};
  std::array<vec3, 3> translation{};  ///< by channel [1/m]
};

/// A record read back.
struct Record {
  Place place;
  float radius = 0;          ///< of validity [m], of an ellipse the greater; 0: none yet
  float lesser_radius = 0;   ///< [m]
  vec3 along{0};             ///< unit, the ellipse's greater axis; 0 of a circle
  float mean_distance = 0;   ///< harmonic mean of what its rays met [m]; infinite where they met nothing
  float least_distance = 0;  ///< [m]
  float error = 0;           ///< standard error of the luminance of value, all evaluated parts together
  uint32_t rays = 0;
  uint32_t pass = 0;     ///< that placed it
  bool crowded = false;  ///< it holds no irradiance: paths gather there themselves (shared::k_record_crowded)
  std::array<Irradiance, shared::k_part_count> parts;
};

/// All that device memory holds of some records, as it is there: what files keep.
struct RawRecords {
  std::vector<vec4> places;   ///< record_texels
  std::vector<vec4> lights;   ///< irradiance_texels
  std::vector<vec4> spheres;  ///< (position, radius)
  /// record_group_texels (shaders/irradiance_cache/groups.glsl); empty where groups of lights are not kept
  /// apart.
  std::vector<uvec4> groups;
  uint32_t size() const { return static_cast<uint32_t>(spheres.size()); }
  bool crowded(uint32_t record) const;  ///< as Record::crowded
  /// Drops the others; indices in rising order.
  void keep(std::span<const uint32_t> kept);
};

/// #defines of kernels that read or write the light of paths and records where these keep so many groups.
inline gpu::Defines group_defines(uint32_t groups) {
  if (groups < 2) return {};
  return {{"LUCERNA_LIGHT_GROUPS", std::to_string(groups)}, {"LUCERNA_GROUP_SUMS", "1"}};
}

class Records {
 public:
  /// Room for `capacity` records of shared::k_record_bytes. `groups`: of lights, whose shares in the light
  /// are kept; less than 2: they are not. Throws Error when that exceeds what the device can bind
  /// (most_records()) or its memory.
  Records(gpu::Device& device, uint32_t capacity, uint32_t groups = 1);
  /// The most that one buffer of this device holds.
  static uint32_t most_records(const gpu::Device& device);
  uint32_t capacity() const { return capacity_; }
  uint32_t groups() const { return groups_; }
  /// Of device memory, as lookups read the light and as it is gathered.
  uint64_t bytes() const { return capacity_ * (shared::k_record_bytes + 2 * group_bytes()); }
  uint32_t size() const { return size_; }
  /// Adds records without light and validity; returns how many found room. `pass`: at most k_record_pass.
  uint32_t append(std::span<const Place> places, uint32_t pass = 0);
  /// (position, radius), for the octree.
  const gpu::Buffer& spheres() const { return spheres_; }
  /// ... that know in which plane records lie.
  lookup::Discs discs(float thickness) const {
    return {.normals = records_, .stride = shared::k_record_texels, .at = 1, .thickness = thickness};
  }
  /// Keeps the first `count`.
  void truncate(uint32_t count) { size_ = std::min(size_, count); }
  void clear() { size_ = 0; }
  /// All of them, or one; for tests, files and the inspector.
  std::vector<Record> read() const;
  Record read(uint32_t index) const;
  /// The first `count`, for files; and back, in place of all there are. At most capacity(), the lists of one
  /// number of records (assertions). Without shares of groups, or of another number, those are 0: their light
  /// is of none.
  RawRecords raw(uint32_t count) const;
  void restore(const RawRecords& raw);
  /// What the overlay colours by, of every record.
  struct Figures {
    float rays, mean_distance, error;
  };
  std::vector<Figures> figures() const;
  /// Radii of the records from `first` on.
  std::vector<float> radii(uint32_t first) const;
  /// Luminance of the irradiance, all parts together, of every record.
  std::vector<float> luminances() const;
  /// Luminance of the irradiance as pilot rays have told of it, of every record.
  std::vector<float> pilot_luminances() const;
  /// Whether records bring no light because paths gather there (shared::k_record_crowded), of every record.
  std::vector<bool> crowded() const;
  /// Of the records from `first` on, which have no light yet, keeps those (indices from there, rising), with
  /// what is known of them.
  void keep(uint32_t first, std::span<const uint32_t> kept);
  /// Under the names of shaders/irradiance_cache: for kernels that gather, or for those that look up. These
  /// read the light that publish() last left, so that what records gather from each other does not depend on
  /// which of them are done.
  enum class Use { gather, look_up };
  void bind(gpu::Resources& resources, Use use) const;
  void publish(gpu::Stream& stream) const;
  /// Their light as these read it.
  const gpu::Buffer& light(Use use) const { return use == Use::gather ? irradiance_ : read_; }
  /// Shares of groups in it; no buffer where none are kept.
  const gpu::Buffer& shares(Use use) const { return use == Use::gather ? shares_ : shares_read_; }
  uint64_t group_bytes() const { return groups_ < 2 ? 0 : (groups_ + 3) / 4 * sizeof(uvec4); }  ///< a record

 private:
  std::vector<vec4> texels(uint32_t which) const;  ///< one of k_record_texels, of every record
  uint32_t capacity_ = 0, size_ = 0, groups_ = 1;
  gpu::Buffer records_, irradiance_, read_, spheres_, shares_, shares_read_;
};

}  // namespace lucerna::irradiance_cache
