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

/// Contents of the film: means over the samples. Row 0 is at the top.
struct Image {
  uint32_t width = 0, height = 0;
  ByComponent<std::vector<vec3>> components;  ///< radiance
  ByComponent<std::vector<vec3>> odd_half;    ///< mean of the odd samples alone
  std::vector<vec3> albedo, normal;           ///< normal: unit or 0
  std::vector<float> depth;                   ///< metres along the view axis, mean of hits; 0: none
  std::vector<uint32_t> samples;
  std::vector<std::vector<vec3>> layers;      ///< radiance of the layers by path expressions
  std::vector<std::vector<vec3>> odd_layers;  ///< of the odd samples alone
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
  uint32_t layer = 0;  ///< shared::k_layer_*, or k_layer_first_own + the number of a layer by path expression
  uint32_t show = 15;  ///< components in the beauty layer
  uint32_t curve = 0;  ///< tone curve
  float exposure = 1;  ///< factor
  float scale = 1;     ///< depth shown white
  HeatScale heat;      ///< for heat maps
  /// Side of the tiles whose marks (Film::mark_tiles) are drawn over the picture; 0: none.
  uint32_t tiles = 0;
  bool tint_former = false;  ///< of a preview: tints light from before the last edit
  /// A table in place of the tone curve (shaders/shared/display_lut.h): vec4 a node. It must outlive the use
  /// of the view. Null: none.
  const gpu::Buffer* display_lut = nullptr;
};

/// Storage of separate light groups.
enum class GroupStorage {
  /// Each group has sums by component like the picture's: any mix equals rendering it from scratch.
  by_component,
  /// Each group has sums of all components together, rounded to 18 bits without bias
  /// (shaders/film/add_groups.comp), and the picture has its sums by component of the unmixed light. A mix
  /// multiplies these by the ratio of the groups' sums, pixel by pixel and half by half: the picture and its
  /// noise are those of the mix; only its split into components assumes equal shares in all groups.
  compact
};

/// The largest width or height of a picture.
inline constexpr uint32_t k_max_side = 32768;

/// Throws Error, naming the largest size that fits, unless a picture of that size can be allocated: no side
/// beyond k_max_side, no plane beyond one binding of the device, and everything within the device's free
/// memory. `groups`: separate light groups; `layers`: by path expressions.
void check_size(const gpu::DeviceInfo& device, uint32_t width, uint32_t height, uint32_t groups = 1,
                GroupStorage kept = GroupStorage::by_component, uint32_t layers = 0);
/// Bytes of the sums per pixel: of the picture, of layers and, if there are several, of the light groups.
uint64_t sum_bytes(uint32_t groups, GroupStorage kept = GroupStorage::by_component, uint32_t layers = 0);

class Film {
 public:
  /// `groups`: separate light groups (shaders/shared/lanes.h), 1 to shared::k_most_groups; the picture is
  /// then their mix. `layers`: number of layers by path expressions (paths/layers.h). Throws Error like
  /// check_size, or if memory is short.
  Film(gpu::Device& device, uint32_t width, uint32_t height, uint32_t groups = 1,
       GroupStorage kept = GroupStorage::by_component, uint32_t layers = 0);
  uint32_t layers() const { return static_cast<uint32_t>(layers_.size()); }
  uint32_t groups() const { return groups_; }
  GroupStorage group_storage() const { return kept_; }
  /// True if it stores several groups with all components together.
  bool is_compact() const { return groups_ > 1 && kept_ == GroupStorage::compact; }
  /// Factors of the groups' light; 1 if missing (and in a new film). A film of one group, which may be traced
  /// for several, has one weight. If groups are stored by component, the picture's sums change with
  /// transport::Wavefront::mix() and with the next samples of their pixels; compact ones change at once.
  void set_mix(std::span<const vec3> weights);
  /// With separate groups, if the device can bind it: each group's light of all components, for immediate
  /// display of another mix (Developer::mix).
  bool quick() const { return groups_ > 1 && quick_; }
  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  /// Blocks of 8x8 pixels, in raster order.
  uint32_t blocks_across() const { return (width_ + 7) / 8; }
  uint32_t blocks_down() const { return (height_ + 7) / 8; }
  uint32_t blocks() const { return blocks_across() * blocks_down(); }
  /// True if kernels can write it as storage buffers; otherwise they must be compiled with
  /// LUCERNA_FILM_IMAGES.
  bool fits_storage_buffers() const { return fits_storage_buffers_; }
  void clear(gpu::Stream& stream);
  void bind(gpu::Resources& resources) const;
  /// Sums of a group, if stored by component.
  void bind_group(gpu::Resources& resources, uint32_t group) const;
  /// Sums of a layer, as film_layer.
  void bind_layer(gpu::Resources& resources, uint32_t layer) const;
  /// Sums of k_error_layers layers from `first` on, as film_layer_0 and so on, and their errors. Places
  /// without a layer repeat the last one.
  void bind_layer_errors(gpu::Resources& resources, uint32_t first) const;
  /// Sums of a component: two halves a pixel (shared::FilmHalf), before the mix.
  const gpu::Buffer& sums(uint32_t component) const { return sums_.at(component); }
  /// Takes surfaces and counts of samples of another film of the same size. Records; the stream is not run.
  void copy_surfaces(gpu::Stream& stream, const Film& from);
  /// Binds its surfaces as coarse_albedo, coarse_normal and CoarseCount.
  void bind_coarse(gpu::Resources& resources) const;
  /// The latest estimate of each block, in raster order; all 0 without one.
  std::span<const shared::BlockError> errors() const;
  /// Likewise of the k_error_layers layers by path expressions from `first` on, a multiple of that; empty
  /// if there are none.
  std::span<const shared::BlockError> layer_errors(uint32_t first) const;
  /// Allocates the errors of lookups (BlockLookups, one per block in raster order), written by kernels as
  /// FilmLookups and BlockLookupSums; and marks them as complete. Unknown until then, and after a clear().
  void make_room_for_lookup_errors();
  void complete_lookup_errors() { lookup_errors_complete_ = lookup_errors_current_ = true; }
  /// The stored light has less noise than before: the errors are too large until they are complete again.
  void outdate_lookup_errors() { lookup_errors_current_ = false; }
  bool lookup_errors_complete() const { return lookup_errors_complete_; }
  bool lookup_errors_current() const { return lookup_errors_current_; }
  /// Empty while unknown.
  std::span<const shared::BlockLookups> lookup_errors() const;
  /// Allocates the sums of lookup bias, which arrives with the light of paths (LUCERNA_LOOKUP_BIAS):
  /// FilmBiasEven and FilmBiasOdd, empty after a clear(). From then on lookup_bias_known().
  void make_room_for_lookup_bias(gpu::Stream& stream);
  bool lookup_bias_known() const { return lookup_bias_known_; }
  /// Means over the even and over the odd samples: estimated excess of the luminance. Empty while unknown.
  std::array<std::vector<float>, 2> read_lookup_bias() const;
  Image read() const;
  /// Mean radiance of a light group by component, unmixed; requires groups by component.
  ByComponent<std::vector<vec3>> read_group(uint32_t group) const;
  /// Mean radiance of all components together; requires compact groups.
  std::vector<vec3> read_group_sum(uint32_t group) const;
  /// Mean radiance of each component over the picture's sampled pixels.
  static ByComponent<vec3> means(const Image& image);
  /// Likewise of the layers by path expressions.
  static std::vector<vec3> layer_means(const Image& image);
  /// Sets the marks of the tile overlay: one per tile, in raster order; at most one per block.
  void mark_tiles(std::span<const shared::TileMark> marks);
  const gpu::Buffer& picture() const { return picture_; }
  std::vector<uint8_t> read_picture() const;

 private:
  std::vector<shared::GroupSums> read_group_sums() const;
  /// Factors on a pixel's even and odd half by the mix of groups; empty: 1.
  std::vector<vec3> mix_ratios() const;

  uint32_t width_, height_, groups_;
  GroupStorage kept_;
  bool fits_storage_buffers_ = true;
  using Sums = ByComponent<gpu::Buffer>;
  Sums make_sums() const;
  Sums sums_;
  std::vector<gpu::Buffer> layers_;
  std::vector<Sums> group_sums_;  // by component; empty with one group, whose sums are the picture's
  gpu::Buffer group_short_;       // GroupSums of compact groups
  gpu::Buffer light_mix_, group_light_;
  shared::GroupMix mix_{};  // contents of light_mix_
  bool quick_ = false;
  gpu::Buffer albedo_, normal_, count_, vertices_, picture_, errors_, tile_marks_;
  std::vector<gpu::Buffer> layer_errors_;  // one for each k_error_layers layers
  gpu::Device& device_;
  gpu::Buffer lookups_, block_lookups_;  // small where there are none
  bool lookup_errors_complete_ = false, lookup_errors_current_ = false;
  std::array<gpu::Buffer, 2> lookup_bias_;  // likewise
  bool lookup_bias_known_ = false;
};

}  // namespace lucerna::film
