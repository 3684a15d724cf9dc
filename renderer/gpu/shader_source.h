#pragma once
// Finding a shader's files (internal to gpu/).
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace lucerna::gpu {

/// One file of a shader. `display` is its name in messages: "shaders/lib/bsdf.glsl" for files below the root.
struct ShaderFile {
  std::filesystem::path path;
  std::string display, text;
};

class ShaderSource {
 public:
  explicit ShaderSource(std::filesystem::path root) : root_(std::move(root)) {}
  /// A copy in which #include of these names finds these texts; they have no path.
  ShaderSource with(std::map<std::string, std::string> texts) const {
    ShaderSource other(root_);
    other.texts_ = std::move(texts);
    return other;
  }
  const std::filesystem::path& root() const { return root_; }
  /// A kernel's file: relative to the root ("shaders/x" is x), or absolute.
  std::optional<ShaderFile> open(const std::string& file) const;
  /// File for #include "name" in the file with the display name `includer`.
  std::optional<ShaderFile> include(const std::string& name, const std::string& includer) const;
  /// The file and all files that its #include lines name, directly or not, each once, in order of first
  /// mention. #if is ignored, so this may be more than the compiler reads; files that are not found are
  /// skipped (they may be in a C++ branch).
  std::vector<ShaderFile> closure(const ShaderFile& file) const;

 private:
  std::optional<ShaderFile> read(const std::filesystem::path& path) const;
  std::filesystem::path path_of(const std::string& display) const;
  std::filesystem::path root_;
  std::map<std::string, std::string> texts_;  ///< by the name in #include
};

}  // namespace lucerna::gpu
