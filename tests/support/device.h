#pragma once
// The device shared by tests of whole pictures: created once per process, so the second renderer reuses the
// first one's kernels.
#include <cstdlib>
#include <memory>
#include <string_view>

#include "session/renderer.h"
#include "support/device_name.h"

namespace lucerna::test {

/// False if LUCERNA_TEST_VALIDATION is 0. The validation layers take up to half of a test's time, so ctest
/// uses them where commands are recorded that no other test records (tests/CMakeLists.txt); by hand a test
/// has them.
inline bool with_validation() {
  const char* wanted = std::getenv("LUCERNA_TEST_VALIDATION");
  return !wanted || std::string_view(wanted) != "0";
}

/// The device is created before its variable: it is then destroyed before the driver's own exit handlers.
inline std::shared_ptr<gpu::Device> shared_device(bool validation) {
  const auto make = [&] {
    return std::make_shared<gpu::Device>(gpu::DeviceOptions{device_name(), validation});
  };
  if (validation && with_validation()) {
    static const std::shared_ptr<gpu::Device> validated = make();
    return validated;
  }
  static const std::shared_ptr<gpu::Device> plain = make();
  return plain;
}

inline session::RendererOptions renderer_options(bool validation = true, const gpu::Defines& defines = {},
                                                 bool interactive = false) {
  return {.device = device_name(),
          .validation = validation && with_validation(),
          .shaders = {},
          .defines = defines,
          .interactive = interactive,
          .on = shared_device(validation)};
}

}  // namespace lucerna::test
