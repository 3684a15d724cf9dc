#pragma once
// Shared by tests of the light mix: a room with light of five groups in every component, and renderers and
// comparisons for its pictures.
#include "bvh/embree/host_tracer.h"
#include "schedule/uniform.h"
#include "support/render.h"
#include "support/rooms.h"
#include "transport/frame.h"

namespace lucerna::test {

/// A room under an uneven environment with a sun, two lamps, an emissive block and a metal sphere, so every
/// component has light of every group. Groups: sky, sun, lamp, spot, block.
inline scene::Scene room() {
  scene::Scene s = block_room(true);
  scene::Image sky;
  sky.name = "sky", sky.width = 32, sky.height = 16;
  for (int i = 0; i < 32 * 16; ++i) {
    const float value = i == 3 * 32 + 9 ? 200.0f : 0.2f + 0.01f * float(i % 32);
    sky.floats.insert(sky.floats.end(), {value, value, 1.2f * value, 1});
  }
  s.images = {};
  s.images.push_back(sky);
  s.lights[0].intensity = vec3(3, 2, 1);
  s.lights.push_back({.name = "spot",
                      .kind = scene::LightKind::spot,
                      .intensity = vec3(1, 3, 6),
                      .position = {-1.2f, 2.2f, 1.2f},
                      .direction = glm::normalize(vec3(0.3f, -1, -0.5f)),
                      .inner_cone = 0.3f,
                      .outer_cone = 0.8f});
  s.materials[0].name = "wall", s.materials[1].name = "block";
  s.materials[1].emission = vec3(0.3f, 0.8f, 0.2f);
  scene::Material metal;
  metal.name = "metal", metal.base_color = vec4(0.9f, 0.9f, 0.9f, 1), metal.metallic = 1,
  metal.roughness = 0.6f;
  s.materials.push_back(metal);
  add_ball(s, {1, 0.5f, 0.7f}, 0.5f, 2, 12);
  return s;
}

/// `chosen_by` decides where samples go; `shining`, which differs in strengths and colours only, gives their
/// light: per group, mixed by `weights`. `draft`: onto a film without groups, as for preview samples.
inline film::Image trace(const scene::Scene& chosen_by, const scene::Scene& shining,
                         const std::vector<vec3>& weights, uint32_t samples = 8,
                         film::GroupStorage kept = film::GroupStorage::by_component, bool draft = false) {
  const auto device = shared_device(true);
  gpu::ShaderCompiler compiler(gpu::ShaderCompiler::default_root());
  upload::FlatScene flat = upload::flatten(
      chosen_by,
      upload::LightSeparation{scene::k_sun_threshold,
                              std::make_shared<const scene::LightGroups>(scene::group_lights(chosen_by)),
                              kept == film::GroupStorage::by_component});
  upload::flatten_factors(shining, flat);
  upload::flatten_emission(shining, flat);
  const bvh::HostTracer tracer({flat.positions, flat.non_opaque});
  const upload::DeviceScene scene(*device, flat, {});
  transport::Wavefront wavefront(
      *device, compiler, scene, 2048,
      [&](bvh::Query query, std::span<const shared::Ray> rays, std::span<shared::Hit> hits,
          const uint32_t* queue, uint32_t count,
          bool coherent) { tracer.trace(query, rays, hits, queue, count, coherent); });
  film::Film film(*device, 48, 32, draft ? 1 : uint32_t(flat.groups->groups.size()), kept);
  film.set_mix(weights);
  wavefront.set_frame(transport::make_frame(flat, chosen_by.cameras[0], paths::compile_components(),
                                            {.width = 48, .height = 32, .seed = 5, .max_depth = 8}),
                      15);
  film.clear(wavefront.stream());
  schedule::UniformSchedule schedule(film.blocks(), samples, wavefront.slots());
  while (!schedule.done()) wavefront.run(schedule.next(), film);
  CHECK(wavefront.stats().dropped == 0);
  return film.read();
}

/// A renderer of a scene with per-group light.
struct Bench {
  session::Renderer r{renderer_options(true)};
  explicit Bench(const scene::Scene& s, const Settings& settings = {}, uint32_t samples = 16) {
    r.set_size(48, 32);
    std::vector<session::SettingChange> changes{{"samples", std::to_string(samples), ""},
                                                {"path.batch", "4096", ""},
                                                {"path.max_depth", "8", ""},
                                                {"relight.enabled", "on", ""}};
    for (const auto& [key, value] : settings) changes.push_back({key, value, ""});
    r.set_scene(std::make_shared<scene::Scene>(s), {}, changes);
  }
  film::Image image() { return finish(r); }
  void mix(const std::string& text) { set(r, {{"relight.mix", text}}); }
};

/// Light of all components, or of their odd halves.
inline std::vector<vec3> all_components(const film::Image& image, bool odd = false) {
  std::vector<vec3> sum(image.samples.size(), vec3(0));
  for (const auto& component : odd ? image.odd_half : image.components)
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += component[i];
  return sum;
}
/// All components summed into the first.
inline film::Image as_one_component(film::Image image) {
  image.components[0] = all_components(image), image.odd_half[0] = all_components(image, true);
  for (size_t c = 1; c < shared::k_component_count; ++c) {
    image.components[c].assign(image.samples.size(), vec3(0));
    image.odd_half[c] = image.components[c];
  }
  return image;
}

/// The largest difference over the largest value.
inline double difference(const film::Image& a, const film::Image& b) {
  double most = 0, scale = 0;
  for (const int c : k_components)
    for (size_t i = 0; i < a.samples.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        most = std::max(most, double(std::abs(a.components[c][i][k] - b.components[c][i][k])));
        scale = std::max(scale, double(b.components[c][i][k]));
      }
  return most / scale;
}

/// The largest difference between blocks of two pictures with independent samples, in standard errors, over
/// all blocks and components. There are about 96, each error has about 64 degrees of freedom, so 5.5 occurs
/// by chance in one of 10^4 comparisons; these scenes have no rare bright samples.
inline double worst_z(const film::Image& a, const film::Image& b) {
  double worst = 0;
  for (const int c : k_components)
    for (uint32_t y = 0; y < a.height / 8; ++y)
      for (uint32_t x = 0; x < a.width / 8; ++x) {
        const Mean p = block_mean(a, c, x, y), q = block_mean(b, c, x, y);
        const double noise = std::hypot(p.noise, q.noise);
        if (noise > 0) worst = std::max(worst, std::abs(p.value - q.value) / noise);
      }
  return worst;
}

inline const scene::LightGroups& groups_of_room() {
  static const scene::LightGroups groups = scene::group_lights(room());
  return groups;
}

}  // namespace lucerna::test
