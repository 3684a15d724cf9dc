#pragma once
// Reading and trimming SPIR-V: the resources of a kernel and the layout of its structs. Public for tests that
// compare C++ struct layouts with those of the shaders.
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

/// Removes resource variables that the entry point does not use (a library file may declare more) and
/// renumbers the bindings 0, 1, 2 ... in set 0. Declares buffers as `Aliased`: kernels read a buffer as
/// texels and write it as words, and otherwise GPU compilers move loads past stores (SPIR-V 2.18.2; GLSL has
/// no keyword for it).
std::vector<uint32_t> trim(const std::vector<uint32_t>& words);

/// Describes a module made by trim().
Module reflect(const std::vector<uint32_t>& words);

/// Members of the struct of this name in memory layout, in order; empty if there is none.
std::vector<Member> struct_members(const std::vector<uint32_t>& words, const std::string& name);

/// Distance of two array elements of the struct of this name (ArrayStride); 0 if there is no such array.
uint32_t struct_stride(const std::vector<uint32_t>& words, const std::string& name);

}  // namespace lucerna::gpu::spirv
