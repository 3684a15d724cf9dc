#include "upload/textures.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

#include "base/error.h"
#include "shaders/shared/scene.h"

namespace lucerna::upload {
namespace {

using namespace shared;
using Key = std::tuple<uint32_t, uint32_t, bool, bool>;  // width, height, floats, srgb

Key key_of(const scene::Scene& scene, const scene::Texture& t) {
  const scene::Image& i = scene.images[t.image];
  return {i.width, i.height, !i.floats.empty(), t.srgb && i.floats.empty()};
}

/// Bilinear enlargement, repeating at the borders, channel by channel on the stored values.
template <class T>
std::vector<uint8_t> enlarge(const std::vector<T>& from, uint32_t w, uint32_t h, uint32_t to_w,
                             uint32_t to_h) {
  std::vector<T> out(size_t(to_w) * to_h * 4);
  for (uint32_t y = 0; y < to_h; ++y)
    for (uint32_t x = 0; x < to_w; ++x) {
      const double sx = (x + 0.5) * w / to_w - 0.5, sy = (y + 0.5) * h / to_h - 0.5;
      const double fx = sx - std::floor(sx), fy = sy - std::floor(sy);
      const uint32_t x0 = uint32_t(int(std::floor(sx)) + int(w)) % w,
                     y0 = uint32_t(int(std::floor(sy)) + int(h)) % h;
      const uint32_t x1 = (x0 + 1) % w, y1 = (y0 + 1) % h;
      for (int c = 0; c < 4; ++c) {
        const auto at = [&](uint32_t px, uint32_t py) { return double(from[(size_t(py) * w + px) * 4 + c]); };
        const double v = (at(x0, y0) * (1 - fx) + at(x1, y0) * fx) * (1 - fy) +
                         (at(x0, y1) * (1 - fx) + at(x1, y1) * fx) * fy;
        out[(size_t(y) * to_w + x) * 4 + c] = std::is_integral_v<T> ? T(v + 0.5) : T(v);
      }
    }
  std::vector<uint8_t> bytes(out.size() * sizeof(T));
  std::memcpy(bytes.data(), out.data(), bytes.size());
  return bytes;
}

template <class T>
std::vector<uint8_t> as_bytes(const std::vector<T>& v) {
  std::vector<uint8_t> bytes(v.size() * sizeof(T));
  std::memcpy(bytes.data(), v.data(), bytes.size());
  return bytes;
}

double srgb_to_linear(double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); }

}  // namespace

uint32_t TextureMap::bits(const scene::TextureUse& use) const {
  return use ? place[use.texture] | (use.uv_set == 1 ? k_texture_uv1 : 0u) : 0u;
}

TextureMap pack_textures(const scene::Scene& scene, std::vector<Bucket>& buckets) {
  buckets.clear();
  std::map<Key, Key> home;  // kind of texture -> kind of bucket
  for (const scene::Texture& t : scene.textures) {
    const Key k = key_of(scene, t);
    home.emplace(k, k);
  }
  // Join kinds until they fit: the two of one format whose common size costs the fewest added texels.
  const auto kinds = [&] {
    std::vector<Key> list;
    for (const auto& [from, to] : home)
      if (std::find(list.begin(), list.end(), to) == list.end()) list.push_back(to);
    return list;
  };
  for (auto list = kinds(); list.size() > k_max_buckets; list = kinds()) {
    double best = 1e300;
    Key a, b, joined;
    for (size_t i = 0; i < list.size(); ++i)
      for (size_t j = i + 1; j < list.size(); ++j) {
        const auto [wa, ha, fa, sa] = list[i];
        const auto [wb, hb, fb, sb] = list[j];
        if (fa != fb || sa != sb) continue;
        const double size = double(std::max(wa, wb)) * std::max(ha, hb);
        const double cost = 2 * size - double(wa) * ha - double(wb) * hb;
        if (cost < best)
          best = cost, a = list[i], b = list[j], joined = Key{std::max(wa, wb), std::max(ha, hb), fa, sa};
      }
    for (auto& [from, to] : home)
      if (to == a || to == b) to = joined;
  }
  std::map<Key, uint32_t> number;
  std::map<std::tuple<scene::Id, Key>, uint32_t> layer_of;  // an image used twice is stored once a bucket
  TextureMap map;
  for (const scene::Texture& t : scene.textures) {
    const scene::Image& image = scene.images[t.image];
    const Key key = home.at(key_of(scene, t));
    const auto [w, h, floats, srgb] = key;
    const auto [at, fresh] = number.emplace(key, uint32_t(buckets.size()));
    if (fresh) buckets.push_back({w, h, floats, srgb, {}});
    Bucket& bucket = buckets[at->second];
    const auto [layer, first_use] =
        layer_of.emplace(std::tuple{t.image, key}, uint32_t(bucket.layers.size()));
    if (first_use) {
      if (bucket.layers.size() == 2048)
        throw_error(scene.file, "more than 2048 textures of {}x{}; merge some or use other sizes", w, h);
      const bool same = image.width == w && image.height == h;
      if (floats)
        bucket.layers.push_back(same ? as_bytes(image.floats)
                                     : enlarge(image.floats, image.width, image.height, w, h));
      else
        bucket.layers.push_back(same ? image.bytes : enlarge(image.bytes, image.width, image.height, w, h));
    }
    map.place.push_back(layer->second | at->second << 11 | uint32_t(t.wrap_u) << 16 |
                        uint32_t(t.wrap_v) << 18 | (t.nearest ? k_texture_nearest : 0u) | k_texture_present);
  }
  return map;
}

vec3 read_texture(const scene::Scene& scene, const scene::TextureUse& use, vec2 uv) {
  const scene::Texture& t = scene.textures[use.texture];
  const scene::Image& image = scene.images[t.image];
  const float u = use.m[0] * uv.x + use.m[1] * uv.y + use.m[2],
              v = use.m[3] * uv.x + use.m[4] * uv.y + use.m[5];
  const auto index = [](float x, uint32_t size, scene::Wrap wrap) {
    if (!std::isfinite(x)) return 0u;
    if (wrap == scene::Wrap::repeat) x -= std::floor(x);
    if (wrap == scene::Wrap::mirror) x = std::abs(x - 2 * std::floor(0.5f * x + 0.5f));
    return std::min(uint32_t(std::clamp(x, 0.f, 1.f) * size), size - 1);
  };
  const size_t at =
      4 * (size_t(index(v, image.height, t.wrap_v)) * image.width + index(u, image.width, t.wrap_u));
  vec3 c;
  for (int k = 0; k < 3; ++k) {
    const double x = image.floats.empty() ? image.bytes[at + k] / 255.0 : image.floats[at + k];
    c[k] = float(t.srgb && image.floats.empty() ? srgb_to_linear(x) : x);
  }
  return c;
}

}  // namespace lucerna::upload
