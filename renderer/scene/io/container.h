#pragma once
// The bytes of a .gltf or .glb file.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lucerna::scene {

/// A file taken apart; offsets into its bytes.
struct Container {
  std::vector<uint8_t> bytes;
  size_t json_begin = 0, json_end = 0;  ///< without padding zeros
  size_t bin_begin = 0, bin_end = 0;    ///< content of the binary chunk
  size_t end = 0;                       ///< of the last chunk
  bool binary = false;                  ///< a .glb
  bool has_bin = false;

  std::string_view text(size_t begin, size_t until) const {
    return {reinterpret_cast<const char*>(bytes.data()) + begin, until - begin};
  }
  std::string_view json() const { return text(json_begin, json_end); }
  std::string_view bin() const { return text(bin_begin, bin_end); }
  /// All chunks of a .glb behind its JSON, with their headers.
  std::string_view chunks() const { return text(chunks_begin, end); }
  size_t chunks_begin = 0;
};

/// Throws Error at `file` for an empty file or a damaged .glb.
Container take_apart(std::vector<uint8_t> bytes, const std::string& file);

/// A .glb of a JSON text and further chunks.
std::string glb_bytes(std::string_view json, std::string_view chunks);
/// A binary chunk with its header, padded; "" for none.
std::string chunk_bytes(const std::vector<uint8_t>& bytes);

}  // namespace lucerna::scene
