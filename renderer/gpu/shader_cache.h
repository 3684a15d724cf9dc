#pragma once
// SPIR-V cache on disk (internal to gpu/).
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/hash.h"

namespace lucerna::gpu {

/// A folder of files named by key. Files are written under a temporary name and renamed, so that other
/// processes see a complete file or none; truncated or changed files count as absent. Failures are silent:
/// the cache only saves time.
class ShaderCache {
 public:
  explicit ShaderCache(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// $XDG_CACHE_HOME/lucerna/spirv, else ~/.cache/lucerna/spirv; empty (no cache) if neither is known.
  static std::filesystem::path default_folder();
  std::optional<std::vector<uint32_t>> load(const std::string& key) const;
  void store(const std::string& key, const std::vector<uint32_t>& words) const;

 private:
  void drop_oldest() const;
  std::filesystem::path folder_;
};

}  // namespace lucerna::gpu
