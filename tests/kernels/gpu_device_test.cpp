// links: gpu
#include <thread>

#include "kernels/gpu_support.h"

namespace gpu_device_tests {

using namespace lucerna;
using namespace lucerna::gpu;
using Catch::Matchers::Contains;
using test::error_of;

TEST_CASE("devices are listed with their limits, and at least one is usable") {
  const auto devices = enumerate();
  REQUIRE_FALSE(devices.empty());
  bool usable = false;
  for (const DeviceInfo& d : devices) {
    CHECK(d.index == static_cast<uint32_t>(&d - devices.data()));
    CHECK_FALSE(d.name.empty());
    CHECK(d.memory_bytes > 0);
    if (!d.missing.empty()) continue;
    usable = true;
    CHECK(d.limits.max_storage_buffer >= 128u << 20);
    CHECK(d.limits.max_texel_elements >= 65536);
    CHECK(d.limits.max_workgroups_x >= k_most_groups);
    CHECK(d.limits.subgroup_size > 0);
    CHECK(d.device_uuid != std::array<uint8_t, 16>{});
  }
  CHECK(usable);
}

TEST_CASE("a device is chosen by index, part of its name or kind") {
  const auto devices = enumerate();
  for (const DeviceInfo& d : devices) {
    if (!d.missing.empty()) continue;
    CHECK(Device({std::to_string(d.index)}).info().name == d.name);
    std::string shouted = d.name.substr(0, 6);
    for (char& c : shouted) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    CHECK_THAT(Device({shouted}).info().name, Contains(d.name.substr(0, 6)));
    CHECK(Device({d.is_cpu ? "cpu" : "gpu"}).info().is_cpu == d.is_cpu);
  }
}

TEST_CASE("an unknown device is refused with the list of devices") {
  const std::string name = enumerate().front().name;
  CHECK_THAT(error_of([] { Device({"no such device"}); }),
             Contains("'no such device'") && Contains("0: " + name));
  CHECK_THAT(error_of([] { Device({"4711"}); }), Contains("'4711'"));
  CHECK_THAT(error_of([] { Device({"99999999999999999999"}); }), Contains("99999999999999999999"));
}

TEST_CASE("LUCERNA_DEVICE is the default, and an option overrides it") {
  setenv("LUCERNA_DEVICE", "no such device", 1);
  CHECK_THAT(error_of([] { Device(); }), Contains("no such device"));
  CHECK_NOTHROW(Device({"0"}));
  unsetenv("LUCERNA_DEVICE");
  CHECK_NOTHROW(Device());
}

TEST_CASE("devices can be created and destroyed on several threads at once") {
  std::vector<std::thread> threads;
  std::atomic<int> good{0};
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&good, i] {
      Device device({"", i % 2 == 0});
      Buffer buffer(device, {"own", 1024});
      const std::vector<int> values(256, i);
      buffer.write(std::span<const int>(values));
      good += buffer.read_all<int>() == values && !enumerate().empty();
    });
  for (auto& thread : threads) thread.join();
  CHECK(good == 4);
}

}  // namespace gpu_device_tests
