#pragma once
// Irradiance known beforehand where lookups of tertiary light take place, so that one is to find the piece of
// surface on which it lies (shaders/photons/irradiance.glsl) instead of adding up all photons around.
#include <memory>

#include "solvers/photons/irradiance_cells.h"
#include "solvers/photons/photon_map.h"

namespace lucerna::photons {

class IrradianceMap {
 public:
  /// `groups`: of lights that are kept apart in sums of their own; 0: none are. Throws Error: no memory.
  IrradianceMap(gpu::Device& device, uint32_t groups);

  /// What it is to be.
  struct Wanted {
    uint32_t nearest = 0;  ///< IrradianceCellsBuilder's
    float widest = 0;
    uint64_t states = 0;   ///< bits: of the eye path, in which tertiary light is looked up, and nothing else
    bool gathers = false;  ///< IrradianceFrame::gathers
    uint32_t max_depth = 64;  ///< scattering events of a path from the eye to a light, at most
  };
  /// One piece of making it of a complete map that tells of its surfaces; until complete(). Lookups find what
  /// there was before until then; with the last piece they are bound anew. Throws Error when memory is short.
  void make(transport::Wavefront& wavefront, const PhotonMap& map, const upload::FlatScene& flat,
            const Wanted& wanted);
  /// It is to be made anew; until then lookups find what there was.
  void restart() { complete_ = false, builder_.reset(); }
  /// ... and until then nothing.
  void clear();
  /// Surfaces are others.
  void invalidate() { clear(), order_.reset(); }
  bool complete() const { return complete_; }
  /// Lookups find something, or at least that nothing is known.
  bool readable() const { return readable_; }
  void bind(gpu::Resources& resources) const;
  uint32_t pieces() const { return pieces_; }
  uint64_t bytes() const;

 private:
  void upload(const IrradianceCells& cells, const Wanted& wanted);

  gpu::Device& device_;
  uint32_t groups_;
  std::unique_ptr<SideOrder> order_;
  std::vector<bool> diffuse_;  ///< materials, by which it was made
  std::unique_ptr<IrradianceCellsBuilder> builder_;
  uint32_t maps_ = 0;  ///< that it has so far
  gpu::Buffer roots_, nodes_, block_;
  uint32_t pieces_ = 0;
  bool complete_ = false, readable_ = false;
};

}  // namespace lucerna::photons
