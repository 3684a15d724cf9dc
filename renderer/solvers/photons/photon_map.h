#pragma once
// The photons of one round: traced in batches, stored in an order of their own, found by cells
// (shaders/shared/photons/photons.h).
//
// Bit-identical, however threads run and however many paths are in flight: photons are stored in whatever
// order they come, and the sort that puts them into their cells also puts those of one cell into the order of
// their paths' numbers.
#include <algorithm>
#include <array>
#include <functional>

#include "shaders/shared/photons/photons.h"
#include "solvers/photons/photon_cells.h"
#include "transport/light_emitter.h"

namespace lucerna::photons {

/// What a round is to be; `parts`: of light that are stored.
struct Round : transport::LightRound {
  shared::PhotonFrame lookup{};  ///< as lookups are to read it; count, mask and round are filled in
};

/// Of the last complete round.
struct RoundFigures {
  uint32_t round = 0, paths = 0, photons = 0;
  uint32_t escaped = 0;                                 ///< paths that left the scene
  uint32_t dark = 0;                                    ///< paths that began where their light has no light
  uint32_t entries = 0;                                 ///< of the table
  uint32_t spared = 0;                                  ///< photons that nobody would have looked at
  std::array<uint32_t, paths::k_part_count> by_part{};  ///< photons
  uint64_t rays = 0;                                    ///< that its paths consist of
  uint64_t roulette = 0, depth = 0;                     ///< paths ended by roulette, by the most events
  uint32_t grown = 0;   ///< batches traced again because there was no room, so far
  uint32_t wanted = 0;  ///< paths that were asked for; more than `paths` where a buffer could not hold theirs
  double trace_s = 0, build_s = 0;  ///< wall time of its tracing, and of putting it in order
};

class PhotonMap {
 public:
  /// `scene_defines`: of the kernels that know the scene. Throws Error: a kernel does not compile (located),
  /// no memory.
  PhotonMap(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& scene_defines,
            const paths::Automaton& automaton);

  /// photon_texels, photon_table, PhotonBlock: as they are until a round is complete.
  void bind(gpu::Resources& resources) const;
  /// Lookups find nothing, until the next round is complete.
  void clear();
  /// The next round is to begin anew.
  void restart() { tracing_ = false, fits_ = ~0u; }

  /// One batch of the round, as many paths as the wavefront has slots; with the last the round is complete.
  /// The wavefront's frame is then `picture`, of `enabled` components, again. False when it was cancelled: it
  /// will be done again. Throws Error: more photons than the device can hold.
  bool trace(transport::Wavefront& wavefront, const transport::LightSource& lights, const Round& round,
             const shared::Frame& picture, uint32_t enabled, const std::function<bool()>& cancel);
  /// From now on lookups find nothing, but note how much of the picture hangs on them, from nothing on; until
  /// a round is complete. `lookup`: by whose radii. `pixels`: of the paths' picture, for each of which is
  /// noted where caustics are looked up; 0: they are not. `vertices`: where the first so many vertices behind
  /// the first are that lie behind a diffuse one, too (reached()).
  void note_importance(transport::Wavefront& wavefront, const shared::PhotonFrame& lookup, uint32_t pixels,
                       uint32_t vertices);
  /// Meanwhile, while held, lookups note nothing.
  void hold_notes(bool held);
  /// What was noted of each pixel, and of the vertices behind; carried 0: nothing.
  std::vector<shared::PhotonLookup> lookups() const;
  std::vector<shared::PhotonLookup> reached() const;
  /// Whether photons are stored by the importance that was noted last: where nobody looks, one in so many.
  void store_by_importance(bool on);
  /// ... by what the other one has noted, as that one does. It outlives this one's rounds.
  void store_by_importance_of(const PhotonMap& other);
  /// Of `unreachable_parts` (bits) rounds from now on store only light that no path from the eye finds
  /// (k_photon_unreachable); with `skips_unreachable` they store none of that light.
  void store_parts(uint32_t unreachable_parts, bool skips_unreachable);
  /// Whether worths() tells of caustics what paths from the eye would bring of them, in rounds from now on.
  void store_radiance(bool on);
  /// What each photon of the complete round brings to the picture, by the importance that was noted last; in
  /// the order of the map.
  std::vector<shared::PhotonContribution> contributions(transport::Wavefront& wavefront,
                                                        const transport::LightSource& lights);
  /// The round that lookups read; false: none.
  bool complete() const { return complete_; }
  uint32_t round() const { return figures_.round; }
  /// Of so many paths those that are traced, as far as is known: fewer where their photons outgrow a buffer.
  uint32_t fitting(uint32_t paths) const { return std::min(paths, fits_); }
  /// Paths of the round under way.
  uint32_t traced() const { return tracing_ ? traced_ : 0; }
  const RoundFigures& figures() const { return figures_; }
  const shared::PhotonFrame& lookup() const { return lookup_; }
  /// Whether surfaces() tells of them, in rounds from now on.
  void store_surface(bool on);
  /// Of the complete round, in whatever order they have come, as the other two: the photons, the number of
  /// each (k_photon_id_events), and where it lies.
  std::vector<shared::Photon> photons() const;
  std::vector<uint32_t> numbers() const;
  std::vector<shared::PhotonSurface> surfaces() const;
  uint64_t bytes() const;

 private:
  enum class Went { cancelled, on, too_many };
  Went trace_batch(transport::Wavefront& wavefront, const transport::LightSource& lights, const Round& round,
                   uint32_t count, const shared::Frame& picture, uint32_t enabled,
                   const std::function<bool()>& cancel);
  void bind_list(gpu::Resources& resources) const;  ///< what stores photons
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
  shared::PhotonFrame lookup_{}, noted_{};  ///< noted_: by whose radii importance is noted
  const PhotonMap* importance_of_ = this;
  RoundFigures figures_, next_;  ///< of the last complete round, of the one under way
  bool tracing_ = false, complete_ = false, notes_held_ = false;
  uint32_t traced_ = 0, stored_ = 0;  ///< paths and photons of the round under way
  uint32_t fits_ = ~0u;               ///< paths of which photons fit into the device's largest buffer
  uint32_t capacity_ = 0;
  uint32_t noted_pixels_ = 0;
};

}  // namespace lucerna::photons
