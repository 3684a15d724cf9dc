#pragma once
// Compute kernels: GLSL files compiled in process by glslang, with includes, defines and a disk cache.
// Resources are bound BY NAME: a kernel declares what it uses; the host has one table name -> resource for a
// whole frame.
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "gpu/resources.h"

namespace lucerna::gpu {

/// #define NAME VALUE in front of the source. A name that begins with k_include_define is no macro: its value
/// is the text that #include of the rest of the name finds instead of a file.
using Defines = std::map<std::string, std::string>;
inline constexpr const char* k_include_define = "include:";
struct SpecConstant {
  uint32_t id;
  uint32_t value;
};

/// Finds, compiles and caches shaders. `root` is the shaders/ folder. A file is named relative to it, with or
/// without "shaders/" in front, or by an absolute path (for kernels of tests). #include "shaders/x" is x
/// below the root; #include "x" is x beside the including file, else below the root.
/// Kernels are compiled as GLSL 460 for Vulkan 1.2 (SPIR-V 1.5). In front of the source are: its defines;
/// `layout(scalar)` as the default of buffers and push constants, so that structs have the C++ layout; the
/// extensions for includes, control-flow hints, 8- and 16-bit storage, 64-bit integers and their atomics,
/// float atomics, basic subgroup operations and debugPrintfEXT. A #version in the source is ignored.
/// Errors read "shaders/lib/bsdf.glsl:123: 'foo' : undeclared identifier". A macro that an #if tests before
/// it is defined is an error too (where its value matters); macros that the host may set get their default 0
/// in shaders/lib/variants.glsl.
/// Disk cache: $XDG_CACHE_HOME/lucerna/spirv (or ~/.cache), keyed by the text of all files that the kernel
/// may include, defines and compiler version. Safe with concurrent processes and damaged files. Thread-safe.
class ShaderCompiler {
 public:
  explicit ShaderCompiler(std::filesystem::path root = default_root());
  ~ShaderCompiler();
  /// $LUCERNA_SHADERS, else share/lucerna/shaders of the executable's install prefix, else the source tree's.
  static std::filesystem::path default_root();
  const std::filesystem::path& root() const;
  void set_cache(bool enabled);
  /// Compiles a file to SPIR-V. Throws Error located at file and line. Unused resources are removed, and
  /// bindings are renumbered.
  std::vector<uint32_t> compile(const std::string& file, const Defines& defines = {});
  /// Throws the errors of compile() for undefined macros, in a small part of its time.
  void check_macros(const std::string& file, const Defines& defines = {}) const;
  /// Files that the last compile() with these arguments read, successful or not (for hot reload): the kernel
  /// and all files in #include lines, also in inactive branches.
  std::vector<std::filesystem::path> dependencies(const std::string& file, const Defines& defines = {});
  double seconds_spent() const;  ///< in glslang, so far
  uint64_t cache_hits() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Table name -> resource. Resources must outlive every use. Setting a name again replaces it.
class Resources {
 public:
  /// Binds the storage buffer block, samplerBuffer, usamplerBuffer or imageBuffer of that name.
  void set(const std::string& name, const Buffer& buffer);
  /// Binds the sampler2DArray of that name.
  void set(const std::string& name, const TextureArray& array);
  void remove(const std::string& name);
  uint64_t version() const { return version_; }  ///< grows with every change
  using Entry = std::variant<const Buffer*, const TextureArray*>;
  const Entry* find(const std::string& name) const;

 private:
  std::map<std::string, Entry> entries_;
  uint64_t version_ = 0;
};

/// One compute pipeline. In the shader, `buffer NAME {...}` is bound to the resource NAME (the block's name,
/// not the instance's); so are `uniform samplerBuffer NAME`, `uniform usamplerBuffer NAME`, `layout(rgba32f)
/// uniform imageBuffer NAME` and `uniform sampler2DArray NAME`. Set and binding numbers are ignored. A
/// library file may declare more than a kernel uses: only what main() reaches is needed. `constants` set
/// `layout(constant_id = N) const` values (and local_size_x_id).
class Kernel {
 public:
  Kernel();
  /// Throws Error: does not compile (located), needs more push constants than the device has, or declares
  /// something that cannot be bound by name (a uniform block, an image).
  Kernel(Device& device, ShaderCompiler& compiler, const std::string& file, const Defines& defines = {},
         std::vector<SpecConstant> constants = {});
  ~Kernel();
  Kernel(Kernel&&) noexcept;
  Kernel& operator=(Kernel&&) noexcept;
  explicit operator bool() const { return impl_ != nullptr; }
  const std::string& file() const;
  uint32_t workgroup_size() const;  ///< local_size_x
  uint32_t push_constant_bytes() const;
  std::vector<std::string> resource_names() const;

  struct Impl;
  Impl* impl() const { return impl_.get(); }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::gpu
