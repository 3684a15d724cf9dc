#include "gpu/shader_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace lucerna::gpu {

namespace fs = std::filesystem;

namespace {

struct Header {
  char magic[8];
  uint64_t words, checksum;
};
constexpr char k_magic[8] = {'L', 'U', 'C', 'S', 'P', 'V', '0', '2'};
constexpr size_t k_most_files = 2000;

uint64_t checksum(const std::vector<uint32_t>& words) {
  Hash hash;
  hash.add_bytes(words.data(), words.size() * sizeof(uint32_t));
  return hash.low();
}

}  // namespace

fs::path ShaderCache::default_folder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache)
    return fs::path(cache) / "lucerna" / "spirv";
  if (const char* home = std::getenv("HOME"); home && *home)
    return fs::path(home) / ".cache" / "lucerna" / "spirv";
  return {};
}

std::optional<std::vector<uint32_t>> ShaderCache::load(const std::string& key) const {
  if (folder_.empty()) return std::nullopt;
  const fs::path path = folder_ / key;
  std::error_code error;
  const uint64_t size = fs::file_size(path, error);
  if (error || size < sizeof(Header)) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  Header header{};
  file.read(reinterpret_cast<char*>(&header), sizeof header);
  if (!file || std::memcmp(header.magic, k_magic, sizeof k_magic) != 0) return std::nullopt;
  if (header.words != (size - sizeof header) / sizeof(uint32_t) || (size - sizeof header) % sizeof(uint32_t))
    return std::nullopt;
  std::vector<uint32_t> words(header.words);
  file.read(reinterpret_cast<char*>(words.data()),
            static_cast<std::streamsize>(words.size() * sizeof(uint32_t)));
  if (!file || checksum(words) != header.checksum) return std::nullopt;
  return words;
}

void ShaderCache::store(const std::string& key, const std::vector<uint32_t>& words) const {
  if (folder_.empty()) return;
  std::error_code error;
  fs::create_directories(folder_, error);
  static std::atomic<unsigned> serial{0};
  const fs::path temporary = folder_ / fmt::format("{}.{}.{}.new", key, ::getpid(), ++serial);
  Header header{};
  std::memcpy(header.magic, k_magic, sizeof k_magic);
  header.words = words.size();
  header.checksum = checksum(words);
  {
    std::ofstream file(temporary, std::ios::binary);
    file.write(reinterpret_cast<const char*>(&header), sizeof header);
    file.write(reinterpret_cast<const char*>(words.data()),
               static_cast<std::streamsize>(words.size() * sizeof(uint32_t)));
    file.close();
    if (!file) {
      fs::remove(temporary, error);
      return;
    }
  }
  fs::rename(temporary, folder_ / key, error);
  if (error) fs::remove(temporary, error);
  drop_oldest();
}

void ShaderCache::drop_oldest() const {
  std::error_code error;
  std::vector<std::pair<fs::file_time_type, fs::path>> files;
  for (auto it = fs::directory_iterator(folder_, error); !error && it != fs::directory_iterator();
       it.increment(error)) {
    std::error_code gone;
    const auto time = fs::last_write_time(it->path(), gone);
    if (!gone) files.emplace_back(time, it->path());
  }
  if (files.size() <= k_most_files) return;
  std::sort(files.begin(), files.end());
  for (size_t i = 0; i < files.size() - k_most_files / 2; ++i) fs::remove(files[i].second, error);
}

}  // namespace lucerna::gpu
