#include "scene/light_picture.h"

#include <algorithm>
#include <cmath>

#include "base/alias_table.h"
#include "base/error.h"
#include "scene/scene.h"

namespace lucerna::scene {
namespace {

/// Means of blocks of that many texels in both directions; rests at the border are left out.
void reduce(uint32_t& width, uint32_t& height, std::vector<vec3>& texels, uint32_t factor) {
  const uint32_t w = width / factor, h = height / factor;
  std::vector<vec3> means(size_t{w} * h);
  for (uint32_t y = 0; y < h; ++y)
    for (uint32_t x = 0; x < w; ++x) {
      glm::dvec3 sum(0);
      for (uint32_t j = 0; j < factor; ++j)
        for (uint32_t i = 0; i < factor; ++i)
          sum += glm::dvec3(texels[size_t{y * factor + j} * width + x * factor + i]);
      means[size_t{y} * w + x] = vec3(sum / (double(factor) * factor));
    }
  width = w, height = h, texels = std::move(means);
}

/// Solid angle of a small area about a point of the plane at distance 1.
double seen(double x, double y, double area) { return area / std::pow(1 + x * x + y * y, 1.5); }

}  // namespace

vec3 LightPicture::at(const vec2& uv) const {
  const float x = std::clamp(uv.x, 0.f, 1.f) * float(width - 1),
              y = std::clamp(uv.y, 0.f, 1.f) * float(height - 1);
  const uint32_t i = std::min(uint32_t(x), width - 2), j = std::min(uint32_t(y), height - 2);
  const float fx = x - float(i), fy = y - float(j);
  return glm::mix(glm::mix(at(i, j), at(i + 1, j), fx), glm::mix(at(i, j + 1), at(i + 1, j + 1), fx), fy);
}

LightPicture make_picture(uint32_t width, uint32_t height, std::vector<vec3> texels,
                          const std::string& where) {
  if (width == 0 || height == 0) throw_error(where, "the picture has no texels");
  for (const vec3& t : texels)
    for (int k = 0; k < 3; ++k)
      if (!(t[k] >= 0 && t[k] < k_infinity))
        throw_error(where, "a texel has the value {}, expected finite and at least 0", t[k]);
  if (const uint32_t most = std::max(width, height); most > k_most_picture) {
    const uint32_t factor = (most + k_most_picture - 1) / k_most_picture;
    if (std::min(width, height) < factor)
      throw_error(where, "{} by {} texels are too long a picture", width, height);
    reduce(width, height, texels, factor);
  }
  if (width == 1) {
    std::vector<vec3> twice;
    for (const vec3& t : texels) twice.insert(twice.end(), 2, t);
    width = 2, texels = std::move(twice);
  }
  if (height == 1) {
    texels.resize(2 * size_t{width});
    std::copy_n(texels.begin(), width, texels.begin() + width);
    height = 2;
  }
  LightPicture picture;
  picture.width = width, picture.height = height, picture.texels = std::move(texels);
  std::vector<double> weights;
  weights.reserve(size_t{width - 1} * (height - 1));
  for (uint32_t y = 0; y + 1 < height; ++y)
    for (uint32_t x = 0; x + 1 < width; ++x)
      weights.push_back(
          0.25 * (double{luminance(picture.at(x, y))} + double{luminance(picture.at(x + 1, y))} +
                  double{luminance(picture.at(x, y + 1))} + double{luminance(picture.at(x + 1, y + 1))}));
  picture.alias = build_alias_table(weights);
  if (picture.alias.empty()) throw_error(where, "the picture is black");
  for (const vec4& entry : picture.alias)
    picture.cell_density.push_back(float(double{entry.z} * double(weights.size())));
  constexpr uint32_t n = LightPicture::k_blocks, k_inner = 4;
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i) {
      double sum = 0;
      // The mean over the cells that it overlaps, by points evenly spaced in it.
      const uint32_t sx = std::max(k_inner, width / n + 1), sy = std::max(k_inner, height / n + 1);
      for (uint32_t b = 0; b < sy; ++b)
        for (uint32_t a = 0; a < sx; ++a)
          sum += double{luminance(picture.at(vec2((float(i) + (float(a) + 0.5f) / float(sx)) / n,
                                                  (float(j) + (float(b) + 0.5f) / float(sy)) / n)))};
      picture.blocks.push_back(float(sum / (double(sx) * sy)));
    }
  return picture;
}

vec2 picture_extent(const Light& spot) {
  const float reach = std::tan(std::min(spot.outer_cone, k_widest_picture));
  const vec2 size(float(spot.picture->width), float(spot.picture->height));
  return reach * size / glm::length(size);
}

vec3 picture_along(const Light& spot, const vec3& direction) {
  const float ahead = glm::dot(direction, spot.direction);
  if (!(ahead > 0)) return vec3(0);
  const vec3 up = glm::cross(spot.right, spot.direction);
  const vec2 at =
      vec2(glm::dot(direction, spot.right), glm::dot(direction, up)) / ahead / picture_extent(spot);
  if (std::abs(at.x) > 1 || std::abs(at.y) > 1) return vec3(0);
  return spot.picture->at(vec2(0.5f + 0.5f * at.x, 0.5f - 0.5f * at.y));
}

double picture_solid_angle(const Light& spot) {
  constexpr uint32_t n = LightPicture::k_blocks;
  const glm::dvec2 half(picture_extent(spot));
  const double area = 4 * half.x * half.y / (double(n) * n);
  double sum = 0;
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i)
      sum += double{spot.picture->blocks[size_t{j} * n + i]} *
             seen(half.x * ((2 * i + 1.0) / n - 1), half.y * ((2 * j + 1.0) / n - 1), area);
  return sum;
}

}  // namespace lucerna::scene
