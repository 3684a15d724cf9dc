// The ray bench as a separate program: reads a flattened scene, needs only a Vulkan driver.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "base/huge_pages.h"
#include "raybench/report.h"

namespace {

using namespace lucerna;

int run(int argc, char** argv) {
  CLI::App app{
      "Measures lucerna's compute tracer on a flattened scene (made by 'lucerna bench rays SCENE --flat "
      "FILE')"};
  app.set_version_flag("--version", LUCERNA_VERSION);
  std::string file, device_name;
  uint32_t count = 1 << 20;
  int repeats = 5;
  bool json = false, variants = false;
  raybench::FrameOptions frame;
  app.add_option("FILE", file, "flattened scene")->required();
  app.add_option("--device", device_name, "device: index, part of a name, cpu or gpu (also LUCERNA_DEVICE)");
  app.add_option("--rays", count, "primary rays")->check(CLI::Range(64u, 1u << 24))->capture_default_str();
  app.add_option("--repeats", repeats, "measurements of each figure")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--samples", frame.samples, "samples per pixel of the path-traced frame; 0: none")
      ->check(CLI::Range(0u, 1u << 20))
      ->capture_default_str();
  app.add_option("--width", frame.width, "width of the frame")
      ->check(CLI::Range(1u, 16384u))
      ->capture_default_str();
  app.add_option("--height", frame.height, "height of the frame")
      ->check(CLI::Range(1u, 16384u))
      ->capture_default_str();
  app.add_option("--batch", frame.slots, "paths in flight")
      ->check(CLI::Range(64u, 1u << 24))
      ->capture_default_str();
  app.add_flag("--variants", variants, "also measure other node fetches and stacks");
  app.add_flag("--json", json, "as JSON");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 1;
  }
  const raybench::FlatFile scene = raybench::read(file);
  gpu::Device device({device_name, false});
  gpu::ShaderCompiler compiler;
  raybench::ComputeTracer compute(device, compiler, scene.tree);
  const auto sets = raybench::make_rays(scene, count, 1, [&](bvh::Query query, auto rays, auto hits) {
    compute.trace({"", query, false, {rays.begin(), rays.end()}}, hits);
  });
  std::vector<std::unique_ptr<raybench::ComputeTracer>> others;
  std::vector<raybench::Tracer> tracers;
  const auto add = [&](std::string name, raybench::ComputeTracer* tracer) {
    tracers.push_back(
        {std::move(name), [tracer](const auto& set, auto hits) { return tracer->trace(set, hits); }});
  };
  add("compute-bvh", &compute);
  if (variants) {
    const std::pair<const char*, gpu::Defines> list[] = {
        {"storage buffer", {{"LUCERNA_FETCH_STORAGE", "1"}}},
        {"local stack", {{"LUCERNA_STACK_LOCAL", "1"}}},
        {"storage, local", {{"LUCERNA_FETCH_STORAGE", "1"}, {"LUCERNA_STACK_LOCAL", "1"}}}};
    for (const auto& [name, defines] : list) {
      others.push_back(std::make_unique<raybench::ComputeTracer>(device, compiler, scene.tree, defines));
      add(name, others.back().get());
    }
  }
  raybench::Report report{.scene = scene.name,
                          .device = device.info().name,
                          .triangles = scene.tree.primitive_count,
                          .tree_nodes = scene.tree.node_count,
                          .tree_depth = scene.tree.max_depth};
  report.repeats = repeats;
  report.rates = raybench::measure(tracers, sets, repeats);
  for (const auto& t : tracers) report.tracers.push_back(t.name);
  for (const auto& s : sets) report.sets.push_back(s.name), report.set_sizes.push_back(s.rays.size());
  report.frame_options = frame;
  if (frame.samples) {
    raybench::PathTracedFrame on_device(device, compiler, scene, frame, {});
    raybench::PathTracedFrame* const frames[] = {&on_device};
    report.frames = {{"compute-bvh", raybench::measure(frames, repeats).front()}};
  }
  std::printf("%s\n", (json ? raybench::to_json(report) : raybench::to_text(report, "")).c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  lucerna::separate_large_allocations();
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "lucerna-raybench: %s\n", e.what());
    return 1;
  }
}
