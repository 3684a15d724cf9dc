#pragma once
// Emission of light paths: each light in proportion to its power, with its distribution over places and
// directions (shaders/lib/emission.glsl). For photons, light tracing and other uses.
//
// A share of the paths may be aimed at casters (casters.h) and at entrances of distant light (first_hits.h):
// strata are the pairs of a group of lights and a box, and stratum 0, which is unaimed. Shares do not change
// the mean; stratum 0 must have one.
#include <span>
#include <vector>

#include "gpu/kernel.h"
#include "shaders/shared/emission.h"
#include "upload/flatten.h"

namespace lucerna::transport {

/// A light alone where it is a lamp, the sun or the sky; emissive triangles that lie together.
struct LightGroups {
  std::vector<std::vector<uint32_t>> members;  ///< entries of the light table, behind it the sky's
};
/// At most `most` (>= 1), of lights that shine: where there are more, those of the end share one.
LightGroups group_lights(const upload::FlatScene& flat, std::span<const double> power, uint32_t most);

/// True if an entry of the light table, or the sky's behind them, is distant light, which passes the scene's
/// disk.
bool from_afar(const upload::FlatLights& lights, uint32_t entry);

class LightSource {
 public:
  LightSource() = default;
  /// Throws Error: no memory. Nothing is aimed.
  LightSource(gpu::Device& device, const upload::FlatLights& lights, const vec3& scene_centre,
              float scene_radius);
  /// If the scene has a smaller core, half of the distant light starts in front of it.
  LightSource(gpu::Device& device, const upload::FlatScene& flat);
  /// Paths are aimed at these boxes, in equal shares but for `unaimed` of stratum 0 (0 < unaimed <= 1). None,
  /// or no light: nothing is aimed. Throws Error: no memory.
  void aim(gpu::Device& device, const upload::FlatScene& flat, std::span<const Box> casters, double unaimed);
  /// Lights are chosen in proportion to these, an entry each, where paths are not aimed: by powers() until
  /// this is called. Above 0 where a light has power.
  void choose_by(std::span<const double> weights);
  /// Luminance of each entry's flux [W].
  std::span<const double> powers() const { return powers_; }
  /// Sets the strata's shares, up to a factor; that of stratum 0 must be above 0.
  void share_out(std::span<const double> shares);
  /// 1 + groups * casters; 1 where nothing is aimed.
  uint32_t strata() const { return 1 + table_.groups * table_.casters; }
  std::span<const double> shares() const { return shares_; }
  /// Entries of the light table by group, the sky's behind the last; none where nothing is aimed.
  std::span<const std::vector<uint32_t>> groups() const { return members_of_groups_; }
  /// emission_*, EmissionBlock. What lights are is bound with the scene.
  void bind(gpu::Resources& resources) const;
  /// Luminance of the flux of all lights [W]; 0: there is nothing to begin.
  double power() const { return power_; }
  double power_from_afar() const { return power_from_afar_; }  ///< ... of distant lights
  const shared::EmissionTable& table() const { return table_; }
  uint64_t bytes() const;

 private:
  shared::EmissionTable table_{};
  std::vector<double> powers_, shares_;
  std::vector<std::vector<uint32_t>> members_of_groups_;
  gpu::Buffer alias_, block_, strata_, boxes_, groups_, members_;
  double power_ = 0, power_from_afar_ = 0;
};

}  // namespace lucerna::transport
