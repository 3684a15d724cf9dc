// links: gpu
#include <numeric>

#include "gpu/memory.h"
#include "kernels/gpu_support.h"

namespace gpu_resources_tests {

using namespace lucerna;
using namespace lucerna::gpu;
using Catch::Matchers::Contains;
using test::error_of;

namespace {

std::vector<uint32_t> counting(size_t n) {
  std::vector<uint32_t> values(n);
  std::iota(values.begin(), values.end(), 1u);
  return values;
}

}  // namespace

TEST_CASE("buffers return what was written, in both memories, smaller and larger than the staging buffer") {
  const bool map_device_memory = GENERATE(true, false);
  test::SilentDevice silent(map_device_memory);
  for (const Memory memory : {Memory::device, Memory::host})
    for (const size_t count : {1u, 5u, 1000u, 5000003u}) {
      Buffer buffer(silent.device, {"round trip", count * 4, memory});
      CHECK(buffer.bytes() == count * 4);
      const auto values = counting(count);
      buffer.write(std::span<const uint32_t>(values));
      CHECK(buffer.read_all<uint32_t>() == values);
      if (memory == Memory::host) CHECK(buffer.mapped() != nullptr);
      if (memory == Memory::device && !map_device_memory) CHECK(buffer.mapped() == nullptr);
      const uint32_t patch[] = {77};
      buffer.write(std::span<const uint32_t>(patch), count - 1);
      uint32_t last = 0;
      buffer.read(&last, 4, (count - 1) * 4);
      CHECK(last == 77);
    }
}

TEST_CASE("reading or writing beyond a buffer is refused") {
  test::SilentDevice silent;
  Buffer buffer(silent.device, {"small", 100});
  char data[200] = {};
  CHECK_THAT(error_of([&] { buffer.write(data, 101); }), Contains("'small'") && Contains("100 bytes"));
  CHECK_THAT(error_of([&] { buffer.read(data, 1, 100); }), Contains("'small'"));
  CHECK_THAT(error_of([&] { buffer.read(data, 8, ~0ull - 3); }), Contains("'small'"));
  CHECK_NOTHROW(buffer.read(data, 100));
  CHECK_THAT(error_of([&] { Buffer().write(data, 1); }), Contains("empty"));
}

TEST_CASE("an empty buffer is valid, and a moved-from one holds nothing") {
  test::SilentDevice silent;
  Buffer none(silent.device, {"none", 0});
  CHECK(none);
  CHECK(none.bytes() == 0);
  Buffer moved = std::move(none);
  CHECK(moved);
  CHECK_FALSE(none);
  CHECK(none.bytes() == 0);
  moved = Buffer(silent.device, {"other", 64});
  CHECK(moved.name() == "other");
}

TEST_CASE("memory is accounted, released and reused") {
  test::SilentDevice silent;
  Device& device = silent.device;
  const uint64_t before = device.allocated_bytes();
  {
    std::vector<Buffer> buffers;
    for (uint64_t i = 0; i < 200; ++i)
      buffers.emplace_back(device, BufferDesc{"piece", 1000 + 997 * i % 100000});
    const uint64_t with_small = device.allocated_bytes();
    CHECK(with_small > before);
    Buffer large(device, {"large", 8 << 20});
    CHECK(device.allocated_bytes() >= with_small + (8 << 20));
    // Neighbours must not overlap after any sequence of releases and reuse.
    for (size_t i = 0; i < buffers.size(); i += 2) buffers[i] = Buffer();
    for (size_t i = 0; i < buffers.size(); i += 2)
      buffers[i] = Buffer(device, {"again", 500 + 991 * i % 50000});
    for (size_t i = 0; i < buffers.size(); ++i) {
      const std::vector<uint8_t> fill(buffers[i].bytes(), static_cast<uint8_t>(i));
      buffers[i].write(fill.data(), fill.size());
    }
    int wrong = 0;
    for (size_t i = 0; i < buffers.size(); ++i)
      for (const uint8_t byte : buffers[i].read_all<uint8_t>()) wrong += byte != static_cast<uint8_t>(i);
    CHECK(wrong == 0);
  }
  CHECK(device.allocated_bytes() == before);
  CHECK(device.peak_bytes() >= before + (8 << 20));
}

TEST_CASE("a resource beyond the device's limits is refused by name, size and limit") {
  test::SilentDevice silent;
  Device& device = silent.device;
  const Limits& limits = device.info().limits;
  CHECK_THAT(error_of([&] {
               Buffer(device, {"film sums", limits.max_storage_buffer + 16});
             }),
             Contains("'film sums'") && Contains("maxStorageBufferRange"));
  CHECK_THAT(error_of([&] {
               Buffer(device, {"vertices", limits.max_texel_elements * 16 + 16, Memory::device, true});
             }),
             Contains("'vertices'") && Contains("maxTexelBufferElements"));
  CHECK_THAT(error_of([&] { Buffer(device, {"odd", 24, Memory::device, true}); }), Contains("16 bytes"));
  CHECK_THAT(error_of([&] {
               TextureArray(device, {"wide", limits.max_image_size + 1, 1, 1});
             }),
             Contains("'wide'") && Contains("maxImageDimension2D"));
  CHECK_THAT(error_of([&] {
               TextureArray(device, {"deep", 1, 1, limits.max_image_layers + 1});
             }),
             Contains("'deep'") && Contains("maxImageArrayLayers"));
  CHECK_THAT(error_of([&] { TextureArray(device, {"flat", 4, 0, 1}); }), Contains("'flat'"));
}

TEST_CASE("when memory runs out the message names the resource, and existing resources stay usable") {
  test::SilentDevice silent;
  Device& device = silent.device;
  Buffer kept(device, {"kept", 4096});
  const auto values = counting(1024);
  kept.write(std::span<const uint32_t>(values));
  const uint64_t before = device.allocated_bytes();
  // 4 bytes * 16384 * 16384 * layers exceeds every present device; nothing is touched.
  const uint32_t side = std::min(16384u, device.info().limits.max_image_size);
  const uint32_t layers = device.info().limits.max_image_layers;
  const std::string message = error_of([&] {
    TextureArray(device, {"sky", side, side, layers, TexelFormat::rgba32f});
  });
  CHECK_THAT(message, Contains("'sky'") && Contains("iB"));
  CHECK(device.allocated_bytes() == before);
  CHECK(kept.read_all<uint32_t>() == values);
}

TEST_CASE("sizes are formatted for readers") {
  CHECK(format_bytes(640) == "640 bytes");
  CHECK(format_bytes(2048) == "2 KiB");
  CHECK(format_bytes(99ull << 20) == "99 MiB");
  CHECK(format_bytes(3ull << 29) == "1.5 GiB");
}

}  // namespace gpu_resources_tests
