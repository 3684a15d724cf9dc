#pragma once
// Reading and trimming SPIR-V: which resources a kernel uses and how its structs are laid out. Public for the
// tests that hold C++ struct layouts against the shaders'.
#include <cstdint>
#include <string>
#include <vector>

namespace lucerna::gpu::spirv {

enum class ResourceKind {
  storage_buffer,
  uniform_buffer,
  texel_buffer,        ///< samplerBuffer
  texel_buffer_words,  ///< usamplerBuffer
  texel_image,
  sampled_image,
  unsupported
};

struct Resource {
  std::string name;  ///< block name, or the variable's for samplers
  ResourceKind kind = ResourceKind::unsupported;
  uint32_t binding = 0;
};

struct Member {
  std::string name;
  uint32_t offset = 0;
};

struct Module {
  std::vector<Resource> resources;               ///< that the entry point uses, by binding number
  uint32_t push_constant_bytes = 0;              ///< 0: none
  uint32_t workgroup[3] = {1, 1, 1};             ///< with default specialization
  int32_t workgroup_constant[3] = {-1, -1, -1};  ///< specialization constant that sets each, or -1
};

/// Removes the resource variables that the entry point never reaches (a library file may declare more than a
/// kernel uses) and numbers the bindings of the others 0, 1, 2 ... in set 0, whatever the source says.
/// Buffers are declared as possibly one another (`Aliased`): kernels read a buffer as texels that they write
/// as words, and without it compilers of GPUs move loads beyond stores (SPIR-V 2.18.2; GLSL has no word for
/// it).
std::vector<uint32_t> trim(const std::vector<uint32_t>& words);

/// Describes a module that trim() has made.
Module reflect(const std::vector<uint32_t>& words);

/// Members of the struct of this name as laid out in memory, in order; empty when no laid-out struct has the
/// name.
std::vector<Member> struct_members(const std::vector<uint32_t>& words, const std::string& name);

/// The distance between two array elements of the struct of this name (ArrayStride), or 0 when there is no
/// such array.
uint32_t struct_stride(const std::vector<uint32_t>& words, const std::string& name);

}  // namespace lucerna::gpu::spirv
