#include <cmath>
#include <cstring>

#include "scene/io/document.h"

namespace lucerna::scene::io {
namespace {

struct View {
  const unsigned char* data;
  size_t stride;
};

size_t component_size(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return 4;
    default: return 0;
  }
}

int components_of(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR: return 1;
    case TINYGLTF_TYPE_VEC2: return 2;
    case TINYGLTF_TYPE_VEC3: return 3;
    case TINYGLTF_TYPE_VEC4: return 4;
    case TINYGLTF_TYPE_MAT4: return 16;
    default: return 0;
  }
}

/// `count` elements of `size` bytes from a buffer view, every byte checked to exist.
View view_of(const Document& d, int buffer_view, size_t offset, size_t count, size_t size, const std::string& element) {
  if (buffer_view < 0 || size_t(buffer_view) >= d.model.bufferViews.size())
    d.fail(element, fmt::format("buffer view {} does not exist", buffer_view));
  const tinygltf::BufferView& v = d.model.bufferViews[buffer_view];
  if (v.buffer < 0 || size_t(v.buffer) >= d.model.buffers.size()) d.fail(element, fmt::format("buffer {} does not exist", v.buffer));
  const std::vector<unsigned char>& bytes = d.model.buffers[v.buffer].data;
  if (v.byteOffset > bytes.size() || v.byteLength > bytes.size() - v.byteOffset)
    d.fail(element, fmt::format("buffer view {} ends at byte {} of a buffer of {}", buffer_view, v.byteOffset + v.byteLength, bytes.size()));
  const size_t stride = v.byteStride ? v.byteStride : size;
  if (stride < size || stride > (1u << 20)) d.fail(element, fmt::format("stride {} is smaller than an element of {} bytes", stride, size));
  if (count && (offset > v.byteLength || size > v.byteLength - offset || (count - 1) > (v.byteLength - offset - size) / stride))
    d.fail(element, fmt::format("{} elements reach beyond their buffer view of {} bytes", count, v.byteLength));
  return {bytes.data() + v.byteOffset + offset, stride};
}

float component(const unsigned char* p, int type, bool normalized) {
  const auto get = [&](auto example) {
    decltype(example) x;
    std::memcpy(&x, p, sizeof x);
    return x;
  };
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: { const float x = get(int8_t{}); return normalized ? std::max(x / 127.f, -1.f) : x; }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: { const float x = get(uint8_t{}); return normalized ? x / 255.f : x; }
    case TINYGLTF_COMPONENT_TYPE_SHORT: { const float x = get(int16_t{}); return normalized ? std::max(x / 32767.f, -1.f) : x; }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: { const float x = get(uint16_t{}); return normalized ? x / 65535.f : x; }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return float(get(uint32_t{}));
    default: return get(float{});
  }
}

uint32_t index_at(const unsigned char* p, int type) {
  uint8_t a;
  uint16_t b;
  uint32_t c;
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return std::memcpy(&a, p, 1), a;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return std::memcpy(&b, p, 2), b;
    default: return std::memcpy(&c, p, 4), c;
  }
}

const tinygltf::Accessor& accessor_at(const Document& d, int index, const std::string& element) {
  if (index < 0 || size_t(index) >= d.model.accessors.size()) d.fail(element, fmt::format("accessor {} does not exist", index));
  return d.model.accessors[index];
}

constexpr size_t k_most_elements = size_t(1) << 30;

}  // namespace

int component_count(const Document& d, int accessor, const std::string& element) {
  return components_of(accessor_at(d, accessor, element).type);
}

std::vector<float> read_floats(const Document& d, int index, int components, const std::string& element) {
  const tinygltf::Accessor& a = accessor_at(d, index, element);
  const size_t size = component_size(a.componentType);
  if (!size || components_of(a.type) != components)
    d.fail(element, fmt::format("accessor {} has the wrong type; expected {} components", index, components));
  if (a.count > k_most_elements) d.fail(element, fmt::format("accessor {} has {} elements, more than can be", index, a.count));
  // A count is believed only when bytes stand behind it, so that no absurd one makes us allocate.
  std::vector<float> out;
  if (a.bufferView >= 0) {
    const View v = view_of(d, a.bufferView, a.byteOffset, a.count, size * components, element);
    out.resize(a.count * components);
    for (size_t i = 0; i < a.count; ++i)
      for (int c = 0; c < components; ++c)
        out[i * components + c] = component(v.data + i * v.stride + c * size, a.componentType, a.normalized);
  } else {
    if (a.count > (1u << 26)) d.fail(element, fmt::format("accessor {} has {} elements without data", index, a.count));
    out.assign(a.count * components, 0.f);
  }
  if (a.sparse.isSparse) {
    const size_t n = a.sparse.count < 0 ? 0 : size_t(a.sparse.count);
    const size_t index_size = component_size(a.sparse.indices.componentType);
    if (!index_size || n > a.count || a.sparse.indices.byteOffset < 0 || a.sparse.values.byteOffset < 0)
      d.fail(element, fmt::format("accessor {} has a wrong sparse part", index));
    const View where = view_of(d, a.sparse.indices.bufferView, size_t(a.sparse.indices.byteOffset), n, index_size, element);
    const View what = view_of(d, a.sparse.values.bufferView, size_t(a.sparse.values.byteOffset), n, size * components, element);
    for (size_t i = 0; i < n; ++i) {
      const uint32_t at = index_at(where.data + i * where.stride, a.sparse.indices.componentType);
      if (at >= a.count) d.fail(element, fmt::format("accessor {}: sparse index {} of {} elements", index, at, a.count));
      for (int c = 0; c < components; ++c)
        out[size_t(at) * components + c] = component(what.data + i * what.stride + c * size, a.componentType, a.normalized);
    }
  }
  return out;
}

std::vector<uint32_t> read_indices(const Document& d, int index, const std::string& element) {
  const tinygltf::Accessor& a = accessor_at(d, index, element);
  const size_t size = component_size(a.componentType);
  const bool whole = a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                     a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT || a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (!whole || a.type != TINYGLTF_TYPE_SCALAR)
    d.fail(element, fmt::format("accessor {} has the wrong type; expected unsigned whole numbers", index));
  if (a.bufferView < 0 || a.sparse.isSparse) {
    // Rare but legal: through the float reader, exact below 2^24.
    std::vector<uint32_t> out;
    for (float f : read_floats(d, index, 1, element)) out.push_back(uint32_t(f));
    return out;
  }
  const View v = view_of(d, a.bufferView, a.byteOffset, a.count, size, element);
  std::vector<uint32_t> out(a.count);
  for (size_t i = 0; i < a.count; ++i) out[i] = index_at(v.data + i * v.stride, a.componentType);
  return out;
}

}  // namespace lucerna::scene::io
