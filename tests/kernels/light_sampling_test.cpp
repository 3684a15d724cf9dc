// links: upload
// Light sampling through shaders/lib/lights.glsl with the program's tables: the chosen light, the point on
// it, and the densities.
#include <bit>
#include <cstring>

#include "base/alias_table.h"
#include "kernels/light_support.h"

namespace light_sampling_tests {

using namespace lucerna;
using namespace lucerna::test;

namespace {

/// Four triangles of different size, shape and power, one of them dark.
scene::Scene triangles() {
  scene::Scene scene;
  add_triangle(scene, {0, 0, 0}, {3, 0, 0}, {0.5f, 0, 1}, {1, 2, 3});
  add_triangle(scene, {-1, 2, 1}, {-1, 2.5f, 1}, {-1.2f, 2, 3}, {20, 10, 5});
  add_triangle(scene, {5, 5, 5}, {6, 5, 5}, {5, 6, 5}, {0, 0, 0});
  add_triangle(scene, {2, 1, -2}, {2.02f, 1, -2}, {2, 4, -2}, {5, 5, 5});
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
         lights.choose(build_alias_table(weights), k_draws, 50 + static_cast<uint32_t>(k))) {
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

TEST_CASE("alias tables of millions of entries: an entry that is almost every alias gets its share") {
  // Like a sun in a large map: all other entries' coins together give it a 2 % share.
  constexpr size_t k_entries = 1 << 22, k_sun = 1234567;
  constexpr uint32_t k_draws = 1 << 22;
  constexpr double k_share = 0.02;
  std::vector<double> weights(k_entries, (1 - k_share) / (k_entries - 1));
  weights[k_sun] = k_share;
  Lights lights(triangles());
  double drawn = 0;
  for (const Answer& a : lights.choose(build_alias_table(weights), k_draws, 9))
    drawn += static_cast<size_t>(a.value.x) == k_sun;
  const double error = std::sqrt(k_share * (1 - k_share) / k_draws);
  INFO("share " << drawn / k_draws << " of " << k_share << " +- " << error);
  CHECK(std::abs(drawn / k_draws - k_share) < 4 * error);
}

TEST_CASE("points on emissive triangles: uniform in area, triangles by power, with the stated density") {
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
    const scene::Scene scene = light_sampling_tests::triangles();
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
  Jury jury;
  for (const float x : {-1.f, -1.7f, -2.1f, -6.f}) {
    const vec3 position(x, 0, 0);
    Mean inverse[3];  // 1 over the density of each: its mean is 1 where it sends light
    bool sends[3] = {false, false, false};
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
      sends[kind] |= luminance(radiance) > 0;
      for (int k = 0; k < 3; ++k) inverse[k].add(k == kind ? 1 / d.pdf : 0);
    }
    INFO("x " << x);
    CHECK(bad == 0);
    for (int k = 0; k < 3; ++k)
      if (sends[k])
        jury.add(fmt::format("lamp {} at x {}: {}", k, x, inverse[k].value()),
                 mean_tail(inverse[k], 1, 1e-5));
  }
  CHECK(jury.size() >= 10);
  CHECK(jury.verdict() == "");
}

TEST_CASE("of many lamps those that light a point are sampled: the mean is right, with little of the noise") {
  // Spots of four powers in a ceiling, each with its own cone; two points, one below the floor, and a panel.
  scene::Scene scene;
  for (int i = 0; i < 20; ++i) {
    scene::Light spot;
    spot.kind = scene::LightKind::spot, spot.direction = {0, -1, 0};
    spot.inner_cone = 0.2f, spot.outer_cone = 0.35f + 0.02f * float(i);
    spot.position = {2 * float(i % 5), 3, 2 * float(i / 5)};
    spot.intensity = vec3(float(1 << 2 * (i % 4)));
    scene.lights.push_back(spot);
  }
  for (const float y : {2.f, -1.f}) {
    scene::Light point;
    point.intensity = {3, 3, 3}, point.position = {3, y, 3};
    scene.lights.push_back(point);
  }
  add_triangle(scene, {0, 4, 0}, {1, 4, 0}, {0, 4, 1}, vec3(2));
  Lights lights(scene);
  CHECK(lights.flat.effects.lamp_candidates == 8);
  CHECK(lights.flat.lamp_alias.size() == 22);
  Jury jury;
  double variance = 0, by_power = 0;
  for (const vec3& position : {vec3(0, 0, 0), vec3(3.1f, 0, 2.2f), vec3(6, 1, 6), vec3(9.5f, 0, 0.5f)}) {
    double right = 0, second = 0;
    std::vector<double> of_lamp(scene.lights.size());
    for (size_t k = 0; k < scene.lights.size(); ++k) {
      const scene::Light& l = scene.lights[k];
      const vec3 to = l.position - position, direction = glm::normalize(to);
      const float inner = std::cos(l.inner_cone), outer = std::cos(l.outer_cone);
      const float fade =
          l.kind == scene::LightKind::point
              ? 1
              : std::clamp((glm::dot(-direction, l.direction) - outer) / (inner - outer), 0.f, 1.f);
      of_lamp[k] = double(l.intensity.x * fade * fade / glm::dot(to, to) * std::max(direction.y, 0.f));
      right += of_lamp[k];
    }
    // As if the lamps were chosen by the table alone.
    for (size_t i = 0; i < lights.flat.entries.size(); ++i) {
      const upload::LightEntry& e = lights.flat.entries[i];
      if (e.kind != shared::k_light_triangle)
        second += of_lamp[e.index] * of_lamp[e.index] / double(lights.flat.light_alias[i].z);
    }
    Mean mean;
    for (const Draw& d : lights.draw(position, 1 << 16, 3))
      mean.add(d.delta == 1 && d.pdf > 0 ? double(d.radiance.x * std::max(d.direction.y, 0.f) / d.pdf) : 0);
    REQUIRE(right > 0);
    jury.add(fmt::format("{} where {} is right", mean.value(), right), mean_tail(mean, right, 1e-5 * right));
    variance += mean.error() * mean.error() * (1 << 16) / (right * right),
        by_power += second / (right * right) - 1;
  }
  CHECK(jury.verdict() == "");
  INFO(variance << " by contribution, " << by_power << " by power");
  CHECK(variance < 0.2 * by_power);
}

TEST_CASE("lights of another strength, chosen as before: the distribution stays, the mean is the new light") {
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
                            rebuilt = upload::flatten(after, sun_threshold);
    upload::FlatScene kept = made;
    upload::flatten_emission(after, kept);
    const auto same = [](const auto& a, const auto& b) {
      return std::equal(a.begin(), a.end(), b.begin(), b.end());
    };
    CHECK(same(kept.light_alias, made.light_alias));
    CHECK_FALSE(same(kept.light_alias, rebuilt.light_alias));
    CHECK(same(kept.primitive_light_pmf, made.primitive_light_pmf));
    CHECK(same(kept.environment.density, made.environment.density));
    CHECK(kept.environment_light_pmf == made.environment_light_pmf);
    CHECK(same(kept.lights, rebuilt.lights));
    CHECK(same(kept.environment_texels, rebuilt.environment_texels));
    CHECK(kept.environment_radiance == rebuilt.environment_radiance);
    CHECK(kept.environment_rotation == rebuilt.environment_rotation);
    // The mean light at a point from all directions.
    const auto mean = [](upload::FlatScene flat, uint32_t seed) {
      Lights lights(std::move(flat));
      Mean m;
      for (const Draw& d : lights.draw({0.3f, 1, 0.4f}, 1 << 18, seed))
        m.add(d.pdf > 0 ? double(luminance(d.radiance)) / double(d.pdf) : 0);
      return m;
    };
    const Mean with_old = mean(kept, 3), with_own = mean(rebuilt, 4), old_light = mean(made, 5);
    INFO("sun threshold " << sun_threshold << ": " << with_old.value() << " and " << with_own.value());
    const double error = std::hypot(with_old.error(), with_own.error());
    CHECK(error < 0.02 * with_own.value());
    CHECK(std::abs(with_old.value() - with_own.value()) < 4 * error);
    CHECK(std::abs(old_light.value() - with_own.value()) > 10 * error);
  }
}

TEST_CASE("there were no validation messages: light sampling") { CHECK(device().validation_messages() == 0); }

}  // namespace light_sampling_tests
