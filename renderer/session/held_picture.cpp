#include "session/held_picture.h"

#include <algorithm>
#include <cmath>

#include "film/io/planes.h"

namespace lucerna::session {

std::string methods_text(const ComponentMethods& methods) {
  constexpr std::array<const char*, paths::k_component_count> k_light = {"primary light", "secondary light",
                                                                         "tertiary light", "caustics"};
  constexpr std::array<size_t, paths::k_component_count> k_by_weight = {paths::k_secondary, paths::k_tertiary,
                                                                        paths::k_caustic, paths::k_primary};
  const auto known = [&](size_t c) { return !methods[c].empty(); };
  if (std::none_of(k_by_weight.begin(), k_by_weight.end(), known)) return "";
  const auto main = std::find_if(k_by_weight.begin(), k_by_weight.end(),
                                 [&](size_t c) { return known(c) && methods[c] != "off"; });
  if (main == k_by_weight.end()) return "no light";
  std::string text = methods[*main];
  for (size_t c = 0; c < methods.size(); ++c) {
    const bool usual = (c == paths::k_primary || c == paths::k_caustic) && methods[c] == "path";
    if (!known(c) || methods[c] == methods[*main] || usual) continue;
    text += methods[c] == "off" ? ", without " + std::string(k_light[c])
                                : ", " + methods[c] + " for " + k_light[c];
  }
  return text;
}

HeldPicture read_held_picture(const std::string& file) {
  const film::FilmImage image = film::read_exr(file);
  const film::RgbPlanes planes = film::rgb_planes(image, file, "a picture with R, G and B");
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
