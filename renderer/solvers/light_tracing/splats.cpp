#include "solvers/light_tracing/splats.h"

#include <algorithm>

#include "base/timer.h"

namespace lucerna::light_tracing {

using namespace shared;

Splats::Splats(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& scene_defines,
               const paths::Automaton& automaton, bool groups)
    : device_(device),
      compiler_(compiler),
      scene_defines_(scene_defines),
      groups_(groups),
      emitter_(device, compiler, scene_defines, automaton),
      resolve_(device, compiler, "light_tracing/resolve.comp", {{"LUCERNA_GROUP_SUMS", groups ? "1" : "0"}}),
      counts_(device, {.name = "splat counts", .bytes = 4 * k_splat_counts, .memory = gpu::Memory::host}),
      block_(device, {.name = "splats", .bytes = sizeof(SplatFrame)}),
      round_(device, {.name = "round of light paths", .bytes = sizeof(EmitPush)}),
      picture_(device, {.name = "picture of splats", .bytes = 16, .texel = true}) {
  summed_ = compile(false);
  write_frame(false);
}

Splats::Kernels Splats::compile(bool weighed) const {
  gpu::Defines defines = scene_defines_;
  defines["LUCERNA_SPLATS_SUMMED"] = "1";
  if (weighed) defines["LUCERNA_SPLATS_WEIGHED"] = "1";
  return {.vertex = gpu::Kernel(device_, compiler_, "light_tracing/trace.comp", defines),
          .arrival = gpu::Kernel(device_, compiler_, "transport/shadow.comp", defines)};
}

void Splats::bind(gpu::Resources& resources) const {
  resources.set("SplatBlock", block_);
  resources.set("splat_picture", picture_);
}

void Splats::bind_sums(gpu::Resources& resources) const {
  constexpr const char* k_names[] = {"SplatRed", "SplatGreen", "SplatBlue"};
  for (size_t i = 0; i < sums_.size(); ++i) resources.set(k_names[i], sums_[i]);
  if (groups_) resources.set("SplatOwnerList", owners_);
}

void Splats::write_frame(bool shown) {
  SplatFrame f = frame_;
  if (!shown) f.width = f.height = 0;
  block_.write(&f, sizeof f);
}

void Splats::begin(transport::Wavefront& wavefront, uint32_t width, uint32_t height, uint32_t component,
                   float unit) {
  restart();
  const uint64_t pixels = uint64_t{width} * height;
  if (width != frame_.width || height != frame_.height || !sums_[0]) {
    std::array<gpu::Buffer, 3> sums;
    for (gpu::Buffer& of_color : sums)
      of_color = {device_, {.name = "sums of splats", .bytes = pixels * sizeof(LongSum)}};
    gpu::Buffer picture(device_, {.name = "picture of splats", .bytes = 16 * pixels, .texel = true});
    gpu::Buffer owners;
    if (groups_) owners = {device_, {.name = "groups of splats", .bytes = pixels * sizeof(SplatOwners)}};
    sums_ = std::move(sums), picture_ = std::move(picture), owners_ = std::move(owners);
    wavefront.rebind_lookup();
  }
  frame_ = {width, height, component, unit};
  write_frame(false);
  clear(wavefront);
}

void Splats::clear(transport::Wavefront& wavefront) {
  for (const gpu::Buffer& of_color : sums_) wavefront.stream().fill(of_color, 0);
  if (groups_) wavefront.stream().fill(owners_, ~0u);
  wavefront.account_stages();
}

Splats::Went Splats::batch(transport::Wavefront& wavefront, const transport::LightSource& lights,
                           const transport::LightRound& round, const Kernels& kernels, const Frame& picture,
                           uint32_t enabled, const std::function<bool()>& cancel) {
  if (!tracing_ || next_.round != round.number || next_.paths != round.paths) {
    next_ = {.round = round.number, .paths = round.paths};
    traced_ = 0, tracing_ = true;
  }
  const uint32_t count = std::min(wavefront.slots(), round.paths - traced_);
  const EmitPush told{count, traced_, round.number, 1 / float(round.paths),
                      transport::LightEmitter::stratum_step(round.paths)};
  round_.write(&told, sizeof told);
  uint32_t counts[k_splat_counts] = {};
  counts_.write(counts, sizeof counts);
  const transport::LightVertexWork work{.vertex = &kernels.vertex,
                                        .stage = "light vertex",
                                        .bind =
                                            [&](gpu::Resources& r) {
                                              bind(r);
                                              r.set("SplatCounts", counts_);
                                              bind_sums(r);
                                              r.set("LightRoundBlock", round_);
                                              if (worths_) r.set("SplatWorths", worths_);
                                            },
                                        .arrival = &kernels.arrival};
  const Timer timer;
  if (!emitter_.trace(wavefront, lights, round, traced_, count, work, picture, enabled, cancel)) {
    // Part of its light has arrived.
    tracing_ = false;
    clear(wavefront);
    return Went::cancelled;
  }
  counts_.read(counts, sizeof counts);
  next_.joined += counts[k_splats_joined];
  next_.escaped += emitter_.escaped(), next_.dark += emitter_.dark();
  next_.trace_s += timer.seconds();
  traced_ += count;
  return traced_ < round.paths ? Went::on : Went::complete;
}

bool Splats::trace(transport::Wavefront& wavefront, const transport::LightSource& lights,
                   const transport::LightRound& round, const Frame& picture, uint32_t enabled,
                   const std::function<bool()>& cancel) {
  complete_ = false;
  if (lights.power() > 0) {
    const Went went = batch(wavefront, lights, round, summed_, picture, enabled, cancel);
    if (went != Went::complete) return went == Went::on;
  } else {
    next_ = {.round = round.number};
  }
  const Timer timer;
  const uint32_t pixels = frame_.width * frame_.height;
  uint32_t counts[k_splat_counts] = {};
  counts_.write(counts, sizeof counts);
  gpu::Resources r;
  bind(r);
  r.set("SplatCounts", counts_);
  bind_sums(r);
  r.set("SplatPicture", picture_);
  wavefront.stream().dispatch(resolve_, r, SplatPush{pixels}, gpu::groups_for(pixels, 64), "splats");
  wavefront.account_stages();
  counts_.read(counts, sizeof counts);
  write_frame(true);
  next_.pixels = counts[k_splats_pixels];
  next_.trace_s += timer.seconds();
  figures_ = next_;
  tracing_ = false, complete_ = true;
  return true;
}

std::optional<std::vector<double>> Splats::weigh(transport::Wavefront& wavefront,
                                                 const transport::LightSource& lights,
                                                 const transport::LightRound& round, const Frame& picture,
                                                 uint32_t enabled, const std::function<bool()>& cancel) {
  if (!weighed_.vertex) weighed_ = compile(true);
  const uint32_t strata = lights.strata();
  if (!tracing_) {
    gpu::make_room(
        device_, worths_,
        {.name = "worths of strata", .bytes = strata * sizeof(LongSum), .memory = gpu::Memory::host});
    wavefront.stream().fill(worths_, 0);
    wavefront.account_stages();
  }
  const Went went = batch(wavefront, lights, round, weighed_, picture, enabled, cancel);
  if (went != Went::complete) return std::nullopt;
  tracing_ = false;
  std::vector<double> worth;
  const auto* found = static_cast<const LongSum*>(worths_.mapped());
  for (uint32_t i = 0; i < strata; ++i) worth.push_back(value(found[i]));
  return worth;
}

uint64_t Splats::bytes() const {
  uint64_t sum = picture_.bytes();
  for (const gpu::Buffer* b : {&sums_[0], &sums_[1], &sums_[2], &owners_, &worths_})
    sum += *b ? b->bytes() : 0;
  return sum;
}

}  // namespace lucerna::light_tracing
