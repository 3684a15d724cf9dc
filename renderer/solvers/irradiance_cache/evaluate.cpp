#include "solvers/irradiance_cache/evaluate.h"

#include <algorithm>

#include "base/error.h"
#include "gpu/stream.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

RecordPush push_of(const paths::Automaton& automaton, const EvaluateOptions& o) {
  return {.elevations = o.elevations,
          .azimuths = o.azimuths,
          .rays_before = o.rays_before,
          .parts = o.parts,
          .state = in_phase(automaton.after(0, paths::Event::diffuse),
                            o.elsewhere ? k_phase_fallback : k_phase_start),
          .seed = o.seed};
}

}  // namespace

struct Evaluator::Impl {
  gpu::Device& device;
  gpu::ShaderCompiler& compiler;
  gpu::Defines defines;  ///< of kernels that read or write the light of paths
  gpu::Kernel record, gather, gather_groups, distances, hessian, near, guide;
  gpu::Buffer first_hits, list;
  gpu::Resources resources;

  /// Traces the rays of the listed records by `push` (except its range), one batch of the wavefront's slots
  /// at a time, and runs `kernels` in order. `hits_only`: these read only the first hits.
  size_t gather_by(std::initializer_list<const gpu::Kernel*> kernels, bool hits_only,
                   transport::Wavefront& wavefront, Records& records, std::span<const uint32_t> all,
                   RecordPush push, const std::function<bool()>& cancel) {
    wavefront.bind_paths(resources);
    records.bind(resources, Records::Use::gather);
    resources.set("RecordList", list);
    resources.set("first_hit_texels", hits_only ? wavefront.hits() : first_hits);
    const uint32_t cells = push.elevations * push.azimuths;
    gpu::Stream& stream = wavefront.stream();
    size_t done = 0;
    while (done < all.size()) {
      push.records = static_cast<uint32_t>(std::min<size_t>(all.size() - done, wavefront.slots() / cells));
      const uint32_t rays = push.records * cells;
      list.write(all.subspan(done, push.records));
      transport::PathEnds ends{
          .begin = [&] { stream.dispatch(record, resources, push, gpu::groups_for(rays, 64), "records"); },
          .first_hits = {},
          .end =
              [&] {
                for (const gpu::Kernel* kernel : kernels)
                  if (kernel)
                    stream.dispatch(
                        *kernel, resources, push,
                        gpu::groups_for(push.records * (kernel == &gather_groups
                                                            ? uint32_t(records.group_bytes() / sizeof(uvec4))
                                                            : 1),
                                        64),
                        "records");
              },
          .hits_only = hits_only};
      if (!hits_only)
        ends.first_hits = [&] { stream.copy(wavefront.hits(), first_hits, uint64_t{rays} * sizeof(Hit)); };
      if (!wavefront.run(rays, ends, cancel)) break;
      done += push.records;
    }
    return done;
  }
};

Evaluator::Evaluator(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots, uint32_t groups)
    : impl_(new Impl{device, compiler, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}}) {
  impl_->defines = group_defines(groups);
  impl_->record = gpu::Kernel(device, compiler, "irradiance_cache/record.comp", impl_->defines);
  impl_->gather = gpu::Kernel(device, compiler, "irradiance_cache/gather.comp", impl_->defines);
  if (groups > 1)
    impl_->gather_groups =
        gpu::Kernel(device, compiler, "irradiance_cache/gather_groups.comp", impl_->defines);
  impl_->distances = gpu::Kernel(device, compiler, "irradiance_cache/distances.comp");
  impl_->first_hits = gpu::Buffer(
      device, {.name = "first hits of records", .bytes = uint64_t{slots} * sizeof(Hit), .texel = true});
  impl_->list = gpu::Buffer(
      device, {.name = "records to evaluate", .bytes = uint64_t{slots} * 4, .memory = gpu::Memory::host});
}

Evaluator::~Evaluator() = default;

size_t Evaluator::evaluate(transport::Wavefront& wavefront, const paths::Automaton& automaton,
                           Records& records, std::span<const uint32_t> list, const EvaluateOptions& o,
                           const std::function<bool()>& cancel) {
  Impl& e = *impl_;
  const uint32_t cells = o.elevations * o.azimuths, most = std::min(wavefront.slots(), k_most_rays);
  if (cells == 0 || cells > most)
    throw_error("irradiance cache", "{} x {} rays per record; the range is 1 to {}", o.elevations, o.azimuths,
                most);
  if (o.near && !e.near) e.near = gpu::Kernel(e.device, e.compiler, "irradiance_cache/near.comp", e.defines);
  if (o.guides && !e.guide)
    e.guide = gpu::Kernel(e.device, e.compiler, "irradiance_cache/guide.comp", e.defines);
  return e.gather_by({e.gather_groups ? &e.gather_groups : nullptr, &e.gather, o.near ? &e.near : nullptr,
                      o.guides ? &e.guide : nullptr},
                     false, wavefront, records, list, push_of(automaton, o), cancel);
}

size_t Evaluator::measure(transport::Wavefront& wavefront, Records& records, std::span<const uint32_t> list,
                          uint32_t seed, const std::function<bool()>& cancel) {
  Impl& e = *impl_;
  return e.gather_by({&e.distances}, true, wavefront, records, list,
                     {.elevations = k_distance_elevations,
                      .azimuths = k_distance_rays / k_distance_elevations,
                      .seed = seed},
                     cancel);
}

size_t Evaluator::pilot(transport::Wavefront& wavefront, const paths::Automaton& automaton, Records& records,
                        std::span<const uint32_t> list, const EvaluateOptions& o,
                        const std::function<bool()>& cancel) {
  Impl& e = *impl_;
  if (!e.hessian) e.hessian = gpu::Kernel(e.device, e.compiler, "irradiance_cache/hessian.comp", e.defines);
  RecordPush push = push_of(automaton, o);
  push.pilot = 1;
  return e.gather_by({&e.distances, &e.hessian}, false, wavefront, records, list, push, cancel);
}

}  // namespace lucerna::irradiance_cache
