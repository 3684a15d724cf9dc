// links: gpu
// Sums beyond 32 bits are exact for any order of additions.
#include "shaders/shared/wide_sum.h"
#include <cmath>

#include "kernels/gpu_support.h"

namespace wide_sum_tests {

using namespace lucerna;
using namespace lucerna::gpu;

TEST_CASE("a sum over many invocations is exact beyond 32 bits") {
  test::SilentDevice silent;
  ShaderCompiler compiler;
  const Kernel kernel(silent.device, compiler, test::shader("wide_sum.comp"));
  Buffer sum(silent.device, {"sum", sizeof(shared::WideSum), Memory::host});
  Resources resources;
  resources.set("Sum", sum);
  Stream stream(silent.device);
  struct Push {
    uint32_t count, each;
  };
  for (const Push push : {Push{1, 0}, {1000, 1}, {100000, 0xfffe0000u}, {200000, 0x7fffffffu}}) {
    INFO(push.count << " " << push.each);
    uint64_t expected = 0;
    for (uint32_t i = 0; i < push.count; ++i) expected += i % 3 == 0 ? 0 : uint32_t(push.each + i);
    stream.fill(sum, 0);
    stream.dispatch(kernel, resources, push, groups_for(push.count, 64));
    stream.run();
    CHECK(value(*static_cast<const shared::WideSum*>(sum.mapped())) == expected);
  }
}

__extension__ using Wide = unsigned __int128;

TEST_CASE("a sum of three words carries from each to the next, and accepts floats") {
  test::SilentDevice silent;
  ShaderCompiler compiler;
  const Kernel kernel(silent.device, compiler, test::shader("long_sum.comp"));
  Buffer sum(silent.device, {"sum", sizeof(shared::LongSum), Memory::host});
  Resources resources;
  resources.set("Sum", sum);
  Stream stream(silent.device);
  struct Push {
    uint32_t count;
    float each;
  };
  // The first words overflow, the middle ones, and both at once.
  for (const Push push : {Push{1, 0},
                          {1000, 1},
                          {70000, 4294967040.0f},
                          {70000, 0x1.fffffep63f},
                          {100000, 0x1.000002p63f},
                          {30000, 0x1.fffffep40f},
                          {7, 0.75f}}) {
    INFO(push.count << " " << push.each);
    stream.fill(sum, 0);
    stream.dispatch(kernel, resources, push, groups_for(push.count, 64));
    stream.run();
    const auto& found = *static_cast<const shared::LongSum*>(sum.mapped());
    const auto each = static_cast<Wide>(std::floor(double(push.each)));
    const Wide all = each * push.count;
    CHECK(found.low == uint32_t(all));
    CHECK(found.middle == uint32_t(all >> 32));
    CHECK(found.high == uint32_t(all >> 64));
    CHECK(value(found) == Approx(std::floor(double(push.each)) * push.count).epsilon(1e-12));
  }
}

}  // namespace wide_sum_tests
