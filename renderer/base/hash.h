#pragma once
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace lucerna {

/// A 128-bit hash that distinguishes contents (sources, files, scenes). Not cryptographic: FNV-1a twice, with
/// two seeds.
class Hash {
 public:
  /// Adds the text and its length, so that ("ab", "c") and ("a", "bc") differ.
  void add(const std::string& text);
  void add_bytes(const void* data, size_t bytes);
  /// Adds the bytes of a value. The type has no padding, and equal values have equal bytes.
  template <class T>
  void add_value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    add_bytes(&value, sizeof value);
  }
  /// Adds length and elements.
  template <class T>
  void add_values(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add_value(uint64_t{values.size()});
    add_bytes(values.data(), values.size() * sizeof(T));
  }
  std::string hex() const;             ///< 32 digits
  uint64_t low() const { return a_; }  ///< plain FNV-1a, 64 bits

 private:
  uint64_t a_ = 0xcbf29ce484222325ull, b_ = 0x9ae16a3b2f90404full;
};

}  // namespace lucerna
