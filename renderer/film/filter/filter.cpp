#include "film/filter/filter.h"

#include <cmath>
#include <iterator>

namespace lucerna::film {

using shared::FilterPush;

Filter::Filter(gpu::Device& device, gpu::ShaderCompiler& compiler)
    : device_(device),
      pack_(device, compiler, "film/filter/pack.comp"),
      tame_(device, compiler, "film/filter/tame.comp"),
      outliers_(device, compiler, "film/filter/outliers.comp"),
      noise_(device, compiler, "film/filter/noise.comp"),
      guide_(device, compiler, "film/filter/guide.comp"),
      regress_(device, compiler, "film/filter/regress.comp"),
      judge_(device, compiler, "film/filter/judge.comp"),
      choose_(device, compiler, "film/filter/choose.comp"),
      blend_(device, compiler, "film/filter/blend.comp") {}

namespace {

// Pixels from one of the window's to the next, of each regression: wider and wider, and once more at the end,
// so that no pattern of the wide ones is left.
constexpr uint32_t k_strides[] = {1, 2, 4, 1};

/// Brings the mean luminance of the picture to about 1: a power of two, so that nothing is rounded.
float scale_of(const std::array<vec3, k_components>& means) {
  const float y = luminance(means[0] + means[1] + means[2] + means[3]);
  return y > 0 && std::isfinite(y) ? std::exp2(-std::round(std::log2(y))) : 1.0f;
}

}  // namespace

void Filter::apply(gpu::Stream& stream, const Film& film, Film& filtered) {
  const uint32_t width = film.width(), height = film.height();
  if (!film.fits_storage_buffers())
    throw_error("filter", "{}x{} is larger than this device can filter at once", width, height);
  const uint64_t pixels = uint64_t{width} * height;
  const auto room = [&](gpu::Buffer& buffer, const char* name) {
    gpu::make_texel_room(device_, buffer, name, pixels * 16);
  };
  for (gpu::Buffer* b : {&lights_, &tamed_, &surfaces_, &guides_, &fitted_, &judged_, &chosen_}) room(*b, "filter");
  const uint32_t blocks =
      gpu::groups_for(width, shared::k_filter_block) * gpu::groups_for(height, shared::k_filter_block);
  gpu::make_texel_room(device_, taken_, "filter outliers", blocks * uint64_t{16});
  filtered.copy_surfaces(stream, film);
  film.bind(resources_);
  resources_.set("FilterSurfaces", surfaces_);
  resources_.set("filter_surfaces", surfaces_);
  resources_.set("FilterTaken", taken_);
  resources_.set("filter_taken", taken_);
  const auto means = Film::means(film.read());
  const uint32_t groups = gpu::groups_for(pixels, 64);
  FilterPush push{width, height, 0, 1, scale_of(means)};
  const auto run = [&](const gpu::Kernel& kernel,
                       std::initializer_list<std::pair<const char*, const gpu::Buffer*>> names,
                       uint32_t count) {
    for (const auto& [name, buffer] : names) resources_.set(name, *buffer);
    stream.dispatch(kernel, resources_, push, count, "filter");
  };
  for (uint32_t c = 0; c < k_components; ++c) {
    const gpu::Buffer& sums = filtered.sums(c);
    if (means[c] == vec3(0)) {
      stream.fill(sums, 0);
      continue;
    }
    push.component = c;
    push.stride = 1;
    run(pack_, {{"FilterLights", &lights_}}, groups);
    run(tame_, {{"filter_lights", &lights_}, {"FilterTamed", &tamed_}}, groups);
    run(outliers_, {{"filter_lights", &lights_}, {"filter_tamed", &tamed_}}, gpu::groups_for(blocks, 64));
    // What later is compared with are the samples without their outliers.
    run(noise_, {{"filter_noisy", &tamed_}, {"FilterMeasured", &lights_}}, groups);
    run(guide_, {{"filter_lights", &lights_}, {"FilterGuides", &guides_}}, groups);
    const gpu::Buffer *before = &lights_, *guide = &guides_, *after = &chosen_;
    for (size_t stage = 0; stage < std::size(k_strides); ++stage) {
      push.stride = k_strides[stage];
      run(regress_, {{"filter_data", before}, {"filter_guides", guide}, {"FilterFitted", &fitted_}}, groups);
      run(judge_,
          {{"filter_lights", &lights_},
           {"filter_before", before},
           {"filter_fitted", &fitted_},
           {"FilterJudged", &judged_}},
          groups);
      run(choose_,
          {{"filter_before", before},
           {"filter_fitted", &fitted_},
           {"filter_judged", &judged_},
           {"FilterChosen", after}},
          groups);
      if (stage + 1 < std::size(k_strides)) {
        run(noise_, {{"filter_noisy", after}, {"FilterMeasured", &guides_}}, groups);
        before = guide = &guides_;
      }
    }
    run(blend_, {{"filter_chosen", after}, {"FilteredSums", &sums}}, groups);
  }
  stream.run();
}

}  // namespace lucerna::film
