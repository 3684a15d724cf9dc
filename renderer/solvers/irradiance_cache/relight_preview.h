#pragma once
// Preview light during relighting, for edits whose effect on the light is known: records keep places and
// radii and show their old light times the edit's factor for each light group, until they are relit.
// Relighting itself takes hundreds of rays per record and is independent of the preview.
//
// Other edits have no known factor. Tracing few rays for each of many records would light a room worse than
// tracing the same number of preview samples, which are filtered over surfaces and have known noise. Preview
// samples therefore read only relit records and trace the rest.
#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "solvers/irradiance_cache/lookup_tables.h"
#include "transport/wavefront.h"

namespace lucerna::irradiance_cache {

class RelightPreview {
 public:
  /// `groups`: light groups, as in Records.
  RelightPreview(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t groups)
      : device_(device), compiler_(compiler), groups_(std::max(1u, groups)), factors_(groups_, vec3(1)) {}

  /// Allocates memory for that many records in advance. Throws Error: memory.
  void make_room(uint32_t count);
  /// True if these factors, for each light group or for all light, determine the new light of records.
  bool known(const std::optional<std::vector<vec3>>& factors) const;
  /// The first `count` records are about to lose their light; the new light will be the old times known()
  /// factors. If a preview is already shown, its light counts as the old one. `sky_group`: group of the sky.
  void begin(const LookupTables& tables, uint32_t count, const std::vector<vec3>& factors,
             uint32_t sky_group = 0);
  /// Ends the preview.
  void end() { count_ = 0; }
  bool active() const { return count_ > 0; }

  /// The first `count` records have been relit and show their light.
  void take(gpu::Stream& stream, const LookupTables& tables, uint32_t count);
  /// Switches lookups of the wavefront's paths to the preview or back. Calls the tables' bind() through
  /// Wavefront::rebind_lookup().
  void look_up(transport::Wavefront& wavefront, const LookupTables& tables, bool on);
  bool looked_up() const { return looked_up_; }
  /// Replaces the bindings of the tables.
  void bind(gpu::Resources& to) const;
  uint64_t bytes() const;  ///< of device memory

 private:
  /// Device work of begin().
  void make_ready(gpu::Stream& stream);

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  uint32_t groups_;                   ///< at least 1
  std::unique_ptr<Records> records_;  ///< preview records, as lookups read them
  std::unique_ptr<lookup::Octree> octree_;
  gpu::Kernel kernel_;
  gpu::Buffer old_, old_shares_, frame_, group_factors_;
  gpu::Resources resources_;
  std::vector<vec3> factors_;  ///< product of factors since the preview began, by group
  uint32_t sky_group_ = 0, count_ = 0;
  bool looked_up_ = false, indexed_ = false, begun_ = false;
};

}  // namespace lucerna::irradiance_cache
