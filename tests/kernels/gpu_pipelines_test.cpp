// links: gpu
// Kernels of the same content share a pipeline, also one after the other; different ones never do.
#include <fstream>
#include <numeric>
#include <optional>

#include "gpu/vulkan.h"
#include "kernels/gpu_support.h"

namespace gpu_pipelines_tests {

using namespace lucerna;
using namespace lucerna::gpu;

namespace {

struct Bed {
  test::SilentDevice silent;
  ShaderCompiler compiler;
  Buffer marks{silent.device, {"marks", 64 * 4}}, total{silent.device, {"total", 4}},
      arguments{silent.device, {"arguments", 12}};
  Resources resources;

  Bed() {
    resources.set("Marks", marks);
    resources.set("Total", total);
    resources.set("Arguments", arguments);
  }
  Kernel count(uint32_t step, uint32_t workgroup = 16) {
    return {silent.device, compiler, test::shader("gpu_count.comp"), {}, {{0, workgroup}, {1, step}}};
  }
  /// The number that the kernel adds to each of its 64 marks; 0 if they differ.
  uint32_t step_of(const Kernel& kernel) {
    const std::vector<uint32_t> none(64, 0);
    marks.write(std::span<const uint32_t>(none));
    const uint32_t push[] = {64, 0};
    Stream stream(silent.device);
    stream.dispatch(kernel, resources, push, groups_for(64, kernel.workgroup_size()));
    stream.run();
    const auto values = marks.read_all<uint32_t>();
    for (const uint32_t value : values)
      if (value != values[0]) return 0;
    return values[0];
  }
  uint64_t made() { return silent.device.handles().pipelines.made(); }
};

}  // namespace

TEST_CASE("a kernel that is built again reuses the pipeline, beside the first or after it") {
  Bed bed;
  std::optional<Kernel> first = bed.count(3);
  CHECK(bed.made() == 1);
  Kernel second = bed.count(3);
  CHECK(bed.made() == 1);
  CHECK(bed.step_of(*first) == 3);
  first.reset();
  CHECK(bed.step_of(second) == 3);
  second = {};
  const Kernel third = bed.count(3);
  CHECK(bed.made() == 1);
  CHECK(bed.step_of(third) == 3);
  CHECK(third.workgroup_size() == 16);
}

TEST_CASE("kernels that differ in a constant, a define or a line of source do not share") {
  Bed bed;
  const Kernel three = bed.count(3), five = bed.count(5), wide = bed.count(3, 32);
  CHECK(bed.made() == 3);
  CHECK(bed.step_of(three) == 3);
  CHECK(bed.step_of(five) == 5);
  CHECK(bed.step_of(wide) == 3);

  const test::Folder folder;
  const auto edited = [&](const char* step) {
    std::ofstream(folder / "edited.comp")
        << "#include \"shaders/lib/invocation.glsl\"\n"
           "layout(local_size_x = 16) in;\n"
           "layout(push_constant) uniform Push { uint count; uint unused; } push;\n"
           "buffer Marks { uint marks[]; };\n"
           "void main() { if (global_index() < push.count) marks[global_index()] += "
        << step << "; }\n";
    return folder / "edited.comp";
  };
  const std::string file = edited("7u");
  const Kernel before(bed.silent.device, bed.compiler, file);
  CHECK(bed.made() == 4);
  edited("STEP");
  const Kernel after(bed.silent.device, bed.compiler, file, {{"STEP", "8u"}});
  const Kernel other(bed.silent.device, bed.compiler, file, {{"STEP", "9u"}});
  CHECK(bed.made() == 6);
  CHECK(bed.step_of(before) == 7);
  CHECK(bed.step_of(after) == 8);
  CHECK(bed.step_of(other) == 9);
}

TEST_CASE("pipelines in use are kept, and the most recent unused ones") {
  Bed bed;
  const Kernel used = bed.count(1);
  const uint32_t spare = Pipelines::k_spare;
  for (uint32_t step = 2; step < 2 + spare + 2; ++step) CHECK(bed.count(step));
  CHECK(bed.made() == spare + 3);
  const Kernel again = bed.count(1);
  const Kernel late = bed.count(spare + 3), oldest_kept = bed.count(4);
  CHECK(bed.made() == spare + 3);
  const Kernel dropped = bed.count(2);
  CHECK(bed.made() == spare + 4);
  CHECK(bed.step_of(used) == 1);
  CHECK(bed.step_of(dropped) == 2);
}

}  // namespace gpu_pipelines_tests
