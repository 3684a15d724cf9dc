#pragma once
// Shared by the tests of gpu/: their device, and the folder of their shaders.
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "gpu/stream.h"
#include "support/folder.h"

namespace lucerna::test {

/// A validated device, whose destructor requires that there were no validation messages.
struct SilentDevice {
  explicit SilentDevice(bool map_device_memory = true) : device({"", true, map_device_memory}) {
    REQUIRE(device.validation_active());
  }
  ~SilentDevice() { CHECK(device.validation_messages() == 0); }
  gpu::Device device;
};

inline std::string shader(const std::string& file) {
  return std::string(LUCERNA_SOURCE_DIR) + "/tests/kernels/shaders/" + file;
}

/// The message of the Error that `call` throws, or "no error".
template <class Call>
std::string error_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace lucerna::test
