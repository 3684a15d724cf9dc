#include "scene/io/container.h"

#include <cstring>
#include <utility>

#include "base/error.h"

namespace lucerna::scene {
namespace {

constexpr uint32_t k_magic = 0x46546c67, k_json = 0x4e4f534a, k_bin = 0x004e4942;

uint32_t read_u32(const std::vector<uint8_t>& bytes, size_t at) {
  uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

void append_u32(std::string& bytes, size_t value, const char* what) {
  if (value > 0xffffffffu) throw Error(what, "a .glb holds at most 4 GiB");
  const auto word = static_cast<uint32_t>(value);
  bytes.append(reinterpret_cast<const char*>(&word), 4);
}

}  // namespace

Container take_apart(std::vector<uint8_t> bytes, const std::string& file) {
  Container c;
  c.bytes = std::move(bytes);
  const size_t size = c.bytes.size();
  c.json_end = c.chunks_begin = c.end = size;
  if (size == 0) throw_error(file, "the file is empty");
  if (size < 4 || read_u32(c.bytes, 0) != k_magic) return c;

  c.binary = true;
  if (size < 20) throw_error(file, "truncated .glb: {} bytes, expected a header of 20", size);
  const uint32_t version = read_u32(c.bytes, 4), length = read_u32(c.bytes, 8);
  if (version != 2) throw_error(file, "container version {}, expected 2", version);
  if (length > size) throw_error(file, "truncated .glb: {} bytes, expected {}", size, length);
  size_t at = 12;
  for (int chunk = 0; at < length; ++chunk) {
    if (length - at < 8) throw_error(file, "truncated .glb: chunk {} has no header", chunk);
    const uint32_t chunk_length = read_u32(c.bytes, at), type = read_u32(c.bytes, at + 4);
    at += 8;
    if (chunk_length > length - at)
      throw_error(file, "truncated .glb: chunk {} claims {} bytes, {} are left", chunk, chunk_length,
                  length - at);
    if (chunk == 0) {
      if (type != k_json) throw_error(file, "the first chunk of a .glb must be JSON");
      c.json_begin = at;
      c.json_end = c.chunks_begin = at + chunk_length;
    } else if (type == k_bin && !c.has_bin) {
      c.bin_begin = at;
      c.bin_end = at + chunk_length;
      c.has_bin = true;
    }
    at += chunk_length;
  }
  if (c.json_begin == 0) throw_error(file, "a .glb without a JSON chunk");
  c.end = length;
  // JSON is padded with spaces; zeros are a common mistake.
  while (c.json_end != c.json_begin && c.bytes[c.json_end - 1] == '\0') --c.json_end;
  return c;
}

std::string glb_bytes(std::string_view json, std::string_view chunks) {
  const size_t padded = (json.size() + 3) / 4 * 4;
  std::string bytes;
  bytes.reserve(20 + padded + chunks.size());
  append_u32(bytes, k_magic, "glb");
  append_u32(bytes, 2, "glb");
  append_u32(bytes, 20 + padded + chunks.size(), "glb");
  append_u32(bytes, padded, "glb");
  append_u32(bytes, k_json, "glb");
  bytes += json;
  bytes.append(padded - json.size(), ' ');
  bytes += chunks;
  return bytes;
}

std::string chunk_bytes(const std::vector<uint8_t>& data) {
  if (data.empty()) return "";
  const size_t padded = (data.size() + 3) / 4 * 4;
  std::string bytes;
  bytes.reserve(8 + padded);
  append_u32(bytes, padded, "glb");
  append_u32(bytes, k_bin, "glb");
  bytes.append(reinterpret_cast<const char*>(data.data()), data.size());
  bytes.append(padded - data.size(), '\0');
  return bytes;
}

}  // namespace lucerna::scene
