// links: gpu
// Sums beyond 32 bits are exact, however the additions meet.
#include "shaders/shared/wide_sum.h"
#include "kernels/gpu_support.h"

using namespace lucerna;
using namespace lucerna::gpu;

TEST_CASE("a sum of many invocations is exact beyond 32 bits") {
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
