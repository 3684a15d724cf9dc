#include "base/hash.h"

#include <fmt/format.h>

namespace lucerna {

void Hash::add_bytes(const void* data, size_t bytes) {
  const auto* p = static_cast<const unsigned char*>(data);
  for (size_t i = 0; i < bytes; ++i) {
    a_ = (a_ ^ p[i]) * 0x100000001b3ull;
    b_ = (b_ ^ p[i]) * 0x100000001b3ull;
    b_ ^= b_ >> 29;
  }
}

void Hash::add(const std::string& text) {
  add_value(uint64_t{text.size()});
  add_bytes(text.data(), text.size());
}

std::string Hash::hex() const { return fmt::format("{:016x}{:016x}", a_, b_); }

}  // namespace lucerna
