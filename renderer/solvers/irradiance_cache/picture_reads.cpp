#include "solvers/irradiance_cache/picture_reads.h"

#include <algorithm>

#include "shaders/shared/irradiance_cache/records.h"
#include "shaders/shared/wide_sum.h"

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

constexpr const char* k_counting_reads = "importance";
constexpr uint32_t k_read_paths = 2;  ///< per pixel

}  // namespace

PictureReads::PictureReads(gpu::Device& device, gpu::ShaderCompiler& compiler, uint32_t capacity,
                           const gpu::Defines& defines)
    : device_(device),
      keeping_(device, compiler, "irradiance_cache/importance_places.comp", defines),
      adding_(device, compiler, "irradiance_cache/importance_sum.comp", defines),
      sums_(device, {.name = "importance of records",
                     .bytes = uint64_t{capacity} * sizeof(WideSum),
                     .memory = gpu::Memory::host}) {}

uint32_t PictureReads::blocks() const {
  return (frame_.width + k_block - 1) / k_block * ((frame_.height + k_block - 1) / k_block);
}

void PictureReads::begin(const Frame& frame) {
  begun_ = false;
  frame_ = frame;
  for (uint32_t k = 2; pixels() > k_most_pixels; ++k)
    frame_.width = std::max(frame.width / k, 1u), frame_.height = std::max(frame.height / k, 1u);
  done_ = 0;
  gpu::make_texel_room(device_, places_, "places of lookups",
                       uint64_t{pixels()} * k_read_paths * sizeof(vec4));
  begun_ = true;
}

bool PictureReads::see(transport::Wavefront& wavefront, const gpu::Buffer& candidates, bool next,
                       const std::function<void(uint32_t probing)>& write_frame,
                       const std::function<bool()>& cancel) {
  schedule::WorkItem item{{}, k_read_paths};
  const uint32_t end = std::min(blocks(), done_ + std::max(1u, wavefront.slots() / (64 * k_read_paths)));
  for (uint32_t b = done_; b < end; ++b) item.blocks.push_back({b, 0});
  gpu::Stream& stream = wavefront.stream();
  next_ = next;
  if (next)
    gpu::make_texel_room(device_, next_places_, "places of lookups by records' rays", places_.bytes());
  for (const auto& [probing, to] :
       {std::pair{k_probe_reads, &places_}, std::pair{k_probe_next, &next_places_}}) {
    if (probing == k_probe_next && !next) continue;
    stream.fill(candidates, 0);
    write_frame(probing);
    const bool complete = wavefront.probe(item, cancel);
    write_frame(k_probe_none);
    if (!complete) return false;
    resources_.set("candidate_texels", candidates);
    resources_.set("Places", *to);
    const ImportancePush push{64 * (end - done_), 64 * done_, next};
    stream.dispatch(keeping_, resources_, push, gpu::groups_for(item.slots(), 64), k_counting_reads);
    stream.run();
  }
  done_ = end;
  return true;
}

std::vector<float> PictureReads::measure(gpu::Stream& stream,
                                         const std::function<void(gpu::Resources&)>& bind, uint32_t count) {
  bind(resources_);
  resources_.set("place_texels", places_);
  resources_.set("next_place_texels", next_ ? next_places_ : places_);
  resources_.set("Sums", sums_);
  stream.fill(sums_, 0);
  stream.dispatch(adding_, resources_, ImportancePush{pixels(), 0, next_}, gpu::groups_for(pixels(), 64),
                  k_counting_reads);
  stream.run();
  const WideSum* const sums = static_cast<const WideSum*>(sums_.mapped());
  const float pixel = 1.0f / (float(k_importance_steps) * float(frame_.height) * float(frame_.height));
  std::vector<float> importance(count);
  std::transform(sums, sums + count, importance.begin(),
                 [&](const WideSum& sum) { return pixel * float(value(sum)); });
  return importance;
}

}  // namespace lucerna::irradiance_cache
