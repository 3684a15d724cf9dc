#pragma once
// Multiple-reference octree: finds the spheres that may contain a point. Shared by solvers that look up by
// position: cache records with their radii, photons with the gather radius.
//
// It stores only leaves, all of one level, each with the list of every sphere that overlaps it, so a lookup
// is one hash lookup and one loop (contract: shaders/lib/octree.glsl). Optionally, leaves with many small
// spheres are split into leaves of a finer level; a lookup there takes two hash lookups. It is built on the
// device: references are counted, placed by a prefix sum, written, sorted by the Morton code of their leaf,
// and cut into leaves. No order depends on atomics: two builds of the same spheres are byte-identical.
#include "base/math.h"
#include "gpu/stream.h"
#include "shaders/shared/octree.h"
#include "sort/radix_sort.h"

namespace lucerna::lookup {

inline constexpr uint32_t k_most_spheres = 1u << 24;  ///< counted in float

struct OctreeOptions {
  uint32_t spheres = 0;     ///< maximum spheres of a build, at most k_most_spheres
  uint32_t references = 0;  ///< memory for references; about 8 to 12 per sphere if all have similar sizes
  /// Maximum leaf size over the mean diameter of the spheres (the minimum is half of that, if levels permit).
  /// Affects speed and memory, never results.
  float leaf_scale = 1;
  /// Stores copies of the spheres in list order (a vec4 per reference), for octree_copy().
  bool copies = false;
  /// Lists each sphere only in the leaf of its centre: the plain grid that the bench compares with. Lookups
  /// must then visit neighbouring leaves.
  bool single_reference = false;
  /// Spheres are only looked up near a plane through their centre: builds take Discs, and farther points may
  /// miss them. Fewer leaves list each sphere, so leaves can be smaller.
  bool discs = false;
  /// Leaves with more spheres than this are split, by up to shared::k_octree_most_split levels, until
  /// `leaf_scale` fits the spheres that they list; half of the references are reserved for it. 0: no
  /// splitting. Not with `single_reference`.
  uint32_t crowd = 0;
};

/// Discs: sphere i is found where |dot(x - centre, normal)| <= thickness * radius; its unit normal is texel
/// stride * i + at.
struct Discs {
  const gpu::Buffer& normals;
  uint32_t stride = 1, at = 0;
  float thickness = 0;
};

class Octree {
 public:
  /// Throws Error if the device cannot hold it; the message contains the maximum number of references.
  Octree(gpu::Device& device, gpu::ShaderCompiler& compiler, const OctreeOptions& options);

  /// Builds from `spheres`, a texel buffer of (centre, radius) in metres. Spheres with a negative radius or
  /// nonfinite values are left out; indices are positions in the buffer. Runs the stream, including
  /// everything recorded before. Reads the header back twice: when the level is known, because it determines
  /// the bits to sort by, and at the end; and once for every split level that is tried.
  ///
  /// If memory does not suffice for the required level, the finest level that fits is used: lists are longer,
  /// results are equal, and the header reports it (`level` < `wanted_level`, `needed` > `capacity`).
  /// `overflow` is nonzero only if one leaf cannot list every sphere; then the spheres of the highest indices
  /// are missing. `discs`: required if and only if the options use discs.
  ///
  /// With a core, the root covers the part of the spheres' box inside it: see set_core().
  const shared::OctreeHeader& build(gpu::Stream& stream, const gpu::Buffer& spheres, const sort::Count& count,
                                    const Discs* discs = nullptr);

  /// For later builds: the box of most points, without distant outliers [m]; empty: the root covers all
  /// spheres. Without it one distant sphere makes all leaves so large that one lists thousands. Points beyond
  /// the core are found in the outermost leaves. Affects speed and memory, never results.
  void set_core(const Box& core) { core_ = core; }
  const Box& core() const { return core_; }
  /// For later builds: OctreeOptions::leaf_scale. Larger leaves build sooner and list more spheres.
  void set_leaf_scale(float scale) { options_.leaf_scale = scale; }

  /// Of the latest build.
  const shared::OctreeHeader& header() const { return header_; }
  /// Binds everything that shaders/lib/octree.glsl needs. Call it after every build.
  void bind(gpu::Resources& resources) const;
  uint64_t bytes() const;  ///< device memory

  /// Maximum references in the storage buffers of a device.
  static uint32_t most_references(const gpu::Device& device);

 private:
  // The steps of build(), in order.
  struct Work;
  void bind_spheres(Work& work, const gpu::Buffer& spheres, const sort::Count& count,
                    const Discs* discs) const;
  void write_references(Work& work, const sort::Count& count);
  void cut_into_leaves(Work& work);
  void split_crowded(Work& work, const sort::Count& written);

  OctreeOptions options_;
  Box core_;
  uint32_t groups_;
  sort::PrefixSum prefix_sum_;
  sort::RadixSort sorter_;
  gpu::Kernel bounds_, grid_, levels_, choose_, count_, write_, heads_, leaves_, clear_, insert_, expand_,
      copy_, crowd_, split_count_, split_write_;
  gpu::Buffer header_buffer_, run_bounds_, run_needs_, run_leaves_, sphere_references_, unused_;
  gpu::Buffer pairs_[2], slot_leaves_, slots_, copies_, splits_, leaf_cells_;
  const gpu::Buffer* references_ = nullptr;  ///< one of pairs_
  shared::OctreeHeader header_{};
};

}  // namespace lucerna::lookup
