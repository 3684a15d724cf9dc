// links: upload
// Textures read by shaders from the shared pages, compared with a bilinear filter on the host: every size,
// wrap mode, format and transform; and the guarantees of the packing.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "gpu/stream.h"
#include "support/device_name.h"
#include "upload/device_scene.h"
#include "upload/textures.h"

namespace texture_read_tests {

using namespace lucerna;

namespace {

double srgb(double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); }

int64_t wrapped(int64_t i, int64_t size, scene::Wrap wrap) {
  if (wrap == scene::Wrap::clamp) return std::clamp<int64_t>(i, 0, size - 1);
  const int64_t period = wrap == scene::Wrap::mirror ? 2 * size : size, k = ((i % period) + period) % period;
  return k < size ? k : 2 * size - 1 - k;
}

glm::dvec4 reference(const scene::Scene& s, const scene::TextureUse& use, vec2 uv) {
  const scene::Texture& t = s.textures[use.texture];
  const scene::Image& image = s.images[t.image];
  const double u = double(use.m[0]) * uv.x + double(use.m[1]) * uv.y + use.m[2],
               v = double(use.m[3]) * uv.x + double(use.m[4]) * uv.y + use.m[5];
  const auto texel = [&](int64_t x, int64_t y) {
    const size_t at =
        4 * size_t(wrapped(y, image.height, t.wrap_v) * image.width + wrapped(x, image.width, t.wrap_u));
    glm::dvec4 c;
    for (int k = 0; k < 4; ++k) {
      c[k] = image.floats.empty() ? image.bytes[at + k] / 255.0 : image.floats[at + k];
      if (t.srgb && image.floats.empty() && k < 3) c[k] = srgb(c[k]);
    }
    return c;
  };
  const double x = u * image.width, y = v * image.height;
  if (t.nearest) return texel(int64_t(std::floor(x)), int64_t(std::floor(y)));
  const double x0 = std::floor(x - 0.5), y0 = std::floor(y - 0.5), fx = x - 0.5 - x0, fy = y - 0.5 - y0;
  const auto at = [&](int dx, int dy) { return texel(int64_t(x0) + dx, int64_t(y0) + dy); };
  return glm::mix(glm::mix(at(0, 0), at(1, 0), fx), glm::mix(at(0, 1), at(1, 1), fx), fy);
}

/// One texture of each combination, each on its own material, and a material without a texture.
scene::Scene make_scene(bool only_repeat) {
  std::mt19937 engine(5);
  scene::Scene s;
  s.file = "textures";
  const std::pair<uint32_t, uint32_t> sizes[] = {{1, 1}, {2, 3}, {16, 16}, {64, 8}, {7, 100}, {256, 128}};
  const auto add = [&](uint32_t w, uint32_t h, bool floats, bool srgb_texture, scene::Wrap u, scene::Wrap v,
                       bool nearest) {
    scene::Image image;
    image.width = w, image.height = h;
    for (uint32_t i = 0; i < 4 * w * h; ++i)
      floats ? image.floats.push_back(float(engine() % 1000) * 0.01f)
             : image.bytes.push_back(uint8_t(engine() >> 20));
    s.images.push_back(image);
    s.textures.push_back({scene::Id(s.images.size() - 1), u, v, nearest, srgb_texture});
    scene::Material m;
    m.base_color_texture.texture = scene::Id(s.textures.size() - 1);
    if (s.materials.size() % 3 == 1) m.base_color_texture.m = {0.5f, -1.25f, 0.125f, 2, 0.25f, -3};
    s.materials.push_back(m);
  };
  const scene::Wrap wraps[] = {scene::Wrap::repeat, scene::Wrap::clamp, scene::Wrap::mirror};
  for (const auto& [w, h] : sizes) {
    if (only_repeat) {
      add(w, h, false, true, scene::Wrap::repeat, scene::Wrap::repeat, false);
      continue;
    }
    for (const scene::Wrap u : wraps)
      for (const scene::Wrap v : wraps)
        for (const int kind : {0, 1, 2}) add(w, h, kind == 2, kind == 0, u, v, engine() % 4 == 0);
  }
  s.materials.emplace_back();
  return s;
}

}  // namespace

TEST_CASE("every texture reads like a bilinear filter on the host") {
  gpu::Device device({test::device_name(), true});
  gpu::ShaderCompiler compiler;
  for (const bool only_repeat : {true, false}) {
    const scene::Scene s = make_scene(only_repeat);
    const upload::FlatScene flat = upload::flatten(s);
    CHECK(flat.buckets.size() == (only_repeat ? 1 : 3));
    CHECK(flat.effects.tex_wraps == !only_repeat);
    const upload::DeviceScene on_device(device, flat, {});
    const gpu::Kernel kernel(device, compiler,
                             std::string(LUCERNA_SOURCE_DIR) + "/tests/kernels/shaders/texture_probe.comp",
                             on_device.defines());
    std::mt19937 engine(9);
    std::vector<vec2> at(s.materials.size() * 200);
    const auto materials = uint32_t(s.materials.size());
    for (size_t i = 0; i < at.size(); ++i) {
      const auto uniform = [&] { return float(engine() >> 8) * (1.0f / 16777216.0f); };
      // A third at or close to the borders, where neighbours on the page must not bleed in.
      at[i] = i / materials % 3 ? vec2(uniform() * 4 - 2, uniform() * 4 - 2)
                                : vec2(float(engine() % 5) - 2 + (uniform() - 0.5f) * 1e-3f, uniform());
    }
    gpu::Buffer coordinates(device, {.name = "coordinates", .bytes = at.size() * sizeof(vec2)});
    gpu::Buffer texels(device, {.name = "texels", .bytes = at.size() * sizeof(vec4)});
    coordinates.write(std::span<const vec2>(at));
    gpu::Resources resources;
    on_device.bind(resources);
    resources.set("Coordinates", coordinates);
    resources.set("Texels", texels);
    gpu::Stream stream(device);
    const struct { uint32_t count, materials; } push{uint32_t(at.size()), materials};
    stream.dispatch(kernel, resources, push, gpu::groups_for(at.size(), 64));
    stream.run();
    const std::vector<vec4> got = texels.read_all<vec4>();
    size_t wrong = 0;
    for (size_t i = 0; i < at.size(); ++i) {
      const scene::TextureUse& use = s.materials[i % materials].base_color_texture;
      if (!use) {
        CHECK(got[i] == vec4(7));
        continue;
      }
      const scene::Texture& t = s.textures[use.texture];
      const scene::Image& image = s.images[t.image];
      // Filters have at least 8 bits of fraction; between two texels that is 1/256 of their difference in
      // each direction. Near an edge a nearest texel may be its neighbour by rounding.
      const double range = image.floats.empty() ? 1 : 10;
      glm::dvec4 best = reference(s, use, at[i]) - glm::dvec4(got[i]);
      if (t.nearest)
        for (const vec2 shift : {vec2(1e-5f, 0), vec2(-1e-5f, 0), vec2(0, 1e-5f), vec2(0, -1e-5f)}) {
          const glm::dvec4 other = reference(s, use, at[i] + shift) - glm::dvec4(got[i]);
          if (glm::length(other) < glm::length(best)) best = other;
        }
      for (int k = 0; k < 4; ++k)
        if (!(std::abs(best[k]) <= range * (t.nearest ? 0.005 : 0.012))) {
          ++wrong;
          if (wrong < 5)
            UNSCOPED_INFO(image.width << "x" << image.height << " wraps " << int(t.wrap_u) << int(t.wrap_v)
                                      << " nearest " << t.nearest << " at " << at[i].x << " " << at[i].y
                                      << " channel " << k << " off by " << best[k]);
        }
    }
    CHECK(wrong == 0);
  }
  CHECK(device.validation_messages() == 0);
}

TEST_CASE("packing: nothing overlaps, equal uses share, and textures beyond the limit are refused") {
  scene::Scene s = make_scene(false);
  s.textures.push_back(s.textures.front());  // the same image, with the same use
  std::vector<upload::Bucket> buckets;
  const upload::TextureMap map = upload::pack_textures(s, buckets);
  CHECK(map.place.back().rect == map.place.front().rect);
  const auto box = [&](size_t i) {
    const upload::TexturePlace& p = map.place[i];
    const upload::Bucket& b = buckets[p.bucket];
    const vec2 page(b.width, b.height), low = vec2(p.rect.x, p.rect.y) * page - 1.0f,
                                        high = low + p.size + 2.0f;
    CHECK(low.x >= -0.01f);
    CHECK(low.y >= -0.01f);
    CHECK(high.x <= page.x + 0.01f);
    CHECK(high.y <= page.y + 0.01f);
    return std::tuple{p.bucket, p.bits & 0x7ffu, low, high};
  };
  for (size_t i = 0; i + 1 < s.textures.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const auto [bi, li, lowi, highi] = box(i);
      const auto [bj, lj, lowj, highj] = box(j);
      const bool apart = bi != bj || li != lj || lowi.x >= highj.x - 0.01f || lowj.x >= highi.x - 0.01f ||
                         lowi.y >= highj.y - 0.01f || lowj.y >= highi.y - 0.01f;
      if (!apart) FAIL("textures " << j << " and " << i << " overlap");
    }
  // Small buckets: more of them, up to the limit.
  const upload::TextureMap split = upload::pack_textures(s, buckets, 4 << 20);
  CHECK(split.place.size() == map.place.size());
  CHECK_THROWS_AS(upload::pack_textures(s, buckets, 1), Error);
}

}  // namespace texture_read_tests
