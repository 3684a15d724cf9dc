#pragma once
// Every kind of surface, each in a separate shaft.
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "support/rooms.h"

namespace lucerna::test::shafts {

/// A surface with the textures and vertex data that it needs.
struct Kind {
  std::string name;
  scene::Material material;
  bool solid = false, colors = false, uv1 = false;
};

enum Picture : scene::Id { k_colors, k_data, k_tilts, k_clamped, k_nearest, k_floats, k_white };

inline void add_pictures(scene::Scene& s) {
  std::mt19937 random(5);
  for (int i = 0; i < 3; ++i) {
    scene::Image image;
    image.name = "picture", image.width = image.height = 8;
    for (int k = 0; k < 64; ++k) {
      const bool left = k % 8 < 4;
      if (i == k_tilts)
        for (const int c : {128 + int(random() % 80) - 40, 128 + int(random() % 80) - 40, 240, 255})
          image.bytes.push_back(uint8_t(c));
      else
        // Data is nothing in one half and everything in the other, as masks are.
        for (int c = 0; c < 4; ++c)
          image.bytes.push_back(i == k_data      ? (left ? 0 : 255)
                                : c == 3 && left ? 40
                                                 : uint8_t(60 + random() % 190));
    }
    s.images.push_back(image);
  }
  scene::Image floats;
  floats.name = "floats", floats.width = floats.height = 4;
  for (int k = 0; k < 64; ++k) floats.floats.push_back(float(random() % 100) / 100);
  s.images.push_back(floats);
  scene::Image white;
  white.name = "white", white.width = white.height = 1, white.bytes.assign(4, 255);
  s.images.push_back(white);
  s.textures = {{.image = 0, .srgb = true},
                {.image = 1},
                {.image = 2},
                {.image = 0, .wrap_u = scene::Wrap::clamp, .wrap_v = scene::Wrap::mirror, .srgb = true},
                {.image = 0, .nearest = true, .srgb = true},
                {.image = 3},
                {.image = 4}};
}

inline scene::Material glass(float roughness, float thickness) {
  scene::Material m;
  m.base_color = vec4(0.9f, 0.8f, 0.7f, 1);
  m.metallic = 0, m.roughness = roughness, m.transmission = 1, m.thickness = thickness;
  return m;
}
inline scene::Material metal(float roughness) {
  scene::Material m;
  m.base_color = vec4(0.9f, 0.8f, 0.6f, 1), m.roughness = roughness;
  return m;
}

inline std::vector<Kind> kinds() {
  std::vector<Kind> list;
  const auto add = [&](const char* name, scene::Material m, const std::function<void(Kind&)>& change = {}) {
    list.push_back({name, std::move(m)});
    if (change) change(list.back());
    list.back().solid = list.back().material.thickness > 0;
  };
  const scene::Material plain = test::diffuse({0.7f, 0.6f, 0.5f});
  add("plain", plain);
  add("metal", metal(0.3f));
  add("mirror", metal(0));
  add("coat", plain, [](Kind& k) { k.material.specular = 1, k.material.roughness = 0.2f; });
  add("smooth coat", plain, [](Kind& k) { k.material.specular = 1, k.material.roughness = 0; });
  add("rough glass", glass(0.5f, 1));
  add("clear glass", glass(0, 1));
  add("absorbing glass", glass(0.3f, 1), [](Kind& k) {
    k.material.attenuation_color = {0.3f, 0.6f, 0.9f}, k.material.attenuation_distance = 0.2f;
  });
  add("pane", glass(0, 0));
  add("frosted pane", glass(0.5f, 0));
  add("half a pane", glass(0, 0), [](Kind& k) { k.material.transmission = 0.5f; });
  add("diffuse transmission", plain, [](Kind& k) { k.material.diffuse_transmission = 0.5f; });
  add("unlit", plain, [](Kind& k) { k.material.unlit = true; });
  add("blend", plain,
      [](Kind& k) { k.material.alpha_mode = scene::AlphaMode::blend, k.material.base_color.w = 0.4f; });
  add("mask", plain, [](Kind& k) {
    k.material.alpha_mode = scene::AlphaMode::mask, k.material.base_color_texture.texture = k_colors;
  });
  add("normal map", plain, [](Kind& k) { k.material.normal_texture.texture = k_tilts; });
  add("vertex colours", plain, [](Kind& k) { k.colors = true; });
  add("second coordinates", plain,
      [](Kind& k) { k.uv1 = true, k.material.base_color_texture = {.texture = k_colors, .uv_set = 1}; });
  add("texture", plain, [](Kind& k) { k.material.base_color_texture.texture = k_colors; });
  add("clamped texture", plain, [](Kind& k) {
    k.material.base_color_texture = {.texture = k_clamped, .m = {2, 0, -0.5f, 0, 2, -0.5f}};
  });
  add("turned texture", plain, [](Kind& k) {
    k.material.base_color_texture = {.texture = k_colors, .m = {0.5f, 0.7f, 0.1f, -0.7f, 0.5f, 0.2f}};
  });
  add("unfiltered texture", plain, [](Kind& k) { k.material.base_color_texture.texture = k_nearest; });
  add("float texture", plain, [](Kind& k) { k.material.base_color_texture.texture = k_floats; });
  add("metal by texture", metal(0.6f),
      [](Kind& k) { k.material.metallic_roughness_texture.texture = k_data; });
  add("gloss by texture", plain, [](Kind& k) {
    k.material.specular = 1, k.material.roughness = 0.3f, k.material.specular_texture.texture = k_data;
    k.material.specular_color_texture.texture = k_colors;
  });
  // Where the texture transmits nothing these are coats.
  add("pane by texture", glass(0, 0),
      [](Kind& k) { k.material.transmission_texture.texture = k_data, k.material.base_color = vec4(0.02f); });
  add("glass by texture", glass(0.3f, 1),
      [](Kind& k) { k.material.transmission_texture.texture = k_data, k.material.base_color = vec4(0.02f); });
  add("diffuse transmission by texture", plain, [](Kind& k) {
    k.material.diffuse_transmission = 1, k.material.diffuse_transmission_texture.texture = k_data;
    k.material.diffuse_transmission_color_texture.texture = k_colors;
  });
  add("clear coat", plain, [](Kind& k) { k.material.clearcoat = 1; });
  add("clear coat by texture", metal(0.4f), [](Kind& k) {
    k.material.clearcoat = 1, k.material.clearcoat_texture.texture = k_data;
    k.material.clearcoat_roughness = 0.5f, k.material.clearcoat_roughness_texture.texture = k_colors;
    k.material.clearcoat_normal_texture.texture = k_tilts;
  });
  add("sheen", plain,
      [](Kind& k) { k.material.sheen_color = vec3(0.8f), k.material.sheen_roughness = 0.4f; });
  add("sheen by texture", plain, [](Kind& k) {
    k.material.sheen_color = vec3(1), k.material.sheen_color_texture.texture = k_colors;
    k.material.sheen_roughness = 0.8f, k.material.sheen_roughness_texture.texture = k_colors;
  });
  add("brushed", metal(0.3f), [](Kind& k) { k.material.anisotropy = 0.7f; });
  add("brushed by texture", metal(0.3f),
      [](Kind& k) { k.material.anisotropy = 1, k.material.anisotropy_texture.texture = k_colors; });
  add("film by texture", metal(0.3f), [](Kind& k) {
    k.material.iridescence = 1, k.material.iridescence_texture.texture = k_colors;
    k.material.iridescence_thickness_texture.texture = k_colors;
  });
  add("rough diffuse", plain, [](Kind& k) { k.material.diffuse_roughness = 0.7f; });
  add("rough coated diffuse by texture", plain, [](Kind& k) {
    k.material.specular = 1, k.material.roughness = 0.4f;
    k.material.diffuse_roughness = 1, k.material.diffuse_roughness_texture.texture = k_data;
  });
  add("relief by height", plain,
      [](Kind& k) { k.material.height = 0.1f, k.material.height_texture.texture = k_colors; });
  add("deep relief", plain, [](Kind& k) {
    k.material.height = 0.2f, k.material.height_texture.texture = k_colors, k.material.deep_relief = true;
  });
  add("shadow catcher", plain, [](Kind& k) { k.material.shadow_catcher = true; });
  // White, so light samples are the same with and without it.
  add("light by texture", plain,
      [](Kind& k) { k.material.emission = vec3(1), k.material.emission_texture.texture = k_white; });
  return list;
}

inline constexpr uint32_t k_across = 7, k_pixels = 8;

/// Shafts with grey walls, seen from above; each contains a surface and below it a floor with gaps. Kinds
/// that are not `shown` are replaced by the first, and so are unused shafts.
inline scene::Scene shafts_with(const std::vector<Kind>& kinds, const std::vector<bool>& shown, bool lamps) {
  scene::Scene s;
  s.name = "shafts", s.file = "shafts.gltf";
  s.environment.given = true;
  add_pictures(s);
  s.materials = {test::diffuse(vec3(0.5f)), kinds[0].material, kinds[0].material};
  s.materials[2].emission = vec3(1);
  const float side = k_across, low = -1, high = 1.5f;
  for (uint32_t k = 0; k <= k_across; ++k) {
    test::add_quad(s, {float(k), low, 0}, {0, high - low, 0}, {0, 0, side});
    test::add_quad(s, {0, low, float(k)}, {side, 0, 0}, {0, high - low, 0});
  }
  for (uint32_t i = 0; i < k_across * k_across; ++i) {
    const vec3 corner(float(i % k_across), 0, float(i / k_across));
    const bool own = i < kinds.size() && shown[i];
    const Kind& kind = kinds[own ? i : 0];
    scene::Id material = own ? scene::Id(s.materials.size()) : 1;
    if (own) s.materials.push_back(kind.material);
    const bool shines = i < kinds.size() && kinds[i].material.emission.x > 0;
    if (shines && !lamps && own) s.materials.back().emission = vec3(0);
    if (shines && lamps && !own) material = 2;
    test::add_quad(s, corner + vec3(0.1f, -0.7f, 0.1f), {0, 0, 0.8f}, {0.8f, 0, 0});
    if (lamps)
      s.lights.push_back({.name = "lamp", .intensity = vec3(0.5f), .position = corner + vec3(0.3f, 1, 0.6f)});
    if (kind.solid && own) {
      // A wedge, whose sides face outwards.
      scene::Primitive p;
      p.material = material;
      const vec3 o = corner + vec3(0.15f, -0.2f, 0.15f);
      p.positions = {o,
                     o + vec3(0.7f, 0, 0),
                     o + vec3(0.7f, 0, 0.7f),
                     o + vec3(0, 0, 0.7f),
                     o + vec3(0, 0.3f, 0),
                     o + vec3(0.7f, 0.4f, 0),
                     o + vec3(0.7f, 0.4f, 0.7f),
                     o + vec3(0, 0.3f, 0.7f)};
      for (int k = 0; k < 8; ++k) p.uv0.emplace_back(k % 4 == 1 || k % 4 == 2, k % 4 >= 2);
      p.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}, {0, 5, 1}, {0, 4, 5},
                     {1, 6, 2}, {1, 5, 6}, {2, 7, 3}, {2, 6, 7}, {3, 4, 0}, {3, 7, 4}};
      test::add_mesh(s, "wedge", p);
      continue;
    }
    test::add_quad(s, corner + vec3(0.1f, 0, 0.1f), {0, 0.1f, 0.8f}, {0.8f, 0, 0}, material);
    scene::Primitive& p = s.meshes.back().primitives[0];
    if (own && kind.colors) p.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 1}};
    if (own && kind.uv1) p.uv1 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  }
  if (!lamps) {
    scene::Image sky;
    sky.name = "sky", sky.width = 8, sky.height = 4;
    for (int i = 0; i < 32; ++i) {
      const float value = 0.2f + 0.1f * float(i % 8) + (i == 3 ? 5.0f : 0.0f);
      sky.floats.insert(sky.floats.end(), {value, value, 1.5f * value, 1});
    }
    s.environment.image = scene::Id(s.images.size());
    s.images.push_back(sky);
  }
  scene::Camera c = test::looking_down({side / 2, 5, side / 2}, 1);
  c.orthographic = true, c.xmag = c.ymag = side / 2;
  s.cameras = {c};
  return s;
}

}  // namespace lucerna::test::shafts
