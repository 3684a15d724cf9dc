// links: sort
// Prefix sums on the device compared with std::exclusive_scan.
#include <numeric>
#include <random>

#include "kernels/gpu_support.h"
#include "sort/prefix_sum.h"

namespace sort_scan_tests {

using namespace lucerna;
using Catch::Matchers::Contains;

namespace {

constexpr uint32_t k_most = (1u << 20) + 1, k_words = (k_most + 7) & ~3u, k_untouched = 0xdeadbeefu;

/// 0, 1, 2, 3, and around every power of two up to 2^20.
std::vector<uint32_t> sizes() {
  std::vector<uint32_t> list{0, 1, 2, 3};
  for (uint32_t k = 2; k <= 20; ++k)
    for (uint32_t n : {(1u << k) - 1, 1u << k, (1u << k) + 1})
      if (n != list.back()) list.push_back(n);
  return list;
}

struct Scanner {
  explicit Scanner(const sort::Runs* runs = nullptr)
      : sum(silent.device, compiler, runs ? *runs : sort::PrefixSum::runs_for(silent.device)),
        stream(silent.device),
        in(silent.device, {.name = "in", .bytes = k_words * 4, .texel = true}),
        out(silent.device, {.name = "out", .bytes = k_words * 4, .texel = true}),
        total(silent.device, {.name = "total", .bytes = 16}) {}

  /// The number of differences from the host's sum, including the total and the elements behind the end.
  size_t wrong(const std::vector<uint32_t>& values, const sort::Count& count, size_t n, bool in_place) {
    const gpu::Buffer& target = in_place ? in : out;
    std::vector<uint32_t> padded(k_words, k_untouched);
    std::copy(values.begin(), values.begin() + std::ptrdiff_t(n), padded.begin());
    in.write(std::span<const uint32_t>(padded));
    stream.fill(out, k_untouched);
    stream.fill(total, k_untouched);
    sum.encode(stream, in, target, count, &total, 8);
    stream.run();
    std::vector<uint32_t> expected = padded;
    std::exclusive_scan(padded.begin(), padded.begin() + std::ptrdiff_t(n), expected.begin(), 0u);
    std::fill(expected.begin() + std::ptrdiff_t(n), expected.end(), k_untouched);
    const auto got = target.read_all<uint32_t>();
    const auto totals = total.read_all<uint32_t>();
    size_t bad = 0;
    for (size_t i = 0; i < k_words; ++i) bad += got[i] != expected[i];
    const uint32_t sum_of_all = std::accumulate(padded.begin(), padded.begin() + std::ptrdiff_t(n), 0u);
    return bad + (totals[2] != sum_of_all) + (totals[0] != k_untouched) + (totals[3] != k_untouched);
  }

  test::SilentDevice silent;
  gpu::ShaderCompiler compiler;
  sort::PrefixSum sum;
  gpu::Stream stream;
  gpu::Buffer in, out, total;
};

std::vector<uint32_t> random_values(uint32_t below) {
  std::mt19937 random(7);
  std::vector<uint32_t> values(k_most);
  for (uint32_t& v : values) v = below ? random() % below : uint32_t(random());
  return values;
}

}  // namespace

TEST_CASE("prefix sums of all sizes around powers of two, into another buffer and in place") {
  Scanner scanner;
  const auto values = random_values(1000);
  for (const uint32_t n : sizes())
    for (const bool in_place : {false, true}) {
      INFO(n << (in_place ? " in place" : ""));
      CHECK(scanner.wrong(values, {.most = n}, n, in_place) == 0);
    }
}

TEST_CASE("prefix sums in runs of a GPU's size") {
  const sort::Runs runs{.group = 64, .wanted = 16384, .least = 16, .most = 16384};
  Scanner scanner(&runs);
  const auto values = random_values(1000);
  for (const uint32_t n : {0u, 1u, 5u, 16u, 17u, 1023u, 65536u, 262144u, 262145u, k_most})
    CHECK(scanner.wrong(values, {.most = n}, n, true) == 0);
}

TEST_CASE("prefix sums wrap around at 2^32, like unsigned integers") {
  Scanner scanner;
  CHECK(scanner.wrong(random_values(0), {.most = 100000}, 100000, false) == 0);
  CHECK(scanner.wrong(std::vector<uint32_t>(k_most, 0xffffffffu), {.most = 70001}, 70001, true) == 0);
  CHECK(scanner.wrong(std::vector<uint32_t>(k_most, 0u), {.most = k_most}, k_most, true) == 0);
}

TEST_CASE("the number of elements can be in a buffer, limited by the capacity") {
  Scanner scanner;
  gpu::Buffer count(scanner.silent.device, {.name = "count", .bytes = 16});
  const auto values = random_values(50);
  for (const uint32_t n : {0u, 1u, 3u, 64u, 4095u, 4096u, 4097u, 100000u, 0xffffffffu}) {
    count.write(std::span<const uint32_t>({77u, 77u, n, 77u}));
    INFO(n);
    CHECK(scanner.wrong(values, {.most = 100000, .buffer = &count, .offset = 8}, std::min(n, 100000u),
                        n % 2 == 0) == 0);
  }
}

TEST_CASE("prefix sums of sixteen million elements") {
  test::SilentDevice silent;
  gpu::ShaderCompiler compiler;
  sort::PrefixSum sum(silent.device, compiler);
  gpu::Stream stream(silent.device);
  constexpr uint32_t n = 1u << 24;
  gpu::Buffer data(silent.device, {.name = "data", .bytes = n * 4ull, .texel = true});
  stream.fill(data, 3);
  sum.encode(stream, data, data, {.most = n});
  stream.run();
  const auto got = data.read_all<uint32_t>();
  size_t bad = 0;
  for (uint32_t i = 0; i < n; ++i) bad += got[i] != 3 * i;
  CHECK(bad == 0);
}

TEST_CASE("a prefix sum beyond the capacity is refused") {
  Scanner scanner;
  CHECK_THAT(
      test::error_of([&] { scanner.sum.encode(scanner.stream, scanner.in, scanner.total, {.most = 5}); }),
      Contains("'total'") && Contains("5 elements"));
  CHECK_THAT(test::error_of(
                 [&] { scanner.sum.encode(scanner.stream, scanner.in, scanner.out, {.most = k_words + 1}); }),
             Contains("'in'"));
}

}  // namespace sort_scan_tests
