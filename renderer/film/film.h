#pragma once
// The film: component sums in two independently scrambled halves, features, sample counts, in device memory;
// and its tone-mapped picture. Layout: shaders/shared/film.h.
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "base/math.h"
#include "gpu/stream.h"
#include "shaders/shared/film.h"
#include "shaders/shared/lanes.h"
#include "shaders/shared/ramp.h"

namespace lucerna::film {

inline constexpr int k_components = 4;

/// What the film holds, read back: means over the samples. Row 0 at the top.
struct Image {
  uint32_t width = 0, height = 0;
  std::array<std::vector<vec3>, k_components> components;  ///< radiance
  std::array<std::vector<vec3>, k_components> odd_half;    ///< mean of the odd samples alone
  std::vector<vec3> albedo, normal;                        ///< normal: unit or 0
  std::vector<float> depth;  ///< metres along the view axis, mean of hits; 0: none
  std::vector<uint32_t> samples;
};

/// The scale of a heat map: the layers samples, error (relative, of a pixel's block) and cost (device time of
/// a pixel, shared out by the vertices of its paths).
struct HeatScale {
  uint32_t ramp = 0;  ///< shared::k_ramp_*
  bool logarithmic = false;
  float lo = 0, hi = 1;  ///< values at its ends, lo < hi; samples, error 0..1, ms
  float unit = 1;        ///< cost: ms a vertex
};

struct View {
  uint32_t layer = 0;  ///< shared::k_layer_*
  uint32_t show = 15;  ///< components in the beauty layer
  uint32_t curve = 0;  ///< tone curve
  float exposure = 1;  ///< factor
  float scale = 1;     ///< depth shown white
  HeatScale heat;      ///< of the layers that are heat maps
  /// Side of the tiles whose marks (Film::mark_tiles) are drawn over the picture; 0: none.
  uint32_t tiles = 0;
};

/// How light is kept apart by groups of lights.
enum class GroupStorage {
  /// Each group has sums by component like the picture's: any mix is what rendering anew would be.
  by_component,
  /// Each group has sums of all components together, rounded to 18 bits without bias
  /// (shaders/film/add_groups.comp), and the picture has its own, by component, of the light as it is. A mix
  /// multiplies these by what it makes of the groups' sums, pixel by pixel and half by half: the picture and
  /// its noise are those of the mix, but it is shared out to the components as if all groups were alike in
  /// them.
  compact
};

/// The largest width or height of a picture.
inline constexpr uint32_t k_max_side = 32768;

/// Throws Error, naming the largest size that fits, unless a picture of that size can be held: no side beyond
/// k_max_side, no plane beyond what one binding of the device sees, and all of it in the device's memory, as
/// far as that is free of other things.
/// `groups`: of lights, that are kept apart.
void check_size(const gpu::DeviceInfo& device, uint32_t width, uint32_t height, uint32_t groups = 1,
                GroupStorage kept = GroupStorage::by_component);
/// Bytes that a pixel's sums take: 192 for the picture, and where there is more than one group of lights 200
/// (by component) or 16 (in short) for each.
uint64_t sum_bytes(uint32_t groups, GroupStorage kept = GroupStorage::by_component);

class Film {
 public:
  /// `groups`: of lights (shaders/shared/lanes.h), 1 to shared::k_most_groups, whose sums are kept apart; the
  /// picture is then their sum, as they are mixed. Throws Error as check_size, or when memory is short.
  Film(gpu::Device& device, uint32_t width, uint32_t height, uint32_t groups = 1,
       GroupStorage kept = GroupStorage::by_component);
  uint32_t groups() const { return groups_; }
  GroupStorage group_storage() const { return kept_; }
  /// Whether it keeps more than one group, all components of one together.
  bool is_compact() const { return groups_ > 1 && kept_ == GroupStorage::compact; }
  /// What each group's light is multiplied by, 1 where nothing is said (and for all of a new film): of a film
  /// of one group, which may have been drawn for more, the one weight there is. Where
  /// groups are kept by component the picture's sums take it up with transport::Wavefront::mix(), and with
  /// the next samples of their pixels; in short, at once.
  void set_mix(std::span<const vec3> weights);
  /// Where groups are kept apart and the device can bind it: each group's light of all components, by which
  /// another mix can be shown at once (Developer::mix).
  bool quick() const { return groups_ > 1 && quick_; }
  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  /// Blocks of 8x8 pixels, in raster order.
  uint32_t blocks_across() const { return (width_ + 7) / 8; }
  uint32_t blocks_down() const { return (height_ + 7) / 8; }
  uint32_t blocks() const { return blocks_across() * blocks_down(); }
  /// Whether kernels may write it as storage buffers; otherwise they must be compiled with
  /// LUCERNA_FILM_IMAGES.
  bool fits_storage_buffers() const { return fits_storage_buffers_; }
  void clear(gpu::Stream& stream);
  void bind(gpu::Resources& resources) const;
  /// A group's own sums, where they are kept apart by component.
  void bind_group(gpu::Resources& resources, uint32_t group) const;
  /// Of a component: two halves a pixel (shared::FilmHalf), as samples have brought them.
  const gpu::Buffer& sums(uint32_t component) const { return sums_.at(component); }
  /// Takes surfaces and counts of samples of another film of the same size. Records; the stream is not run.
  void copy_surfaces(gpu::Stream& stream, const Film& from);
  /// What it knows of surfaces, under the names coarse_albedo, coarse_normal and CoarseCount.
  void bind_coarse(gpu::Resources& resources) const;
  /// One for each block, in raster order, as the last estimates left them (all 0 where there was none).
  std::span<const shared::BlockError> errors() const;
  /// What the pixels read of records may be wrong by (BlockRecords, one a block in raster order), for kernels
  /// to write, as FilmRecords and BlockRecordSums; and that they have written all of it. Until then, and
  /// after a clear(), nothing is known.
  void make_room_for_record_errors();
  void complete_record_errors() { record_errors_complete_ = true; }
  /// Records have become other ones.
  void forget_record_errors() { record_errors_complete_ = false; }
  bool record_errors_complete() const { return record_errors_complete_; }
  /// Empty while nothing is known.
  std::span<const shared::BlockRecords> records() const;
  /// What lookups blur, which their paths bring with their light (LUCERNA_LOOKUP_BIAS): room for its sums,
  /// empty after a clear(), as FilmBiasEven and FilmBiasOdd, 8 bytes a pixel. From then on it is known.
  void make_room_for_lookup_bias(gpu::Stream& stream);
  bool lookup_bias_known() const { return lookup_bias_known_; }
  /// Means over the even and over the odd samples: by what luminance is told to be too large. Empty while
  /// nothing is known.
  std::array<std::vector<float>, 2> read_lookup_bias() const;
  Image read() const;
  /// Of a group of lights, where they are kept apart by component: mean radiance of each, not mixed.
  std::array<std::vector<vec3>, k_components> read_group(uint32_t group) const;
  /// Likewise, where they are kept in short: mean radiance of all components together.
  std::vector<vec3> read_group_sum(uint32_t group) const;
  /// Mean radiance of each component over the picture's sampled pixels.
  static std::array<vec3, k_components> means(const Image& image);
  /// What the overlay of tiles shows: one mark a tile, in raster order; at most one a block.
  void mark_tiles(std::span<const shared::TileMark> marks);
  const gpu::Buffer& picture() const { return picture_; }
  std::vector<uint8_t> read_picture() const;

 private:
  std::vector<shared::GroupSums> read_group_sums() const;
  /// What a pixel's even and odd half are multiplied by as the groups are mixed; empty: nothing.
  std::vector<vec3> mix_ratios() const;

  uint32_t width_, height_, groups_;
  GroupStorage kept_;
  bool fits_storage_buffers_ = true;
  using Sums = std::array<gpu::Buffer, k_components>;
  Sums make_sums() const;
  Sums sums_;
  std::vector<Sums> group_sums_;  // by component; none where there is one group: they are the picture's
  gpu::Buffer group_short_;       // GroupSums, where groups are kept in short
  gpu::Buffer light_mix_, group_light_;
  shared::GroupMix mix_{};  // what light_mix_ holds
  bool quick_ = false;
  gpu::Buffer albedo_, normal_, count_, vertices_, picture_, errors_, tile_marks_;
  gpu::Device& device_;
  gpu::Buffer records_, block_records_;  // small where there are none
  bool record_errors_complete_ = false;
  std::array<gpu::Buffer, 2> lookup_bias_;  // likewise
  bool lookup_bias_known_ = false;
};

}  // namespace lucerna::film
