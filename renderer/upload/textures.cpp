#include "upload/textures.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <tuple>

#include "base/color.h"
#include "base/error.h"

namespace lucerna::upload {

using namespace shared;

namespace {

struct Format {
  bool floats, srgb;
  auto operator<=>(const Format&) const = default;
  uint64_t texel_bytes() const { return floats ? 16 : 4; }
};

/// A texture to place: an image with a border for its wrap modes. An image with two wrap modes is stored
/// twice, one used twice with equal modes once.
struct Item {
  scene::Id image;
  scene::Wrap wrap_u, wrap_v;
  uint32_t width, height;  ///< with the border
  uint32_t page = 0, x = 0, y = 0;
};

/// Shelves: items in decreasing height, side by side on shelves as high as their first. Returns the number of
/// pages.
uint32_t place_on_shelves(std::vector<Item*>& items, uint32_t page_width, uint32_t page_height) {
  uint32_t page = 0, x = 0, y = 0, shelf = 0;
  for (Item* item : items) {
    if (x + item->width > page_width) x = 0, y += shelf, shelf = 0;
    if (y + item->height > page_height) ++page, x = 0, y = 0, shelf = 0;
    item->page = page, item->x = x, item->y = y;
    shelf = std::max(shelf, item->height);
    x += item->width;
  }
  return page + 1;
}

/// Page size with the smallest total: the largest item's, up to four times that in each direction, or as many
/// items side by side as there are.
void place_all(std::vector<Item>& items, uint32_t& page_width, uint32_t& page_height) {
  std::vector<Item*> order;
  uint32_t widest = 0, highest = 0;
  for (Item& item : items) {
    order.push_back(&item);
    widest = std::max(widest, item.width), highest = std::max(highest, item.height);
  }
  std::stable_sort(order.begin(), order.end(), [](const Item* a, const Item* b) {
    return std::tuple(a->height, a->width) > std::tuple(b->height, b->width);
  });
  constexpr uint32_t k_widest = 8192;  // within every device's limit, unless one texture alone is larger
  uint64_t best = ~uint64_t(0);
  for (uint32_t across = 1; across <= 4; ++across)
    for (uint32_t down = 1; down <= 4; ++down) {
      const uint32_t w = across * widest, h = down * highest;
      if ((across > 1 && w > k_widest) || (down > 1 && h > k_widest)) continue;
      const uint64_t total = uint64_t(place_on_shelves(order, w, h)) * w * h;
      if (total < best) best = total, page_width = w, page_height = h;
    }
  place_on_shelves(order, page_width, page_height);
}

/// Texel at `at` (-1 .. size) of a row or column of `size` texels.
uint32_t wrapped(int64_t at, uint32_t size, scene::Wrap wrap) {
  if (at >= 0 && at < int64_t(size)) return uint32_t(at);
  if (wrap == scene::Wrap::repeat) return at < 0 ? size - 1 : 0;
  return at < 0 ? 0 : size - 1;  // clamp; likewise mirror, which repeats the edge texel
}

template <class T>
void copy_with_border(const Item& item, const std::vector<T>& from, uint32_t page_width,
                      std::vector<uint8_t>& page) {
  const uint32_t w = item.width - 2, h = item.height - 2;
  constexpr size_t k_texel = 4 * sizeof(T);
  for (uint32_t y = 0; y < item.height; ++y) {
    const uint8_t* row = reinterpret_cast<const uint8_t*>(from.data()) +
                         size_t(wrapped(int64_t(y) - 1, h, item.wrap_v)) * w * k_texel;
    uint8_t* out = page.data() + (size_t(item.y + y) * page_width + item.x) * k_texel;
    std::memcpy(out, row + wrapped(-1, w, item.wrap_u) * k_texel, k_texel);
    std::memcpy(out + k_texel, row, w * k_texel);
    std::memcpy(out + (w + 1) * k_texel, row + wrapped(w, w, item.wrap_u) * k_texel, k_texel);
  }
}

}  // namespace

uint32_t TextureMap::bits(const scene::TextureUse& use) const {
  return use ? place[use.texture].bits | (use.uv_set == 1 ? k_texture_uv1 : 0u) : 0u;
}

TextureMap pack_textures(const scene::Scene& scene, std::vector<Bucket>& buckets, uint64_t bucket_bytes) {
  buckets.clear();
  using Key = std::tuple<scene::Id, scene::Wrap, scene::Wrap>;
  std::map<Format, std::vector<Item>> items;
  std::map<std::pair<Format, Key>, size_t> index;
  std::vector<std::pair<Format, size_t>> item_of;  // by texture
  for (const scene::Texture& t : scene.textures) {
    const scene::Image& image = scene.images[t.image];
    const Format format{!image.floats.empty(), t.srgb && image.floats.empty()};
    std::vector<Item>& list = items[format];
    const auto [at, fresh] = index.emplace(std::pair{format, Key{t.image, t.wrap_u, t.wrap_v}}, list.size());
    if (fresh) list.push_back({t.image, t.wrap_u, t.wrap_v, image.width + 2, image.height + 2});
    item_of.emplace_back(format, at->second);
  }
  std::map<Format, std::pair<uint32_t, uint32_t>> first_bucket;  // and pages in each
  for (auto& [format, list] : items) {
    uint32_t width = 0, height = 0;
    place_all(list, width, height);
    const uint64_t page_bytes = uint64_t(width) * height * format.texel_bytes();
    const auto pages_a_bucket = uint32_t(std::clamp<uint64_t>(bucket_bytes / page_bytes, 1, 2048));
    first_bucket[format] = {uint32_t(buckets.size()), pages_a_bucket};
    for (Item& item : list) {
      const size_t b = first_bucket[format].first + item.page / pages_a_bucket,
                   layer = item.page % pages_a_bucket;
      if (b >= k_max_buckets)
        throw_error(scene.file, "the textures take more than {} arrays of {} MiB; use smaller or fewer ones",
                    k_max_buckets, bucket_bytes >> 20);
      while (buckets.size() <= b) buckets.push_back({width, height, format.floats, format.srgb, {}});
      auto& layers = buckets[b].layers;
      while (layers.size() <= layer) layers.emplace_back(page_bytes);
      const scene::Image& image = scene.images[item.image];
      if (format.floats)
        copy_with_border(item, image.floats, width, layers[layer]);
      else
        copy_with_border(item, image.bytes, width, layers[layer]);
    }
  }
  TextureMap map;
  for (size_t i = 0; i < scene.textures.size(); ++i) {
    const scene::Texture& t = scene.textures[i];
    const auto& [format, at] = item_of[i];
    const Item& item = items[format][at];
    const auto [first, pages] = first_bucket[format];
    TexturePlace place;
    place.bucket = first + item.page / pages;
    place.bits = item.page % pages | place.bucket << 11 | uint32_t(t.wrap_u) << 16 |
                 uint32_t(t.wrap_v) << 18 | (t.nearest ? k_texture_nearest : 0u) | k_texture_present;
    const Bucket& bucket = buckets[place.bucket];
    const vec2 page(bucket.width, bucket.height);
    place.size = vec2(item.width - 2, item.height - 2);
    place.rect = vec4(vec2(item.x + 1, item.y + 1) / page, place.size / page);
    map.place.push_back(place);
  }
  return map;
}

vec3 read_texel(const scene::Scene& scene, scene::Id texture, uint32_t x, uint32_t y) {
  const scene::Texture& t = scene.textures[texture];
  const scene::Image& image = scene.images[t.image];
  const size_t at = 4 * (size_t(y) * image.width + x);
  vec3 c;
  for (int k = 0; k < 3; ++k) {
    const double value = image.floats.empty() ? image.bytes[at + k] / 255.0 : image.floats[at + k];
    c[k] = float(t.srgb && image.floats.empty() ? linear_from_srgb(value) : value);
  }
  return c;
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
  return read_texel(scene, use.texture, index(u, image.width, t.wrap_u), index(v, image.height, t.wrap_v));
}

}  // namespace lucerna::upload
