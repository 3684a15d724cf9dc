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

/// Place of a record or candidate. World space; `position` is off its surface by the error bound, `normal`
/// unit, on the lit side.
struct Place {
  vec3 position{0}, normal{0, 1, 0};
  uint32_t facet = 0;                         ///< geometric normal, shared::facet_pack()
  uint32_t origin = shared::k_origin_screen;  ///< shared::k_origin_*
  uint32_t medium = 0;                        ///< media around it, as shared::PathState::media
  float reach = 0;  ///< of candidates: distance within which it covers others [m]; 0 for records
};

/// One part of a record's irradiance, with gradients in world space.
struct Irradiance {
  vec3 value{0};  ///< rgb; radiance times sr
  /// Rotational gradient: change of a channel as the normal n_i turns to n: dot(n_i x n, rotation[channel]).
  std::array<vec3, 3> rotation{};
  std::array<vec3, 3> translation{};  ///< translational gradient, by channel [1/m]
};

/// A record read back.
struct Record {
  Place place;
  float radius = 0;          ///< of validity [m], major one of an ellipse; 0: none yet
  float lesser_radius = 0;   ///< minor radius [m]
  vec3 along{0};             ///< unit vector along the major axis; 0: circle
  float mean_distance = 0;   ///< harmonic mean of its ray distances [m]; infinite without hits
  float least_distance = 0;  ///< [m]
  float error = 0;           ///< standard error of the luminance of `value`, summed over the evaluated parts
  uint32_t rays = 0;
  uint32_t pass = 0;     ///< pass that placed it
  bool crowded = false;  ///< stores no irradiance: paths gather there (shared::k_record_crowded)
  std::array<Irradiance, shared::k_part_count> parts;
};

/// Raw device data of records, as stored in files.
struct RawRecords {
  std::vector<vec4> places;   ///< record_texels
  std::vector<vec4> lights;   ///< irradiance_texels
  std::vector<vec4> spheres;  ///< (position, radius)
  /// record_group_texels (shaders/irradiance_cache/groups.glsl); empty without light groups.
  std::vector<uvec4> groups;
  uint32_t size() const { return static_cast<uint32_t>(spheres.size()); }
  bool crowded(uint32_t record) const;  ///< as Record::crowded
  /// Keeps only these; rising indices.
  void keep(std::span<const uint32_t> kept);
};

/// Light of records as lookups read it.
struct PublishedLight {
  std::vector<vec4> lights;   ///< as in RawRecords
  std::vector<uvec4> groups;  ///< as in RawRecords
  /// k_lookup_lanes for each record: error of the luminance of all its parts in that lane (picture_error.h).
  std::vector<float> errors;
};

/// Shares of a light group, as RawRecords::groups has them: shaders/lib/group_shares.glsl.
uint32_t share_pack(vec3 share);
vec3 share_unpack(uint32_t bits);

/// Tangent and bitangent of a record: make_basis() of shaders/lib/math.glsl.
std::array<vec3, 2> tangent_basis(const vec3& normal);

/// #defines of kernels that read or write light of that many groups.
inline gpu::Defines group_defines(uint32_t groups) {
  if (groups < 2) return {};
  return {{"LUCERNA_LIGHT_GROUPS", std::to_string(groups)}, {"LUCERNA_GROUP_SUMS", "1"}};
}

class Records {
 public:
  /// Allocates `capacity` records of shared::k_record_bytes. `groups`: light groups whose shares are stored;
  /// less than 2: none. Throws Error if that exceeds what the device can bind (most_records()) or its memory.
  Records(gpu::Device& device, uint32_t capacity, uint32_t groups = 1);
  /// Maximum number of records in one buffer of this device.
  static uint32_t most_records(const gpu::Device& device);
  uint32_t capacity() const { return capacity_; }
  uint32_t groups() const { return groups_; }
  /// Device memory, for lookups and for gathering.
  uint64_t bytes() const { return capacity_ * (shared::k_record_bytes + 2 * group_bytes()); }
  uint32_t size() const { return size_; }
  /// Adds records without light and validity; returns the number that fit. `pass`: at most k_record_pass.
  uint32_t append(std::span<const Place> places, uint32_t pass = 0);
  /// (position, radius), for the octree.
  const gpu::Buffer& spheres() const { return spheres_; }
  /// ... with the planes of the records.
  lookup::Discs discs(float thickness) const {
    return {.normals = records_, .stride = shared::k_record_texels, .at = 1, .thickness = thickness};
  }
  /// Keeps the first `count`.
  void truncate(uint32_t count) { size_ = std::min(size_, count); }
  void clear() { size_ = 0; }
  /// Reads all of them, or one; for tests, files and the inspector.
  std::vector<Record> read() const;
  Record read(uint32_t index) const;
  /// Luminance of the sum of a record's parts as lookups read it. 0 for crowded records.
  float published_luminance(uint32_t index) const;
  /// Reads the first `count`, for files; and replaces all records, published as they are. At most capacity();
  /// all lists must have the same number of records (assertions). Group shares are 0 if missing or of another
  /// number of groups.
  RawRecords raw(uint32_t count) const;
  void restore(const RawRecords& raw);
  /// Values that overlays colour by, for every record.
  struct Figures {
    float rays, mean_distance, error;
  };
  std::vector<Figures> figures() const;
  /// Radii of the records from `first` on.
  std::vector<float> radii(uint32_t first) const;
  /// Luminance of the irradiance of every record, over all parts.
  std::vector<float> luminances() const;
  /// Likewise, from pilot rays.
  std::vector<float> pilot_luminances() const;
  /// True for crowded records (shared::k_record_crowded).
  std::vector<bool> crowded() const;
  /// Of the records from `first` on, which have no light yet, keeps those listed (rising indices relative to
  /// `first`).
  void keep(uint32_t first, std::span<const uint32_t> kept);
  /// Binds the names of shaders/irradiance_cache, for kernels that gather and for those that look up. Lookups
  /// read the light of the last publish(), so that records gathering from each other do not depend on the
  /// order of evaluation.
  enum class Use { gather, look_up };
  void bind(gpu::Resources& resources, Use use) const;
  /// Publishes the gathered light of all records. Runs the stream.
  void publish(gpu::Stream& stream) const;
  /// Publishes other light for the first records, and their errors. No work is recorded that publishes.
  void publish(const PublishedLight& light);
  /// Light of the records as lookups read it.
  const gpu::Buffer& light(Use use) const { return use == Use::gather ? irradiance_ : read_; }
  /// Its group shares; no buffer without groups.
  const gpu::Buffer& shares(Use use) const { return use == Use::gather ? shares_ : shares_read_; }
  uint64_t group_bytes() const {
    return groups_ < 2 ? 0 : (groups_ + 3) / 4 * sizeof(uvec4);
  }  ///< per record

 private:
  std::vector<vec4> texels(uint32_t which) const;  ///< one of k_record_texels, of every record
  uint32_t capacity_ = 0, size_ = 0, groups_ = 1;
  gpu::Buffer records_, irradiance_, read_, errors_, spheres_, shares_, shares_read_;
};

}  // namespace lucerna::irradiance_cache
