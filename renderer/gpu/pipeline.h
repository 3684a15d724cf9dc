#pragma once
// Compute pipelines, shared by kernels of the same content (internal to gpu/).
#include <volk.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace lucerna::gpu {

struct Handles;

/// A pipeline with the layouts that it was made with. Destroyed with the last that holds it.
struct Pipeline {
  explicit Pipeline(const Handles& handles) : handles(handles) {}
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  const Handles& handles;
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;
};

/// A device's pipelines by what they are built from. Solvers and renderers that are built again find the
/// kernels of the last ones: drivers take from milliseconds to seconds for each, lavapipe at its first
/// dispatch. Those in use are kept, and of those that no kernel uses any more the last k_spare.
/// Thread-safe.
class Pipelines {
 public:
  using Make = std::function<std::shared_ptr<const Pipeline>()>;
  /// `key` tells everything that `make` depends on. What `make` throws is passed on.
  std::shared_ptr<const Pipeline> find_or_make(const std::string& key, const Make& make);
  void clear();
  uint64_t made() const;  ///< so far

  static constexpr size_t k_spare = 128;

 private:
  void drop_spare();

  struct Entry {
    std::string key;
    std::shared_ptr<const Pipeline> pipeline;
  };
  mutable std::mutex mutex_;
  std::vector<Entry> entries_;  ///< the one asked for last at the end
  uint64_t made_ = 0;
};

}  // namespace lucerna::gpu
