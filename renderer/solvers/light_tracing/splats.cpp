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
  kernels(false, false, false);
  write_frame();
}

const Splats::Kernels& Splats::kernels(bool weighed, bool lens, bool section) {
  Kernels& k = kernels_[weighed][lens][section];
  if (k.vertex) return k;
  gpu::Defines defines = scene_defines_;
  defines["LUCERNA_SPLATS_SUMMED"] = "1";
  if (weighed) defines["LUCERNA_SPLATS_WEIGHED"] = "1";
  k.arrival = gpu::Kernel(device_, compiler_, "transport/shadow.comp", defines);
  if (lens) defines["LUCERNA_THIN_LENS"] = "1";
  if (section) defines["LUCERNA_SECTION"] = "1";
  k.vertex = gpu::Kernel(device_, compiler_, "light_tracing/trace.comp", defines);
  return k;
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

void Splats::write_frame(bool whole) {
  SplatFrame f = frame_;
  if (!shown_) f.width = f.height = 0;
  f.first = whole ? 0 : band_ * band_pixels_;
  f.pixels = whole ? frame_.width * frame_.height : pixels_of_band();
  block_.write(&f, sizeof f);
}

uint32_t Splats::pixels_of_band() const {
  return std::min(band_pixels_, frame_.width * frame_.height - band_ * band_pixels_);
}

void Splats::begin(transport::Wavefront& wavefront, uint32_t width, uint32_t height, uint32_t component,
                   float unit) {
  restart();
  const uint64_t pixels = uint64_t{width} * height;
  if (width != frame_.width || height != frame_.height || !sums_[0]) {
    constexpr uint64_t k_texel = 16;
    static_assert(k_texel >= sizeof(LongSum) && k_texel >= sizeof(SplatOwners));
    const uint64_t band = std::min(pixels, device_.info().limits.max_storage_buffer / k_texel);
    std::array<gpu::Buffer, 3> sums;
    for (gpu::Buffer& of_color : sums)
      of_color = {device_, {.name = "sums of splats", .bytes = band * sizeof(LongSum)}};
    gpu::Buffer picture(device_, {.name = "picture of splats", .bytes = k_texel * pixels, .texel = true});
    gpu::Buffer owners, band_picture;
    if (groups_) owners = {device_, {.name = "groups of splats", .bytes = band * sizeof(SplatOwners)}};
    if (band < pixels) band_picture = {device_, {.name = "band of splats", .bytes = k_texel * band}};
    sums_ = std::move(sums), picture_ = std::move(picture), owners_ = std::move(owners);
    band_picture_ = std::move(band_picture), band_pixels_ = uint32_t(band);
    wavefront.rebind_lookup();
  }
  frame_ = {width, height, component, unit, 0, 0}, shown_ = false;
  write_frame();
  clear(wavefront);
}

void Splats::clear(transport::Wavefront& wavefront) {
  for (const gpu::Buffer& of_color : sums_) wavefront.stream().fill(of_color, 0);
  if (groups_) wavefront.stream().fill(owners_, ~0u);
  wavefront.account_stages();
}

Splats::Went Splats::batch(transport::Wavefront& wavefront, const transport::LightSource& lights,
                           const transport::LightRound& round, bool weighed, const Frame& picture,
                           uint32_t enabled, const std::function<bool()>& cancel) {
  const Kernels& used = kernels(weighed, picture.lens_radius > 0, picture.section_normal != vec3(0));
  if (!tracing_ || next_.round != round.number || next_.paths != round.paths) {
    next_ = {.round = round.number, .paths = round.paths};
    traced_ = 0, tracing_ = true, band_ = 0;
  }
  if (traced_ == 0) write_frame(weighed);
  const uint32_t count = std::min(wavefront.slots(), round.paths - traced_);
  const EmitPush push{count, traced_, round.number, 1 / float(round.paths),
                      transport::LightEmitter::stratum_step(round.paths)};
  round_.write(&push, sizeof push);
  uint32_t counts[k_splat_counts] = {};
  counts_.write(counts, sizeof counts);
  const transport::LightVertexWork work{.vertex = &used.vertex,
                                        .stage = "light vertex",
                                        .bind =
                                            [&](gpu::Resources& r) {
                                              bind(r);
                                              r.set("SplatCounts", counts_);
                                              bind_sums(r);
                                              r.set("LightRoundBlock", round_);
                                              if (contributions_) r.set("SplatContributions", contributions_);
                                            },
                                        .arrival = &used.arrival};
  const Timer timer;
  if (!emitter_.trace(wavefront, lights, round, traced_, count, work, picture, enabled, cancel)) {
    // Part of its light has arrived already.
    tracing_ = false, band_ = 0;
    clear(wavefront);
    return Went::cancelled;
  }
  counts_.read(counts, sizeof counts);
  next_.joined += counts[k_splats_joined];
  // All bands use the same paths.
  if (band_ == 0) next_.escaped += emitter_.escaped(), next_.dark += emitter_.dark();
  next_.trace_s += timer.seconds();
  traced_ += count;
  return traced_ < round.paths ? Went::on : Went::complete;
}

bool Splats::trace(transport::Wavefront& wavefront, const transport::LightSource& lights,
                   const transport::LightRound& round, const Frame& picture, uint32_t enabled,
                   const std::function<bool()>& cancel) {
  complete_ = false;
  if (lights.power() > 0) {
    const Went went = batch(wavefront, lights, round, false, picture, enabled, cancel);
    if (went != Went::complete) return went == Went::on;
  } else {
    next_ = {.round = round.number};
  }
  const Timer timer;
  resolve(wavefront);
  next_.trace_s += timer.seconds();
  if (band_ + 1 < bands()) {
    ++band_, traced_ = 0;
    return true;
  }
  band_ = 0, shown_ = true;
  write_frame();
  figures_ = next_;
  tracing_ = false, complete_ = true;
  return true;
}

void Splats::resolve(transport::Wavefront& wavefront) {
  const uint32_t pixels = pixels_of_band();
  uint32_t counts[k_splat_counts] = {};
  counts_.write(counts, sizeof counts);
  gpu::Resources r;
  bind(r);
  r.set("SplatCounts", counts_);
  bind_sums(r);
  r.set("SplatPicture", band_picture_ ? band_picture_ : picture_);
  wavefront.stream().dispatch(resolve_, r, SplatPush{pixels}, gpu::groups_for(pixels, 64), "splats");
  if (band_picture_)
    wavefront.stream().copy(band_picture_, picture_, 16 * uint64_t{pixels}, 0,
                            16 * uint64_t{band_} * band_pixels_);
  wavefront.account_stages();
  counts_.read(counts, sizeof counts);
  next_.pixels += counts[k_splats_pixels];
}

std::optional<std::vector<double>> Splats::weigh(transport::Wavefront& wavefront,
                                                 const transport::LightSource& lights,
                                                 const transport::LightRound& round, const Frame& picture,
                                                 uint32_t enabled, const std::function<bool()>& cancel) {
  const uint32_t strata = lights.strata();
  if (!tracing_) {
    gpu::make_room(
        device_, contributions_,
        {.name = "contributions of strata", .bytes = strata * sizeof(LongSum), .memory = gpu::Memory::host});
    wavefront.stream().fill(contributions_, 0);
    wavefront.account_stages();
  }
  const Went went = batch(wavefront, lights, round, true, picture, enabled, cancel);
  if (went != Went::complete) return std::nullopt;
  tracing_ = false;
  std::vector<double> contributions;
  const auto* found = static_cast<const LongSum*>(contributions_.mapped());
  for (uint32_t i = 0; i < strata; ++i) contributions.push_back(value(found[i]));
  return contributions;
}

uint64_t Splats::bytes() const {
  uint64_t sum = picture_.bytes();
  for (const gpu::Buffer* b : {&sums_[0], &sums_[1], &sums_[2], &owners_, &band_picture_, &contributions_})
    sum += *b ? b->bytes() : 0;
  return sum;
}

}  // namespace lucerna::light_tracing
