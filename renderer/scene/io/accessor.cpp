#include "scene/io/accessor.h"

#include <algorithm>
#include <cstring>

namespace lucerna::scene {
namespace {

// An element of zeros, as large as one can be.
const uint8_t k_zero[16 * sizeof(float)] = {};

template <class T>
T load(const uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);  // accessors of damaged files are not aligned
  return value;
}

template <class T>
void read_integers(const uint8_t* at, float* out, int n, bool normalized) {
  const float scale = normalized ? 1.0f / static_cast<float>(std::numeric_limits<T>::max()) : 1.0f;
  for (int i = 0; i < n; ++i) {
    const float value = static_cast<float>(load<T>(at + sizeof(T) * static_cast<size_t>(i))) * scale;
    out[i] = normalized ? std::max(value, -1.0f) : value;
  }
}

uint32_t unsigned_at(const uint8_t* at, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *at;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<uint16_t>(at);
    default:
      return load<uint32_t>(at);
  }
}

}  // namespace

int bytes_of_component(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

int components_of_type(const std::string& type) {
  static const std::pair<const char*, int> k_types[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                        {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
  for (const auto& [name, count] : k_types)
    if (type == name) return count;
  return 0;
}

AccessorReader::AccessorReader(Document& document, uint32_t index) {
  const tinygltf::Model& model = document.model;
  const tinygltf::Accessor& accessor = model.accessors[index];
  count_ = accessor.count;
  components_ = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
  component_type_ = accessor.componentType;
  normalized_ = accessor.normalized;
  const size_t element =
      static_cast<size_t>(components_) * static_cast<size_t>(bytes_of_component(component_type_));
  stride_ = element;
  const auto bytes = [&model](int view, size_t offset) {
    const tinygltf::BufferView& v = model.bufferViews[static_cast<size_t>(view)];
    return model.buffers[static_cast<size_t>(v.buffer)].data.data() + v.byteOffset + offset;
  };
  backed_ = accessor.bufferView >= 0;
  if (backed_) {
    base_ = bytes(accessor.bufferView, accessor.byteOffset);
    const size_t stride = model.bufferViews[static_cast<size_t>(accessor.bufferView)].byteStride;
    if (stride != 0) stride_ = stride;
  }
  if (!base_) base_ = k_zero, stride_ = 0;
  if (!accessor.sparse.isSparse) return;

  // Made once, however many primitives share it.
  const auto [place, fresh] = document.sparse.try_emplace(index);
  std::vector<uint8_t>& own = place->second;
  const uint8_t* const from = base_;
  const size_t step = stride_;
  const auto use_own = [&] { base_ = own.data(), stride_ = element; };
  if (!fresh) {
    use_own();
    return;
  }
  document.budget.take(count_ * element, fmt::format("{}: accessors[{}]", document.file, index),
                       "{} elements of a sparse accessor", count_);
  own.resize(count_ * element);
  for (size_t i = 0; i < count_; ++i) std::memcpy(own.data() + i * element, from + i * step, element);
  use_own();
  const auto& sparse = accessor.sparse;
  const uint8_t* indices = bytes(sparse.indices.bufferView, static_cast<size_t>(sparse.indices.byteOffset));
  const uint8_t* values = bytes(sparse.values.bufferView, static_cast<size_t>(sparse.values.byteOffset));
  const auto index_bytes = static_cast<size_t>(bytes_of_component(sparse.indices.componentType));
  for (size_t i = 0; i < static_cast<size_t>(sparse.count); ++i) {
    const uint32_t target = unsigned_at(indices + i * index_bytes, sparse.indices.componentType);
    if (target >= count_)
      throw_error(fmt::format("{}: accessors[{}].sparse.indices", document.file, index),
                  "entry {} is {}, but the accessor has {} elements", i, target, count_);
    std::memcpy(own.data() + target * element, values + i * element, element);
  }
}

void AccessorReader::read(size_t element, float* out, int n) const {
  const uint8_t* at = base_ + element * stride_;
  switch (component_type_) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      std::memcpy(out, at, sizeof(float) * static_cast<size_t>(n));
      break;
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      read_integers<int8_t>(at, out, n, normalized_);
      break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      read_integers<uint8_t>(at, out, n, normalized_);
      break;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      read_integers<int16_t>(at, out, n, normalized_);
      break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      read_integers<uint16_t>(at, out, n, normalized_);
      break;
    default:
      read_integers<uint32_t>(at, out, n, normalized_);
      break;
  }
}

uint32_t AccessorReader::read_index(size_t element) const {
  return unsigned_at(base_ + element * stride_, component_type_);
}

}  // namespace lucerna::scene
