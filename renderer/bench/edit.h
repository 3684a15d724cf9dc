#pragma once
// Edits of a scene for measurements, as users make them.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "scene/scene.h"

namespace lucerna::bench {

enum class Edit {
  load,      ///< loading the scene; time is counted from its end
  strength,  ///< strength of the brightest lamp, or without lamps of the material that emits most light
  move,      ///< moves that lamp aside, or turns a lamp without a position; not measured without lamps
  sky,       ///< turns the environment; not measured without an image
  material,  ///< another colour for the material of the largest surface without a texture
  undo,      ///< undoes the last of the edits above except load
  camera,    ///< turns and steps aside
  solver,    ///< from path tracing to the solver, or back
  orbit      ///< moves the camera continuously (bench/orbit.h)
};
inline constexpr std::array<const char*, 9> k_edit_names = {"load", "strength", "move",   "sky",  "material",
                                                            "undo", "camera",   "solver", "orbit"};
/// Throws Error listing the names.
Edit edit_of(const std::string& name);

/// New values, as for Session and Renderer.
struct Change {
  std::optional<scene::Camera> camera;
  std::optional<std::pair<uint32_t, scene::Light>> light;
  std::optional<std::pair<float, float>> environment;  ///< strength, rotation in degrees
  std::optional<std::pair<uint32_t, scene::Material>> material;

  template <class Target>
  void apply(Target& to) const {
    if (camera) to.set_camera(*camera);
    if (light) to.set_light(light->first, light->second);
    if (environment) to.set_environment(environment->first, environment->second);
    if (material) to.set_material(material->first, material->second);
  }
};

/// The change that an edit makes: strength, move, sky, material or camera. None: the scene has nothing for
/// it. `seed` 0: strength / 3, a tenth of the scene's radius or 25 degrees, 90 degrees, red, 12 degrees and 2
/// % of the radius. Other seeds draw these.
std::optional<Change> change_of(Edit edit, const scene::Scene& scene, const scene::Camera& camera,
                                uint64_t seed = 0);
/// The change that undoes `change`, from the scene and camera before it.
Change reverse_of(const Change& change, const scene::Scene& scene, const scene::Camera& camera);

}  // namespace lucerna::bench
