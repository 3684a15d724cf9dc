#pragma once
// Which device the tests of kernels and pictures run on.
#include <cstdlib>
#include <string>

namespace lucerna::test {

/// What LUCERNA_TEST_DEVICE says, in the words of LUCERNA_DEVICE: an index, part of a name, cpu or gpu.
/// Without it cpu, so that a result does not depend on the machine.
inline std::string device_name() {
  const char* chosen = std::getenv("LUCERNA_TEST_DEVICE");
  return chosen && *chosen ? chosen : "cpu";
}

}  // namespace lucerna::test
