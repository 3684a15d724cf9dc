#include "solvers/irradiance_cache/file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they lie in memory");
// A record of another size is refused by its size; the assertion below reminds to update k_record_layout.
static_assert(k_record_texels == 6 && k_part_texels == 4 && k_part_count == 4 && k_record_layout == 5);

constexpr char k_magic[8] = {'L', 'U', 'C', 'C', 'A', 'C', 'H', 'E'};
constexpr size_t k_head = sizeof k_magic + 3 * sizeof(uint32_t) + sizeof(uint64_t);
constexpr size_t k_length_at = k_head - sizeof(uint64_t);
constexpr size_t k_checksum = sizeof(uint64_t);
constexpr uint32_t k_bytes_a_record = sizeof(vec4) * (k_record_texels + k_part_count * k_part_texels + 1);

/// One description of the format (fields()) for reading and writing.
class Writer {
 public:
  template <class T>
  void plain(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    raw(&value, sizeof value);
  }
  void raw(const void* data, size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  void text(const std::string& value) {
    plain(static_cast<uint32_t>(value.size()));
    bytes_ += value;
  }
  template <class V, class Each>
  void map(const std::map<std::string, V>& values, const Each& each) {
    plain(static_cast<uint32_t>(values.size()));
    for (const auto& [key, value] : values) text(key), each(value);
  }
  void records(const RawRecords& r) {
    plain(r.size());
    plain(uint32_t(r.size() > 0 ? r.groups.size() / r.size() : 0));
    for (const auto* list : {&r.places, &r.lights, &r.spheres})
      raw(list->data(), list->size() * sizeof(vec4));
    raw(r.groups.data(), r.groups.size() * sizeof(uvec4));
  }
  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads contents whose checksum is valid, but still never beyond their end.
class Reader {
 public:
  Reader(std::string_view bytes, const std::string& where) : bytes_(bytes), where_(where) {}
  template <class T>
  void plain(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    raw(&value, sizeof value);
  }
  void raw(void* data, size_t size) {
    require(size);
    if (size > 0) std::memcpy(data, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  void text(std::string& value) {
    uint32_t size = 0;
    plain(size);
    require(size);
    value = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
  }
  template <class V, class Each>
  void map(std::map<std::string, V>& values, const Each& each) {
    uint32_t count = 0;
    plain(count);
    for (uint32_t i = 0; i < count; ++i) {
      std::string key;
      text(key);
      each(values[key]);
    }
  }
  void records(RawRecords& r) {
    uint32_t count = 0, shares = 0;
    plain(count), plain(shares);
    const uint64_t expected = count * (k_bytes_a_record + uint64_t{shares} * sizeof(uvec4));
    if (shares > k_most_groups / 4 || bytes_.size() != expected)
      throw_error(where_, "damaged: {} bytes for its {} records, expected {}", bytes_.size(), count,
                  expected);
    r.places.resize(size_t{count} * k_record_texels);
    r.lights.resize(size_t{count} * k_part_count * k_part_texels);
    r.spheres.resize(count);
    r.groups.resize(size_t{count} * shares);
    for (auto* list : {&r.places, &r.lights, &r.spheres}) raw(list->data(), list->size() * sizeof(vec4));
    raw(r.groups.data(), r.groups.size() * sizeof(uvec4));
  }

 private:
  void require(size_t size) const {
    if (bytes_.size() < size)
      throw_error(where_, "damaged: an entry of {} bytes, but only {} follow", size, bytes_.size());
  }
  std::string_view bytes_;
  const std::string& where_;
};

// Writing does not change the file object.
void assign(bool& value, uint8_t read) { value = read != 0; }
void assign(const bool&, uint8_t) {}

template <class Archive, class File>
void fields(Archive& a, File& f) {
  a.text(f.program);
  a.text(f.made_with.scene);
  a.map(f.made_with.hashes, [&](auto& value) { a.plain(value); });
  a.map(f.made_with.settings, [&](auto& value) { a.text(value); });
  a.plain(f.made_with.parts);
  // 1: looked up in other records, 2: provided by another solver.
  uint8_t tertiary = f.made_with.elsewhere ? 2 : f.made_with.recursive ? 1 : 0;
  a.plain(tertiary);
  assign(f.made_with.recursive, tertiary == 1);
  assign(f.made_with.elsewhere, tertiary == 2);
  a.text(f.made_with.seed);
  a.text(f.view);
  a.plain(f.status.pass), a.plain(f.status.probed.uncovered), a.plain(f.status.probed.paths),
      a.plain(f.status.rays);
  a.plain(f.status.stop);
  a.plain(f.grouping);
  a.records(f.records);
}

uint64_t checksum(std::string_view bytes) {
  Hash hash;
  hash.add_bytes(bytes.data(), bytes.size());
  return hash.low();
}

/// "secondary, tertiary" from the bits of parts.
std::string part_names(uint32_t parts) {
  constexpr const char* k_names[k_part_count] = {"environment", "secondary", "tertiary", "caustic"};
  std::vector<std::string> names;
  for (uint32_t p = 0; p < k_part_count; ++p)
    if (parts >> p & 1) names.push_back(k_names[p]);
  return names.empty() ? "no" : fmt::format("{}", fmt::join(names, ", "));
}

/// Checks the first k_head bytes of a file of `size` bytes.
void check_head(std::string_view bytes, uint64_t size, const std::string& where) {
  const std::string_view magic(k_magic, sizeof k_magic);
  if (!bytes.starts_with(magic) && !magic.starts_with(bytes))
    throw_error(where, "not an irradiance cache: expected a file that begins with '{}'", magic);
  if (bytes.size() < k_head)
    throw_error(where, "cut short: an irradiance cache has more than {} bytes, this file has {}", k_head,
                size);
  Reader head(bytes.substr(magic.size()), where);
  uint32_t version = 0, layout = 0, record = 0;
  uint64_t length = 0;
  head.plain(version), head.plain(layout), head.plain(record), head.plain(length);
  if (version != k_cache_file_version)
    throw_error(where, "an irradiance cache in version {} of its format; expected version {}", version,
                k_cache_file_version);
  if (layout != k_record_layout || record != k_bytes_a_record)
    throw_error(where,
                "its records are laid out otherwise: layout {} of {} bytes each, expected layout {} of {}",
                layout, record, k_record_layout, k_bytes_a_record);
  if (size < length) throw_error(where, "cut short: {} bytes, but its header states {}", size, length);
  if (size > length || length < k_head + k_checksum)
    throw_error(where, "damaged: {} bytes, but its header states {}", size, length);
}

}  // namespace

std::string encode(const CacheFile& cache) {
  Writer w;
  w.raw(k_magic, sizeof k_magic);
  w.plain(k_cache_file_version), w.plain(k_record_layout), w.plain(k_bytes_a_record);
  w.plain(uint64_t{0});
  fields(w, cache);
  const uint64_t length = w.bytes().size() + k_checksum;
  std::memcpy(w.bytes().data() + k_length_at, &length, sizeof length);
  w.plain(checksum(w.bytes()));
  return std::move(w.bytes());
}

CacheFile decode(const std::string& bytes, const std::string& where) {
  check_head(std::string_view(bytes).substr(0, k_head), bytes.size(), where);
  const std::string_view contents = std::string_view(bytes).substr(0, bytes.size() - k_checksum);
  uint64_t stored = 0;
  std::memcpy(&stored, bytes.data() + contents.size(), sizeof stored);
  if (const uint64_t found = checksum(contents); found != stored)
    throw_error(where, "damaged: its checksum is {:016x}, that of its contents {:016x}", stored, found);
  CacheFile cache;
  Reader reader(contents.substr(k_head), where);
  fields(reader, cache);
  if (cache.status.stop > StopReason::finished_early)
    throw_error(where, "damaged: stop reason {}, expected 0 to {}", int(cache.status.stop),
                int(StopReason::finished_early));
  return cache;
}

void write_cache(const std::filesystem::path& file, const CacheFile& cache) {
  write_file(file, encode(cache));
}

CacheFile read_cache(const std::filesystem::path& file) {
  // Other files are not read to the end, however long.
  std::error_code error;
  const uint64_t size = std::filesystem::file_size(file, error);  // an error if it is not a regular file
  if (std::ifstream in(file, std::ios::binary); in && !error) {
    std::string head(k_head, 0);
    in.read(head.data(), k_head);
    head.resize(static_cast<size_t>(in.gcount()));
    check_head(head, size, file.string());
  }
  return decode(read_file(file), file.string());
}

void check_fits(const CacheFile& cache, const MadeWith& wanted, uint32_t room, const std::string& where) {
  const MadeWith& made = cache.made_with;
  const auto differing = [](const auto& a, const auto& b, const auto& describe) {
    std::map<std::string, int> keys;  // of both, sorted
    for (const auto& [key, value] : a) keys[key];
    for (const auto& [key, value] : b) keys[key];
    std::vector<std::string> found;
    for (const auto& [key, unused] : keys) {
      const auto x = a.find(key), y = b.find(key);
      if (x == a.end() || y == b.end() || x->second != y->second)
        found.push_back(
            describe(key, x == a.end() ? nullptr : &x->second, y == b.end() ? nullptr : &y->second));
    }
    return found;
  };
  const auto scene = differing(made.hashes, wanted.hashes,
                               [](const std::string& key, const auto*, const auto*) { return key; });
  if (!scene.empty())
    throw_error(where, "records of another scene ('{}', this is '{}'): they differ in {}", made.scene,
                wanted.scene, fmt::join(scene, ", "));
  const auto settings = differing(
      made.settings, wanted.settings, [](const std::string& key, const std::string* x, const std::string* y) {
        return fmt::format("{} = {} (now {})", key, x ? *x : "unknown", y ? *y : "unknown");
      });
  if (!settings.empty()) throw_error(where, "its records were made with {}", fmt::join(settings, ", "));
  if (const uint32_t missing = wanted.parts & ~made.parts)
    throw_error(where, "its records hold {} light; the looked-up components also need {} light",
                part_names(made.parts), part_names(missing));
  const auto by = [](const MadeWith& m) { return m.elsewhere ? "photons" : m.recursive ? "cache" : "path"; };
  const std::string_view made_by = by(made), wanted_by = by(wanted);
  if ((wanted.parts & 1u << k_part_tertiary) != 0 && made_by != wanted_by)
    throw_error(where,
                "the tertiary light of its records was gathered by '{}', here it is by '{}'; set "
                "components.tertiary {}",
                made_by, wanted_by, made_by);
  if (cache.records.size() > room)
    throw_error(where, "holds {} records, but the limit is {}; set cache.max_records to {} or more",
                cache.records.size(), room, cache.records.size());
}

}  // namespace lucerna::irradiance_cache
