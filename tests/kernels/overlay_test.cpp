// links: overlay
// Points, segments and discs over a small picture with known surfaces, through the real shaders: marks behind
// a surface are hidden, marks in front of it are drawn in their colour, and nothing else changes.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <optional>
#include <random>

#include "kernels/gpu_support.h"
#include "overlay/painter.h"
#include "support/device_name.h"

namespace overlay_tests {

using namespace lucerna;
using shared::OverlayDisc;
using shared::OverlayPoint;
using shared::OverlaySegment;

namespace {

constexpr float k_wall = 4;  // depth [m]
constexpr uint32_t k_base = 0xff405060u;

/// A picture of one colour. The camera is at the origin and looks along -z; the left half shows a wall that
/// faces it, the right half no surface.
struct Bed {
  gpu::Device device{{test::device_name(), true}};
  gpu::ShaderCompiler compiler;
  upload::DeviceScene scene{device, {}, {}};
  transport::Wavefront wavefront{device, compiler, scene, 64, [](auto&&...) {}};
  film::Film film, coarse;
  overlay::Sheet sheet{device, compiler};
  overlay::Canvas canvas{wavefront, film, coarse, sheet};
  overlay::Painter painter{device, compiler};
  shared::Frame frame{};

  /// `aside`: lens shift, in halves of the picture.
  Bed(uint32_t width, uint32_t height, bool orthographic = false, uint32_t enlarged = 1, vec2 aside = vec2(0))
      : film(device, width, height), coarse(device, std::max(1u, width / 4), std::max(1u, height / 4)) {
    frame.width = width, frame.height = height;
    const float scale = orthographic ? 2.0f : 0.5f;
    frame.camera_right = vec3(scale * float(width) / float(height), 0, 0);
    frame.camera_up = vec3(0, scale, 0);
    frame.camera_axis = vec3(0, 0, -1);
    frame.camera_forward = frame.camera_axis + aside.x * frame.camera_right + aside.y * frame.camera_up;
    frame.projection = orthographic ? shared::k_projection_orthographic : shared::k_projection_perspective;
    wavefront.set_frame(frame, 15);
    shared::Frame sheet_frame = frame;
    sheet_frame.width = enlarged * width, sheet_frame.height = enlarged * height;
    sheet.fit(film, enlarged, sheet_frame);
    film.clear(wavefront.stream());
    coarse.clear(wavefront.stream());
    std::vector<vec4> albedo(size_t{width} * height), normal(albedo.size());
    for (size_t p = 0; p < albedo.size(); ++p)
      if (wall(uint32_t(p % width)))
        albedo[p] = vec4(0.5f, 0.5f, 0.5f, 2), normal[p] = vec4(0, 0, 2, 2 * k_wall);
    const std::vector<uint32_t> counts(albedo.size(), 2);
    put("film_albedo", albedo), put("film_normal", normal), put("FilmCount", counts);
  }
  ~Bed() { CHECK(device.validation_messages() == 0); }

  bool wall(uint32_t x) const { return x < film.width() / 2; }

  template <class T>
  void put(const char* name, const std::vector<T>& values) {
    gpu::Resources table;
    film.bind(table);
    gpu::Buffer& to = const_cast<gpu::Buffer&>(*std::get<const gpu::Buffer*>(*table.find(name)));
    to.write(std::span<const T>(values));
  }

  /// The point in the scene at that pixel and depth.
  vec3 at(float x, float y, float depth) const {
    const vec2 ndc = 2.0f * vec2(x, y) / vec2(film.width(), film.height()) - 1.0f;
    const vec3 shift = ndc.x * frame.camera_right - ndc.y * frame.camera_up;
    return frame.projection == shared::k_projection_orthographic ? shift + depth * frame.camera_forward
                                                                 : depth * (frame.camera_forward + shift);
  }

  /// The picture of one colour with the drawing on it.
  template <class Draw>
  std::vector<uint32_t> picture(const Draw& draw) {
    put("Picture", std::vector<uint32_t>(canvas.at_film().pixels(), k_base));
    sheet.enlarge(wavefront.stream(), film);
    draw();
    std::vector<uint32_t> pixels(canvas.pixels());
    canvas.picture().read(pixels.data(), pixels.size() * 4);
    return pixels;
  }
  std::vector<uint32_t> drawn(const std::vector<OverlayPoint>& points,
                              const std::vector<OverlaySegment>& segments = {},
                              const std::vector<OverlayDisc>& discs = {}, const overlay::Style& style = {}) {
    return picture([&] { painter.draw(canvas, points, segments, discs, style); });
  }
};

uint32_t word(const glm::ivec3& bytes) {
  return uint32_t(bytes.x) | uint32_t(bytes.y) << 8 | uint32_t(bytes.z) << 16 | 0xff000000u;
}
vec3 bytes_of(uint32_t pixel) { return vec3(pixel & 0xffu, pixel >> 8 & 0xffu, pixel >> 16 & 0xffu); }
vec3 encoded(const glm::ivec3& bytes) { return vec3(bytes) / 255.0f; }
float farthest(uint32_t pixel, const vec3& bytes) {
  const vec3 d = glm::abs(bytes_of(pixel) - bytes);
  return std::max({d.x, d.y, d.z});
}
size_t changed(const std::vector<uint32_t>& picture) {
  return size_t(std::count_if(picture.begin(), picture.end(), [](uint32_t p) { return p != k_base; }));
}

/// A dot that covers exactly the pixel around it.
OverlayPoint dot(const vec3& position, const glm::ivec3& bytes, uint32_t rank = shared::k_rank_least) {
  return {position, 0.5f, encoded(bytes), 1, 0, rank};
}
OverlaySegment line(const vec3& from, const vec3& to, const glm::ivec3& bytes) {
  return {from, to, 0.5f, 0, encoded(bytes), 1, 1, 0, shared::k_rank_least};
}

}  // namespace

TEST_CASE(
    "points in front of a surface, and where there is none, are drawn in their colour; those behind are "
    "not") {
  for (const auto& [orthographic, aside] :
       {std::pair(false, vec2(0)), std::pair(true, vec2(0)), std::pair(false, vec2(1.5f, -0.75f))}) {
    Bed bed(48, 32, orthographic, 1, aside);
    std::vector<OverlayPoint> points;
    std::vector<uint32_t> expected(bed.canvas.pixels(), k_base);
    // Near and far alternately; the nearest ones behind the wall are within the tolerance of half a per cent
    // and two pixels.
    const float depths[] = {1, 3.9f, k_wall, 4.2f + 2 * 4.0f / 32, 9, -2};
    for (uint32_t y = 0; y < 32; ++y)
      for (uint32_t x = 0; x < 48; ++x) {
        const float depth = depths[(x + 5 * y) % 6];
        const glm::ivec3 ink(10 + 3 * x, 20 + 5 * y, 200);
        points.push_back(dot(bed.at(float(x) + 0.5f, float(y) + 0.5f, depth), ink));
        if (depth > 0 && (depth <= k_wall || !bed.wall(x))) expected[y * 48 + x] = word(ink);
      }
    std::shuffle(points.begin(), points.end(), std::mt19937(3));
    const std::vector<uint32_t> found = bed.drawn(points);
    CHECK(found == expected);
    CHECK(bed.drawn(points) == found);
  }
}

TEST_CASE("points have their size, their alpha and a dark edge") {
  Bed bed(48, 32);
  constexpr float k_half = 2.5f, k_edge = 1.5f, k_alpha = 0.8f, k_edge_alpha = 0.5f;
  const glm::ivec3 ink(250, 10, 90);
  const std::vector<uint32_t> found =
      bed.drawn({{bed.at(30.2f, 15.7f, 2), k_half, encoded(ink), k_alpha, k_edge, shared::k_rank_least}}, {},
                {}, {.edge_alpha = k_edge_alpha});
  size_t drawn = 0;
  for (uint32_t p = 0; p < found.size(); ++p) {
    const float away = distance(vec2(float(p % 48) + 0.5f, float(p / 48) + 0.5f), vec2(30.2f, 15.7f));
    const float core = std::clamp(k_half + 0.5f - away, 0.0f, 1.0f);
    const float edge = std::clamp(k_half + k_edge + 0.5f - away, 0.0f, 1.0f);
    const bool in = core > 0.2f;
    const float cover = in ? k_alpha * core : k_edge_alpha * edge;
    INFO(p % 48 << " " << p / 48);
    CHECK(farthest(found[p], glm::mix(bytes_of(k_base), in ? vec3(ink) : vec3(0), cover)) < 2);
    drawn += found[p] != k_base;
  }
  CHECK(drawn > 50);
}

TEST_CASE("each pixel shows the first unhidden point of the highest rank of a million in device memory") {
  Bed bed(96, 64);
  constexpr uint32_t k_count = 1'000'000;
  std::mt19937 random(7);
  std::vector<OverlayPoint> points;
  points.reserve(k_count);
  std::vector<uint32_t> expected(bed.canvas.pixels(), k_base), rank(bed.canvas.pixels(), 0);
  for (uint32_t i = 0; i < k_count; ++i) {
    const uint32_t x = random() % 96, y = random() % 64, pixel = y * 96 + x;
    const float depth = random() % 2 ? 3.0f : 6.0f;
    // Rare ranks are above common ones.
    uint32_t of = shared::k_rank_least;
    while (of < shared::k_rank_most && random() % 8 == 0) ++of;
    if (random() % 2 == 0) of = shared::k_rank_low;
    const glm::ivec3 ink(random() % 256, random() % 256, random() % 256);
    points.push_back(dot(bed.at(float(x) + 0.5f, float(y) + 0.5f, depth), ink, of));
    if ((depth > k_wall && bed.wall(x)) || of <= rank[pixel]) continue;
    rank[pixel] = of, expected[pixel] = word(ink);
  }
  gpu::Buffer buffer(bed.device, {.name = "points", .bytes = k_count * sizeof(OverlayPoint)});
  buffer.write(std::span<const OverlayPoint>(points));
  const auto draw = [&](uint32_t count) {
    return bed.picture([&] {
      bed.painter.draw(bed.canvas, {.points = {&buffer, count}, .segments = {}, .discs = {}});
    });
  };
  const std::vector<uint32_t> found = draw(k_count);
  size_t wrong = 0;
  for (size_t p = 0; p < found.size(); ++p) wrong += found[p] != expected[p];
  CHECK(wrong == 0);
  CHECK(changed(found) == found.size());
  CHECK(changed(draw(1)) <= 1);  // no more than requested
  CHECK_THAT(test::error_of([&] { draw(shared::k_most_strokes + 1); }), Catch::Contains("at most 4194304"));
}

TEST_CASE("segments are hidden from the point where they pass through a surface, and have their length") {
  Bed bed(64, 32);
  const glm::ivec3 ink(240, 130, 20);
  for (const bool upright : {false, true}) {
    // Along a row or a column of pixels of the wall, from in front of it to behind it.
    const vec2 a(4.5f, upright ? 2.5f : 20.5f), b(upright ? 4.5f : 28.5f, upright ? 26.5f : 20.5f);
    const float near = 2, far = 8;
    const std::vector<uint32_t> found =
        bed.drawn({}, {line(bed.at(a.x, a.y, near), bed.at(b.x, b.y, far), ink)});
    size_t shown = 0, hidden = 0;
    for (int k = -4; k < 30; ++k) {
      const float t = float(k) / 24, depth = 1 / ((1 - t) / near + t / far);
      const uint32_t x = upright ? 4 : uint32_t(4 + k), y = upright ? uint32_t(2 + k) : 20;
      if (x >= 64 || y >= 32 || std::abs(depth / (1.005f * k_wall) - 1) < 1e-4f) continue;
      const bool there = k >= 0 && k <= 24 && depth < 1.005f * k_wall;
      INFO(k);
      CHECK(found[y * 64 + x] == (there ? word(ink) : k_base));
      (there ? shown : hidden) += 1;
    }
    CHECK(shown == changed(found));
    CHECK(shown > 10);
    CHECK(hidden > 5);
    // Each segment has its own tolerance behind the surface.
    OverlaySegment loose = line(bed.at(a.x, a.y, near), bed.at(b.x, b.y, far), ink);
    loose.slack = 100;
    CHECK(changed(bed.drawn({}, {loose})) == 25);
    loose.strength = 0;
    CHECK(changed(bed.drawn({}, {loose})) == 0);
  }
}

TEST_CASE("segments cover the pixels near them, even if they pass beside, in front of or behind the camera") {
  Bed bed(90, 70);
  std::mt19937 random(11);
  const auto between = [&](float lo, float hi) {
    return std::uniform_real_distribution<float>(lo, hi)(random);
  };
  const vec3 ink = encoded({250, 220, 30});
  size_t drawn = 0;
  for (int round = 0; round < 120; ++round) {
    // In front of the wall.
    const bool behind = round % 4 == 3, outside = round % 3 == 2;
    const float m = outside ? 200.0f : 0.0f;
    const vec3 from = bed.at(between(-m, 90 + m), between(-m, 70 + m), between(0.5f, 3.9f));
    const vec3 to = behind ? vec3(between(-1, 1), between(-1, 1), between(0, 2))
                           : bed.at(between(-m, 90 + m), between(-m, 70 + m), between(0.5f, 3.9f));
    const float half = between(0.3f, 2.5f), edge = round % 2 ? 1.0f : 0.0f;
    const std::vector<uint32_t> found =
        bed.drawn({}, {{from, to, half, edge, ink, 0.9f, 0.8f, 0, shared::k_rank_least}});
    const auto project = [&](const glm::dvec3& x) {
      const double depth = -x.z;
      return glm::dvec2((0.5 + 0.5 * x.x / depth / double{bed.frame.camera_right.x}) * 90,
                        (0.5 - 0.5 * x.y / depth / double{bed.frame.camera_up.y}) * 70);
    };
    glm::dvec3 end(to);
    const double near = 1e-3 * -double{from.z};
    if (-end.z < near) end = glm::mix(end, glm::dvec3(from), (near + end.z) / (end.z - double{from.z}));
    const glm::dvec2 a = project(glm::dvec3(from)), b = project(end);
    size_t wrong = 0, whole = 0;
    for (uint32_t p = 0; p < found.size(); ++p) {
      const glm::dvec2 here(p % 90 + 0.5, p / 90 + 0.5);
      const double t = std::clamp(dot(here - a, b - a) / std::max(dot(b - a, b - a), 1e-12), 0.0, 1.0);
      const double away = distance(here, a + t * (b - a));
      const float core = float(std::clamp(half + 0.5 - away, 0.0, 1.0));
      const float dark = float(std::clamp(half + edge + 0.5 - away, 0.0, 1.0));
      const bool in = core > 0.2f || edge == 0;
      const float cover = 0.8f * (in ? 0.9f * core : 0.55f * dark);
      const vec3 expected = glm::mix(bytes_of(k_base), in ? 255.0f * ink : vec3(0), cover);
      // Far ends are rounded to float precision; ink and edge meet at a share of 0.2.
      wrong += farthest(found[p], expected) > 4 && std::abs(core - 0.2f) > 0.01f;
      whole += found[p] != k_base;
    }
    INFO("round " << round << ": " << a.x << ' ' << a.y << " to " << b.x << ' ' << b.y << ", " << whole);
    CHECK(wrong == 0);
    drawn += whole > 0;
  }
  CHECK(drawn > 60);
}

TEST_CASE("a segment across a wide picture, divided among invocations, has no gap") {
  Bed bed(2100, 8);
  const glm::ivec3 ink(5, 250, 120);
  const std::vector<uint32_t> found =
      bed.drawn({}, {line(bed.at(0.5f, 4.5f, 2), bed.at(2099.5f, 4.5f, 2), ink)});
  CHECK(changed(found) == 2100);
  for (uint32_t x = 0; x < 2100; ++x) REQUIRE(found[4 * 2100 + x] == word(ink));
}

TEST_CASE("discs: a rim on their surface, and none behind it, beside it or turned away") {
  Bed bed(128, 64);
  const glm::ivec3 ink(255, 60, 200);
  const float pixel = k_wall / 64;  // [m] on the wall
  const vec2 middle(24.5f, 32.5f);
  const auto disc = [&](float depth, const vec3& normal, float x = 24.5f) {
    return OverlayDisc{
        bed.at(x, middle.y, depth), 40 * pixel * depth / k_wall, normal, 0.4f, encoded(ink), 1, 0, 1,
        shared::k_rank_least};
  };
  const std::vector<uint32_t> found = bed.drawn({}, {}, {disc(k_wall, {0, 0, 1})});
  size_t rim = 0;
  for (uint32_t p = 0; p < found.size(); ++p) {
    const float away = distance(vec2(float(p % 128) + 0.5f, float(p / 128) + 0.5f), middle) - 40;
    const bool on = bed.wall(p % 128);
    INFO(p % 128 << ' ' << p / 128 << ": " << away);
    // Straight pieces are up to a fifth of a pixel inside.
    if (std::abs(away) > 1.2f || !on) CHECK(found[p] == k_base);
    if (std::abs(away + 0.1f) > 0.3f || !on) continue;
    CHECK(farthest(found[p], vec3(ink)) < 0.6f * farthest(k_base, vec3(ink)));
    ++rim;
  }
  CHECK(rim > 20);
  // It extends beyond the wall's border, where there is no surface and nothing is drawn.
  CHECK(changed(bed.drawn({}, {}, {disc(k_wall, {0, 0, 1}, 60)})) > 20);
  CHECK(changed(bed.drawn({}, {}, {disc(k_wall, {0, 0, 1}, 110)})) == 0);
  CHECK(changed(bed.drawn({}, {}, {disc(1.3f * k_wall, {0, 0, 1})})) == 0);
  CHECK(changed(bed.drawn({}, {}, {disc(0.6f * k_wall, {0, 0, 1})})) == 0);
  CHECK(changed(bed.drawn({}, {}, {disc(k_wall, {1, 0, 0})})) == 0);
  CHECK(changed(bed.drawn({}, {}, {disc(k_wall, {0, 0, -1})})) == 0);
  // Small ones fade.
  OverlayDisc small = disc(k_wall, {0, 0, 1});
  small.radius = 3.5f * pixel;
  CHECK(changed(bed.drawn({}, {}, {small})) == 0);
}

TEST_CASE("of points, segments and discs at one pixel the highest rank is shown, then the first one") {
  Bed bed(128, 64);
  const glm::ivec3 red(250, 0, 0), green(0, 250, 0), blue(0, 0, 250);
  const float pixel = k_wall / 64;
  // They meet at (64 - 40, 32).
  const vec3 place = bed.at(24.5f, 32.5f, 3.99f);
  OverlayPoint point = dot(place, red);
  OverlaySegment segment = line(bed.at(24.5f, 2.5f, 3.99f), bed.at(24.5f, 62.5f, 3.99f), green);
  OverlayDisc disc{bed.at(64.5f, 32.5f, k_wall), 40 * pixel, {0, 0, 1}, 1.5f, encoded(blue), 1, 0, 1,
                   shared::k_rank_least};
  const auto seen = [&] { return bed.drawn({point}, {segment}, {disc})[32 * 128 + 24]; };
  CHECK(seen() == word(red));
  segment.rank = shared::k_rank_least + 1;
  CHECK(seen() == word(green));
  disc.rank = shared::k_rank_most;
  CHECK(seen() == word(blue));
  point.rank = segment.rank = disc.rank = shared::k_rank_low;
  CHECK(seen() == word(red));
  point.half_width = 0, point.edge_width = 3;  // an edge is below all but the lowest
  CHECK(bytes_of(seen()).x < 0x60);
  segment.rank = shared::k_rank_least;
  CHECK(seen() == word(green));
}

TEST_CASE("empty marks, and marks outside the picture or at invalid positions, draw nothing") {
  Bed bed(40, 24);
  CHECK(changed(bed.drawn({})) == 0);
  CHECK(changed(bed.picture([&] { bed.painter.draw(bed.canvas, overlay::Drawing{}); })) == 0);
  std::vector<OverlayPoint> points;
  std::vector<OverlaySegment> segments;
  std::vector<OverlayDisc> discs;
  std::vector<vec3> away{vec3(NAN), vec3(INFINITY, 0, -1), vec3(0, 0, -INFINITY), vec3(0, 0, 3), vec3(0)};
  for (const vec2& p :
       {vec2(-5, 12), vec2(45, 12), vec2(20, -5), vec2(20, 29), vec2(-1e9f, 3), vec2(3, 1e9f)})
    away.push_back(bed.at(p.x, p.y, 2));
  for (const vec3& x : away) {
    points.push_back({x, 2, vec3(1), 1, 1, shared::k_rank_most});
    segments.push_back({x, x, 2, 1, vec3(1), 1, 1, 1, shared::k_rank_most});
    discs.push_back({x, 0.01f, {0, 0, 1}, 2, vec3(1), 1, 1, 1, shared::k_rank_most});
  }
  const std::vector<uint32_t> found = bed.drawn(points, segments, discs);
  CHECK(changed(found) == 0);

  // The whole picture is dimmed, and marks keep their brightness.
  const std::vector<uint32_t> dim =
      bed.drawn({dot(bed.at(8.5f, 9.5f, 2), {200, 100, 0})}, {}, {}, {.dimmed = true});
  const vec3 base = bytes_of(k_base);
  const vec3 expected = 0.6f * glm::mix(base, vec3(dot(base, vec3(0.2126f, 0.7152f, 0.0722f))), 0.6f);
  for (uint32_t p = 0; p < dim.size(); ++p)
    if (p == 9 * 40 + 8)
      CHECK(dim[p] == word({200, 100, 0}));
    else
      CHECK(farthest(dim[p], expected) <= 1);
}

TEST_CASE(
    "on a sheet of larger scale strokes are as wide in pixels of the sheet, and the picture is enlarged") {
  constexpr uint32_t k_scale = 4, k_across = 48 * k_scale;
  for (const bool orthographic : {false, true}) {
    Bed bed(48, 32, orthographic, k_scale);
    const auto at = [&](uint32_t x, uint32_t y, float depth) {
      return bed.at((float(x) + 0.5f) / k_scale, (float(y) + 0.5f) / k_scale, depth);
    };
    std::vector<OverlayPoint> points;
    std::vector<uint32_t> expected(bed.canvas.pixels(), k_base);
    // Every third pixel of the sheet: before the wall, behind it, beside it.
    for (uint32_t y = 1; y < 32 * k_scale; y += 3)
      for (uint32_t x = 1; x < k_across; x += 3) {
        const float depth = (x + y) % 2 ? 3.5f : 9;
        const glm::ivec3 ink(10 + x, 20 + y, 200);
        points.push_back(dot(at(x, y, depth), ink));
        if (depth < k_wall || !bed.wall(x / k_scale)) expected[y * k_across + x] = word(ink);
      }
    CHECK(bed.drawn(points) == expected);
  }
}

}  // namespace overlay_tests
