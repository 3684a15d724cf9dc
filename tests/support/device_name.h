#pragma once
// The device of the tests of kernels and pictures.
#include <cstdlib>
#include <string>

namespace lucerna::test {

/// The value of LUCERNA_TEST_DEVICE, in the form of LUCERNA_DEVICE: an index, part of a name, cpu or gpu.
/// Default: cpu, so that a result does not depend on the machine.
inline std::string device_name() {
  const char* chosen = std::getenv("LUCERNA_TEST_DEVICE");
  return chosen && *chosen ? chosen : "cpu";
}

}  // namespace lucerna::test
