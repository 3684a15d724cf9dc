#pragma once
// Photons of one round: traced in batches, sorted, and found by cells (shaders/shared/photons/photons.h).
//
// Bit-identical for any thread timing and any number of paths in flight: photons are stored in order of
// arrival, and sorting them by cell also sorts those of one cell by path number.
#include <algorithm>
#include <array>
#include <functional>

#include "shaders/shared/photons/photons.h"
#include "solvers/photons/photon_cells.h"
#include "transport/light_emitter.h"

namespace lucerna::photons {

/// Parameters of a round; `parts`: parts of the light to store.
struct Round : transport::LightRound {
  shared::PhotonFrame lookup{};  ///< for lookups; count, mask and round are set automatically
};

/// Of the latest complete round.
struct RoundFigures {
  uint32_t round = 0, paths = 0, photons = 0;
  uint32_t escaped = 0;  ///< paths that left the scene
  uint32_t dark = 0;     ///< paths that started where their light does not emit
  uint32_t entries = 0;  ///< of the table
  uint32_t spared = 0;   ///< photons not stored because no lookup is near
  std::array<uint32_t, paths::k_part_count> by_part{};  ///< photons
  uint64_t rays = 0;                                    ///< rays of its paths
  uint64_t roulette = 0, depth = 0;  ///< paths ended by roulette; by the maximum number of events
  uint32_t grown = 0;                ///< batches repeated for lack of memory, so far
  uint32_t wanted = 0;  ///< requested paths; more than `paths` if a buffer could not hold their photons
  double trace_s = 0, build_s = 0;  ///< wall time of tracing and of sorting
};

class PhotonMap {
 public:
  /// `scene_defines`: of kernels that read the scene. Throws Error: a kernel does not compile (located),
  /// memory.
  PhotonMap(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& scene_defines,
            const paths::Automaton& automaton);

  /// Binds photon_texels, photon_table, PhotonBlock; valid until a round is complete.
  void bind(gpu::Resources& resources) const;
  /// Removes all photons from lookups, until the next round is complete.
  void clear();
  /// Restarts the next round.
  void restart() { tracing_ = false, fits_ = ~0u; }

  /// Traces one batch of the round, as many paths as the wavefront has slots; the last one completes the
  /// round. Afterwards the wavefront has frame `picture` with `enabled` components again. False if cancelled:
  /// it will be repeated. Throws Error: more photons than the device can hold.
  bool trace(transport::Wavefront& wavefront, const transport::LightSource& lights, const Round& round,
             const shared::Frame& picture, uint32_t enabled, const std::function<bool()>& cancel);
  /// Until the next round is complete, lookups find no photons but record their importance, starting from
  /// zero. `lookup`: its radii are used. `pixels`: of the paths' picture, each of which records its caustics
  /// lookup; 0: none. `vertices`: that many diffuse vertices behind the first are recorded too (reached()).
  void note_importance(transport::Wavefront& wavefront, const shared::PhotonFrame& lookup, uint32_t pixels,
                       uint32_t vertices);
  /// While held, lookups record nothing.
  void hold_notes(bool held);
  /// Recorded lookups of each pixel, and of the vertices behind; carried 0: none.
  std::vector<shared::PhotonLookup> lookups() const;
  std::vector<shared::PhotonLookup> reached() const;
  /// Stores photons by the latest importance: where no lookup was recorded, a fraction of them.
  void store_by_importance(bool on);
  /// ... by the importance of another map, which must outlive this one's rounds.
  void store_by_importance_of(const PhotonMap& other);
  /// For later rounds: of `unreachable_parts` (bits), stores only light that no eye path finds
  /// (k_photon_unreachable); with `skips_unreachable`, stores none of that light.
  void store_parts(uint32_t unreachable_parts, bool skips_unreachable);
  /// For later rounds: contributions() includes the radiance that eye paths would carry for caustics.
  void store_radiance(bool on);
  /// Contribution of each photon of the complete round to the picture, by the latest importance; in map
  /// order.
  std::vector<shared::PhotonContribution> contributions(transport::Wavefront& wavefront,
                                                        const transport::LightSource& lights);
  /// True if lookups read a round.
  bool complete() const { return complete_; }
  uint32_t round() const { return figures_.round; }
  /// How many of that many paths are traced, as far as known: fewer if their photons exceed a buffer.
  uint32_t fitting(uint32_t paths) const { return std::min(paths, fits_); }
  /// Paths of the current round.
  uint32_t traced() const { return tracing_ ? traced_ : 0; }
  const RoundFigures& figures() const { return figures_; }
  const shared::PhotonFrame& lookup() const { return lookup_; }
  /// For later rounds: surfaces() is available.
  void store_surface(bool on);
  /// Of the complete round, in order of arrival: the photons, their numbers (k_photon_id_events), and their
  /// surfaces.
  std::vector<shared::Photon> photons() const;
  std::vector<uint32_t> numbers() const;
  std::vector<shared::PhotonSurface> surfaces() const;
  uint64_t bytes() const;

 private:
  enum class Went { cancelled, on, too_many };
  Went trace_batch(transport::Wavefront& wavefront, const transport::LightSource& lights, const Round& round,
                   uint32_t count, const shared::Frame& picture, uint32_t enabled,
                   const std::function<bool()>& cancel);
  void bind_list(gpu::Resources& resources) const;  ///< for kernels that store photons
  uint32_t most_photons() const;
  void grow(transport::Wavefront& wavefront, uint32_t needed);
  void build(transport::Wavefront& wavefront, const Round& round);
  void write_lookup();

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Defines scene_defines_;
  transport::LightEmitter emitter_;
  gpu::Kernel trace_, contribution_kernel_;
  PhotonCells cells_;  ///< with the photons of the complete round
  gpu::Buffer counts_, list_, ids_, block_, importance_, contributions_, lookups_, radiances_, on_;
  shared::PhotonFrame lookup_{}, noted_{};  ///< noted_: radii for recording importance
  const PhotonMap* importance_of_ = this;
  RoundFigures figures_, next_;  ///< of the latest complete round; of the current one
  bool tracing_ = false, complete_ = false, notes_held_ = false;
  uint32_t traced_ = 0, stored_ = 0;  ///< paths and photons of the current round
  uint32_t fits_ = ~0u;               ///< paths whose photons fit into the device's largest buffer
  uint32_t capacity_ = 0;
  uint32_t noted_pixels_ = 0;
};

}  // namespace lucerna::photons
