// links: irradiance_cache
// Files of irradiance caches, without a device: a file is read back bit for bit; an incomplete file, another
// format or another scene is refused with the expected and the actual value.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "solvers/irradiance_cache/file.h"
#include "support/folder.h"
#include "support/records.h"

namespace cache_file_tests {

namespace fs = std::filesystem;
using namespace lucerna;
using namespace lucerna::irradiance_cache;
using Catch::Contains;

namespace {

/// A record in a file: position, light and sphere.
constexpr uint32_t k_stored_bytes =
    16 * (shared::k_record_texels + shared::k_part_count * shared::k_part_texels + 1);

/// Every texel differs; infinities, negative zeros and NaN bits are included.
CacheFile some_cache(uint32_t records) {
  CacheFile c;
  c.program = "1.2.3";
  c.made_with.scene = "hall";
  c.made_with.hashes = {{"geometry", 1}, {"lights", 0xfedcba9876543210ull}};
  c.made_with.settings = {{"cache.error", "0.3"}, {"path.max_depth", "64"}};
  c.made_with.parts = 0b0110;
  c.made_with.recursive = records % 2 == 0;
  c.made_with.seed = "7";
  c.view = "perspective 0.8 at 1 2 3";
  c.status.pass = 3, c.status.probed.uncovered = 5, c.status.probed.paths = 1ull << 40,
  c.status.rays = 123456789012ull;
  c.status.stop = StopReason::passes;
  float next = 1;
  const auto fill = [&](std::vector<vec4>& list, size_t count) {
    for (size_t i = 0; i < count; ++i, next += 4) list.emplace_back(next, next + 1, next + 2, next + 3);
  };
  fill(c.records.places, size_t{records} * shared::k_record_texels);
  fill(c.records.lights, size_t{records} * shared::k_part_count * shared::k_part_texels);
  fill(c.records.spheres, records);
  // Some have shares of light groups, two texels per record.
  c.grouping = records % 2 == 1 ? 0x123456789abcdefull : 0;
  for (uint32_t i = 0; records % 2 == 1 && i < 2 * records; ++i)
    c.records.groups.emplace_back(i, ~i, 0x80000000u, 7 * i);
  if (records > 0) {
    c.records.places[1].w = k_infinity;
    c.records.lights[0].x = -0.0f;
    const uint32_t odd = 0x7fc01234;
    std::memcpy(&c.records.places[2].w, &odd, sizeof odd);
  }
  return c;
}

std::string complaint(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}
std::string refusal(const std::string& bytes) {
  return complaint([&] { decode(bytes, "a.cache"); });
}

}  // namespace

TEST_CASE("a cache is unchanged after write and read, bit for bit") {
  const test::Folder folder;
  for (const uint32_t records : {0u, 1u, 3u, 1000u}) {
    INFO(records);
    const CacheFile c = some_cache(records);
    const fs::path file = folder.path / "a.cache";
    write_cache(file, c);
    const CacheFile d = read_cache(file);
    CHECK(d.program == c.program);
    CHECK(d.made_with.scene == c.made_with.scene);
    CHECK(d.made_with.hashes == c.made_with.hashes);
    CHECK(d.made_with.settings == c.made_with.settings);
    CHECK(d.made_with.parts == c.made_with.parts);
    CHECK(d.made_with.recursive == c.made_with.recursive);
    CHECK(d.made_with.seed == c.made_with.seed);
    CHECK(d.view == c.view);
    CHECK(d.status.pass == c.status.pass);
    CHECK(d.status.probed.uncovered == c.status.probed.uncovered);
    CHECK(d.status.probed.paths == c.status.probed.paths);
    CHECK(d.status.rays == c.status.rays);
    CHECK(d.status.stop == c.status.stop);
    CHECK(d.grouping == c.grouping);
    CHECK(d.records.groups.size() == (records % 2 == 1 ? 2 * records : 0));
    CHECK(d.records.size() == records);
    CHECK(test::identical(d.records, c.records));
    CHECK(encode(d) == encode(c));
  }
  // No temporary file remains.
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);
}

TEST_CASE("the format matches its header comment, byte for byte") {
  const std::string bytes = encode(some_cache(2));
  const std::string head("LUCCACHE\3\0\0\0\5\0\0\0", 16);
  CHECK(bytes.substr(0, 16) == head);
  const auto number = [&](size_t at, int size) {
    uint64_t value = 0;
    for (int k = size - 1; k >= 0; --k) value = value << 8 | uint8_t(bytes[at + size_t(k)]);
    return value;
  };
  CHECK(number(16, 4) == k_stored_bytes);
  CHECK(number(20, 8) == bytes.size());
  CHECK(number(28, 4) == 5);
  CHECK(bytes.substr(32, 5) == "1.2.3");
  CHECK(number(bytes.size() - 8 - 2 * k_stored_bytes - 8, 4) == 2);
}

TEST_CASE("a truncated file is refused at every length") {
  const std::string bytes = encode(some_cache(3));
  for (size_t n = 0; n < bytes.size(); ++n) {
    const std::string reported = refusal(bytes.substr(0, n));
    INFO(n << ": " << reported);
    REQUIRE(reported.find("a.cache: cut short: ") == 0);
    REQUIRE_THAT(reported, Contains(std::to_string(n)));
  }
  CHECK(refusal(bytes).empty());
  CHECK_THAT(refusal(bytes + "x"), Contains("a.cache: damaged: ") && Contains("its header states"));
}

TEST_CASE("a file with one byte changed is refused, for every byte and change") {
  const std::string bytes = encode(some_cache(3));
  for (size_t n = 0; n < bytes.size(); ++n)
    for (const int change : {1, 0x80, 0xff}) {
      std::string other = bytes;
      other[n] = char(other[n] ^ change);
      const std::string reported = refusal(other);
      INFO(n << " ^ " << change << ": " << reported);
      REQUIRE(reported.find("a.cache: ") == 0);
      if (n < 8)
        REQUIRE_THAT(reported, Contains("not an irradiance cache: expected a file that begins with"));
      if (n >= 28) REQUIRE_THAT(reported, Contains("damaged: its checksum is"));
    }
  std::string other = bytes;
  other[8] = 1;
  CHECK(refusal(other) == "a.cache: an irradiance cache in version 1 of its format; expected version 3");
  other = bytes, other[12] = 9;
  CHECK_THAT(refusal(other), Contains("its records are laid out otherwise: layout 9 of 368 bytes each, "
                                      "expected layout 5 of 368"));
  other = bytes, other[17] = 2;
  CHECK_THAT(refusal(other), Contains("layout 5 of 624 bytes each, expected layout 5 of 368"));
  CHECK_THAT(refusal("glTF and so on"), Contains("not an irradiance cache"));
}

TEST_CASE("invalid contents with a valid checksum are refused or read, never followed outside the file") {
  const std::string bytes = encode(some_cache(2));
  size_t refused = 0, read = 0;
  for (size_t n = 28; n + 8 < bytes.size(); ++n)
    for (const char value : {'\0', '\x01', '\x7f', '\xff'}) {
      std::string other = bytes;
      other[n] = value;
      Hash hash;
      hash.add_bytes(other.data(), other.size() - 8);
      const uint64_t sum = hash.low();
      std::memcpy(other.data() + other.size() - 8, &sum, sizeof sum);
      const std::string reported = refusal(other);
      ++(reported.empty() ? read : refused);
      REQUIRE((reported.empty() || reported.starts_with("a.cache: damaged: ")));
    }
  CHECK(refused > 50);  // lengths and counts
  CHECK(read > 2000);   // the records' own numbers
}

TEST_CASE("a failed read or write is reported, and existing files stay") {
  const test::Folder folder;
  const fs::path file = folder.path / "a.cache";
  CHECK_THAT(complaint([&] { read_cache(file); }),
             Contains(file.string() + ": cannot be read: No such file"));
  CHECK_THAT(complaint([&] { read_cache(folder.path); }), Contains("it is a folder"));
  CHECK_THAT(complaint([&] { write_cache(folder.path / "no" / "a.cache", some_cache(1)); }),
             Contains("no/a.cache: cannot be written: "));
  // A folder of that name cannot be replaced by a file; the partial file is removed.
  fs::create_directories(file / "inner");
  CHECK_THAT(complaint([&] { write_cache(file, some_cache(1)); }), Contains("is a folder"));
  CHECK(fs::is_directory(file / "inner"));
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);
}

TEST_CASE("a cache fits what it was built from, and reports what differs") {
  const CacheFile c = some_cache(20);
  const auto fits = [&](const std::function<void(MadeWith&)>& change, uint32_t room = 20) {
    MadeWith wanted = c.made_with;
    change(wanted);
    return complaint([&] { check_fits(c, wanted, room, "a.cache"); });
  };
  CHECK(fits([](MadeWith&) {}).empty());
  CHECK(fits([](MadeWith& m) { m.seed = "8", m.scene = "another name"; }).empty());
  CHECK(fits([](MadeWith& m) { m.hashes["lights"] = 2, m.scene = "attic"; }) ==
        "a.cache: records of another scene ('hall', this is 'attic'): they differ in lights");
  CHECK_THAT(fits([](MadeWith& m) { m.hashes["geometry"] = 2, m.hashes["lights"] = 2; }),
             Contains("they differ in geometry, lights"));
  CHECK_THAT(fits([](MadeWith& m) { m.hashes["fog"] = 2; }), Contains("they differ in fog"));
  CHECK(fits([](MadeWith& m) { m.settings["cache.error"] = "0.5"; }) ==
        "a.cache: its records were made with cache.error = 0.3 (now 0.5)");
  CHECK_THAT(fits([](MadeWith& m) {
               m.settings = {{"cache.error", "1"}, {"cache.metric", "hessian"}};
             }),
             Contains("made with cache.error = 0.3 (now 1), cache.metric = unknown (now hessian), "
                      "path.max_depth = 64 (now unknown)"));
  // Components that are not looked up need no match.
  CHECK(fits([](MadeWith& m) { m.parts = 0b0100; }).empty());
  CHECK(fits([](MadeWith& m) { m.parts = 0b1111; }) ==
        "a.cache: its records hold secondary, tertiary light; the looked-up components also need "
        "environment, caustic light");
  // The way tertiary light was gathered matters only if it is looked up.
  CHECK(c.made_with.recursive);
  CHECK(fits([](MadeWith& m) { m.recursive = false; }) ==
        "a.cache: the tertiary light of its records was gathered by 'cache', here it is by 'path'; set "
        "components.tertiary cache");
  CHECK(fits([](MadeWith& m) { m.recursive = false, m.parts = 0b0010; }).empty());
  CHECK(fits([](MadeWith&) {}, 19) ==
        "a.cache: holds 20 records, but the limit is 19; set cache.max_records to 20 or more");
}

}  // namespace cache_file_tests
