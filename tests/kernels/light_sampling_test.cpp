// links: upload
// Light sampling through shaders/lib/lights.glsl with the tables that the program makes: which light, where
// on it, which direction of the environment; and that what is drawn has the density that it says.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <bit>
#include <cstring>
#include <random>

#include "gpu/stream.h"
#include "kernels/statistics_support.h"
#include "upload/alias_table.h"
#include "upload/device_scene.h"

using namespace lucerna;
using namespace lucerna::test;

namespace {

constexpr double k_tau = 6.283185307179586;

struct Draw {
  vec3 direction;
  float distance;
  vec3 radiance;
  float pdf;
  vec3 target;
  uint32_t primitive;
  vec3 normal;
  uint32_t delta;  ///< 2: of the sky, where that is apart
  vec2 uv;
};
struct Answer {
  vec3 value;
  float pdf;
};

gpu::Device& device() {
  static gpu::Device instance({"", true});
  return instance;
}

/// A flattened scene on the device, and the kernel in the variant that the scene calls for.
class Lights {
 public:
  explicit Lights(const scene::Scene& scene, float sun_threshold = 0)
      : Lights(upload::flatten(scene, sun_threshold)) {}
  explicit Lights(upload::FlatScene flattened) : flat(std::move(flattened)), scene_(device(), flat, {}) {
    frame.light_count = static_cast<uint32_t>(flat.lights.size() / shared::k_light_texels);
    frame.environment_radiance = flat.environment_radiance;
    frame.environment_width = flat.environment_width;
    frame.environment_height = flat.environment_height;
    frame.environment_rotation = flat.environment_rotation;
    frame.environment_light_pmf = flat.environment_light_pmf;
    frame_.write(&frame, sizeof frame);
    scene_.bind(resources_);
    resources_.set("FrameBlock", frame_);
  }

  std::vector<Draw> draw(const vec3& position, uint32_t count, uint32_t seed) {
    return run<Draw>("0", "Draws", {count, seed, position});
  }
  /// `sun`: of the sun, where that is apart.
  std::vector<Answer> environment(const std::vector<vec3>& directions, bool sun = false) {
    std::vector<vec4> questions;
    for (const vec3& d : directions) questions.emplace_back(d, sun ? 1 : 0);
    return ask("1", questions);
  }
  std::vector<Answer> triangle_pdf(const std::vector<vec4>& questions) { return ask("2", questions); }
  /// Entries of a table of its own.
  std::vector<Answer> choose(const std::vector<vec4>& table, uint32_t count, uint32_t seed) {
    gpu::Buffer buffer(device(), {"table", table.size() * sizeof(vec4), gpu::Memory::device, true});
    buffer.write(std::span<const vec4>(table));
    shared::Frame own = frame;
    own.light_count = static_cast<uint32_t>(table.size());
    frame_.write(&own, sizeof own);
    resources_.set("light_alias", buffer);
    questions_ = gpu::Buffer(device(), {"questions", count * sizeof(vec4)});
    resources_.set("Questions", questions_);
    return run<Answer>("3", "Answers", {count, seed, vec3(0)});
  }

  upload::FlatScene flat;
  shared::Frame frame{};

 private:
  struct Push {
    uint32_t count, seed;
    vec3 position;
  };
  std::vector<Answer> ask(const char* what, const std::vector<vec4>& questions) {
    questions_ = gpu::Buffer(device(), {"questions", questions.size() * sizeof(vec4)});
    questions_.write(std::span<const vec4>(questions));
    resources_.set("Questions", questions_);
    return run<Answer>(what, "Answers", {static_cast<uint32_t>(questions.size()), 0, vec3(0)});
  }
  template <class Result>
  std::vector<Result> run(const char* what, const char* name, const Push& push) {
    static gpu::ShaderCompiler compiler;
    gpu::Defines defines = scene_.defines();
    defines["TEST_ASK"] = what;
    const gpu::Kernel kernel(device(), compiler,
                             std::string(LUCERNA_SOURCE_DIR) + "/tests/kernels/shaders/light_probe.comp",
                             defines);
    const gpu::Buffer results(device(), {name, push.count * sizeof(Result)});
    resources_.set(name, results);
    gpu::Stream stream(device());
    stream.dispatch(kernel, resources_, push, gpu::groups_for(push.count, 64));
    stream.run();
    return results.read_all<Result>();
  }

  upload::DeviceScene scene_;
  gpu::Buffer frame_{device(), {"frame", sizeof(shared::Frame)}};
  gpu::Buffer questions_;
  gpu::Resources resources_;
};

void add_triangle(scene::Scene& scene, const vec3& a, const vec3& b, const vec3& c, const vec3& emission) {
  scene::Material material;
  material.emission = emission;
  scene::Primitive primitive;
  primitive.positions = {a, b, c};
  primitive.normals.assign(3, glm::normalize(glm::cross(b - a, c - a)));
  primitive.triangles = {{0, 1, 2}};
  primitive.material = static_cast<scene::Id>(scene.materials.size());
  scene::Mesh mesh;
  mesh.primitives.push_back(primitive);
  scene::Instance instance;
  instance.mesh = static_cast<scene::Id>(scene.meshes.size());
  scene.materials.push_back(material);
  scene.meshes.push_back(mesh);
  scene.instances.push_back(instance);
}

/// Four triangles of different size, shape and power, one of them dark.
scene::Scene triangles() {
  scene::Scene scene;
  add_triangle(scene, {0, 0, 0}, {3, 0, 0}, {0.5f, 0, 1}, {1, 2, 3});
  add_triangle(scene, {-1, 2, 1}, {-1, 2.5f, 1}, {-1.2f, 2, 3}, {20, 10, 5});
  add_triangle(scene, {5, 5, 5}, {6, 5, 5}, {5, 6, 5}, {0, 0, 0});
  add_triangle(scene, {2, 1, -2}, {2.02f, 1, -2}, {2, 4, -2}, {5, 5, 5});
  return scene;
}

/// A map with a sun, a dark floor, a gradient and noise.
scene::Scene sky(uint32_t width, uint32_t height, float rotation) {
  scene::Scene scene;
  scene::Image image;
  image.width = width, image.height = height;
  std::mt19937 random(3);
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      const float noise = static_cast<float>(random() >> 8) * 0x1p-24f;
      float value =
          y > height / 2 ? 0 : 0.2f + noise + 2.0f * static_cast<float>(x) / static_cast<float>(width);
      if (x == width / 3 && y == height / 4) value = 500;
      image.floats.insert(image.floats.end(), {value, 0.9f * value, 0.5f * value + 0.1f * noise, 1});
    }
  scene.images.push_back(image);
  scene.environment.image = 0;
  scene.environment.rotation = rotation;
  scene.environment.scale = 2;
  return scene;
}

/// Solid angle of a triangle (Van Oosterom and Strackee 1983).
double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double numerator = std::abs(glm::dot(a, glm::cross(b, c)));
  const double denominator = la * lb * lc + glm::dot(a, b) * lc + glm::dot(a, c) * lb + glm::dot(b, c) * la;
  const double half = std::atan2(numerator, denominator);
  return 2 * half;
}

}  // namespace

TEST_CASE("alias tables: every entry with its probability, never one of weight 0") {
  Lights lights(triangles());
  std::mt19937 random(2);
  std::vector<std::vector<double>> lists{
      {5}, {1, 3}, {0, 1, 0, 0, 2}, {1e-9, 1, 1e9}, std::vector<double>(777, 1)};
  lists.emplace_back();
  for (int i = 0; i < 1000; ++i)
    lists.back().push_back(i % 7 == 0 ? 0 : std::exp2(static_cast<double>(random() % 16)));
  Jury jury;
  for (size_t k = 0; k < lists.size(); ++k) {
    const std::vector<double>& weights = lists[k];
    constexpr uint32_t k_draws = 1 << 18;
    double total = 0;
    for (const double w : weights) total += w;
    std::vector<double> observed(weights.size(), 0.0), expected;
    for (const double w : weights) expected.push_back(w / total * k_draws);
    size_t wrong = 0;
    for (const Answer& a :
         lights.choose(upload::build_alias_table(weights), k_draws, 50 + static_cast<uint32_t>(k))) {
      const auto entry = static_cast<size_t>(a.value.x);
      if (entry >= weights.size()) FAIL("entry " << entry);
      observed[entry] += 1;
      wrong += weights[entry] == 0 || std::abs(a.pdf / (weights[entry] / total) - 1) > 1e-6;
    }
    INFO("list " << k);
    CHECK(wrong == 0);
    jury.add(fmt::format("list {}", k), chi_square(observed, expected).p);
  }
  CHECK(jury.verdict() == "");
}

TEST_CASE("alias tables of millions of entries: the one that nearly all have for alias gets its share") {
  // As a sun in a large map: every other entry's coin gives it a 2 % share.
  constexpr size_t k_entries = 1 << 22, k_sun = 1234567;
  constexpr uint32_t k_draws = 1 << 22;
  constexpr double k_share = 0.02;
  std::vector<double> weights(k_entries, (1 - k_share) / (k_entries - 1));
  weights[k_sun] = k_share;
  Lights lights(triangles());
  double drawn = 0;
  for (const Answer& a : lights.choose(upload::build_alias_table(weights), k_draws, 9))
    drawn += static_cast<size_t>(a.value.x) == k_sun;
  const double error = std::sqrt(k_share * (1 - k_share) / k_draws);
  INFO("share " << drawn / k_draws << " of " << k_share << " +- " << error);
  CHECK(std::abs(drawn / k_draws - k_share) < 4 * error);
}

TEST_CASE("beside the poles of a high map directions have the density that is told of them") {
  // Rows of 1/8192 of a half circle, of equal power in the eight at either pole, dark between.
  constexpr uint32_t k_width = 4, k_height = 8192, k_rows = 8;
  scene::Scene scene;
  scene::Image image;
  image.width = k_width, image.height = k_height;
  const auto pole_row = [&](uint32_t row) { return std::min(row, k_height - 1 - row); };
  for (uint32_t row = 0; row < k_height; ++row)
    for (uint32_t x = 0; x < k_width; ++x) {
      const float value = pole_row(row) < k_rows ? 1 / float(pole_row(row) + 0.5f) : 0;
      image.floats.insert(image.floats.end(), {value, value, value, 1});
    }
  scene.images.push_back(image);
  scene.environment.image = 0;
  Lights lights(scene);
  const double row_angle = 0.5 * k_tau / k_height;
  // By the nearer pole's row, and by sin^2 of half the angle to it within the row.
  constexpr int k_grid = 8;
  std::vector<double> within(k_rows * k_grid, 0.0), rows(k_rows, 0.0);
  size_t wrong = 0, count = 0;
  const auto band = [&](uint32_t from_pole) {
    return 2 * std::sin(row_angle * (from_pole + 0.5)) * std::sin(0.5 * row_angle);
  };
  double all = 0;
  for (uint32_t row = 0; row < k_height; ++row) {
    double power = 0;
    for (uint32_t x = 0; x < k_width; ++x)
      for (int d = -1; d <= 1; ++d)
        power += image.floats[4 * (size_t(std::clamp(int(row) + d, 0, int(k_height) - 1)) * k_width + x)] *
                 (d ? 0.25 : 0.5) * band(pole_row(row));
    all += power;
    if (pole_row(row) < k_rows) rows[pole_row(row)] += power;
  }
  constexpr uint32_t k_draws = 1 << 19;
  for (const Draw& d : lights.draw(vec3(0), k_draws, 3)) {
    const double across = std::hypot(double(d.direction.x), double(d.direction.z));
    const double theta = std::atan2(across, std::abs(double(d.direction.y)));
    const auto row = uint32_t(theta / row_angle);
    if (row >= k_rows) continue;
    const auto half_sine = [](double angle) { return std::pow(std::sin(0.5 * angle), 2); };
    const double from = half_sine(row * row_angle), to = half_sine((row + 1) * row_angle);
    within[row * k_grid + std::clamp(int((half_sine(theta) - from) / (to - from) * k_grid), 0, k_grid - 1)] +=
        1;
    const double exact = rows[row] / all / (2 * k_tau * band(row));
    wrong += !(std::abs(d.pdf / exact - 1) < 1e-3), ++count;
  }
  std::vector<double> expected;
  for (const double power : rows) expected.insert(expected.end(), k_grid, power / all * k_draws / k_grid);
  // Rounding may put a direction into the next row, or its part of a row.
  INFO(wrong << " of " << count << " densities are off");
  CHECK(double(count) > 0.9 * k_draws);
  CHECK(double(wrong) < 2e-3 * double(count));
  const double p = chi_square(within, expected).p;
  INFO("p " << p);
  CHECK(p > 1e-4);
}

TEST_CASE("points on emissive triangles: uniform in area, each triangle by its power, density as it says") {
  Lights lights(triangles());
  constexpr uint32_t k_draws = 1 << 18;
  constexpr int k_grid = 16;
  const vec3 position(0.3f, 1.7f, 0.4f);
  const auto draws = lights.draw(position, k_draws, 5);
  const uvec4* triangles = lights.flat.triangles.data();
  const size_t count = lights.flat.triangles.size();
  REQUIRE(count == 4);
  Jury jury;
  std::vector<double> power(count, 0.0), chosen(count, 0.0);
  std::vector<std::vector<double>> cells(count, std::vector<double>(k_grid * k_grid, 0.0));
  std::vector<Mean> inverse(count);
  std::vector<vec4> questions;
  size_t bad_point = 0, bad_direction = 0, bad_pdf = 0, bad_kind = 0, bad_normal = 0;
  const auto corner = [&](size_t t, int k) {
    return glm::dvec3(vec3(lights.flat.vertices[2 * triangles[t][k]]));
  };
  for (const Draw& d : draws) {
    bad_kind += d.delta != 0 || d.primitive >= count;
    if (d.primitive >= count) continue;
    const size_t t = d.primitive;
    const double u = d.uv.x, v = d.uv.y, w = 1 - u - v;
    const glm::dvec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2), p = w * a + u * b + v * c;
    bad_point += u < -1e-6 || v < -1e-6 || w < -1e-6 || glm::length(p - glm::dvec3(d.target)) > 1e-5;
    const glm::dvec3 to = p - glm::dvec3(position);
    bad_direction += std::abs(d.distance / glm::length(to) - 1) > 1e-5 ||
                     glm::length(glm::dvec3(d.direction) - glm::normalize(to)) > 1e-5;
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const double area = 0.5 * glm::length(n),
                 cosine = std::abs(glm::dot(glm::normalize(n), glm::normalize(to)));
    bad_normal += glm::dot(d.normal, d.direction) > 0 ||
                  std::abs(std::abs(glm::dot(glm::dvec3(d.normal), n)) / (2 * area) - 1) > 1e-5;
    // Uniform on a triangle: (u + v)^2 and v / (u + v) are independent and uniform.
    const double s = u + v, x = s * s, y = s > 0 ? v / s : 0;
    cells[t][std::clamp(int(x * k_grid), 0, k_grid - 1) * k_grid +
             std::clamp(int(y * k_grid), 0, k_grid - 1)] += 1;
    chosen[t] += 1;
    questions.emplace_back(std::bit_cast<float>(d.primitive), d.distance * d.distance, cosine, 0);
    for (size_t k = 0; k < count; ++k) inverse[k].add(k == t ? 1 / d.pdf : 0);
  }
  CHECK(bad_kind == 0);
  CHECK(bad_point == 0);
  CHECK(bad_direction == 0);
  CHECK(bad_normal == 0);
  const auto answers = lights.triangle_pdf(questions);
  REQUIRE(answers.size() == draws.size());
  for (size_t i = 0; i < draws.size(); ++i) bad_pdf += !(std::abs(answers[i].pdf / draws[i].pdf - 1) < 1e-4f);
  CHECK(bad_pdf == 0);
  double total = 0;
  for (size_t t = 0; t < count; ++t) {
    const double area =
        0.5 * glm::length(glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)));
    const scene::Scene scene = ::triangles();
    total += power[t] =
        area * luminance(scene.materials[triangles[t].w & shared::k_triangle_material_mask].emission);
  }
  for (double& p : power) p *= k_draws / total;
  jury.add("choice", chi_square(chosen, power).p);
  for (size_t t = 0; t < count; ++t) {
    INFO("triangle " << t);
    if (power[t] == 0) {
      CHECK(chosen[t] == 0);
      continue;
    }
    jury.add(
        fmt::format("place on triangle {}", t),
        chi_square(cells[t], std::vector<double>(cells[t].size(), chosen[t] / double(cells[t].size()))).p);
    const glm::dvec3 o(position);
    const double angle = solid_angle(corner(t, 0) - o, corner(t, 1) - o, corner(t, 2) - o);
    jury.add(fmt::format("solid angle of triangle {}: {} +- {}, really {}", t, inverse[t].value(),
                         inverse[t].error(), angle),
             mean_tail(inverse[t], angle, 1e-5 * angle));
  }
  CHECK(jury.verdict() == "");
}

TEST_CASE("directions of the environment map: by its density, which integrates to the chance of the map") {
  // Flat texels, so that an error of height shows, and high ones, in which the solid angle is not spread
  // evenly.
  for (const uvec2 size : {uvec2(64, 512), uvec2(16, 4)}) {
    const float rotation = size.x == 64 ? 0 : 37;
    scene::Scene scene = sky(size.x, size.y, rotation);
    scene::Light lamp;
    lamp.intensity = vec3(300);
    scene.lights.push_back(lamp);  // takes a share of the draws
    Lights lights(scene);
    const uint32_t width = lights.frame.environment_width, height = lights.frame.environment_height;
    const double turn = rotation * k_tau / 360;
    constexpr int k_probes = 2;
    // Density by texel, at several points of each.
    std::vector<vec3> directions;
    const auto at = [&](double x, double y) {  // in texels; uniform in solid angle within a row
      const uint32_t row = std::min(static_cast<uint32_t>(y), height - 1);
      const double top = std::cos(0.5 * k_tau * row / height),
                   low = std::cos(0.5 * k_tau * (row + 1) / height);
      const double z = top + (low - top) * (y - row), s = std::sqrt(std::max(0.0, 1 - z * z));
      const double phi = (x / width - 0.5) * k_tau - turn;
      return vec3(s * std::cos(phi), z, s * std::sin(phi));
    };
    for (uint32_t y = 0; y < height; ++y)
      for (uint32_t x = 0; x < width; ++x)
        for (int k = 0; k < k_probes * k_probes; ++k)
          directions.push_back(at(x + (k % k_probes + 0.3) / k_probes, y + (k / k_probes + 0.7) / k_probes));
    const auto answers = lights.environment(directions);
    std::vector<double> expected;
    double integral = 0;
    for (uint32_t y = 0; y < height; ++y) {
      const double band = std::cos(0.5 * k_tau * y / height) - std::cos(0.5 * k_tau * (y + 1) / height);
      for (uint32_t x = 0; x < width; ++x) {
        double sum = 0;
        for (int k = 0; k < k_probes * k_probes; ++k)
          sum += answers[(size_t(y) * width + x) * k_probes * k_probes + k].pdf;
        expected.push_back(sum / (k_probes * k_probes) * band * k_tau / width);
        integral += expected.back();
      }
    }
    CHECK(integral == Approx(lights.frame.environment_light_pmf).epsilon(1e-4));
    CHECK(integral > 0.2);
    CHECK(integral < 0.8);
    // Draws into the same texels.
    constexpr uint32_t k_draws = 1 << 19;
    constexpr int k_grid = 8;
    std::vector<double> observed(expected.size(), 0.0), within(k_grid * k_grid, 0.0);
    double drawn = 0;
    size_t bad = 0;
    size_t elsewhere = 0;  // density of a neighbouring texel
    std::vector<vec3> again;
    std::vector<float> pdfs;
    for (const Draw& d : lights.draw(vec3(0), k_draws, 11)) {
      if (d.delta) continue;
      drawn += 1;
      bad += d.primitive != shared::k_no_hit || !std::isinf(d.distance) ||
             std::abs(glm::length(d.direction) - 1) > 1e-5f || !(d.pdf > 0);
      const double turns = std::atan2(double(d.direction.z), double(d.direction.x)) + turn;
      double x = 0.5 + turns / k_tau;
      x = (x - std::floor(x)) * width;
      const double y = std::acos(std::clamp(double(d.direction.y), -1.0, 1.0)) / (0.5 * k_tau) * height;
      const uint32_t column = std::min(static_cast<uint32_t>(x), width - 1),
                     row = std::min(static_cast<uint32_t>(y), height - 1);
      observed[size_t(row) * width + column] += 1;
      const double top = std::cos(0.5 * k_tau * row / height),
                   low = std::cos(0.5 * k_tau * (row + 1) / height);
      const double fx = x - column, fy = (double(d.direction.y) - top) / (low - top);
      within[std::clamp(int(fy * k_grid), 0, k_grid - 1) * k_grid +
             std::clamp(int(fx * k_grid), 0, k_grid - 1)] += 1;
      const double exact =
          lights.flat.environment_density[size_t(row) * width + column] * lights.frame.environment_light_pmf;
      elsewhere += std::abs(d.pdf / exact - 1) > 1e-3;
      again.push_back(d.direction), pdfs.push_back(d.pdf);
    }
    CHECK(bad == 0);
    CHECK(double(elsewhere) < 1e-3 * drawn);
    Jury jury;
    const double share = lights.frame.environment_light_pmf;
    jury.add("chance of the map",
             normal_tail((drawn / k_draws - share) / std::sqrt(share * (1 - share) / k_draws)));
    for (double& e : expected) e *= drawn / integral;
    jury.add("texels", chi_square(observed, expected).p);
    jury.add("within texels",
             chi_square(within, std::vector<double>(within.size(), drawn / double(within.size()))).p);
    CHECK(jury.verdict() == "");
    // What a draw says of its density is what hitting the sky in that direction is told.
    const auto told = lights.environment(again);
    size_t different = 0;
    for (size_t i = 0; i < told.size(); ++i) different += std::abs(told[i].pdf / pdfs[i] - 1) > 1e-4f;
    CHECK(different == 0);
  }
}

TEST_CASE("the environment's radiance is the map, bilinear, turned counter-clockwise seen from above") {
  const scene::Scene scene = sky(16, 8, 90);
  Lights lights(scene);
  const scene::Image& image = scene.images[0];
  std::mt19937 random(4);
  std::vector<vec3> directions;
  for (int i = 0; i < 20000; ++i) {
    const double z = static_cast<double>(random()) * 0x1p-31 - 1,
                 phi = static_cast<double>(random()) * 0x1p-32 * k_tau;
    const double s = std::sqrt(1 - z * z);
    directions.emplace_back(s * std::cos(phi), z, s * std::sin(phi));
  }
  const auto answers = lights.environment(directions);
  size_t bad = 0, dark = 0;
  for (size_t i = 0; i < answers.size(); ++i) {
    // Turned by 90 degrees counter-clockwise (seen from above, x to the right, z towards the viewer), the map
    // shows at d what it showed at d turned back clockwise: (x, z) -> (-z, x).
    const glm::dvec3 d(-directions[i].z, directions[i].y, directions[i].x);
    const double u = 0.5 + std::atan2(d.z, d.x) / k_tau,
                 v = std::acos(std::clamp(d.y, -1.0, 1.0)) / (0.5 * k_tau);
    const double x = u * image.width - 0.5, y = v * image.height - 0.5;
    const auto texel = [&](int c, int r, int channel) {
      const int w = static_cast<int>(image.width), h = static_cast<int>(image.height);
      return double(image.floats[4 * (size_t(std::clamp(r, 0, h - 1)) * w + ((c % w) + w) % w) + channel]);
    };
    const int c = static_cast<int>(std::floor(x)), r = static_cast<int>(std::floor(y));
    for (int k = 0; k < 3; ++k) {
      const double fx = x - c, fy = y - r;
      const double expected = 2 * ((1 - fy) * ((1 - fx) * texel(c, r, k) + fx * texel(c + 1, r, k)) +
                                   fy * ((1 - fx) * texel(c, r + 1, k) + fx * texel(c + 1, r + 1, k)));
      const double most =
          std::max({texel(c, r, k), texel(c + 1, r, k), texel(c, r + 1, k), texel(c + 1, r + 1, k)});
      bad += !(std::abs(answers[i].value[k] - expected) <= 2e-4 * most);
      // Where there is light it is found by draws too.
      dark += expected > 1e-6 && !(answers[i].pdf > 0);
    }
  }
  CHECK(bad == 0);
  CHECK(dark == 0);
}

TEST_CASE("sky and sun apart: two emitters that add up to the environment, each sampled by its own density") {
  scene::Scene scene = sky(48, 24, 37);
  scene::Light lamp;
  lamp.intensity = vec3(300);
  scene.lights.push_back(lamp);
  Lights whole(scene), lights(scene, 16);
  REQUIRE(lights.flat.effects.sky_apart);
  REQUIRE(lights.flat.effects.sun);
  // One texel is the sun; filtering reaches it from the eight around it.
  CHECK(lights.flat.sun_cells.size() == 2 * 9);
  std::vector<vec3> directions;
  const uint32_t width = 48, height = 24;
  constexpr int k_grid = 8;
  std::vector<double> angles;
  for (uint32_t y = 0; y < height * k_grid; ++y)
    for (uint32_t x = 0; x < width * k_grid; ++x) {
      const double theta = 0.5 * k_tau * (y + 0.5) / (height * k_grid),
                   phi = k_tau * (x + 0.5) / (width * k_grid);
      directions.emplace_back(std::sin(theta) * std::cos(phi), std::cos(theta),
                              std::sin(theta) * std::sin(phi));
      angles.push_back(std::sin(theta) * 0.5 * k_tau / (height * k_grid) * k_tau / (width * k_grid));
    }
  const auto both = whole.environment(directions), of_sky = lights.environment(directions),
             of_sun = lights.environment(directions, true);
  size_t different = 0, unsampled = 0, bright = 0;
  double sky_light = 0, sun_light = 0, sky_chance = 0, sun_chance = 0;
  for (size_t i = 0; i < directions.size(); ++i) {
    different +=
        glm::length(of_sky[i].value + of_sun[i].value - both[i].value) > 1e-5f * glm::length(both[i].value);
    unsampled += (of_sky[i].value.x > 1e-6f && !(of_sky[i].pdf > 0)) ||
                 (of_sun[i].value.x > 1e-6f && !(of_sun[i].pdf > 0));
    bright += of_sun[i].value.x > 0;
    sky_light += double(of_sky[i].value.x) * angles[i], sun_light += double(of_sun[i].value.x) * angles[i];
    sky_chance += double(of_sky[i].pdf) * angles[i], sun_chance += double(of_sun[i].pdf) * angles[i];
  }
  CHECK(different == 0);
  CHECK(unsampled == 0);
  CHECK(double(bright) == Approx(4 * k_grid * k_grid).epsilon(0.2));  // two texels wide and high
  CHECK(sky_chance == Approx(lights.frame.environment_light_pmf).epsilon(1e-3));
  CHECK(sun_light > 0.2 * sky_light);
  // Draws bring the light of each, by its share of the draws, with the densities that hitting them tells.
  constexpr uint32_t k_draws = 1 << 18;
  Mean sky_mean, sun_mean;
  double sky_drawn = 0, sun_drawn = 0;
  std::vector<vec3> again[2];
  std::vector<float> pdfs[2];
  for (const Draw& d : lights.draw(vec3(0), k_draws, 12)) {
    const bool is_sky = d.delta == 2, is_sun = d.delta == 0;
    sky_drawn += is_sky, sun_drawn += is_sun;
    sky_mean.add(is_sky ? double(d.radiance.x) / double(d.pdf) : 0);
    sun_mean.add(is_sun ? double(d.radiance.x) / double(d.pdf) : 0);
    if (is_sky || is_sun) again[is_sun].push_back(d.direction), pdfs[is_sun].push_back(d.pdf);
  }
  Jury jury;
  for (const auto& [what, drawn, share] :
       {std::tuple("sky's share", sky_drawn, double(lights.frame.environment_light_pmf)),
        std::tuple("sun's share", sun_drawn, sun_chance)})
    jury.add(what, normal_tail((drawn / k_draws - share) / std::sqrt(share * (1 - share) / k_draws)));
  jury.add(fmt::format("sky {} +- {}, really {}", sky_mean.value(), sky_mean.error(), sky_light),
           mean_tail(sky_mean, sky_light, 1e-3 * sky_light));
  jury.add(fmt::format("sun {} +- {}, really {}", sun_mean.value(), sun_mean.error(), sun_light),
           mean_tail(sun_mean, sun_light, 1e-3 * sun_light));
  CHECK(jury.verdict() == "");
  CHECK(sky_mean.error() < 0.01 * sky_light);
  CHECK(sun_mean.error() < 0.01 * sun_light);
  for (const int sun : {0, 1}) {
    const auto told = lights.environment(again[sun], sun == 1);
    size_t wrong = 0;
    for (size_t i = 0; i < told.size(); ++i) wrong += std::abs(told[i].pdf / pdfs[sun][i] - 1) > 1e-3f;
    CHECK(double(wrong) < 1e-3 * double(told.size()));  // rounding may put a direction into the next texel
  }
  // A sky without anything bright has no sun, and light samples know nothing else.
  scene.lights.clear();
  scene.environment.image = scene::k_none;
  scene.environment.radiance = vec3(1);
  const upload::FlatScene even = upload::flatten(scene, 2);
  CHECK(even.effects.sky_apart);
  CHECK_FALSE(even.effects.sun);
  CHECK(even.environment_light_pmf == 1);
  CHECK(even.effects.lights);
}

TEST_CASE("lamps: intensity over distance squared, a spot's cone, the sun's irradiance") {
  scene::Scene scene;
  scene::Light lamp;
  lamp.intensity = {30, 20, 10}, lamp.position = {1, 2, 3};
  scene.lights.push_back(lamp);
  lamp.kind = scene::LightKind::spot, lamp.direction = {0, -1, 0};
  lamp.inner_cone = 0.3f, lamp.outer_cone = 0.6f, lamp.position = {-1, 2, 0};
  scene.lights.push_back(lamp);
  lamp.kind = scene::LightKind::directional, lamp.direction = glm::normalize(vec3(1, -2, 0.5f)),
  lamp.intensity = {5, 4, 3};
  scene.lights.push_back(lamp);
  Lights lights(scene);
  for (const float x : {-1.f, -1.7f, -2.1f, -6.f}) {
    const vec3 position(x, 0, 0);
    double shares[3] = {0, 0, 0}, pmfs[3] = {0, 0, 0};
    const auto draws = lights.draw(position, 1 << 14, 1);
    size_t bad = 0;
    for (const Draw& d : draws) {
      const int kind = std::isinf(d.distance)                                                            ? 2
                       : std::abs(d.distance - glm::length(scene.lights[0].position - position)) < 1e-5f ? 0
                                                                                                         : 1;
      const scene::Light& light = scene.lights[kind];
      const vec3 to = light.position - position;
      vec3 direction = kind == 2 ? -light.direction : glm::normalize(to), radiance = light.intensity;
      if (kind < 2) radiance /= glm::dot(to, to);
      if (kind == 1) {
        const float inner = std::cos(light.inner_cone), outer = std::cos(light.outer_cone);
        const float fade =
            std::clamp((glm::dot(-direction, light.direction) - outer) / (inner - outer), 0.f, 1.f);
        radiance *= fade * fade;
      }
      bad += glm::length(d.direction - direction) > 1e-5f ||
             glm::length(d.radiance - radiance) > 1e-4f * glm::length(radiance) + 1e-7f || d.delta != 1 ||
             d.primitive != shared::k_no_hit;
      shares[kind] += 1, pmfs[kind] = d.pdf;
    }
    INFO("x " << x);
    CHECK(bad == 0);
    CHECK(pmfs[0] + pmfs[1] + pmfs[2] == Approx(1).epsilon(1e-5));
    for (double& p : pmfs) p *= 1 << 14;
    CHECK(chi_square({shares[0], shares[1], shares[2]}, {pmfs[0], pmfs[1], pmfs[2]}).p > 1e-5);
  }
}

TEST_CASE(
    "lights of another strength, chosen as they were: the distribution stays, the mean is the new light") {
  for (const float sun_threshold : {0.f, 16.f}) {
    const auto lit = [](const vec3& panel, const vec3& lamp, float sky_scale, float turn) {
      scene::Scene scene = sky(48, 24, turn);
      add_triangle(scene, {0, 4, 0}, {1, 4, 0}, {0, 4, 1}, panel);
      scene.lights.resize(1);
      scene.lights[0].intensity = lamp, scene.lights[0].position = {-1, 2, 0};
      scene.environment.scale = sky_scale;
      return scene;
    };
    const scene::Scene before = lit({20, 10, 5}, {300, 200, 100}, 1, 37);
    const scene::Scene after = lit({2, 40, 30}, {100, 300, 900}, 2.5f, 80);
    const upload::FlatScene made = upload::flatten(before, sun_threshold),
                            anew = upload::flatten(after, sun_threshold);
    upload::FlatScene kept = made;
    upload::flatten_emission(after, kept);
    const auto same = [](const auto& a, const auto& b) {
      return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
    };
    CHECK(same(kept.light_alias, made.light_alias));
    CHECK_FALSE(same(kept.light_alias, anew.light_alias));
    CHECK(same(kept.primitive_light_pmf, made.primitive_light_pmf));
    CHECK(same(kept.environment_density, made.environment_density));
    CHECK(kept.environment_light_pmf == made.environment_light_pmf);
    CHECK(same(kept.lights, anew.lights));
    CHECK(same(kept.environment_texels, anew.environment_texels));
    CHECK(kept.environment_radiance == anew.environment_radiance);
    CHECK(kept.environment_rotation == anew.environment_rotation);
    // What arrives at a point from everywhere.
    const auto mean = [](upload::FlatScene flat, uint32_t seed) {
      Lights lights(std::move(flat));
      Mean m;
      for (const Draw& d : lights.draw({0.3f, 1, 0.4f}, 1 << 18, seed))
        m.add(d.pdf > 0 ? double(luminance(d.radiance)) / double(d.pdf) : 0);
      return m;
    };
    const Mean with_old = mean(kept, 3), with_own = mean(anew, 4), old_light = mean(made, 5);
    INFO("sun threshold " << sun_threshold << ": " << with_old.value() << " and " << with_own.value());
    const double error = std::hypot(with_old.error(), with_own.error());
    CHECK(error < 0.02 * with_own.value());
    CHECK(std::abs(with_old.value() - with_own.value()) < 4 * error);
    CHECK(std::abs(old_light.value() - with_own.value()) > 10 * error);
  }
}

TEST_CASE("the validation layers had nothing to say") { CHECK(device().validation_messages() == 0); }
