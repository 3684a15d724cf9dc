#include "film/filter/filter.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lucerna::film {

using shared::FilterPush;

Filter::Filter(gpu::Device& device, gpu::ShaderCompiler& compiler)
    : device_(device),
      pack_(device, compiler, "film/filter/pack.comp"),
      spread_(device, compiler, "film/filter/spread.comp"),
      tame_(device, compiler, "film/filter/tame.comp"),
      outliers_(device, compiler, "film/filter/outliers.comp"),
      noise_(device, compiler, "film/filter/noise.comp"),
      guide_(device, compiler, "film/filter/guide.comp"),
      regress_(device, compiler, "film/filter/regress.comp", {{"LUCERNA_FILTER_GUIDED", "1"}}),
      regress_again_(device, compiler, "film/filter/regress.comp", {{"LUCERNA_FILTER_GUIDED", "0"}}),
      judge_(device, compiler, "film/filter/judge.comp"),
      choose_(device, compiler, "film/filter/choose.comp"),
      blend_(device, compiler, "film/filter/blend.comp") {}

namespace {

// Stride of the window's pixels in each regression: increasing, and a small one at the end, so that no
// pattern of the wide ones remains.
constexpr uint32_t k_strides[] = {1, 2, 4, 1};

// Pixels fitted in one work item.
constexpr uint32_t k_piece = 1u << 16;

/// Factor that scales the picture's mean luminance to about 1: a power of two, so that nothing is rounded.
float scale_of(const ByComponent<vec3>& means) {
  const float y = luminance(means[0] + means[1] + means[2] + means[3]);
  return y > 0 && std::isfinite(y) ? std::exp2(-std::round(std::log2(y))) : 1.0f;
}

}  // namespace

void Filter::apply(gpu::Stream& stream, const Film& film, Film& filtered, const gpu::Buffer* seen,
                   uint32_t looked_up) {
  begin(film, filtered, seen, looked_up);
  while (step(stream)) {
  }
  release();
}

void Filter::begin(const Film& film, Film& filtered, const gpu::Buffer* seen, uint32_t looked_up) {
  release();
  const uint32_t width = film.width(), height = film.height();
  if (!film.fits_storage_buffers())
    throw_error("filter", "{}x{} is larger than this device can filter at once", width, height);
  const uint64_t pixels = uint64_t{width} * height;
  for (gpu::Buffer* b : {&lights_, &tamed_, &surfaces_, &guides_, &fitted_, &judged_, &chosen_})
    gpu::make_texel_room(device_, *b, "filter", pixels * 16);
  const uint32_t blocks =
      gpu::groups_for(width, shared::k_filter_block) * gpu::groups_for(height, shared::k_filter_block);
  gpu::make_texel_room(device_, taken_, "filter outliers", blocks * uint64_t{16});
  film.bind(resources_);
  resources_.set("FilterSurfaces", surfaces_);
  resources_.set("filter_surfaces", surfaces_);
  resources_.set("FilterTaken", taken_);
  resources_.set("filter_taken", taken_);
  resources_.set("filter_seen", seen ? *seen : surfaces_);
  const auto means = Film::means(film.read());
  push_ = {.width = width,
           .height = height,
           .component = 0,
           .stride = 1,
           .first = 0,
           .looked_up = film.lookup_errors_complete() ? looked_up : 0,
           .seen = seen != nullptr,
           .scale = scale_of(means)};
  work_.push_back([&film, &filtered](gpu::Stream& stream) { filtered.copy_surfaces(stream, film); });
  for (const uint32_t c : k_components)
    if (means[c] == vec3(0))
      work_.push_back([&filtered, c](gpu::Stream& stream) { stream.fill(filtered.sums(c), 0); });
    else
      plan_component(c, filtered);
}

bool Filter::step(gpu::Stream& stream) {
  if (work_.empty()) return false;
  try {
    work_.front()(stream);
  } catch (...) {
    stream.discard();
    release();
    throw;
  }
  stream.run();
  work_.pop_front();
  return !work_.empty();
}

void Filter::release() {
  work_.clear();
  for (gpu::Buffer* b : {&lights_, &tamed_, &taken_, &surfaces_, &guides_, &fitted_, &judged_, &chosen_})
    *b = {};
}

void Filter::plan_component(uint32_t component, Film& filtered) {
  using Names = std::vector<std::pair<const char*, const gpu::Buffer*>>;
  const uint32_t pixels = push_.width * push_.height;
  FilterPush push = push_;
  push.component = component;
  const auto run = [&](const char* step, const gpu::Kernel& kernel, const Names& names, uint32_t count) {
    work_.push_back([this, step, &kernel, names, count, push](gpu::Stream& stream) {
      for (const auto& [name, buffer] : names) resources_.set(name, *buffer);
      stream.dispatch(kernel, resources_, push, gpu::groups_for(count, 64), step);
    });
  };
  run("pack", pack_, {{"FilterLights", &lights_}}, pixels);
  run("spread", spread_, {{"filter_lights", &lights_}, {"FilterSpread", &judged_}}, pixels);
  run("tame", tame_, {{"filter_lights", &lights_}, {"filter_spread", &judged_}, {"FilterTamed", &tamed_}},
      pixels);
  run("outliers", outliers_, {{"filter_lights", &lights_}, {"filter_tamed", &tamed_}},
      uint32_t(taken_.bytes() / 16));
  // Later comparisons use the samples without their outliers.
  run("noise", noise_, {{"filter_noisy", &tamed_}, {"FilterMeasured", &lights_}}, pixels);
  run("guide", guide_, {{"filter_lights", &lights_}, {"FilterGuides", &guides_}}, pixels);
  const gpu::Buffer *before = &lights_, *after = &chosen_;
  for (size_t stage = 0; stage < std::size(k_strides); ++stage) {
    push.stride = k_strides[stage];
    for (push.first = 0; push.first < pixels; push.first += k_piece)
      run("regress", stage == 0 ? regress_ : regress_again_,
          {{"filter_data", before}, {"filter_guides", &guides_}, {"FilterFitted", &fitted_}},
          std::min(k_piece, pixels - push.first));
    push.first = 0;
    run("judge", judge_,
        {{"filter_lights", &lights_},
         {"filter_before", before},
         {"filter_fitted", &fitted_},
         {"FilterJudged", &judged_}},
        pixels);
    run("choose", choose_,
        {{"filter_before", before},
         {"filter_fitted", &fitted_},
         {"filter_judged", &judged_},
         {"FilterChosen", after}},
        pixels);
    if (stage + 1 < std::size(k_strides)) {
      run("noise", noise_, {{"filter_noisy", after}, {"FilterMeasured", &guides_}}, pixels);
      before = &guides_;
    }
  }
  run("blend", blend_, {{"filter_chosen", after}, {"FilteredSums", &filtered.sums(component)}}, pixels);
}

}  // namespace lucerna::film
