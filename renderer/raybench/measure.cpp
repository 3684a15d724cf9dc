#include "raybench/measure.h"

#include <algorithm>

#include "base/timer.h"
#include "schedule/uniform.h"
#include "shaders/shared/trace.h"
#include "transport/frame.h"

namespace lucerna::raybench {

using namespace shared;

struct ComputeTracer::Impl {
  gpu::Device& device;
  gpu::Stream stream;
  gpu::Kernel closest, any;
  gpu::Buffer nodes, triangles, rays, hits, queue;
  gpu::Resources resources;
  const RaySet* uploaded = nullptr;
  explicit Impl(gpu::Device& d) : device(d), stream(d) {}
};

ComputeTracer::ComputeTracer(gpu::Device& device, gpu::ShaderCompiler& compiler, const bvh::BvhData& tree,
                             const gpu::Defines& defines)
    : impl_(std::make_unique<Impl>(device)) {
  Impl& t = *impl_;
  const auto kernel = [&](const char* query) {
    gpu::Defines all = defines;
    all["LUCERNA_QUERY"] = query;
    if (tree.has_non_opaque) all["LUCERNA_NON_OPAQUE"] = "1";
    return gpu::Kernel(device, compiler, "trace.comp", all);
  };
  t.closest = kernel("0");
  t.any = kernel("1");
  t.nodes =
      gpu::Buffer(device, {.name = "BVH nodes", .bytes = tree.nodes.size() * sizeof(uvec4), .texel = true});
  t.triangles = gpu::Buffer(device, {.name = "BVH triangles",
                                     .bytes = std::max<size_t>(16, tree.triangles.size() * sizeof(vec4)),
                                     .texel = true});
  t.queue = gpu::Buffer(device, {.name = "no queue", .bytes = 16});
  t.nodes.write(std::span<const uvec4>(tree.nodes));
  t.triangles.write(std::span<const vec4>(tree.triangles));
  t.resources.set("bvh_nodes", t.nodes);
  t.resources.set("bvh_triangles", t.triangles);
  t.resources.set("Queue", t.queue);
}

ComputeTracer::~ComputeTracer() = default;

double ComputeTracer::trace(const RaySet& set, std::span<Hit> out) {
  Impl& t = *impl_;
  const auto count = uint32_t(set.rays.size());
  t.rays = gpu::Buffer(t.device, {.name = "rays", .bytes = count * sizeof(Ray), .texel = true});
  t.hits = gpu::Buffer(t.device, {.name = "hits", .bytes = count * sizeof(Hit), .texel = true});
  t.rays.write(std::span<const Ray>(set.rays));
  t.resources.set("Rays", t.rays);
  t.resources.set("ray_texels", t.rays);
  t.resources.set("Hits", t.hits);
  const gpu::Kernel& kernel = set.query == bvh::Query::closest ? t.closest : t.any;
  // The hits' memory is touched before the clock runs.
  t.stream.fill(t.hits, 0);
  t.stream.dispatch(kernel, t.resources, TracePush{1, 0}, 1);
  t.stream.run();
  const Timer timer;
  t.stream.dispatch(kernel, t.resources, TracePush{count, 0},
                    gpu::groups_for(count, kernel.workgroup_size()));
  t.stream.run();
  const double seconds = timer.seconds();
  t.hits.read(out.data(), count * sizeof(Hit));
  return seconds;
}

std::vector<std::vector<Rate>> measure(std::span<const Tracer> tracers, std::span<const RaySet> sets,
                                       int repeats) {
  std::vector<std::vector<Rate>> rates(tracers.size(), std::vector<Rate>(sets.size()));
  for (size_t s = 0; s < sets.size(); ++s) {
    std::vector<Hit> hits(sets[s].rays.size());
    std::vector<std::vector<double>> seen(tracers.size());
    for (int round = -1; round < repeats; ++round)
      for (size_t t = 0; t < tracers.size(); ++t) {
        const double seconds = tracers[t].trace(sets[s], hits);
        if (round >= 0) seen[t].push_back(1e-6 * double(hits.size()) / std::max(seconds, 1e-9));
      }
    for (size_t t = 0; t < tracers.size(); ++t) {
      std::sort(seen[t].begin(), seen[t].end());
      rates[t][s] = {seen[t][seen[t].size() / 2], seen[t].front(), seen[t].back()};
    }
  }
  return rates;
}

uint64_t count_differences(const Tracer& a, const Tracer& b, const RaySet& set) {
  std::vector<Hit> first(set.rays.size()), second(set.rays.size());
  a.trace(set, first);
  b.trace(set, second);
  uint64_t count = 0;
  for (size_t i = 0; i < first.size(); ++i) {
    const bool hit = first[i].prim != k_no_hit;
    count += hit != (second[i].prim != k_no_hit) ||
             (hit && set.query == bvh::Query::closest && first[i].prim != second[i].prim);
  }
  return count;
}

struct PathTracedFrame::Impl {
  FrameOptions options;
  upload::DeviceScene scene;
  transport::Wavefront wavefront;
  film::Film film;
  Impl(gpu::Device& device, gpu::ShaderCompiler& compiler, const FlatFile& file, const FrameOptions& o,
       const transport::HostTrace& host_trace)
      : options(o),
        scene(device, file.scene, file.tree),
        wavefront(device, compiler, scene, o.slots, host_trace),
        film(device, o.width, o.height) {}
};

PathTracedFrame::PathTracedFrame(gpu::Device& device, gpu::ShaderCompiler& compiler, const FlatFile& file,
                                 const FrameOptions& options, const transport::HostTrace& host_trace)
    : impl_(std::make_unique<Impl>(device, compiler, file, options, host_trace)) {
  impl_->wavefront.set_frame(
      transport::make_frame(file.scene, file.camera, paths::compile_components(),
                            {.width = options.width, .height = options.height, .seed = options.seed}),
      15);
}

PathTracedFrame::~PathTracedFrame() = default;

FrameTime PathTracedFrame::run() {
  Impl& f = *impl_;
  f.film.clear(f.wavefront.stream());
  f.wavefront.reset_stats();
  schedule::UniformSchedule schedule(f.film.blocks(), f.options.samples, f.wavefront.slots());
  const Timer timer;
  while (!schedule.done()) f.wavefront.run(schedule.next(), f.film);
  const double seconds = timer.seconds();
  return {seconds, f.wavefront.stats().rays, f.wavefront.stats().stages};
}

std::vector<FrameTime> measure(std::span<PathTracedFrame* const> frames, int repeats) {
  std::vector<std::vector<FrameTime>> seen(frames.size());
  for (int round = 0; round < repeats; ++round)
    for (size_t f = 0; f < frames.size(); ++f) seen[f].push_back(frames[f]->run());
  std::vector<FrameTime> medians;
  for (auto& times : seen) {
    std::sort(times.begin(), times.end(), [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
    medians.push_back(times[times.size() / 2]);
  }
  return medians;
}

}  // namespace lucerna::raybench
