#pragma once
// A film of synthetic samples and its preview, through the real shaders.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <functional>
#include <numeric>
#include <random>

#include "film/developer.h"
#include "film/preview.h"
#include "film/tonemap.h"
#include "support/device_name.h"

namespace lucerna::test {

using film::Film;

inline uint32_t compact(uint32_t x) { return (x & 1u) | (x >> 1 & 2u) | (x >> 2 & 4u); }

/// The values of a pixel's sample.
struct Sample {
  vec3 light{0}, albedo{1}, normal{0, 0, 1};
  float depth = 5;  ///< 0: no surface
};
using Source = std::function<Sample(uint32_t x, uint32_t y)>;

struct Stage {
  uint32_t width, height;
  uint32_t component = 1;  ///< of the samples' light
  gpu::Device device{{test::device_name(), true}};
  gpu::ShaderCompiler compiler;
  gpu::Stream stream{device};
  gpu::Kernel add{device, compiler, "film/add.comp"};
  film::Developer developer{device, compiler};
  film::Preview preview{device, compiler};
  Film film{device, width, height};
  film::View view;
  film::PreviewCamera camera{{vec3(0), vec3(1, 0, 0), vec3(0, 0.75f, 0), vec3(0, 0, -1)}, false};

  Stage(uint32_t w, uint32_t h) : width(w), height(h) {
    view.curve = shared::k_tone_linear;
    film.clear(stream);
  }
  ~Stage() { CHECK(device.validation_messages() == 0); }

  /// Adds samples to all pixels of a film, or to those of blocks where `where` is true.
  void sample(
      Film& to, uint32_t samples, const Source& source,
      const std::function<bool(uint32_t block)>& where = [](uint32_t) { return true; }) {
    std::vector<shared::WorkBlock> list;
    for (uint32_t b = 0; b < to.blocks(); ++b)
      if (where(b)) list.push_back({b, 0});
    const size_t slots = list.size() * 64 * samples;
    std::vector<vec4> light(slots * 4, vec4(0)), features(slots * 2, vec4(0));
    for (uint32_t s = 0; s < samples; ++s)
      for (size_t b = 0; b < list.size(); ++b)
        for (uint32_t code = 0; code < 64; ++code) {
          const uint32_t across = to.blocks_across(), x = list[b].index % across * 8 + compact(code),
                         y = list[b].index / across * 8 + compact(code >> 1);
          const Sample v = source(x, y);
          const size_t slot = (s * list.size() + b) * 64 + code;
          light[slot * 4 + component] = vec4(v.light, 0);
          if (v.depth > 0)
            features[2 * slot] = vec4(v.albedo, 1), features[2 * slot + 1] = vec4(v.normal, v.depth);
        }
    gpu::Buffer radiance(device, {.name = "radiance", .bytes = light.size() * 16, .texel = true});
    gpu::Buffer surfaces(device, {.name = "features", .bytes = features.size() * 16, .texel = true});
    gpu::Buffer work(device, {.name = "work", .bytes = list.size() * sizeof(shared::WorkBlock)});
    radiance.write(std::span<const vec4>(light));
    surfaces.write(std::span<const vec4>(features));
    work.write(std::span<const shared::WorkBlock>(list));
    gpu::Resources resources;
    to.bind(resources);
    resources.set("WorkBlocks", work);
    resources.set("radiance_texels", radiance);
    resources.set("feature_texels", surfaces);
    const auto n = uint32_t(list.size());
    stream.dispatch(add, resources, shared::FilmPush{to.width(), to.height(), 64 * n, samples, 0, 0}, n);
    stream.run();
  }
  film::PreviewShares show(const Film* draft = nullptr, bool filtered = true) {
    return preview.develop(stream, film, draft, view, camera, filtered);
  }
  /// Linear red as displayed.
  std::vector<float> shown() const {
    const std::vector<uint8_t> rgba = film.read_picture();
    std::vector<float> red;
    for (size_t i = 0; i < rgba.size(); i += 4) {
      const float c = float(rgba[i]) / 255;
      red.push_back(c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f));
    }
    return red;
  }
};

struct Seen {
  float albedo = 1, depth = 5;
  bool emits = false, beyond = false;
  float mirrors = 0;
};

/// Surfaces of so many pixels, or a stage's, that face the camera, in the format of shaders/shared/preview.h.
inline gpu::Buffer surfaces_of(Stage& stage, uint32_t width, uint32_t height,
                               const std::function<Seen(uint32_t x, uint32_t y)>& at) {
  std::vector<vec4> texels;
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      const Seen s = at(x, y);
      const auto byte = uint32_t(std::lround(s.albedo * 255));
      // A normal towards the camera is 0 on the octahedron.
      const uint32_t bits[2] = {0, byte * 0x010101u | (s.emits ? 0 : 0xff000000u)};
      vec4 texel(s.depth, 0, 0,
                 s.beyond ? shared::k_preview_beyond : shared::k_preview_direct - 0.5f * s.mirrors);
      std::memcpy(&texel.y, bits, sizeof bits);
      texels.push_back(texel);
    }
  gpu::Buffer surfaces(stage.device, {.name = "surfaces", .bytes = texels.size() * 16, .texel = true});
  surfaces.write(std::span<const vec4>(texels));
  return surfaces;
}
inline gpu::Buffer surfaces_of(Stage& stage, const std::function<Seen(uint32_t x, uint32_t y)>& at) {
  return surfaces_of(stage, stage.width, stage.height, at);
}

/// The preview of a stage's film with known primary visibility.
inline film::PreviewShares show_seen(Stage& stage, const gpu::Buffer& surfaces) {
  return stage.preview.develop(stage.stream, stage.film, nullptr, stage.view, stage.camera, true,
                               film::Sampled::all, &surfaces);
}

inline double mean_of(const std::vector<float>& shown) {
  return std::accumulate(shown.begin(), shown.end(), 0.0) / double(shown.size());
}

inline double rms(const std::vector<float>& shown, const std::function<float(uint32_t, uint32_t)>& truth,
                  uint32_t width) {
  double sum = 0;
  for (size_t i = 0; i < shown.size(); ++i) {
    const double d = shown[i] / truth(uint32_t(i) % width, uint32_t(i) / width) - 1;
    sum += d * d;
  }
  return std::sqrt(sum / double(shown.size()));
}

}  // namespace lucerna::test
