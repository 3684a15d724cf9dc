#pragma once
// Learned light selection on the device: the kernels' probabilities (shaders/shared/learned_lights.h), and
// the recorded light samples from which they are learned.
#include <vector>

#include "gpu/kernel.h"
#include "transport/learned_lights.h"

namespace lucerna::transport {

/// Minimum of measured_gain() with which further generations pay.
inline constexpr double k_least_gain = 1.3;

class LightLearning {
 public:
  /// At first, selection is as without learning. `most_paths`: maximum number of paths recorded at once.
  LightLearning(gpu::Device& device, upload::LightClusters clusters, uint32_t most_paths);

  /// Binds the buffers of kernels compiled with upload::learned_defines().
  void bind(gpu::Resources& resources) const;
  /// Sets the fields of the frame.
  void describe(shared::Frame& frame) const;
  /// Changes with the bound buffers.
  uint32_t version() const { return version_; }

  /// A generation records light samples, by slot, of the paths traced between begin_recording() and
  /// end_recording(), repeatedly. Its paths use the probabilities learned before, those of the first
  /// generation exploring_lights(); finish_generation() learns from all samples so far. The division of a
  /// generation does not matter.
  /// `pilot`: frame of the recorded paths, before describe().
  void begin_generation(const shared::Frame& pilot);
  void begin_recording();
  void end_recording(uint32_t paths);
  void finish_generation();
  /// Discards the generation, if not all of its paths were traced.
  void abandon_generation();
  /// Frees the records; no generation may follow.
  void end();
  /// Begins again without forgetting: generations that would record the same light samples are replayed.
  void rewind();
  /// Learns the next generation of paths with that frame from memory, bit for bit as if it were recorded
  /// again. False if there is none, or if another pilot learned it, which is then forgotten.
  bool replay(const shared::Frame& pilot);
  /// False once a generation has shown that light samples gain little by learning (k_least_gain): further
  /// generations would take more time than they save. What is learned stays.
  bool pays() const { return pays_; }
  /// Likewise, with samples recorded elsewhere, as a generation.
  void learn(std::vector<shared::LightRecord> records);
  uint32_t generations() const { return generations_; }
  /// Number of them that were replayed.
  uint32_t replayed() const { return replayed_; }
  uint32_t most_paths() const { return most_paths_; }
  /// Restarts with these lights.
  void forget(upload::LightClusters clusters);

  /// Without data that only the device reads.
  const upload::LightClusters& clusters() const { return clusters_; }
  uint32_t rows() const { return row_count_; }
  size_t records() const { return record_count_; }
  /// measured_gain() of the last generation; 1 before the second one, whose samples are the first to show it.
  double gain() const { return gain_; }
  /// Share of the last generation's recorded light samples that contributed light.
  double arrived() const { return arrived_; }
  /// Probabilities of the clusters in a row of learned_rows.
  std::vector<float> row(uint32_t row) const;
  /// LearnedLights::arrived.
  const std::vector<float>& row_arrived() const { return row_arrived_; }
  /// Memory on the device and the host.
  uint64_t bytes() const;

 private:
  /// What a generation has learned.
  struct Generation {
    LearnedLights lights;
    size_t records = 0;  ///< so far
    bool pays = true;
    double gain = 1, arrived = 0;
  };
  void forget();  // with the present lights
  void take(LearnedLights lights);
  void take(const Generation& generation);
  uint64_t kept_bytes() const;
  void upload_clusters();

  gpu::Device& device_;
  upload::LightClusters clusters_;
  uint32_t most_paths_;
  gpu::Buffer grid_, rows_, cluster_texels_, members_, primitives_, shapes_, tiles_, facets_, records_;
  LearnedLights lights_;                              ///< present selection, until the end
  std::vector<Generation> learned_;                   ///< by generation, to be replayed; none if too large
  std::vector<std::byte> pilot_;                      ///< frame of the paths that learned_ is from
  std::vector<shared::LightRecord> samples_, fresh_;  ///< of earlier generations, and of the current one
  std::vector<float> row_arrived_;
  size_t record_count_ = 0;
  bool recording_ = false, pays_ = true;
  uint32_t generations_ = 0, replayed_ = 0, row_count_ = 0, version_ = 0;
  double gain_ = 1, arrived_ = 0;
};

}  // namespace lucerna::transport
