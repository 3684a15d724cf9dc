// links: sort
// The radix sort on the device compared with std::stable_sort.
#include <algorithm>
#include <random>

#include "kernels/gpu_support.h"
#include "sort/radix_sort.h"

namespace sort_radix_tests {

using namespace lucerna;
using Catch::Matchers::Contains;

namespace {

constexpr uint32_t k_most = (1u << 20) + 1;

uint64_t key_of(const shared::SortPair& e) { return e.key; }
uint64_t key_of(const shared::SortEntry64& e) { return uint64_t(e.high) << 32 | e.low; }
void set_key(shared::SortPair& e, uint64_t key) { e.key = uint32_t(key); }
void set_key(shared::SortEntry64& e, uint64_t key) { e.low = uint32_t(key), e.high = uint32_t(key >> 32); }

template <class Entry>
struct Sorter {
  static constexpr bool wide = sizeof(Entry) == 16;
  static constexpr uint64_t k_bytes = ((k_most + 2) & ~1ull) * sizeof(Entry);
  static constexpr sort::Keys k_keys = wide ? sort::Keys::bits64 : sort::Keys::bits32;

  explicit Sorter(const sort::RadixSort::Tuning* tuning = nullptr)
      : sorter(silent.device, compiler, k_keys,
               tuning ? *tuning : sort::RadixSort::tuning_for(silent.device)),
        stream(silent.device),
        a(silent.device, {.name = "entries", .bytes = k_bytes, .texel = true}),
        b(silent.device, {.name = "scratch", .bytes = k_bytes, .texel = true}) {}

  /// Sorts entries with these keys, whose values are their indices, by the lowest `bits`; returns the number
  /// of differences from the host's stable sort and of writes behind the end.
  size_t wrong(const std::vector<uint64_t>& keys, uint32_t bits, const sort::Count& count) {
    std::vector<Entry> entries(a.bytes() / sizeof(Entry));
    for (uint32_t i = 0; i < entries.size(); ++i) {
      set_key(entries[i], i < keys.size() ? keys[i] : 0x1234567812345678ull);
      entries[i].value = i;
    }
    a.write(std::span<const Entry>(entries));
    b.write(std::span<const Entry>(entries));
    const gpu::Buffer& result = sorter.encode(stream, a, b, count, bits);
    stream.run();
    const uint64_t mask = bits == 64 ? ~0ull : (1ull << bits) - 1;
    const auto less = [&](const Entry& x, const Entry& y) { return (key_of(x) & mask) < (key_of(y) & mask); };
    std::stable_sort(entries.begin(), entries.begin() + std::ptrdiff_t(keys.size()), less);
    const auto got = result.template read_all<Entry>();
    size_t bad = 0;
    for (size_t i = 0; i < entries.size(); ++i)
      bad += key_of(got[i]) != key_of(entries[i]) || got[i].value != entries[i].value;
    return bad;
  }
  size_t wrong(const std::vector<uint64_t>& keys, uint32_t bits) {
    return wrong(keys, bits, {.most = uint32_t(keys.size())});
  }

  test::SilentDevice silent;
  gpu::ShaderCompiler compiler;
  sort::RadixSort sorter;
  gpu::Stream stream;
  gpu::Buffer a, b;
};

std::vector<uint64_t> random_keys(size_t n, uint32_t bits) {
  std::mt19937_64 random(n + bits);
  std::vector<uint64_t> keys(n);
  for (uint64_t& k : keys) k = random() >> (64 - bits);
  return keys;
}

}  // namespace

TEST_CASE("pairs of all sizes around powers of two are sorted") {
  Sorter<shared::SortPair> sorter;
  CHECK(sorter.wrong({}, 32) == 0);
  for (const size_t n : {1, 2, 3}) CHECK(sorter.wrong(random_keys(n, 32), 32) == 0);
  for (uint32_t k = 2; k <= 20; ++k)
    for (const int more : {-1, 0, 1}) {
      const size_t n = size_t((1 << k) + more);
      INFO(n);
      CHECK(sorter.wrong(random_keys(n, 32), 32) == 0);
    }
}

TEST_CASE("entries of equal keys keep their order") {
  Sorter<shared::SortPair> sorter;
  for (const uint32_t bits : {1u, 3u, 8u}) CHECK(sorter.wrong(random_keys(200003, bits), 32) == 0);
  CHECK(sorter.wrong(std::vector<uint64_t>(100001, 5), 32) == 0);
  CHECK(sorter.wrong(std::vector<uint64_t>(100001, 0xffffffffu), 32) == 0);
}

TEST_CASE("sorted entries stay; reversed ones are reversed") {
  Sorter<shared::SortPair> sorter;
  std::vector<uint64_t> keys(65537);
  for (size_t i = 0; i < keys.size(); ++i) keys[i] = i * 65535;
  CHECK(sorter.wrong(keys, 32) == 0);
  std::reverse(keys.begin(), keys.end());
  CHECK(sorter.wrong(keys, 32) == 0);
}

TEST_CASE("only the requested bits count") {
  Sorter<shared::SortPair> sorter;
  for (uint32_t bits = 1; bits <= 32; ++bits) {
    INFO(bits);
    CHECK(sorter.wrong(random_keys(5000, 32), bits) == 0);
  }
  CHECK(sorter.wrong(random_keys(5000, 32), 0) == 0);
  CHECK_THAT(test::error_of([&] { sorter.wrong(random_keys(5, 32), 33); }), Contains("33"));
}

TEST_CASE("keys of 64 bits") {
  Sorter<shared::SortEntry64> sorter;
  for (const size_t n : {0u, 1u, 2u, 3u, 4095u, 4096u, 4097u, 262143u}) {
    INFO(n);
    CHECK(sorter.wrong(random_keys(n, 64), 64) == 0);
  }
  for (const uint32_t bits : {7u, 31u, 32u, 33u, 39u, 40u, 41u, 63u}) {
    INFO(bits);
    CHECK(sorter.wrong(random_keys(10000, 64), bits) == 0);
  }
  CHECK(sorter.wrong(std::vector<uint64_t>(10001, ~0ull), 64) == 0);
}

TEST_CASE("the number of entries can be in a buffer, limited by the capacity") {
  Sorter<shared::SortPair> sorter;
  gpu::Buffer count(sorter.silent.device, {.name = "count", .bytes = 16});
  for (const uint32_t n : {0u, 1u, 255u, 4097u, 99999u, 100000u, 100001u, 0xffffffffu}) {
    count.write(std::span<const uint32_t>({1u, n, 2u, 3u}));
    INFO(n);
    CHECK(sorter.wrong(random_keys(std::min(n, 100000u), 32), 24,
                       {.most = 100000, .buffer = &count, .offset = 4}) == 0);
  }
}

TEST_CASE("pairs in runs of a GPU's size") {
  const sort::RadixSort::Tuning tuning{.runs = {.group = 64, .wanted = 65536, .least = 32, .most = 65536},
                                       .digit_bits = 4};
  Sorter<shared::SortPair> sorter(&tuning);
  for (const size_t n : {1u, 33u, 2047u, 65537u, k_most}) {
    INFO(n);
    CHECK(sorter.wrong(random_keys(n, 30), 30) == 0);
  }
}

TEST_CASE("runs are short enough for lavapipe's limit of 65535 iterations") {
  // Enough entries to make them too long.
  test::SilentDevice silent;
  gpu::ShaderCompiler compiler;
  gpu::Stream stream(silent.device);
  sort::RadixSort sorter(silent.device, compiler, sort::Keys::bits32,
                         {.runs = {.group = 8, .wanted = 8, .least = 256, .most = 64}, .digit_bits = 8});
  constexpr uint32_t n = 1500000;
  gpu::Buffer a(silent.device, {.name = "a", .bytes = n * 8ull, .texel = true}),
      b(silent.device, {.name = "b", .bytes = n * 8ull, .texel = true});
  std::vector<shared::SortPair> entries(n);
  for (uint32_t i = 0; i < n; ++i) entries[i] = {i % 7, i};
  a.write(std::span<const shared::SortPair>(entries));
  const gpu::Buffer& result = sorter.encode(stream, a, b, {.most = n}, 3);
  stream.run();
  const auto sorted = result.read_all<shared::SortPair>();
  size_t bad = 0;
  for (uint32_t i = 1; i < n; ++i)
    bad += sorted[i - 1].key > sorted[i].key ||
           (sorted[i - 1].key == sorted[i].key && sorted[i - 1].value >= sorted[i].value);
  CHECK(bad == 0);
}

TEST_CASE("two sorts of the same entries are identical, byte for byte") {
  Sorter<shared::SortPair> sorter;
  std::vector<shared::SortPair> first;
  for (int round = 0; round < 3; ++round) {
    CHECK(sorter.wrong(random_keys(300000, 9), 9) == 0);
    const auto now = sorter.b.read_all<shared::SortPair>();
    if (round == 0) first = now;
    CHECK(std::equal(now.begin(), now.end(), first.begin(),
                     [](auto& x, auto& y) { return x.key == y.key && x.value == y.value; }));
  }
}

TEST_CASE("a sort beyond the capacity is refused") {
  Sorter<shared::SortPair> sorter;
  gpu::Buffer small(sorter.silent.device, {.name = "small", .bytes = 64, .texel = true});
  const auto sort = [&](uint32_t n) {
    sorter.sorter.encode(sorter.stream, sorter.a, small, {.most = n}, 32);
  };
  CHECK_THAT(test::error_of([&] { sort(9); }), Contains("'small'") && Contains("9 entries"));
  CHECK(test::error_of([&] { sort(8); }) == "no error");
  sorter.stream.run();
}

}  // namespace sort_radix_tests
