// Reads the shown preview back as light.
#include <glm/gtc/packing.hpp>

#include "base/error.h"
#include "film/preview.h"

namespace lucerna::film {

std::vector<vec3> Preview::shown_light(uint32_t components) const {
  if (!shown_) throw Error("", "no preview is shown");
  // Two texels a pixel, as preview_unpack() of shaders/film/preview.glsl: half floats, a vec4 a component.
  constexpr size_t k_words = 2;  // of a component
  std::vector<uint32_t> packed(size_t{pixels()} * k_words * shared::k_component_count);
  now_.light.read(packed.data(), packed.size() * sizeof(uint32_t));
  std::vector<vec3> light(pixels(), vec3(0));
  for (size_t i = 0; i < light.size(); ++i)
    for (const uint32_t c : k_components) {
      if (!(components >> c & 1u)) continue;
      const uint32_t* words = &packed[k_words * (i * shared::k_component_count + c)];
      const vec2 xy = glm::unpackHalf2x16(words[0]), zw = glm::unpackHalf2x16(words[1]);
      light[i] += vec3(xy, zw.x) / exposure_;
    }
  return light;
}

}  // namespace lucerna::film
