#include "solvers/irradiance_cache/discontinuity.h"

#include <algorithm>
#include <cmath>

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

constexpr const char* k_stage = "discontinuity";
/// Of the width of its level's cell: what a candidate stands for, and where a record satisfies it.
constexpr float k_cell_share = 0.5f;

}  // namespace

struct Discontinuity::Impl {
  gpu::Device& device;
  gpu::ShaderCompiler& compiler;
  gpu::Defines defines;
  gpu::Kernel centre, surface, lit_kernel, detail, dither, drawing;
  gpu::Buffer surfaces, lit, details, taken, taken_levels;
  gpu::Resources resources;
  uint32_t width = 0, height = 0, stride = 1, across = 0, down = 0, done = 0;
  float pixel = 1;
  bool parallel = false, begun = false;
  std::vector<uint32_t> first;  // entry of each level in `details`; then their sum

  uint32_t points() const { return across * down; }
  uint32_t levels() const { return uint32_t(first.size()) - 1; }
  uint32_t cells(uint32_t level) const {
    const uint32_t most = (1u << level) - 1;
    return ((across + most) >> level) * ((down + most) >> level);
  }
  const gpu::Kernel& ready(gpu::Kernel& kernel, const char* name) {
    if (!kernel)
      kernel = gpu::Kernel(device, compiler, std::string("irradiance_cache/") + name + ".comp", defines);
    return kernel;
  }
  void run(gpu::Stream& stream, const gpu::Kernel& kernel, const void* push, size_t bytes, uint32_t items) {
    stream.dispatch(kernel, resources, push, bytes, gpu::groups_for(items, 64), k_stage);
  }
};

Discontinuity::Discontinuity(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& defines)
    : impl_(new Impl{device, compiler, defines, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}}) {
  impl_->first = {0};
}
Discontinuity::~Discontinuity() = default;

void Discontinuity::begin(const Frame& frame) {
  Impl& d = *impl_;
  d.begun = false;
  d.width = frame.width, d.height = frame.height;
  d.parallel = frame.orthographic != 0;
  for (d.stride = 1;; ++d.stride) {
    d.across = (d.width + d.stride - 1) / d.stride, d.down = (d.height + d.stride - 1) / d.stride;
    if (uint64_t{d.across} * d.down <= k_most_points) break;
  }
  d.pixel = 2 * glm::length(frame.camera_up) / float(frame.height) * float(d.stride);
  d.done = 0;
  d.first = {0};
  for (uint32_t level = 0;; ++level) {
    d.first.push_back(d.first.back() + d.cells(level));
    if (d.cells(level) <= 1) break;
  }
  gpu::make_texel_room(d.device, d.surfaces, "surfaces of the picture",
                       uint64_t{d.points()} * k_surface_texels * sizeof(vec4));
  gpu::make_texel_room(d.device, d.lit, "irradiance of the picture", uint64_t{d.points()} * sizeof(vec3));
  gpu::make_texel_room(d.device, d.details, "discontinuity", uint64_t{d.first.back()} * sizeof(float));
  gpu::make_texel_room(d.device, d.taken, "points taken", uint64_t{d.points()} * sizeof(uint32_t));
  gpu::make_texel_room(d.device, d.taken_levels, "levels of points", uint64_t{d.points()} * sizeof(uint32_t));
  d.begun = true;
}

void Discontinuity::forget() { impl_->begun = false; }
bool Discontinuity::begun() const { return impl_->begun; }
bool Discontinuity::seen() const { return impl_->begun && impl_->done == impl_->points(); }
SightGrid Discontinuity::grid() const {
  return seen() ? SightGrid{impl_->across, impl_->stride} : k_no_sight;
}
const gpu::Buffer& Discontinuity::surfaces() const { return impl_->surfaces; }
uint32_t Discontinuity::across() const { return impl_->across; }
uint32_t Discontinuity::down() const { return impl_->down; }
uint32_t Discontinuity::points() const { return impl_->points(); }
uint32_t Discontinuity::levels() const { return impl_->levels(); }

bool Discontinuity::see(transport::Wavefront& wavefront, const gpu::Buffer& candidates,
                        const std::function<bool()>& cancel) {
  Impl& d = *impl_;
  const SeePush push{d.done, std::min(d.points() - d.done, wavefront.slots()), d.across, d.down, d.stride};
  wavefront.bind_paths(d.resources);
  d.resources.set("candidate_texels", candidates);
  d.resources.set("Surfaces", d.surfaces);
  gpu::Stream& stream = wavefront.stream();
  stream.fill(candidates, 0);
  const transport::PathEnds ends{
      .begin = [&] { d.run(stream, d.ready(d.centre, "centre"), &push, sizeof push, push.count); },
      .first_hits = {},
      .end = [&] { d.run(stream, d.ready(d.surface, "surface"), &push, sizeof push, push.count); }};
  if (!wavefront.run(push.count, ends, cancel)) return false;
  d.done += push.count;
  return true;
}

void Discontinuity::look_up(gpu::Stream& stream, const std::function<void(gpu::Resources&)>& bind) {
  Impl& d = *impl_;
  bind(d.resources);
  d.resources.set("surface_texels", d.surfaces);
  d.resources.set("Lit", d.lit);
  const LitPush push{d.points()};
  d.run(stream, d.ready(d.lit_kernel, "lit"), &push, sizeof push, push.count);
}

void Discontinuity::measure(gpu::Stream& stream, Of of, const DiscontinuityOptions& o, float least) {
  Impl& d = *impl_;
  d.resources.set("surface_texels", d.surfaces);
  d.resources.set("Lit", d.lit);
  d.resources.set("Details", d.details);
  for (uint32_t level = 0; level < d.levels(); ++level) {
    const DetailPush push{.across = d.across,
                          .down = d.down,
                          .level = level,
                          .first = d.first[level],
                          .finer = level > 0 ? d.first[level - 1] : 0,
                          .pixel = d.pixel,
                          .parallel = d.parallel,
                          .depth_weight = o.depth_weight,
                          .normal_weight = o.normal_weight,
                          .irradiance_weight = of == Of::irradiance ? o.irradiance_weight : 0,
                          .irradiance_noise = o.irradiance_noise,
                          .least = std::max(least, 1e-30f)};
    d.run(stream, d.ready(d.detail, "detail"), &push, sizeof push, d.cells(level));
  }
}

void Discontinuity::dither(gpu::Stream& stream, Of of, const DiscontinuityOptions& o, const Scale& scale,
                           uint32_t seed) {
  Impl& d = *impl_;
  d.resources.set("surface_texels", d.surfaces);
  d.resources.set("Lit", d.lit);
  d.resources.set("Details", d.details);
  d.resources.set("Taken", d.taken);
  d.resources.set("TakenLevels", d.taken_levels);
  uint32_t first_level = 0;
  while (first_level + 1 < d.levels() && float(1u << first_level) < scale.least_width / float(d.stride))
    ++first_level;
  const DitherPush push{.across = d.across,
                        .down = d.down,
                        .levels = d.levels(),
                        .first_level = first_level,
                        .density = o.density,
                        .falloff = o.falloff,
                        .pixel = d.pixel,
                        .parallel = d.parallel,
                        .finest = scale.finest,
                        .flat_side = scale.flat_side,
                        .spacing = of == Of::irradiance ? k_cell_share : 0,
                        .key = seed};
  d.run(stream, d.ready(d.dither, "dither"), &push, sizeof push, d.points());
}

Placement::Screen Discontinuity::screen() const {
  const Impl& d = *impl_;
  return {d.surfaces, d.taken, d.taken_levels, d.points(), d.pixel, k_cell_share};
}

void Discontinuity::draw(gpu::Stream& stream, const gpu::Buffer& picture, uint32_t level) {
  Impl& d = *impl_;
  d.resources.set("surface_texels", d.surfaces);
  d.resources.set("Details", d.details);
  d.resources.set("Picture", picture);
  level = std::min(level, d.levels() - 1);
  const DiscontinuityDrawPush push{d.width, d.height, d.across, d.down, d.stride, level, d.first[level]};
  d.run(stream, d.ready(d.drawing, "discontinuity_draw"), &push, sizeof push, d.width * d.height);
}

uint64_t Discontinuity::bytes() const {
  uint64_t sum = 0;
  for (const gpu::Buffer* b :
       {&impl_->surfaces, &impl_->lit, &impl_->details, &impl_->taken, &impl_->taken_levels})
    sum += *b ? b->bytes() : 0;
  return sum;
}

std::vector<float> Discontinuity::level(uint32_t k) const {
  std::vector<float> values(impl_->cells(k));
  impl_->details.read(values.data(), values.size() * sizeof(float), impl_->first[k] * sizeof(float));
  return values;
}

std::vector<uint32_t> Discontinuity::taken() const {
  std::vector<uint32_t> flags(points()), levels_of(points());
  impl_->taken.read(flags.data(), flags.size() * sizeof(uint32_t));
  impl_->taken_levels.read(levels_of.data(), levels_of.size() * sizeof(uint32_t));
  for (size_t i = 0; i < flags.size(); ++i)
    if (flags[i] == 0) levels_of[i] = levels();
  return levels_of;
}

void Discontinuity::set(const std::vector<vec4>& surfaces, const std::vector<vec3>& lit) {
  impl_->surfaces.write(std::span<const vec4>(surfaces));
  impl_->lit.write(std::span<const vec3>(lit));
  impl_->done = points();
}

}  // namespace lucerna::irradiance_cache
