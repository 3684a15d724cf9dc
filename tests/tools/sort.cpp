#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "sort/radix_sort.h"
#include "tools/timing.h"
#include "tools/tools.h"

namespace lucerna::tools {
namespace {

using Json = nlohmann::ordered_json;

/// One figure: elements per second of one method.
struct Row {
  std::string task, method;
  uint32_t size = 0;
  Timing time;
  double ratio = 0;  ///< speed relative to the first host function of the same task
};

struct Bench {
  gpu::Device& device;
  gpu::ShaderCompiler& compiler;
  gpu::Stream& stream;
  uint32_t seed;
  int repeats;
  std::vector<Row> rows;

  void measure(const std::string& what, uint32_t size, const std::vector<std::string>& names,
               const std::vector<Timed>& timed) {
    const auto times = take_turns(timed, repeats);
    for (size_t i = 0; i < times.size(); ++i)
      rows.push_back({what, names[i], size, times[i], times.front().median / times[i].median});
  }
  gpu::Buffer texels(uint64_t bytes) {
    return {device, {.name = "bench", .bytes = (bytes + 15) / 16 * 16, .texel = true}};
  }

  void scan(sort::PrefixSum& sum, uint32_t size) {
    std::vector<uint32_t> values(size), host(size);
    std::mt19937 random(seed);
    for (uint32_t& v : values) v = random() % 1000;
    gpu::Buffer in = texels(size * 4ull), out = texels(size * 4ull);
    in.write(std::span<const uint32_t>(values));
    measure("prefix sum", size, {"std::exclusive_scan", "device"},
            {{{}, [&] { std::exclusive_scan(values.begin(), values.end(), host.begin(), 0u); }},
             {{}, [&] {
                sum.encode(stream, in, out, {.most = size});
                stream.run();
              }}});
    if (out.read_all<uint32_t>()[size - 1] != host[size - 1])
      throw Error("sort", "device and host disagree on a prefix sum");
  }

  template <class Entry, class Key>
  void sort(sort::RadixSort& sorter, uint32_t size, uint32_t bits, const Key& key) {
    std::vector<Entry> values(size), stable, unstable;
    std::mt19937_64 random(seed);
    for (uint32_t i = 0; i < size; ++i) {
      const uint64_t k = random() >> (64 - bits);
      if constexpr (sizeof(Entry) == sizeof(shared::SortEntry64))
        values[i] = {uint32_t(k), uint32_t(k >> 32), i, 0};
      else
        values[i] = {uint32_t(k), i};
    }
    gpu::Buffer original = texels(size * sizeof(Entry)), a = texels(size * sizeof(Entry)),
                b = texels(size * sizeof(Entry));
    original.write(std::span<const Entry>(values));
    const gpu::Buffer* result = nullptr;
    const auto less = [&](const Entry& x, const Entry& y) { return key(x) < key(y); };
    measure(fmt::format("sort, {} of {} bits", bits, sizeof(Entry) == 16 ? 64 : 32), size,
            {"std::sort", "std::stable_sort", "device"},
            {{[&] { unstable = values; }, [&] { std::sort(unstable.begin(), unstable.end(), less); }},
             {[&] { stable = values; }, [&] { std::stable_sort(stable.begin(), stable.end(), less); }},
             {[&] {
                stream.copy(original, a, original.bytes());
                stream.run();
              },
              [&] {
                result = &sorter.encode(stream, a, b, {.most = size}, bits);
                stream.run();
              }}});
    const auto got = result->read_all<Entry>();
    for (uint32_t i = 0; i < size; ++i)
      if (got[i].value != stable[i].value) throw Error("sort", "device and host disagree on a sort");
  }
};

std::string to_text(const std::vector<Row>& rows, const std::string& device, int repeats) {
  std::string text = fmt::format(
      "million elements per second, median of {} (range); 'factor' over the first of each, on one thread; on "
      "{}\n",
      repeats, device);
  for (const Row& r : rows) {
    const auto rate = [&](double seconds) { return 1e-6 * r.size / seconds; };
    text +=
        fmt::format("{:<22}{:>9}  {:<20}{:>10.3f} ms {:>9.1f} ({:.1f} to {:.1f})", r.task, r.size, r.method,
                    1e3 * r.time.median, rate(r.time.median), rate(r.time.high), rate(r.time.low));
    text += fmt::format("  factor {:.2f}\n", r.ratio);
  }
  return text;
}

}  // namespace

int measure_sort(const SortArguments& a) {
  gpu::Device device({a.device, false});
  gpu::ShaderCompiler compiler;
  gpu::Stream stream(device);
  Bench bench{device, compiler, stream, a.seed, a.repeats, {}};
  sort::PrefixSum sum(device, compiler);
  sort::RadixSort pairs(device, compiler, sort::Keys::bits32), wide(device, compiler, sort::Keys::bits64);
  for (const uint32_t size : a.sizes) {
    bench.scan(sum, size);
    for (const uint32_t bits : {32u, 24u})
      bench.sort<shared::SortPair>(pairs, size, bits, [](const auto& e) { return e.key; });
    bench.sort<shared::SortEntry64>(wide, size, 64,
                                    [](const auto& e) { return uint64_t(e.high) << 32 | e.low; });
  }
  std::printf("%s", to_text(bench.rows, device.info().name, a.repeats).c_str());
  if (a.json.empty()) return 0;
  Json j{{"device", device.info().name}, {"repeats", a.repeats}, {"seed", a.seed}, {"rows", Json::array()}};
  for (const Row& r : bench.rows)
    j["rows"].push_back({{"task", r.task},
                         {"method", r.method},
                         {"size", r.size},
                         {"seconds", {{"median", r.time.median}, {"low", r.time.low}, {"high", r.time.high}}},
                         {"elements_per_s", r.size / r.time.median},
                         {"factor_over_first", r.ratio}});
  write_file(a.json, json_text(j, 2) + "\n");
  return 0;
}

}  // namespace lucerna::tools
