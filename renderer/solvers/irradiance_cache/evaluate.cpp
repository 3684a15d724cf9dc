#include "solvers/irradiance_cache/evaluate.h"

#include <algorithm>

#include "base/error.h"
#include "gpu/stream.h"

namespace lucerna::irradiance_cache {

using namespace shared;

struct Evaluator::Impl {
  gpu::Kernel record, gather, distances;
  gpu::Buffer first_hits, list;
  gpu::Resources resources;
};

Evaluator::Evaluator(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t slots)
    : impl_(std::make_unique<Impl>()) {
  impl_->record = gpu::Kernel(device, compiler, "irradiance_cache/record.comp");
  impl_->gather = gpu::Kernel(device, compiler, "irradiance_cache/gather.comp");
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
  const uint32_t cells = o.elevations * o.azimuths, slots = wavefront.slots();
  const uint32_t most = std::min(slots, k_most_rays);
  if (cells == 0 || cells > most)
    throw_error("irradiance cache", "{} x {} rays a record; there is room for 1 to {} paths", o.elevations,
                o.azimuths, most);
  wavefront.bind_paths(e.resources);
  records.bind(e.resources, Records::Use::gather);
  e.resources.set("RecordList", e.list);
  e.resources.set("first_hit_texels", e.first_hits);
  gpu::Stream& stream = wavefront.stream();
  size_t done = 0;
  while (done < list.size()) {
    const auto batch = static_cast<uint32_t>(std::min<size_t>(list.size() - done, slots / cells));
    e.list.write(list.subspan(done, batch));
    const RecordPush push{0,
                          batch,
                          o.elevations,
                          o.azimuths,
                          o.rays_before,
                          o.parts,
                          automaton.after(0, paths::Event::diffuse),
                          o.seed};
    const transport::PathEnds ends{
        .begin =
            [&] {
              stream.dispatch(e.record, e.resources, push, gpu::groups_for(uint64_t{batch} * cells, 64),
                              "records");
            },
        .first_hits =
            [&] { stream.copy(wavefront.hits(), e.first_hits, uint64_t{batch} * cells * sizeof(Hit)); },
        .end = [&] { stream.dispatch(e.gather, e.resources, push, gpu::groups_for(batch, 64), "records"); }};
    if (!wavefront.run(batch * cells, ends, cancel)) break;
    done += batch;
  }
  return done;
}

size_t Evaluator::measure(transport::Wavefront& wavefront, Records& records, std::span<const uint32_t> list,
                          uint32_t seed, const std::function<bool()>& cancel) {
  Impl& e = *impl_;
  constexpr uint32_t k_elevations = 4, k_azimuths = k_distance_rays / k_elevations;
  wavefront.bind_paths(e.resources);
  records.bind(e.resources, Records::Use::gather);
  e.resources.set("RecordList", e.list);
  e.resources.set("first_hit_texels", wavefront.hits());
  gpu::Stream& stream = wavefront.stream();
  size_t done = 0;
  while (done < list.size()) {
    const auto batch =
        static_cast<uint32_t>(std::min<size_t>(list.size() - done, wavefront.slots() / k_distance_rays));
    e.list.write(list.subspan(done, batch));
    const RecordPush push{0, batch, k_elevations, k_azimuths, 0, 0, 0, seed};
    const transport::PathEnds ends{
        .begin =
            [&] {
              stream.dispatch(e.record, e.resources, push,
                              gpu::groups_for(uint64_t{batch} * k_distance_rays, 64), "records");
            },
        .first_hits = {},
        .end =
            [&] { stream.dispatch(e.distances, e.resources, push, gpu::groups_for(batch, 64), "records"); },
        .hits_only = true};
    if (!wavefront.run(batch * k_distance_rays, ends, cancel)) break;
    done += batch;
  }
  return done;
}

}  // namespace lucerna::irradiance_cache
