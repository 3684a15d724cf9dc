// links: transport
// The start of light paths (shaders/lib/emission.glsl) for every kind of light: their flux, origin and
// direction, and the probability of each light.
#include <fmt/format.h>
#include <bit>
#include <catch2/catch.hpp>

#include "gpu/stream.h"
#include "kernels/statistics_support.h"
#include "scene/lamp.h"
#include "shaders/shared/transport.h"
#include "transport/light_source.h"
#include "upload/device_scene.h"

namespace emission_tests {

using namespace lucerna;
using namespace lucerna::test;

namespace {

constexpr double k_pi_d = 3.14159265358979323846;

struct Beginning {
  vec3 origin;
  float pmf;
  vec3 direction;
  float pdf_place;
  vec3 flux;
  float pdf_direction;
  uint32_t light, stratum;
};

gpu::Device& device() {
  static gpu::Device instance({"", true});
  return instance;
}

struct Emitted {
  upload::FlatScene flat;
  transport::LightSource source;
  std::vector<Beginning> paths;

  explicit Emitted(const scene::Scene& scene, uint32_t count = 1 << 16, float sun_threshold = 0,
                   const std::vector<Box>& casters = {}, const std::vector<double>& shares = {})
      : flat(upload::flatten(scene, sun_threshold)),
        source(device(), flat, flat.scene_centre, flat.scene_radius) {
    static gpu::ShaderCompiler compiler;
    if (!casters.empty()) source.aim(device(), flat, casters, 0.3);
    if (!shares.empty()) {
      std::vector<double> all;
      for (uint32_t i = 0; i < source.strata(); ++i) all.push_back(shares[i % shares.size()]);
      source.share_out(all);
    }
    const upload::DeviceScene on_device(device(), flat, {});
    shared::Frame frame{};
    frame.seed = 3;
    frame.light_count = uint32_t(flat.lights.size() / shared::k_light_texels);
    frame.environment_radiance = flat.environment_radiance;
    frame.environment_width = flat.environment_width;
    frame.environment_height = flat.environment_height;
    frame.environment_rotation = flat.environment_rotation;
    frame.environment_light_pmf = flat.environment_light_pmf;
    gpu::Buffer frames(device(), {"frame", sizeof frame});
    frames.write(&frame, sizeof frame);
    const gpu::Kernel kernel(device(), compiler,
                             std::string(LUCERNA_SOURCE_DIR) + "/tests/kernels/shaders/emission_probe.comp",
                             on_device.defines());
    const gpu::Buffer results(device(), {"beginnings", count * sizeof(Beginning)});
    gpu::Resources resources;
    on_device.bind(resources);
    source.bind(resources);
    resources.set("FrameBlock", frames);
    resources.set("Beginnings", results);
    struct {
      uint32_t count, round;
    } push{count, 7};
    gpu::Stream stream(device());
    stream.dispatch(kernel, resources, push, gpu::groups_for(count, 64));
    stream.run();
    paths = results.read_all<Beginning>();
  }
};

/// A square floor of 2 m, which gives the scene a size; light falls on it from above.
scene::Scene floor() {
  scene::Scene s;
  s.materials.resize(1);
  scene::Primitive p;
  p.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
  p.normals.assign(4, vec3(0, 1, 0));
  p.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  p.triangles = {{0, 2, 1}, {0, 3, 2}};
  s.meshes = {{"floor", {p}}};
  s.instances = {{"floor", 0, mat4(1), false}};
  s.environment.given = true;
  return s;
}
scene::Light lamp(scene::LightKind kind, const vec3& intensity) {
  scene::Light l;
  l.kind = kind, l.intensity = intensity;
  l.position = {0.2f, 3, -0.1f};
  l.direction = glm::normalize(vec3(0.3f, -0.8f, 0.2f));
  return l;
}

void check_all(const Emitted& e, const vec3& flux, double tolerance = 1e-5) {
  size_t off = 0;
  for (const Beginning& b : e.paths)
    for (int c = 0; c < 3; ++c) off += !(std::abs(b.flux[c] / flux[c] - 1) < tolerance);
  INFO("first " << e.paths[0].flux.x << " of " << flux.x);
  CHECK(off == 0);
}
vec3 mean_flux(const Emitted& e) {
  glm::dvec3 sum(0);
  for (const Beginning& b : e.paths) sum += glm::dvec3(b.flux);
  return sum / double(e.paths.size());
}
/// Chi-square tail of counts in cells of u, v in 0..1, all equally likely.
double even_tail(const std::vector<vec2>& places, int side = 16) {
  std::vector<double> observed(size_t(side * side), 0.0);
  for (const vec2& p : places)
    observed[size_t(std::clamp(int(p.x * float(side)), 0, side - 1) * side +
                    std::clamp(int(p.y * float(side)), 0, side - 1))] += 1;
  const std::vector<double> expected(observed.size(), double(places.size()) / double(observed.size()));
  return chi_square(observed, expected).p;
}
/// Azimuth around an axis, 0..1.
float turn(const vec3& d, const vec3& axis) {
  const vec3 t = glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.9f ? vec3(1, 0, 0) : vec3(0, 1, 0)));
  const float phi = std::atan2(glm::dot(d, glm::cross(axis, t)), glm::dot(d, t));
  return phi / float(2 * k_pi_d) + 0.5f;
}

}  // namespace

TEST_CASE("a point light emits 4 pi times its intensity, equal per path, uniform over directions") {
  scene::Scene s = floor();
  s.lights = {lamp(scene::LightKind::point, {3, 2, 1})};
  const Emitted e(s);
  check_all(e, vec3(float(4 * k_pi_d)) * vec3(3, 2, 1));
  std::vector<vec2> sphere;
  for (const Beginning& b : e.paths) {
    CHECK(b.origin == s.lights[0].position);
    sphere.emplace_back(0.5f * b.direction.z + 0.5f, turn(b.direction, {0, 0, 1}));
  }
  CHECK(even_tail(sphere) > 1e-4);
}

TEST_CASE(
    "a spot emits the integral of its intensity, equal per path to 1e-3, distributed by its intensity") {
  struct Cones {
    float inner, outer;
  };
  for (const Cones cones :
       {Cones{0.2f, 0.6f}, {0.f, 0.4f}, {0.5f, 0.5001f}, {0.3f, 1.5f}, {0.002f, 0.004f}}) {
    scene::Scene s = floor();
    s.lights = {lamp(scene::LightKind::spot, {3, 2, 1})};
    s.lights[0].inner_cone = cones.inner, s.lights[0].outer_cone = cones.outer;
    const Emitted e(s);
    // Quadrature of sample_light's cone function, with the cosines as floats.
    const double inner = std::cos(cones.inner), outer = std::cos(cones.outer);
    constexpr int k_steps = 200000, k_rings = 24;
    const double width = std::max(double(float(inner) - float(outer)), 1e-4), low = double(float(outer));
    const auto fade = [&](double c) { return std::pow(std::clamp((c - low) / width, 0.0, 1.0), 2); };
    double angle = 0;
    std::vector<double> rings(k_rings, 0.0);
    for (int i = 0; i < k_steps; ++i) {
      const double c = low + (1 - low) * (i + 0.5) / k_steps;
      const double part = 2 * k_pi_d * fade(c) * (1 - low) / k_steps;
      angle += part, rings[size_t(i) * k_rings / k_steps] += part;
    }
    INFO("cones " << cones.inner << " " << cones.outer);
    check_all(e, vec3(float(angle)) * vec3(3, 2, 1), 1e-3);
    CHECK(e.source.power() == Approx(angle * double(luminance(vec3(3, 2, 1)))).epsilon(1e-3));
    if (cones.inner < 0.01f && cones.outer < 0.01f) continue;  // cosines of so narrow a cone have few digits
    std::vector<double> observed(k_rings, 0.0);
    std::vector<vec2> around;
    size_t outside = 0;
    for (const Beginning& b : e.paths) {
      const double c = glm::dot(glm::dvec3(b.direction), glm::dvec3(s.lights[0].direction));
      outside += c < low - 1e-6;
      observed[size_t(std::clamp(int((c - low) / (1 - low) * k_rings), 0, k_rings - 1))] += 1;
      around.emplace_back(turn(b.direction, s.lights[0].direction), 0.5f);
    }
    CHECK(outside == 0);
    for (double& r : rings) r *= double(e.paths.size()) / angle;
    CHECK(chi_square(observed, rings).p > 1e-4);
    CHECK(even_tail(around, 1) > 1e-4);
  }
}

TEST_CASE("shapes emit their power, equal per path, evenly from their surface, cosine-distributed") {
  for (const auto kind : {scene::LightKind::sphere, scene::LightKind::rectangle, scene::LightKind::disk,
                          scene::LightKind::tube})
    for (const bool both : {false, true}) {
      scene::Scene s = floor();
      s.lights = {lamp(kind, {3, 2, 1})};
      scene::Light& l = s.lights[0];
      l.width = 0.8f, l.height = 0.3f, l.radius = 0.2f, l.two_sided = both;
      l.right = scene::right_across(l.direction, {1, 0, 0});
      const Emitted e(s);
      INFO(scene::kind_name(kind) << ", two sides " << both);
      check_all(e, vec3(float(scene::solid_angle(l))) * vec3(3, 2, 1), 1e-4);
      const vec3 up = glm::cross(l.right, l.direction);
      std::vector<vec2> places, cosines;
      size_t off = 0, back = 0;
      for (const Beginning& b : e.paths) {
        const vec3 d = b.origin - l.position;
        const vec3 at(glm::dot(d, l.right), glm::dot(d, up), glm::dot(d, l.direction));
        vec3 normal = l.direction;
        if (kind == scene::LightKind::sphere) {
          normal = d / l.radius;
          places.emplace_back(0.5f * normal.z + 0.5f, turn(normal, {0, 0, 1}));
          off += std::abs(glm::length(d) / l.radius - 1) > 1e-4f;
        } else if (kind == scene::LightKind::tube) {
          normal = (d - at.x * l.right) / l.radius;
          places.emplace_back(at.x / l.width + 0.5f, turn(normal, l.right));
          off += std::abs(glm::length(normal) - 1) > 1e-4f;
        } else {
          const bool front = glm::dot(b.direction, l.direction) > 0;
          back += !front;
          if (!front) normal = -normal;
          const vec2 half = scene::half_size(l), on = vec2(at) / half;
          if (kind == scene::LightKind::disk)
            places.emplace_back(glm::dot(on, on), std::atan2(on.y, on.x) / float(2 * k_pi_d) + 0.5f);
          else
            places.push_back(0.5f * on + 0.5f);
          off += std::abs(at.z) > 1e-5f;
        }
        const float cosine = glm::dot(b.direction, normal);
        off += !(cosine > -1e-5f);
        cosines.emplace_back(cosine * cosine, 0.5f);
      }
      CHECK(off == 0);
      const bool flat = kind == scene::LightKind::rectangle || kind == scene::LightKind::disk;
      CHECK(std::abs(double(back) - (flat && both ? 0.5 : 0) * double(e.paths.size())) <
            4 * std::sqrt(double(e.paths.size())));
      CHECK(even_tail(places) > 1e-4);
      std::vector<double> squares(32, 0.0);
      for (const vec2& c : cosines) squares[size_t(std::clamp(int(c.x * 32), 0, 31))] += 1;
      CHECK(chi_square(squares, std::vector<double>(32, double(cosines.size()) / 32)).p > 1e-4);
    }
}

TEST_CASE("a measured distribution emits its flux, in proportion to its intensity") {
  scene::Scene s = floor();
  s.lights = {lamp(scene::LightKind::profile, {3, 2, 1})};
  scene::Light& l = s.lights[0];
  l.right = scene::rolled(l.direction, 40);
  l.profile = std::make_shared<scene::LightProfile>(scene::sampled_profile(
      [](double polar, double around) {
        const double c = std::cos(polar * k_pi_d / 180);
        return c < -0.5 ? 0 : (1 + c) * (1.2 + std::sin(2 * around * k_pi_d / 180));
      },
      false));
  const Emitted e(s);
  const vec3 mean = mean_flux(e);
  for (int c = 0; c < 3; ++c)
    CHECK(mean[c] == Approx(float(scene::solid_angle(l)) * l.intensity[c]).epsilon(2e-3));
  constexpr uint32_t k_rows = 18, k_columns = 12;
  const auto bin = [&](uint32_t row, uint32_t column) {
    return size_t{row * k_rows / (l.profile->rows - 1)} * k_columns + column * k_columns / l.profile->columns;
  };
  std::vector<double> observed(size_t{k_rows} * k_columns, 0.0), expected(observed.size(), 0.0);
  const std::vector<double> cells = l.profile->cells();
  for (size_t i = 0; i < cells.size(); ++i)
    expected[bin(uint32_t(i / l.profile->columns), uint32_t(i % l.profile->columns))] +=
        cells[i] / l.profile->solid_angle * double(e.paths.size());
  const glm::dvec3 x(l.right), n(l.direction), y = glm::cross(x, n);
  size_t dark = 0;
  for (const Beginning& b : e.paths) {
    const glm::dvec3 d(b.direction);
    double around = std::atan2(glm::dot(d, y), glm::dot(d, x)) / (2 * k_pi_d);
    around -= std::floor(around);
    const double polar = std::acos(std::clamp(glm::dot(d, n), -1.0, 1.0)) / k_pi_d;
    observed[bin(std::min(uint32_t(polar * (l.profile->rows - 1)), l.profile->rows - 2),
                 std::min(uint32_t(around * l.profile->columns), l.profile->columns - 1))] += 1;
    dark += !(b.flux.x > 0);
  }
  CHECK(chi_square(observed, expected).p > 1e-4);
  CHECK(dark < e.paths.size() / 1000);
}

TEST_CASE("a projector emits the flux of its picture, in proportion to its light") {
  scene::Scene s = floor();
  s.lights = {lamp(scene::LightKind::spot, {3, 2, 1})};
  scene::Light& l = s.lights[0];
  l.outer_cone = glm::radians(50.0f), l.inner_cone = 0;
  constexpr uint32_t k_w = 7, k_h = 5;
  std::vector<vec3> texels;
  for (uint32_t i = 0; i < k_w * k_h; ++i)
    texels.push_back(i % 4 == 0 ? vec3(0) : vec3(0.2f + float(i % 3), 1, 0.1f * float(i % 5)));
  // Black over several cells: no path goes there.
  for (const uint32_t i : {0, 1, 7, 8}) texels[i] = vec3(0);
  set_picture(l, std::make_shared<scene::LightPicture>(scene::make_picture(k_w, k_h, texels, "x")));
  l.right = scene::rolled(l.direction, 40);
  const Emitted e(s);
  // The integral of each channel over the directions, by the function of the host.
  const vec2 half = scene::picture_extent(l);
  const glm::dvec3 x(l.right), n(l.direction), y = glm::cross(x, n);
  constexpr int k_n = 600;
  glm::dvec3 flux(0);
  for (int j = 0; j < k_n; ++j)
    for (int i = 0; i < k_n; ++i) {
      const double u = double(half.x) * ((2 * i + 1.0) / k_n - 1),
                   v = double(half.y) * ((2 * j + 1.0) / k_n - 1);
      const double r2 = 1 + u * u + v * v, area = 4 * double(half.x) * double(half.y) / (double(k_n) * k_n);
      const vec3 share = scene::picture_along(l, vec3(glm::normalize(u * x + v * y + n)));
      flux += glm::dvec3(l.intensity * share) * (area / (r2 * std::sqrt(r2)));
    }
  const vec3 mean = mean_flux(e);
  for (int c = 0; c < 3; ++c) CHECK(mean[c] == Approx(float(flux[c])).epsilon(1e-2));
  // Paths by cell, as often as its mean luminance says.
  std::vector<double> observed(size_t{k_w - 1} * (k_h - 1), 0.0), expected;
  double sum = 0;
  for (uint32_t j = 0; j + 1 < k_h; ++j)
    for (uint32_t i = 0; i + 1 < k_w; ++i) {
      double light = 0;
      for (const uint32_t k : {j * k_w + i, j * k_w + i + 1, (j + 1) * k_w + i, (j + 1) * k_w + i + 1})
        light += double(luminance(texels[k]));
      expected.push_back(light), sum += light;
    }
  for (double& v : expected) v *= double(e.paths.size()) / sum;
  size_t outside = 0, dark = 0;
  for (const Beginning& b : e.paths) {
    const glm::dvec3 d(b.direction);
    const double ahead = glm::dot(d, n);
    const double u = 0.5 + 0.5 * glm::dot(d, x) / ahead / double(half.x),
                 v = 0.5 - 0.5 * glm::dot(d, y) / ahead / double(half.y);
    outside += !(ahead > 0 && u > -1e-4 && u < 1.0001 && v > -1e-4 && v < 1.0001);
    const auto i = size_t(std::clamp(u * (k_w - 1), 0.0, k_w - 1.001)),
               j = size_t(std::clamp(v * (k_h - 1), 0.0, k_h - 1.001));
    observed[j * (k_w - 1) + i] += 1;
    dark += !(b.flux.x > 0);
  }
  CHECK(outside == 0);
  CHECK(dark < e.paths.size() / 1000);
  CHECK(observed[0] == 0);
  observed.erase(observed.begin()), expected.erase(expected.begin());
  CHECK(chi_square(observed, expected).p > 1e-4);
}

TEST_CASE("a sun emits its irradiance through a disk that covers the whole scene") {
  scene::Scene s = floor();
  s.lights = {lamp(scene::LightKind::directional, {3, 2, 1})};
  const Emitted e(s);
  const double radius = double(e.flat.scene_radius);
  CHECK(radius == Approx(std::sqrt(2.0)));
  check_all(e, vec3(float(k_pi_d * radius * radius)) * vec3(3, 2, 1), 1e-3);
  std::vector<vec2> disk;
  for (const Beginning& b : e.paths) {
    REQUIRE(b.direction == s.lights[0].direction);
    const vec3 off = b.origin - e.flat.scene_centre;
    REQUIRE(glm::dot(off, b.direction) == Approx(-radius).epsilon(1e-3));  // in front of all surfaces
    const vec3 across = off - glm::dot(off, b.direction) * b.direction;
    disk.emplace_back(glm::dot(across, across) / (radius * radius), turn(across, b.direction));
  }
  CHECK(even_tail(disk) > 1e-4);
  // The number of paths through the floor follows its projected area.
  double through = 0;
  for (const Beginning& b : e.paths) {
    const vec3 at = b.origin - b.direction * (b.origin.y / b.direction.y);
    through += std::abs(at.x) <= 1 && std::abs(at.z) <= 1;
  }
  const double share = 4 * std::abs(double(s.lights[0].direction.y)) / (k_pi_d * radius * radius);
  CHECK(through / double(e.paths.size()) == Approx(share).epsilon(0.01));
}

TEST_CASE(
    "an emissive triangle emits pi times radiance times area, cosine-distributed, from one or both sides") {
  for (const bool both : {false, true}) {
    scene::Scene s = floor();
    s.materials[0].emission = {5, 3, 2};
    s.materials[0].double_sided = both;
    const Emitted e(s);
    check_all(e, vec3(float(4 * k_pi_d * (both ? 2 : 1))) * vec3(5, 3, 2));
    std::vector<vec2> places, directions;
    double below = 0;
    for (const Beginning& b : e.paths) {
      REQUIRE(std::abs(b.origin.y) < 1e-4f);
      places.emplace_back(0.5f * b.origin.x + 0.5f, 0.5f * b.origin.z + 0.5f);
      directions.emplace_back(b.direction.y * b.direction.y, turn(b.direction, {0, 1, 0}));
      below += b.direction.y < 0;
      REQUIRE(b.origin.y * b.direction.y > 0);  // offset to the side that it leaves
      const float cosine = std::abs(b.direction.y);
      REQUIRE(b.pdf_direction == Approx(cosine / k_pi_d).epsilon(1e-3).margin(1e-4));
      REQUIRE(b.pdf_place == Approx(both ? 0.25 : 0.5).epsilon(1e-4));  // each triangle has half of the area
    }
    CHECK(even_tail(places) > 1e-4);
    CHECK(even_tail(directions) > 1e-4);
    CHECK(below == Approx(both ? 0.5 * double(e.paths.size()) : 0).epsilon(0.02));
  }
}

TEST_CASE("an emission texture emits where it is bright") {
  scene::Scene s = floor();
  s.materials[0].emission = {2, 2, 2};
  scene::Image image;
  image.name = "halves", image.width = 2, image.height = 1;
  image.bytes = {255, 255, 255, 255, 0, 0, 0, 255};
  s.images = {image};
  s.textures = {{.image = 0, .wrap_u = scene::Wrap::clamp, .nearest = true, .srgb = true}};
  s.materials[0].emission_texture.texture = 0;
  const Emitted e(s, 1 << 17);
  // Half of the floor is emissive.
  CHECK(mean_flux(e).x == Approx(2 * k_pi_d * 2).epsilon(5e-3));
  size_t wrong = 0;
  for (const Beginning& b : e.paths)
    if (std::abs(b.origin.x) > 1e-3f) wrong += (b.flux.x > 0) != (b.origin.x < 0);
  CHECK(wrong == 0);
}

TEST_CASE("an environment emits through the scene's disk from each direction") {
  constexpr uint32_t k_width = 16, k_height = 8;
  for (const float threshold : {0.f, 20.f}) {
    scene::Scene s = floor();
    scene::Image image;
    image.name = "sky", image.width = k_width, image.height = k_height;
    for (uint32_t y = 0; y < k_height; ++y)
      for (uint32_t x = 0; x < k_width; ++x) {
        const float value = y == 2 && x == 5 ? 200.f : y > 5 ? 0 : 0.5f + 0.1f * float(x);
        image.floats.insert(image.floats.end(), {value, 0.5f * value, 0.25f * value, 1});
      }
    s.images = {image};
    s.environment.image = 0, s.environment.rotation = 40, s.environment.scale = 2;
    s.lights = {lamp(scene::LightKind::point, {3, 2, 1})};
    const Emitted e(s, 1 << 18, threshold);
    CHECK(e.flat.effects.separate_sky == (threshold > 0));
    CHECK(e.flat.effects.sun == (threshold > 0));
    // Integral of the bilinearly filtered map over all directions.
    constexpr int k_fine = 16;
    double integral = 0;
    for (uint32_t y = 0; y < k_height * k_fine; ++y)
      for (uint32_t x = 0; x < k_width * k_fine; ++x) {
        const double v = (y + 0.5) / k_fine - 0.5, u = (x + 0.5) / k_fine - 0.5;
        const int y0 = int(std::floor(v)), x0 = int(std::floor(u));
        const double fv = v - y0, fu = u - x0;
        const auto at = [&](int row, int column) {
          const auto r = size_t(std::clamp(row, 0, int(k_height) - 1)),
                     c = size_t((column + int(k_width)) % int(k_width));
          return double(image.floats[4 * (r * k_width + c)]);
        };
        const double value = (1 - fv) * ((1 - fu) * at(y0, x0) + fu * at(y0, x0 + 1)) +
                             fv * ((1 - fu) * at(y0 + 1, x0) + fu * at(y0 + 1, x0 + 1));
        const double theta = k_pi_d * (y + 0.5) / (k_height * k_fine);
        integral += value * std::sin(theta) * k_pi_d / (k_height * k_fine) * 2 * k_pi_d / (k_width * k_fine);
      }
    const double disk = k_pi_d * std::pow(double(e.source.table().radius), 2);
    test::Mean red;
    for (const Beginning& b : e.paths) {
      const bool point = b.light == 0;
      red.add(point ? 0 : double(b.flux.x));
      if (point) REQUIRE(b.flux.x == Approx(e.paths[0].light == 0 ? e.paths[0].flux.x : b.flux.x));
    }
    INFO("threshold " << threshold << ": " << red.value() << " +- " << red.error() << " of "
                      << 2 * integral * disk);
    // Draws are stratified, so their error is below that of independent ones.
    CHECK(std::abs(red.value() - 2 * integral * disk) < 4 * red.error() + 2e-3 * red.value());
    // Flux over densities is the radiance of the direction, for either emitter.
    for (size_t i = 0; i < 1000; ++i) {
      const Beginning& b = e.paths[i];
      if (b.light == 0) continue;
      const double radiance =
          double(b.flux.x) * double(b.pmf) * double(b.pdf_place) * double(b.pdf_direction);
      CHECK(radiance <= 2 * 200 * 1.001);
    }
  }
}

TEST_CASE("lights are chosen by power, so all paths carry the same flux") {
  scene::Scene s = floor();
  s.materials[0].emission = {5, 3, 2};
  s.lights = {lamp(scene::LightKind::point, {3, 2, 1}), lamp(scene::LightKind::spot, {300, 200, 900}),
              lamp(scene::LightKind::directional, {1, 1, 1}), lamp(scene::LightKind::point, {1e-6f, 0, 0})};
  s.lights[1].inner_cone = 0.1f, s.lights[1].outer_cone = 0.3f;
  s.lights.push_back(lamp(scene::LightKind::point, {100, 100, 100}));
  s.lights.back().enabled = false;
  const Emitted e(s);
  const auto power = float(e.source.power());
  std::vector<double> observed(6, 0.0), expected(6, 0.0);
  for (const Beginning& b : e.paths) {
    REQUIRE(luminance(b.flux) == Approx(power).epsilon(1e-3));
    REQUIRE(b.light < 6);
    observed[b.light] += 1, expected[b.light] = double(b.pmf) * double(e.paths.size());
  }
  CHECK(expected[0] + expected[1] > 0);  // the floor's triangles
  const double floor_power = 4 * k_pi_d * double(luminance(vec3(5, 3, 2)));
  CHECK((observed[0] + observed[1]) / double(e.paths.size()) ==
        Approx(floor_power / e.source.power()).epsilon(0.01));
  for (size_t i = 0; i < 6; ++i) CHECK(std::abs(observed[i] - expected[i]) < 5 * std::sqrt(expected[i] + 1));
}

TEST_CASE("without lights nothing is emitted") {
  const upload::FlatScene flat = upload::flatten(floor());
  const transport::LightSource none(device(), flat, flat.scene_centre, flat.scene_radius);
  CHECK(none.power() == 0);
  CHECK(none.table().count == 0);
}

namespace {

/// True if the path's first ray enters a box; and its origin.
bool enters(const Beginning& b, const Box& box) {
  const glm::dvec3 o(b.origin), d(b.direction);
  double near = 0, far = 1e30;
  for (int k = 0; k < 3; ++k) {
    const double t0 = (double(box.lo[k]) - o[k]) / d[k], t1 = (double(box.hi[k]) - o[k]) / d[k];
    near = std::max(near, std::min(t0, t1)), far = std::min(far, std::max(t0, t1));
  }
  return near <= far;
}

/// Mean contributions of paths in total and through each box, and two moments of their directions.
std::vector<test::Mean> contributions(const Emitted& e, const std::vector<Box>& boxes) {
  std::vector<test::Mean> means(3 + boxes.size());
  for (const Beginning& b : e.paths) {
    const auto flux = double(luminance(b.flux));
    means[0].add(flux);
    means[1].add(flux * (1 + double(b.direction.x)));
    means[2].add(flux * double(glm::dot(b.origin, b.origin)));
    for (size_t k = 0; k < boxes.size(); ++k) means[3 + k].add(enters(b, boxes[k]) ? flux : 0);
  }
  return means;
}

const std::vector<Box> k_boxes{{vec3(-0.3f, 0.5f, -0.2f), vec3(0.1f, 0.8f, 0.3f)},
                               {vec3(0.4f, 0.1f, -0.8f), vec3(0.9f, 0.1001f, -0.4f)},
                               {vec3(-0.2f, 2.5f, -0.6f), vec3(0.6f, 3.2f, 0.3f)}};  // around the lamp
const std::vector<double> k_uneven{0.2, 0.01, 0.5, 0.1, 0.002, 0.3, 0.04};

scene::Scene sky_scene() {
  scene::Scene s = floor();
  scene::Image image;
  image.name = "sky", image.width = 8, image.height = 4;
  for (int i = 0; i < 32; ++i) {
    const float value = i == 10 ? 60.f : 0.2f + 0.1f * float(i % 5);
    image.floats.insert(image.floats.end(), {value, value, value, 1});
  }
  s.images = {image};
  s.environment.image = 0;
  return s;
}

}  // namespace

TEST_CASE("aimed paths have the same mean as unaimed ones, for any shares and every kind of light") {
  std::vector<std::pair<std::string, scene::Scene>> scenes;
  for (const auto kind : {scene::LightKind::point, scene::LightKind::spot, scene::LightKind::directional,
                          scene::LightKind::sphere, scene::LightKind::rectangle, scene::LightKind::tube}) {
    scene::Scene s = floor();
    s.lights = {lamp(kind, {3, 2, 1})};
    s.lights[0].inner_cone = 0.2f, s.lights[0].outer_cone = 0.5f;
    scenes.emplace_back("lamp " + std::to_string(int(kind)), s);
  }
  for (const bool both : {false, true}) {
    scene::Scene s = floor();
    s.materials[0].emission = {5, 3, 2}, s.materials[0].double_sided = both;
    scenes.emplace_back(both ? "panel of two sides" : "panel", s);
  }
  scenes.emplace_back("sky", sky_scene());
  scene::Scene several = sky_scene();
  several.materials[0].emission = {5, 3, 2};
  several.lights = {lamp(scene::LightKind::point, {3, 2, 1}), lamp(scene::LightKind::directional, {5, 5, 5}),
                    lamp(scene::LightKind::point, {3e-5f, 2e-5f, 1e-5f})};
  scenes.emplace_back("several", several);
  for (const auto& [name, s] : scenes)
    for (const float threshold : {0.f, 20.f}) {
      if (threshold > 0 && s.environment.image == scene::k_none) continue;
      const Emitted plain(s, 1 << 17, threshold), aimed(s, 1 << 17, threshold, k_boxes, k_uneven);
      REQUIRE(aimed.source.strata() == 1 + 3 * aimed.source.table().groups);
      const std::vector<test::Mean> a = contributions(plain, k_boxes), b = contributions(aimed, k_boxes);
      // Points are stratified, so both errors are below those of independent ones; 5 sigma of 50 comparisons.
      for (size_t i = 0; i < a.size(); ++i) {
        INFO(name << ", threshold " << threshold << ", moment " << i << ": " << b[i].value() << " +- "
                  << b[i].error() << " of " << a[i].value() << " +- " << a[i].error());
        CHECK(std::abs(a[i].value() - b[i].value()) <=
              5 * std::hypot(a[i].error(), b[i].error()) + 1e-4 * std::abs(a[i].value()));
      }
      CHECK(b[0].value() > 0);
      // Each stratum has its share of the paths, up to the last path.
      std::vector<double> drawn(aimed.source.strata(), 0.0);
      for (const Beginning& path : aimed.paths) drawn[path.stratum] += 1;
      for (size_t i = 0; i < drawn.size(); ++i)
        CHECK(std::abs(drawn[i] - aimed.source.shares()[i] * double(aimed.paths.size())) < 1.5);
    }
}

TEST_CASE("aimed paths reach their box") {
  scene::Scene s = sky_scene();
  s.materials[0].emission = {5, 3, 2};
  s.lights = {lamp(scene::LightKind::point, {3, 2, 1}), lamp(scene::LightKind::directional, {5, 5, 5})};
  // A far and small box, besides the others.
  std::vector<Box> boxes{k_boxes[0], k_boxes[1]};
  boxes.push_back({vec3(0.6f, 0.2f, 0.5f), vec3(0.60005f, 0.20005f, 0.50005f)});
  const Emitted e(s, 1 << 16, 0, boxes);
  size_t missed = 0, aimed = 0;
  for (const Beginning& b : e.paths) {
    if (b.stratum == 0 || luminance(b.flux) <= 0) continue;
    Box box = boxes[(b.stratum - 1) % boxes.size()];
    box.lo -= vec3(3e-6f), box.hi += vec3(3e-6f);  // rounding
    const bool inside =
        glm::all(glm::greaterThan(b.origin, box.lo)) && glm::all(glm::lessThan(b.origin, box.hi));
    ++aimed, missed += !inside && !enters(b, box);
  }
  CHECK(double(aimed) > 0.4 * double(e.paths.size()));
  CHECK(missed == 0);
  // The small box alone receives the flux of its size: for the sun, irradiance times its covered area.
  std::vector<test::Mean> means = contributions(e, {boxes.back()});
  const double sun = [&] {
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += double(std::abs(s.lights[1].direction[k])) * 0.00005 * 0.00005;
    return sum * double(luminance(vec3(5, 5, 5)));
  }();
  CHECK(means[3].value() > sun);
  CHECK(means[3].error() < 0.1 * means[3].value());
}

}  // namespace emission_tests
