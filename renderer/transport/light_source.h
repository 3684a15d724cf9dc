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

/// Groups of lights: single lamps, the sun, the sky, or clusters of emissive triangles.
struct LightGroups {
  std::vector<std::vector<uint32_t>> members;  ///< entries of the light table, followed by the sky's
};
/// At most `most` (>= 1) groups of lights with power; if there are more, the last ones share one.
LightGroups group_lights(const upload::FlatScene& flat, std::span<const double> power, uint32_t most);

/// True if an entry of the light table, or the sky's entry after them, is distant light, which starts on the
/// scene's disk.
bool from_afar(const upload::FlatLights& lights, uint32_t entry);

class LightSource {
 public:
  LightSource() = default;
  /// Without aiming. Throws Error: out of memory.
  LightSource(gpu::Device& device, const upload::FlatLights& lights, const vec3& scene_centre,
              float scene_radius);
  /// If the scene has a smaller core, half of the distant light starts in front of it.
  LightSource(gpu::Device& device, const upload::FlatScene& flat);
  /// Aims paths at these boxes, in equal shares except for the share `unaimed` of stratum 0 (0 < unaimed <=
  /// 1). Without boxes or lights, no aiming. Throws Error: out of memory.
  void aim(gpu::Device& device, const upload::FlatScene& flat, std::span<const Box> casters, double unaimed);
  /// Sets the relative probabilities of lights for unaimed paths, one per entry; initially powers(). Must be
  /// above 0 for lights with power.
  void choose_by(std::span<const double> weights);
  /// Luminance of each entry's flux [W].
  std::span<const double> powers() const { return powers_; }
  /// Sets the strata's shares, up to a factor; that of stratum 0 must be above 0.
  void share_out(std::span<const double> shares);
  /// 1 + groups * casters; 1 without aiming.
  uint32_t strata() const { return 1 + table_.groups * table_.casters; }
  std::span<const double> shares() const { return shares_; }
  /// Entries of the light table by group, the sky's after the last; empty without aiming.
  std::span<const std::vector<uint32_t>> groups() const { return members_of_groups_; }
  /// Binds emission_* and EmissionBlock. The lights are bound with the scene.
  void bind(gpu::Resources& resources) const;
  /// Luminance of the flux of all lights [W]; 0: there are no light paths.
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
