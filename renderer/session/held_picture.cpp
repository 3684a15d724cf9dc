#include "session/held_picture.h"

#include <algorithm>
#include <cmath>

#include "film/io/image_file.h"

namespace lucerna::session {

std::string methods_text(const ComponentMethods& methods) {
  constexpr std::array<const char*, paths::k_component_count> k_light = {"primary light", "secondary light",
                                                                         "tertiary light", "caustics"};
  constexpr size_t k_primary = 0, k_caustic = 3;
  constexpr std::array<size_t, 4> k_by_weight = {1, 2, k_caustic, k_primary};
  const auto known = [&](size_t c) { return !methods[c].empty(); };
  if (std::none_of(k_by_weight.begin(), k_by_weight.end(), known)) return "";
  const auto main = std::find_if(k_by_weight.begin(), k_by_weight.end(),
                                 [&](size_t c) { return known(c) && methods[c] != "off"; });
  if (main == k_by_weight.end()) return "no light";
  std::string text = methods[*main];
  for (size_t c = 0; c < methods.size(); ++c) {
    const bool usual = (c == k_primary || c == k_caustic) && methods[c] == "path";
    if (!known(c) || methods[c] == methods[*main] || usual) continue;
    text += methods[c] == "off" ? ", without " + std::string(k_light[c])
                                : ", " + methods[c] + " for " + k_light[c];
  }
  return text;
}

HeldPicture read_held_picture(const std::string& file) {
  const film::FilmImage image = film::read_exr(file);
  std::array<const std::vector<float>*, 3> planes{};
  for (size_t k = 0; k < 3; ++k)
    if (planes[k] = image.find(std::string(1, "RGB"[k])); !planes[k])
      throw_error(file, "no channel '{}'; expected a picture with R, G and B", "RGB"[k]);
  HeldPicture held;
  held.width = image.width, held.height = image.height;
  held.light.resize(size_t{image.width} * image.height);
  for (size_t i = 0; i < held.light.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      held.light[i][k] = (*planes[size_t(k)])[i];
      if (!std::isfinite(held.light[i][k]))
        throw_error(file, "the value of pixel {} {} is not finite", i % image.width, i / image.width);
    }
  if (const std::vector<float>* samples = image.find("samples")) {
    double sum = 0;
    for (const float n : *samples) sum += n;
    held.samples = sum / double(samples->size());
  }
  const auto text = [&](const char* key) {
    const auto found = image.metadata.find(key);
    return found == image.metadata.end() ? std::string() : found->second;
  };
  held.scene = text("scene"), held.view = text("view");
  return held;
}

}  // namespace lucerna::session
