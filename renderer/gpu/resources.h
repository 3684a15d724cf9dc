#pragma once
// Buffers and texture arrays. Move-only; a default or moved-from object is empty.
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gpu/device.h"

namespace lucerna::gpu {

enum class Memory {
  device,  ///< fastest for kernels; mapped too where the device's memory is host-visible (lavapipe), else
           ///< through staging
  host  ///< always mapped, coherent, cached where possible: read-back, and queues shared with a host tracer
};

struct BufferDesc {
  std::string name;    ///< for messages: "out of device memory for 'film sums' (99 MiB)"
  uint64_t bytes = 0;  ///< 0 is allowed and makes a 16-byte buffer (so that it can be bound)
  Memory memory = Memory::device;
  bool texel = false;  ///< also bindable as samplerBuffer, usamplerBuffer and rgba32f imageBuffer, texels of
                       ///< four words; bytes must be a multiple of 16
};

/// A storage buffer (also transfer source and target, indirect arguments, and optionally a texel buffer).
class Buffer {
 public:
  Buffer();
  /// Throws Error, naming buffer, size and limit, if it exceeds the device's limits or memory.
  Buffer(Device& device, const BufferDesc& desc);
  ~Buffer();
  Buffer(Buffer&&) noexcept;
  Buffer& operator=(Buffer&&) noexcept;

  explicit operator bool() const { return impl_ != nullptr; }
  uint64_t bytes() const;
  const std::string& name() const;
  /// Pointer to the whole buffer, or null if not mapped. Kernels must not be running.
  void* mapped() const;
  /// Blocking copies, through staging if not mapped. offset + size <= bytes().
  void write(const void* data, uint64_t size, uint64_t offset = 0);
  void read(void* data, uint64_t size, uint64_t offset = 0) const;

  template <class T>
  void write(std::span<const T> values, uint64_t first = 0) {
    write(values.data(), values.size_bytes(), first * sizeof(T));
  }
  template <class T>
  std::vector<T> read_all() const {
    std::vector<T> values(bytes() / sizeof(T));
    read(values.data(), values.size() * sizeof(T));
    return values;
  }

  struct Impl;
  Impl* impl() const { return impl_.get(); }

 private:
  std::unique_ptr<Impl> impl_;
};

/// Replaces a buffer that is smaller than desc.bytes, rounded up to texels; the content is lost.
void make_room(Device& device, Buffer& buffer, BufferDesc desc);

/// Likewise, for a buffer in device memory that is also read as texels.
void make_texel_room(Device& device, Buffer& buffer, const char* name, uint64_t bytes);

enum class TexelFormat { rgba8_unorm, rgba8_srgb, rgba16f, rgba32f };

struct TextureArrayDesc {
  std::string name;
  uint32_t width = 1, height = 1, layers = 1;
  TexelFormat format = TexelFormat::rgba8_unorm;
};

/// A sampler2DArray in the shader: bilinear, one mip level, address mode repeat in both directions. Shaders
/// do other modes and nearest filtering on the coordinates.
class TextureArray {
 public:
  TextureArray();
  TextureArray(Device& device, const TextureArrayDesc& desc);
  ~TextureArray();
  TextureArray(TextureArray&&) noexcept;
  TextureArray& operator=(TextureArray&&) noexcept;
  explicit operator bool() const { return impl_ != nullptr; }
  const TextureArrayDesc& desc() const;
  /// Blocking upload of one layer, tightly packed rows, top row first, in the array's format
  /// (4 bytes, 4 half floats or 4 floats a texel).
  void write_layer(uint32_t layer, const void* texels);

  struct Impl;
  Impl* impl() const { return impl_.get(); }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::gpu
