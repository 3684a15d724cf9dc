#include "film/developer.h"

namespace lucerna::film {

using namespace shared;

namespace {
uint32_t groups(const Film& film) { return gpu::groups_for(uint64_t{film.width()} * film.height(), 64); }
}  // namespace

Developer::Developer(gpu::Device& device, gpu::ShaderCompiler& compiler)
    : device_(device),
      compiler_(compiler),
      tonemap_(device, compiler, "film/tonemap.comp"),
      heat_(device, compiler, "film/heat.comp"),
      tiles_(device, compiler, "film/tiles.comp"),
      no_coarse_(device, {.name = "no coarse picture", .bytes = 16, .memory = gpu::Memory::host}) {}

void Developer::develop(gpu::Stream& stream, const Film& film, const View& view, const Film* coarse) {
  film.bind(resources_);
  if (view.layer >= k_layer_samples && !is_own_layer(view.layer)) {
    const HeatScale& h = view.heat;
    const HeatPush push{film.width(), film.height(), view.layer, h.ramp, h.logarithmic, h.lo, h.hi, h.unit};
    stream.dispatch(heat_, resources_, push, groups(film));
    return;
  }
  if (is_own_layer(view.layer)) film.bind_layer(resources_, view.layer - k_layer_first_own);
  resources_.set("Coarse", coarse ? coarse->picture() : no_coarse_);
  const TonePush push{film.width(),
                      film.height(),
                      view.layer,
                      view.show,
                      view.curve,
                      view.exposure,
                      view.scale,
                      coarse ? coarse->width() : 0,
                      coarse ? coarse->height() : 0,
                      0};
  stream.dispatch(tonemap_kernel(view), resources_, push, groups(film));
}

gpu::Kernel& Developer::tonemap_kernel(const View& view) {
  const bool own = is_own_layer(view.layer), by_lut = view.display_lut != nullptr;
  if (by_lut) resources_.set("DisplayLut", *view.display_lut);
  if (!own && !by_lut) return tonemap_;
  gpu::Kernel& kernel = tonemaps_[{own, by_lut}];
  if (!kernel)
    kernel =
        gpu::Kernel(device_, compiler_, "film/tonemap.comp",
                    {{"LUCERNA_DISPLAY_LUT", by_lut ? "1" : "0"}, {"LUCERNA_FILM_LAYER", own ? "1" : "0"}});
  return kernel;
}

void Developer::tone_map(gpu::Stream& stream, const Film& film, const View& view, const Film* coarse) {
  // The coarse film has no layers by path expressions.
  if (is_own_layer(view.layer)) coarse = nullptr;
  if (coarse) develop(stream, *coarse, view, nullptr);
  develop(stream, film, view, coarse);
  draw_tiles(stream, film, view, film.picture(), 1);
}

gpu::Kernel& Developer::mix_kernel(const Film& film, const View& view) {
  const auto [at, made] = mixes_.try_emplace({film.is_compact(), view.curve});
  if (made || !at->second)
    at->second = gpu::Kernel(device_, compiler_, "film/mix.comp",
                             {{"LUCERNA_GROUP_SUMS", film.is_compact() ? "1" : "0"},
                              {"LUCERNA_TONE_CURVE", std::to_string(view.curve)}});
  return at->second;
}

void Developer::prepare_mix(gpu::Stream& stream, const Film& film, const View& view) {
  if (!film.quick() || mixes_.contains({film.is_compact(), view.curve})) return;
  film.bind(resources_);
  stream.dispatch(mix_kernel(film, view), resources_, MixPush{}, 1);
  stream.run();
  stream.take_times();
}

void Developer::mix(gpu::Stream& stream, const Film& film, const View& view) {
  film.bind(resources_);
  const MixPush push{film.width(), film.height(), film.groups(), view.exposure};
  stream.dispatch(mix_kernel(film, view), resources_, push, groups(film));
  stream.run();
  stream.take_times();
}

void Developer::draw_tiles(gpu::Stream& stream, const Film& film, const View& view,
                           const gpu::Buffer& picture, uint32_t scale) {
  if (view.tiles > 0) {
    film.bind(resources_);
    resources_.set("Picture", picture);
    const uint32_t width = scale * film.width(), height = scale * film.height();
    const TilesPush push{width, height, scale * view.tiles, (film.width() + view.tiles - 1) / view.tiles, 1};
    stream.dispatch(tiles_, resources_, push, gpu::groups_for(uint64_t{width} * height, 64));
  }
  stream.run();
  stream.take_times();
}

}  // namespace lucerna::film
