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

/// A pipeline with its layouts. Destroyed with its last owner.
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

/// A device's pipelines by content. Solvers and renderers that are rebuilt find the kernels of the previous
/// ones, since drivers need milliseconds to seconds per pipeline (lavapipe at its first dispatch). Pipelines
/// in use are kept, and of the unused ones the last k_spare. Thread-safe.
class Pipelines {
 public:
  using Make = std::function<std::shared_ptr<const Pipeline>()>;
  /// `key` contains everything that `make` depends on. Exceptions of `make` are passed on.
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
  std::vector<Entry> entries_;  ///< most recently used last
  uint64_t made_ = 0;
};

}  // namespace lucerna::gpu
