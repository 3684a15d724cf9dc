#include "transport/frame.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "scene/projection.h"
#include "shaders/shared/transport.h"
#include "upload/media.h"

namespace lucerna::transport {

float lens_radius(const scene::Camera& camera, float half_width) {
  if (!camera.perspective() || camera.lens.f_number == 0) return 0;
  const float focal_length = 0.5f * scene::k_film_width / half_width;
  return 0.5f * focal_length / camera.lens.f_number;
}

shared::Frame make_frame(const upload::FlatScene& flat, const scene::Camera& camera,
                         const paths::Automaton& automaton, const FrameOptions& options) {
  shared::Frame f{};
  const mat4& m = camera.to_world;
  const vec3 right = glm::normalize(vec3(m[0])), up = glm::normalize(vec3(m[1]));
  const vec2 half = scene::half_extent(camera, float(options.width) / float(options.height));
  f.camera_origin = vec3(m[3]);
  f.camera_right = right * half.x;
  f.camera_up = up * half.y;
  f.camera_axis = -glm::normalize(vec3(m[2]));
  f.camera_forward = f.camera_axis;
  if (camera.wide == scene::Wide::none && camera.shift != vec2(0)) {
    const vec3 aside = 2.0f * (camera.shift.x * f.camera_right + camera.shift.y * f.camera_up);
    (camera.orthographic ? f.camera_origin : f.camera_forward) += aside;
  }
  f.projection = camera.orthographic                    ? shared::k_projection_orthographic
                 : camera.wide == scene::Wide::panorama ? shared::k_projection_panorama
                 : camera.wide == scene::Wide::fisheye  ? shared::k_projection_fisheye
                                                        : shared::k_projection_perspective;
  f.section_normal = camera.section.normal, f.section_offset = camera.section.offset;
  f.lens_radius = lens_radius(camera, half.x);
  f.focus_distance = camera.lens.focus_distance;
  f.lens_blades = camera.lens.blades;
  f.lens_rotation = camera.lens.rotation;
  f.width = options.width;
  f.height = options.height;
  f.seed = options.seed;
  f.environment_radiance = flat.environment_radiance;
  f.environment_width = flat.environment_width;
  f.environment_height = flat.environment_height;
  f.environment_rotation = flat.environment_rotation;
  f.environment_light_pmf = flat.environment_light_pmf;
  f.light_count = uint32_t(flat.lights.size() / shared::k_light_texels);
  f.first_lamp = flat.first_lamp, f.lamp_count = flat.lamp_count;
  f.first_shape = flat.first_shape, f.shape_count = flat.shape_count;
  f.lamp_pmf = flat.lamp_pmf;
  f.max_depth = options.max_depth;
  f.roulette_depth = options.roulette_depth;
  f.most_branches = ~0u;
  f.scene_radius = flat.scene_radius;
  Box start;
  start.grow(f.camera_origin - vec3(f.lens_radius)), start.grow(f.camera_origin + vec3(f.lens_radius));
  if (camera.orthographic)
    for (const float x : {-1.0f, 1.0f})
      for (const float y : {-1.0f, 1.0f}) start.grow(f.camera_origin + x * f.camera_right + y * f.camera_up);
  // On a plane that cuts the view, paths may start anywhere.
  if (camera.section.cuts())
    start.grow(flat.scene_centre - vec3(flat.scene_radius)),
        start.grow(flat.scene_centre + vec3(flat.scene_radius));
  f.camera_in_solids = upload::meets_solids(flat, start);
  if (flat.groups) f.sky_group = flat.groups->sky, f.sun_group = flat.groups->sun;
  const bool met = flat.effects.emissive || flat.effects.shapes || flat.environment_radiance != vec3(0);
  const std::vector<uint32_t> table = paths::pack(automaton, options.enabled, options.routes, met);
  assert(table.size() <= shared::k_phase_states);
  std::copy(table.begin(), table.end(), f.automaton);
  if (options.fallback != 0) {
    const auto put = [&](uint32_t phase, uint32_t enabled, const paths::LookupRoutes& routes) {
      const uint32_t at = shared::in_phase(0, phase);
      const std::vector<uint32_t> all = paths::pack(automaton, enabled, routes, met);
      for (size_t i = 0; i < all.size(); ++i) f.automaton[at + i] = all[i] + (at | at << 8 | at << 16);
    };
    // A path that passes a lookup must compute the light of the next vertex itself, for any component.
    paths::LookupRoutes gather = options.gather, nothing;
    gather.replaced = nothing.replaced = options.routes.replaced;
    put(shared::k_phase_gather, options.fallback, gather);
    put(shared::k_phase_fallback, options.fallback, nothing);
    put(shared::k_phase_known, options.fallback, nothing);
    // Everything behind ED has been looked up: such a path may only meet the light that was sampled.
    constexpr uint32_t k_next = 0xffffff, k_live = 1u << 27, k_none = shared::k_component_none << 24;
    constexpr uint32_t k_dead = shared::k_dead_state | shared::k_dead_state << 8 | shared::k_dead_state << 16;
    for (uint32_t i = 0; i < table.size(); ++i) {
      uint32_t& known = f.automaton[shared::in_phase(i, shared::k_phase_known)];
      const bool meets = met && shared::is_component(known >> 24 & 7u);
      known = (known & ~(k_next | k_live)) | k_dead | (meets ? k_live : 0) | shared::k_ends_on_diffuse;
    }
    f.automaton[shared::k_dead_state] = k_dead | k_none;
  }
  return f;
}

void compute_everything(shared::Frame& frame) {
  for (const uint32_t phase : {shared::k_phase_start, shared::k_phase_gather})
    for (uint32_t s = 0; s < shared::k_phase_states; ++s)
      frame.automaton[shared::in_phase(s, phase)] =
          frame.automaton[shared::in_phase(s, shared::k_phase_fallback)];
}

void set_delegated_tables(shared::Frame& frame, const shared::Frame& other) {
  constexpr uint32_t k_here = shared::k_delegated_states;
  for (uint32_t s = 0; s < k_here; ++s)
    frame.automaton[k_here + s] = other.automaton[s] + (k_here | k_here << 8 | k_here << 16);
}

}  // namespace lucerna::transport
