#pragma once
// The multiple-reference octree: spheres in, for every point the list of the spheres that may contain it.
// Shared by all solvers that look things up by place: cache records with their radii, photons with the gather
// radius.
//
// Only leaves exist, all of one level, each with the list of every sphere that overlaps it, so that a query
// is one hash lookup and one loop (shaders/lib/octree.glsl, where the contract of a query stands). Where that
// is asked for, leaves that list many spheres much smaller than most are split into leaves of a finer level,
// and a query there is two lookups. Everything is built on the device: references are counted, placed by a
// prefix sum, written, sorted by the Morton code of their leaf, and cut into leaves. No order comes from
// atomics: two builds of the same spheres are the same byte for byte.
#include "base/math.h"
#include "gpu/stream.h"
#include "shaders/shared/octree.h"
#include "sort/radix_sort.h"

namespace lucerna::lookup {

inline constexpr uint32_t k_most_spheres = 1u << 24;  ///< they are counted in float

struct OctreeOptions {
  uint32_t spheres = 0;     ///< most that a build may be given, at most k_most_spheres
  uint32_t references = 0;  ///< memory for that many; about 8 to 12 a sphere where all are of a size
  /// Leaves are no larger than this times the mean diameter of the spheres (and larger than half of that, the
  /// level permitting). Changes speed and memory, never a result.
  float leaf_scale = 1;
  /// Keep copies of the spheres in the order of the lists (16 bytes a reference), for octree_copy().
  bool copies = false;
  /// Each sphere is listed once, in the leaf of its centre: the plain grid that the bench compares with.
  /// Queries must then visit the neighbours.
  bool single_reference = false;
  /// Spheres are asked for only near a plane through their centre: builds are given Discs, and points farther
  /// off may not find them. Fewer leaves list them, so that leaves can be smaller.
  bool discs = false;
  /// Leaves that list more spheres than that are split, by up to shared::k_octree_most_split levels, until
  /// they are as `leaf_scale` says of the spheres that they list themselves; half of the references are kept
  /// for that. 0: none is. Not with `single_reference`.
  uint32_t crowd = 0;
};

/// Where discs lie: sphere i is found where |dot(x - centre, normal)| <= thickness * radius, its normal being
/// texel stride * i + at, unit.
struct Discs {
  const gpu::Buffer& normals;
  uint32_t stride = 1, at = 0;
  float thickness = 0;
};

class Octree {
 public:
  /// Throws Error when the device cannot hold it, naming the most references that it can.
  Octree(gpu::Device& device, gpu::ShaderCompiler& compiler, const OctreeOptions& options);

  /// Builds it from `spheres`, a texel buffer of (centre, radius) in metres. Spheres whose radius is
  /// negative, or that are not finite, are left out; indices are places in the buffer. Runs the stream, with
  /// all that was recorded before, and reads the header back twice: when the level is known, because it says
  /// how many bits are to be sorted by, and at the end; and for every number of levels that it tries to split
  /// crowded leaves by.
  ///
  /// Where memory does not suffice for the level that the spheres call for, the finest that fits is taken:
  /// lists grow longer, results stay the same, and the header says so (`level` < `wanted_level`, `needed` >
  /// `capacity`). Only when not even one leaf can list every sphere, `overflow` is not 0, and the spheres of
  /// the highest indices are missing.
  /// `discs`: if and only if the options say that there are.
  ///
  /// Where a core is set, the root holds what of the spheres' box lies in it: see set_core().
  const shared::OctreeHeader& build(gpu::Stream& stream, const gpu::Buffer& spheres, const sort::Count& count,
                                    const Discs* discs = nullptr);

  /// Of the builds to come: where most points are, without what stands far away, metres; empty: the root
  /// holds all spheres. Without it a single far sphere makes all leaves so large that one lists thousands.
  /// What lies beyond the core is found in the outermost leaves. Changes speed and memory, never a result.
  void set_core(const Box& core) { core_ = core; }
  const Box& core() const { return core_; }

  /// Of the last build.
  const shared::OctreeHeader& header() const { return header_; }
  /// Whatever shaders/lib/octree.glsl needs. Call it after a build, and again after every other.
  void bind(gpu::Resources& resources) const;
  uint64_t bytes() const;  ///< device memory

  /// What fits into the storage buffers of a device; on lavapipe 8 388 607.
  static uint32_t most_references(const gpu::Device& device);

 private:
  // The steps of build(), in its order.
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
