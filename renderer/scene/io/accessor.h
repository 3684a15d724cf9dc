#pragma once
// Elements of glTF accessors: any component type, interleaved, normalized, sparse.
#include <cstdint>
#include <string>
#include <vector>

#include "scene/io/document.h"

namespace lucerna::scene {

/// Bytes of a glTF component type (5120 byte .. 5126 float); 0 when there is no such type.
int bytes_of_component(int component_type);
/// Components of "SCALAR", "VEC2" .. "MAT4"; 0 when there is no such type. Matrices of 1- and 2-byte
/// components have padded columns and are never read here.
int components_of_type(const std::string& type);

/// Reads one accessor of a checked document, and refers to its data.
class AccessorReader {
 public:
  AccessorReader(Document& document, uint32_t accessor);

  size_t count() const { return count_; }
  int components() const { return components_; }
  int component_type() const { return component_type_; }
  bool normalized() const { return normalized_; }
  /// True if every element has bytes in a buffer; otherwise all are 0 except sparse ones.
  bool backed() const { return backed_; }
  /// Treats integers as normalized whatever the accessor says (colours, which glTF always normalizes).
  void force_normalized() { normalized_ = true; }

  /// Writes the first `n` components (n <= components()) of an element as floats; normalized integers as
  /// glTF 2.0, 3.11, says: c / max, signed ones max(c / max, -1).
  void read(size_t element, float* out, int n) const;
  /// The element of an unsigned integer scalar accessor.
  uint32_t read_index(size_t element) const;

 private:
  const uint8_t* base_ = nullptr;
  size_t stride_ = 0, count_ = 0;
  int components_ = 0, component_type_ = 0;
  bool normalized_ = false, backed_ = false;
};

}  // namespace lucerna::scene
