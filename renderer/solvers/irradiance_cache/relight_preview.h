#pragma once
// Light for the window while records are relit, where it is known what an edit does to their light: they keep
// their places and radii, and have the light they had times what the edit does to each group of lights, until
// they are relit. Relighting goes pass by pass with hundreds of rays a record, and what it brings does not
// depend on any of this.
//
// Of other edits nothing is known without rays. Few rays to each of many records light a room less well than
// as many paths of the picture do, which drafts filter over its surfaces and whose noise they know; so drafts
// read the records that are relit, and trace what these do not serve.
#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "solvers/irradiance_cache/lookup_tables.h"
#include "transport/wavefront.h"

namespace lucerna::irradiance_cache {

class RelightPreview {
 public:
  /// `groups`: of lights, as Records.
  RelightPreview(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t groups)
      : device_(device), compiler_(compiler), groups_(std::max(1u, groups)), factors_(groups_, vec3(1)) {}

  /// Makes what so many records need, ahead of time. Throws Error when memory is short.
  void make_room(uint32_t count);
  /// Whether such factors, of the light of each group of lights or of all light, say all of what records
  /// hold.
  bool known(const std::optional<std::vector<vec3>>& factors) const;
  /// The first `count` records of the tables are about to lose their light, which will be known() factors
  /// times that; where there is a preview of them already, its light is the one before. `sky_group`: whose
  /// light the sky's is.
  void begin(const LookupTables& tables, uint32_t count, const std::vector<vec3>& factors,
             uint32_t sky_group = 0);
  /// Nothing is to be shown any more.
  void end() { count_ = 0; }
  bool active() const { return count_ > 0; }

  /// The first `count` records of the tables have their light: it is shown.
  void take(gpu::Stream& stream, const LookupTables& tables, uint32_t count);
  /// Lookups of the wavefront's paths read this from now on, or no longer. The tables' bind() is called by
  /// way of Wavefront::rebind_lookup().
  void look_up(transport::Wavefront& wavefront, const LookupTables& tables, bool on);
  bool looked_up() const { return looked_up_; }
  /// In place of what the tables bind.
  void bind(gpu::Resources& to) const;
  uint64_t bytes() const;  ///< of device memory

 private:
  /// What begin() has left to the device.
  void make_ready(gpu::Stream& stream);

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  uint32_t groups_;                   ///< at least 1
  std::unique_ptr<Records> records_;  ///< what is shown, as lookups read it
  std::unique_ptr<lookup::Octree> octree_;
  gpu::Kernel kernel_;
  gpu::Buffer old_, old_shares_, frame_, group_factors_;
  gpu::Resources resources_;
  std::vector<vec3> factors_;  ///< of the light before, since it was begun, by group
  uint32_t sky_group_ = 0, count_ = 0;
  bool looked_up_ = false, indexed_ = false, begun_ = false;
};

}  // namespace lucerna::irradiance_cache
