#pragma once
// The device that tests of whole pictures share: made once a process, so that the second renderer finds the
// first one's kernels.
#include <memory>

#include "session/renderer.h"

namespace lucerna::test {

inline std::shared_ptr<gpu::Device> shared_device(bool validation) {
  static std::shared_ptr<gpu::Device> devices[2];
  std::shared_ptr<gpu::Device>& device = devices[validation];
  if (!device) device = std::make_shared<gpu::Device>(gpu::DeviceOptions{"cpu", validation});
  return device;
}

inline session::RendererOptions renderer_options(bool validation = true, const gpu::Defines& defines = {},
                                                 bool interactive = false) {
  return {.device = "cpu",
          .validation = validation,
          .shaders = {},
          .defines = defines,
          .interactive = interactive,
          .on = shared_device(validation)};
}

}  // namespace lucerna::test
