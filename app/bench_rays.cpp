#include <cstdio>
#include <optional>

#include "app/verbs.h"
#include "base/error.h"
#include "base/timer.h"
#include "bvh/embree/build.h"
#include "bvh/embree/host_tracer.h"
#include "bvh/embree/reference.h"
#include "raybench/report.h"
#include "scene/io/load.h"
#include "scene/range.h"

namespace lucerna::app {

int bench_rays(const BenchRaysArguments& a) {
  const scene::Scene scene = scene::load(a.scene, a.scenes);
  raybench::FlatFile flat{.name = scene.name, .scene = upload::flatten(scene), .tree = {}, .camera = {}};
  if (flat.scene.triangles.empty()) throw Error(a.scene, "there are no triangles to trace");
  flat.camera = scene::starting_camera(scene, a.camera);
  scene::check_range(flat.camera);
  const bvh::Triangles triangles{flat.scene.positions, flat.scene.non_opaque};
  flat.tree = bvh::build(triangles);
  if (!a.flat.empty()) {
    raybench::write(a.flat, flat);
    std::fprintf(stderr, "lucerna: wrote %s\n", a.flat.c_str());
  }
  gpu::Device device({a.device, false});
  gpu::ShaderCompiler compiler;
  // Every triangle is opaque for these rays, because plain Embree has no other kind.
  const bvh::Triangles opaque{flat.scene.positions, {}};
  raybench::ComputeTracer compute(device, compiler,
                                  flat.tree.has_non_opaque ? bvh::build(opaque) : flat.tree);
  const bvh::HostTracer host(opaque);
  const bvh::EmbreeReference embree(opaque);
  const auto sets = raybench::make_rays(flat, a.rays, a.seed, [&](bvh::Query query, auto rays, auto hits) {
    host.trace(query, rays, hits, nullptr, uint32_t(rays.size()), false);
  });
  const raybench::Tracer tracers[] = {
      {"compute-bvh", [&](const auto& set, auto hits) { return compute.trace(set, hits); }},
      {"host",
       [&](const auto& set, auto hits) {
         const Timer timer;
         host.trace(set.query, set.rays, hits, nullptr, uint32_t(set.rays.size()), set.coherent);
         return timer.seconds();
       }},
      {"embree single", [&](const auto& set, auto hits) {
         const Timer timer;
         embree.trace(set.query, set.rays, hits);
         return timer.seconds();
       }}};
  raybench::Report report{.scene = scene.name,
                          .device = device.info().name,
                          .triangles = flat.tree.primitive_count,
                          .tree_nodes = flat.tree.node_count,
                          .tree_depth = flat.tree.max_depth};
  report.repeats = a.repeats;
  report.rates = raybench::measure(tracers, sets, a.repeats);
  for (const auto& t : tracers) report.tracers.push_back(t.name);
  uint64_t differences = 0;
  for (const auto& s : sets) {
    report.sets.push_back(s.name), report.set_sizes.push_back(s.rays.size());
    differences += raybench::count_differences(tracers[0], tracers[1], s);
  }
  report.frame_options = {.width = a.width, .height = a.height, .samples = a.samples, .seed = a.seed};
  if (a.samples) {
    // If all triangles are opaque the rays' tracer is used for the frame too.
    std::optional<bvh::HostTracer> with_flags;
    if (flat.tree.has_non_opaque) with_flags.emplace(triangles);
    const bvh::HostTracer& host_of_frame = with_flags ? *with_flags : host;
    const transport::HostTrace trace = [&](bvh::Query query, auto rays, auto hits, const uint32_t* queue,
                                           uint32_t count, bool coherent) {
      host_of_frame.trace(query, rays, hits, queue, count, coherent);
    };
    raybench::PathTracedFrame on_device(device, compiler, flat, report.frame_options, {}),
        on_host(device, compiler, flat, report.frame_options, trace);
    raybench::PathTracedFrame* const frames[] = {&on_device, &on_host};
    const auto times = raybench::measure(frames, a.repeats);
    report.frames = {{"compute-bvh", times[0]}, {"host", times[1]}};
  }
  if (a.json) {
    std::printf("%s\n", raybench::to_json(report).c_str());
  } else {
    std::printf("%srays for which compute-bvh and host disagree: %llu\n",
                raybench::to_text(report, "embree single").c_str(), (unsigned long long)differences);
  }
  return 0;
}

}  // namespace lucerna::app
