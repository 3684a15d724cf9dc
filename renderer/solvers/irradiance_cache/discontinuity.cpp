#include "solvers/irradiance_cache/discontinuity.h"

#include <algorithm>
#include <cmath>

namespace lucerna::irradiance_cache {

using namespace shared;

namespace {

constexpr const char* k_finding_edges = "discontinuity";
/// Reach of a candidate, and the distance of a record that covers it, in cell widths of its level.
constexpr float k_cell_share = 0.5f;

}  // namespace

struct Discontinuity::Impl {
  gpu::Device& device;
  gpu::ShaderCompiler& compiler;
  gpu::Defines defines;
  overlay::Sight sight;
  struct {
    gpu::Kernel surface, lit, detail, dither, draw;
  } kernels;  // compiled at the first use
  struct {
    gpu::Buffer lit, taken, taken_levels;  // by point
    gpu::Buffer details;                   // by cell, level by level
  } buffers;
  gpu::Resources resources;
  bool begun = false;
  std::vector<uint32_t> first{0};  // first entry of each level in `details`; then their sum

  Impl(gpu::Device& d, gpu::ShaderCompiler& c, const gpu::Defines& with)
      : device(d), compiler(c), defines(with), sight(d, c, with) {}

  uint32_t points() const { return sight.points(); }
  uint32_t levels() const { return uint32_t(first.size()) - 1; }
  uint32_t cells(uint32_t level) const {
    const uint32_t most = (1u << level) - 1;
    return ((sight.across() + most) >> level) * ((sight.down() + most) >> level);
  }
  const gpu::Kernel& ready(gpu::Kernel& kernel, const char* name) {
    if (!kernel)
      kernel = gpu::Kernel(device, compiler, std::string("irradiance_cache/") + name + ".comp", defines);
    return kernel;
  }
  void run(gpu::Stream& stream, const gpu::Kernel& kernel, const void* push, size_t bytes, uint32_t items) {
    stream.dispatch(kernel, resources, push, bytes, gpu::groups_for(items, 64), k_finding_edges);
  }
};

Discontinuity::Discontinuity(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& defines)
    : impl_(new Impl(device, compiler, defines)) {}
Discontinuity::~Discontinuity() = default;

void Discontinuity::begin(const Frame& frame) {
  Impl& d = *impl_;
  d.begun = false;
  d.sight.begin(frame);
  d.first = {0};
  for (uint32_t level = 0;; ++level) {
    d.first.push_back(d.first.back() + d.cells(level));
    if (d.cells(level) <= 1) break;
  }
  gpu::make_texel_room(d.device, d.buffers.lit, "irradiance of the picture",
                       uint64_t{d.points()} * sizeof(vec3));
  gpu::make_texel_room(d.device, d.buffers.details, "discontinuity",
                       uint64_t{d.first.back()} * sizeof(float));
  gpu::make_texel_room(d.device, d.buffers.taken, "points taken", uint64_t{d.points()} * sizeof(uint32_t));
  gpu::make_texel_room(d.device, d.buffers.taken_levels, "levels of points",
                       uint64_t{d.points()} * sizeof(uint32_t));
  d.begun = true;
}

void Discontinuity::forget() {
  impl_->begun = false;
  impl_->sight.forget();
}
bool Discontinuity::begun() const { return impl_->begun; }
bool Discontinuity::seen() const { return impl_->begun && impl_->sight.seen(); }
const overlay::Sight& Discontinuity::sight() const { return impl_->sight; }
uint32_t Discontinuity::levels() const { return impl_->levels(); }

bool Discontinuity::see(transport::Wavefront& wavefront, const gpu::Buffer& candidates,
                        const std::function<bool()>& cancel) {
  Impl& d = *impl_;
  wavefront.bind_paths(d.resources);
  d.resources.set("candidate_texels", candidates);
  d.resources.set("Surfaces", d.sight.surfaces());
  gpu::Stream& stream = wavefront.stream();
  stream.fill(candidates, 0);
  const auto note = [&](const SeePush& push) {
    d.run(stream, d.ready(d.kernels.surface, "surface"), &push, sizeof push, push.count);
  };
  return d.sight.see(wavefront, k_finding_edges, note, cancel);
}

void Discontinuity::look_up(gpu::Stream& stream, const std::function<void(gpu::Resources&)>& bind) {
  Impl& d = *impl_;
  bind(d.resources);
  d.resources.set("surface_texels", d.sight.surfaces());
  d.resources.set("Lit", d.buffers.lit);
  const LitPush push{d.points()};
  d.run(stream, d.ready(d.kernels.lit, "lit"), &push, sizeof push, push.count);
}

void Discontinuity::measure(gpu::Stream& stream, Of of, const DiscontinuityOptions& o, float least) {
  Impl& d = *impl_;
  d.resources.set("surface_texels", d.sight.surfaces());
  d.resources.set("Lit", d.buffers.lit);
  d.resources.set("Details", d.buffers.details);
  for (uint32_t level = 0; level < d.levels(); ++level) {
    const DetailPush push{.across = d.sight.across(),
                          .down = d.sight.down(),
                          .level = level,
                          .first = d.first[level],
                          .finer = level > 0 ? d.first[level - 1] : 0,
                          .pixel = d.sight.pixel(),
                          .parallel = d.sight.parallel(),
                          .depth_weight = o.depth_weight,
                          .normal_weight = o.normal_weight,
                          .irradiance_weight = of == Of::irradiance ? o.irradiance_weight : 0,
                          .irradiance_noise = o.irradiance_noise,
                          .least = std::max(least, 1e-30f)};
    d.run(stream, d.ready(d.kernels.detail, "detail"), &push, sizeof push, d.cells(level));
  }
}

void Discontinuity::dither(gpu::Stream& stream, Of of, const DiscontinuityOptions& o, const Scale& scale,
                           uint32_t seed) {
  Impl& d = *impl_;
  d.resources.set("surface_texels", d.sight.surfaces());
  d.resources.set("Lit", d.buffers.lit);
  d.resources.set("Details", d.buffers.details);
  d.resources.set("Taken", d.buffers.taken);
  d.resources.set("TakenLevels", d.buffers.taken_levels);
  uint32_t first_level = 0;
  while (first_level + 1 < d.levels() &&
         float(1u << first_level) < scale.least_width / float(d.sight.stride()))
    ++first_level;
  const DitherPush push{.across = d.sight.across(),
                        .down = d.sight.down(),
                        .levels = d.levels(),
                        .first_level = first_level,
                        .density = o.density,
                        .falloff = o.falloff,
                        .pixel = d.sight.pixel(),
                        .parallel = d.sight.parallel(),
                        .finest = scale.finest,
                        .flat_side = scale.flat_side,
                        .spacing = of == Of::irradiance ? k_cell_share : 0,
                        .key = seed};
  d.run(stream, d.ready(d.kernels.dither, "dither"), &push, sizeof push, d.points());
}

Placement::Screen Discontinuity::screen() const {
  const Impl& d = *impl_;
  return {d.sight.surfaces(), d.buffers.taken, d.buffers.taken_levels,
          d.points(),         d.sight.pixel(), k_cell_share};
}

void Discontinuity::draw(const overlay::Canvas& canvas, uint32_t level) {
  Impl& d = *impl_;
  d.resources.set("surface_texels", d.sight.surfaces());
  d.resources.set("Details", d.buffers.details);
  d.resources.set("Picture", canvas.picture());
  level = std::min(level, d.levels() - 1);
  const overlay::Sight& s = d.sight;
  const DiscontinuityDrawPush push{
      canvas.width(), canvas.height(), s.across(), s.down(), canvas.scale() * s.stride(),
      level,          d.first[level]};
  d.run(canvas.stream(), d.ready(d.kernels.draw, "discontinuity_draw"), &push, sizeof push,
        uint32_t(canvas.pixels()));
}

uint64_t Discontinuity::bytes() const {
  uint64_t sum = impl_->sight.bytes();
  for (const gpu::Buffer* b :
       {&impl_->buffers.lit, &impl_->buffers.details, &impl_->buffers.taken, &impl_->buffers.taken_levels})
    sum += *b ? b->bytes() : 0;
  return sum;
}

std::vector<float> Discontinuity::level(uint32_t k) const {
  std::vector<float> values(impl_->cells(k));
  impl_->buffers.details.read(values.data(), values.size() * sizeof(float), impl_->first[k] * sizeof(float));
  return values;
}

std::vector<uint32_t> Discontinuity::taken() const {
  std::vector<uint32_t> flags(impl_->points()), levels_of(impl_->points());
  impl_->buffers.taken.read(flags.data(), flags.size() * sizeof(uint32_t));
  impl_->buffers.taken_levels.read(levels_of.data(), levels_of.size() * sizeof(uint32_t));
  for (size_t i = 0; i < flags.size(); ++i)
    if (flags[i] == 0) levels_of[i] = levels();
  return levels_of;
}

void Discontinuity::set(const std::vector<vec4>& surfaces, const std::vector<vec3>& lit) {
  impl_->sight.set(surfaces);
  impl_->buffers.lit.write(std::span<const vec3>(lit));
}

}  // namespace lucerna::irradiance_cache
