#pragma once
// Precomputed irradiance for lookups of tertiary light: a lookup finds the surface cell that contains it
// (shaders/photons/irradiance.glsl) instead of summing nearby photons.
#include <memory>

#include "solvers/photons/irradiance_cells.h"
#include "solvers/photons/photon_map.h"

namespace lucerna::photons {

class IrradianceMap {
 public:
  /// `groups`: number of separate light groups; 0: none. Throws Error: memory.
  IrradianceMap(gpu::Device& device, uint32_t groups);

  /// Parameters of a map.
  struct Wanted {
    uint32_t nearest = 0;  ///< of IrradianceCellsBuilder
    float widest = 0;
    uint64_t states = 0;      ///< bits: states of the eye path in which only tertiary light is looked up
    bool gathers = false;     ///< IrradianceFrame::gathers
    uint32_t max_depth = 64;  ///< maximum scattering events of a path from eye to light
  };
  /// Runs one work item of building from a complete photon map that stores surfaces, until complete().
  /// Lookups use the old data until then; the last item rebinds them. Throws Error: memory.
  void make(transport::Wavefront& wavefront, const PhotonMap& map, const upload::FlatScene& flat,
            const Wanted& wanted);
  /// Starts over; lookups use the old data meanwhile.
  void restart() { complete_ = false, builder_.reset(); }
  /// Starts over; lookups find no data meanwhile.
  void clear();
  /// Call when surfaces have changed.
  void invalidate() { clear(), order_.reset(); }
  bool complete() const { return complete_; }
  /// True if lookups can read it, even if cells have no data.
  bool readable() const { return readable_; }
  void bind(gpu::Resources& resources) const;
  uint32_t pieces() const { return pieces_; }
  uint64_t bytes() const;

 private:
  void upload(const IrradianceCells& cells, const Wanted& wanted);

  gpu::Device& device_;
  uint32_t groups_;
  std::unique_ptr<SideOrder> order_;
  std::vector<bool> diffuse_;  ///< materials that it was built with
  std::unique_ptr<IrradianceCellsBuilder> builder_;
  uint32_t maps_ = 0;  ///< number of complete maps
  gpu::Buffer roots_, nodes_, block_;
  uint32_t pieces_ = 0;
  bool complete_ = false, readable_ = false;
};

}  // namespace lucerna::photons
