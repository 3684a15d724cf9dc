// links: irradiance_cache film
// Propagation of records' errors into the picture: the kernels compared with the same sums on the host, for a
// few records with known errors, and the resulting errors of tiles.
#include <cmath>

#include "film/error.h"
#include "kernels/cache_records_support.h"

namespace cache_error_propagation_tests {

using namespace lucerna;
using shared::BlockLookups;
using shared::k_lookup_lanes;

namespace {

/// As in shaders/irradiance_cache/error_propagation.glsl.
double sign_of(uint32_t record, uint32_t lane) {
  uint32_t x = record + 0x9e3779b9u;
  x = (x ^ x >> 16) * 0x7feb352du;
  x = (x ^ x >> 15) * 0x846ca68bu;
  x ^= x >> 16;
  return x >> lane & 1 ? -1 : 1;
}

/// A grey throughput: a power of 2, which eight bits represent exactly.
uint32_t packed(double power_of_2) {
  return 0x00ffffffu | uint32_t(127 + std::lround(std::log2(power_of_2))) << 24;
}

/// On the floor, facing up; radius one metre.
test::RecordDisc disc(float x, float light, float error) {
  test::RecordDisc d{.place = {}, .radius = 1};
  d.place.position = vec3(x, 0, 0), d.place.normal = vec3(0, 1, 0);
  d.light = vec3(light), d.error = error;
  return d;
}

struct Note {
  float x = 0;
  double throughput = 0;  ///< 0: none
};

/// The kernels' result for paths that read records; `notes` by path and pixel of a picture of 16 x 8.
struct ErrorSums {
  std::vector<vec2> pixels;
  std::vector<BlockLookups> blocks;
  std::vector<vec4> residuals;  ///< by record, k_residual_texels each
};
ErrorSums propagate(test::RecordBed& bed, const std::vector<test::RecordDisc>& discs,
                    const std::array<std::vector<Note>, 2>& notes,
                    const std::array<std::vector<Note>, 2>& beyond, uint32_t step = 1) {
  constexpr uint32_t k_width = 16, k_height = 8;
  const uint32_t blocks = 2 / step / step + (step == 2), pixels = 64 * blocks;
  gpu::Kernel leave(bed.device, bed.compiler, "irradiance_cache/leave_one_out.comp",
                    {{"LUCERNA_CACHE_PARTS", "14"}, {"LUCERNA_CACHE_ELLIPSES", "1"}});
  gpu::Kernel propagating(bed.device, bed.compiler, "irradiance_cache/propagate_errors.comp",
                          {{"LUCERNA_CACHE_PARTS", "14"}, {"LUCERNA_CACHE_ELLIPSES", "1"}});
  const auto texels = [&](const std::array<std::vector<Note>, 2>& of) {
    std::vector<vec4> all(size_t{2} * pixels * shared::k_candidate_texels, vec4(0));
    for (size_t path = 0; path < 2; ++path)
      for (size_t i = 0; i < of[path].size(); ++i)
        if (const Note& n = of[path][i]; n.throughput > 0) {
          vec4* const to = &all[(path * pixels + i) * shared::k_candidate_texels];
          to[0] = vec4(n.x, 0, 0, std::bit_cast<float>(1u));
          to[1] = vec4(0, 1, 0, std::bit_cast<float>(packed(n.throughput)));
        }
    gpu::Buffer buffer(bed.device, {.name = "notes", .bytes = all.size() * sizeof(vec4), .texel = true});
    buffer.write(std::span<const vec4>(all));
    return buffer;
  };
  const gpu::Buffer first = texels(notes), then = texels(beyond);
  gpu::Buffer residuals(
      bed.device,
      {.name = "residuals", .bytes = discs.size() * shared::k_residual_texels * sizeof(vec4), .texel = true});
  film::Film film(bed.device, k_width, k_height);
  film.clear(bed.stream);
  film.make_room_for_lookup_errors();
  gpu::Buffer work(bed.device, {.name = "blocks", .bytes = blocks * sizeof(shared::WorkBlock)});
  std::vector<shared::WorkBlock> list;
  for (uint32_t b = 0; b < blocks; ++b) list.push_back({b, 0});
  work.write(std::span<const shared::WorkBlock>(list));
  shared::CacheFrame frame{};
  std::fill(std::begin(frame.routes), std::end(frame.routes), shared::k_no_routes);
  frame.routes[0] = 0x4414;  // the secondary part to the secondary component
  frame.normal_tolerance = 0.06f, frame.off_plane = 1, frame.off_plane_least = 1;
  ErrorSums out;
  bed.change(discs, 0, frame, [&](const auto& bind) {
    gpu::Resources r;
    bind(r);
    film.bind(r);
    r.set("Residuals", residuals);
    r.set("residual_texels", residuals);
    r.set("candidate_texels", first);
    r.set("beyond_texels", then);
    r.set("WorkBlocks", work);
    const auto count = uint32_t(discs.size());
    bed.stream.dispatch(leave, r, shared::PoolPush{0, count}, gpu::groups_for(count, 64));
    bed.stream.dispatch(propagating, r,
                        shared::PropagatePush{k_width, k_height, step, pixels, !beyond[0].empty()}, blocks);
    bed.stream.run();
    film.complete_lookup_errors();
    out.blocks.assign(film.lookup_errors().begin(), film.lookup_errors().end());
    const gpu::Resources::Entry* kept = r.find("FilmLookups");
    out.pixels = std::get<const gpu::Buffer*>(*kept)->read_all<vec2>();
    out.residuals = residuals.read_all<vec4>();
  });
  return out;
}

/// Weight of the right one of two discs of one metre at 0 and 1, for x between them.
double share_of_right(double x) { return x; }

}  // namespace

TEST_CASE("a record's error reaches the pixels that read it, with its weight there") {
  test::RecordBed bed;
  const std::vector<test::RecordDisc> discs{disc(0, 2, 0.5f), disc(1, 4, 0.25f)};
  // All pixels read at x = 1/4 with a throughput of 1/2; half of the second block reads nothing.
  std::vector<Note> notes(128, Note{0.25f, 0.5});
  for (size_t i = 96; i < 128; ++i) notes[i] = {};
  const ErrorSums got = propagate(bed, discs, {notes, notes}, {});
  const double right = share_of_right(0.25), a = 0.5 * (1 - right) * 0.5, b = 0.5 * right * 0.25;
  double variance = 0;
  for (uint32_t k = 0; k < k_lookup_lanes; ++k)
    variance += std::pow(a * sign_of(0, k) + b * sign_of(1, k), 2) / k_lookup_lanes;
  CHECK(variance == Approx(a * a + b * b).margin(2 * a * b));
  // The pixels of a block are in Morton order: the lower half of the second block reads nothing.
  for (uint32_t y = 0; y < 8; ++y)
    for (uint32_t x = 0; x < 16; ++x) {
      INFO(x << ' ' << y);
      CHECK(got.pixels[y * 16 + x].x == Approx(x >= 8 && y >= 4 ? 0 : variance).epsilon(1e-4));
    }
  for (uint32_t lane = 0; lane < k_lookup_lanes; ++lane)
    for (uint32_t path = 0; path < 2; ++path) {
      const double each = a * sign_of(0, lane) + b * sign_of(1, lane);
      CHECK(got.blocks[0].noise[path * k_lookup_lanes + lane] == Approx(64 * each).epsilon(1e-4));
      CHECK(got.blocks[1].noise[path * k_lookup_lanes + lane] == Approx(32 * each).epsilon(1e-4));
    }
  CHECK(got.blocks[0].pixels == 64);
  // Pixels that read the same records have the same error: a tile of 64 has the error of one of them.
  const film::LookupsError one = film::lookups_error({got.blocks.data(), 1});
  CHECK(one.noise == Approx(std::sqrt(variance)).epsilon(1e-4));
  const film::LookupsError both = film::lookups_error(got.blocks);
  CHECK(both.noise == Approx(0.75 * std::sqrt(variance)).epsilon(1e-4));
  CHECK(both.degrees == k_lookup_lanes);
  // A second run is identical bit for bit.
  const ErrorSums again = propagate(bed, discs, {notes, notes}, {});
  CHECK(std::memcmp(again.blocks.data(), got.blocks.data(), got.blocks.size() * sizeof(BlockLookups)) == 0);
  CHECK(again.pixels == got.pixels);
}

TEST_CASE("pixels that read different records have independent errors") {
  test::RecordBed bed;
  // 64 separate records in a row; each pixel of the first block reads its own.
  std::vector<test::RecordDisc> discs;
  std::vector<Note> notes(128);
  for (uint32_t i = 0; i < 64; ++i)
    discs.push_back(disc(4.0f * float(i), 1, 0.5f)), notes[i] = {4.0f * float(i), 1};
  const ErrorSums got = propagate(bed, discs, {notes, notes}, {});
  CHECK(got.pixels[0].x == Approx(0.25));
  // 16 lanes estimate a variance to a third.
  const film::LookupsError tile = film::lookups_error({got.blocks.data(), 1});
  CHECK(tile.noise > 0.5 / 8 * 0.5);
  CHECK(tile.noise < 0.5 / 8 * 1.5);
}

TEST_CASE("the paths' own noise is not counted as the records' error") {
  test::RecordBed bed;
  // One path of a pixel reads one record, the other path another of the same noise: the mean contains half of
  // each, and the product measures only what they share, which is nothing.
  const std::vector<test::RecordDisc> discs{disc(0, 1, 0.5f), disc(8, 1, 0.5f)};
  const std::vector<Note> one(128, Note{0, 1}), other(128, Note{8, 1});
  const ErrorSums got = propagate(bed, discs, {one, other}, {});
  double product = 0;
  for (uint32_t k = 0; k < k_lookup_lanes; ++k)
    product += 0.25 * sign_of(0, k) * sign_of(1, k) / k_lookup_lanes;
  CHECK(got.pixels[0].x == Approx(product).margin(1e-6));
  CHECK(std::abs(product) < 0.25);
}

TEST_CASE("light that records read from records counts like light that the picture reads") {
  test::RecordBed bed;
  const std::vector<test::RecordDisc> discs{disc(0, 1, 0.5f), disc(8, 1, 1)};
  const std::vector<Note> first(128, Note{0, 1}), beyond(128, Note{8, 0.25});
  const ErrorSums got = propagate(bed, discs, {first, first}, {beyond, beyond});
  double variance = 0;
  for (uint32_t k = 0; k < k_lookup_lanes; ++k)
    variance += std::pow(0.5 * sign_of(0, k) + 0.25 * sign_of(1, k), 2) / k_lookup_lanes;
  CHECK(got.pixels[0].x == Approx(variance).epsilon(1e-4));
}

TEST_CASE("one pixel can stand for several of the film") {
  test::RecordBed bed;
  const std::vector<test::RecordDisc> discs{disc(0, 1, 0.5f)};
  const std::vector<Note> notes(64, Note{0, 1});
  const ErrorSums got = propagate(bed, discs, {notes, notes}, {}, 2);
  for (const vec2& p : got.pixels) CHECK(p.x == Approx(0.25));
  for (const BlockLookups& b : got.blocks) CHECK(b.pixels == 16);
  CHECK(film::lookups_error(got.blocks).noise == Approx(0.5));
}

TEST_CASE("interpolation error: the residual of neighbouring records without their noise") {
  test::RecordBed bed;
  // Curved light, 4 + x^2, stored without gradients by records without noise.
  std::vector<test::RecordDisc> discs;
  constexpr float k_apart = 0.75f;
  for (int i = 0; i < 16; ++i) {
    const float x = k_apart * float(i - 8);
    discs.push_back(disc(x, 4 + x * x, 0));
  }
  const std::vector<Note> notes(128, Note{0, 1});
  const ErrorSums calm = propagate(bed, discs, {notes, notes}, {});
  CHECK(calm.residuals[8 * shared::k_residual_texels].x == Approx(1.0 / 4).epsilon(1e-3));
  // Read at 0, where the light is 4: one record with weight 1, two with 1 - 0.75.
  const double read = (4 + 2 * 0.25 * (4 + k_apart * k_apart)) / 1.5;
  CHECK(calm.pixels[0].y == Approx(std::pow(read - 4, 2)).epsilon(1e-3));
  CHECK(film::lookups_error(calm.blocks).interpolation == Approx(read - 4).epsilon(1e-3));
  // Constant light from noisy records has no interpolation error: only the records' noise is reported.
  for (size_t i = 0; i < discs.size(); ++i)
    discs[i].light = vec3(float(4 + 0.5 * sign_of(uint32_t(i), 3))), discs[i].error = 0.5f;
  const ErrorSums noisy = propagate(bed, discs, {notes, notes}, {});
  const film::LookupsError error = film::lookups_error(noisy.blocks);
  CHECK(error.noise > 0.3);
  CHECK(error.interpolation < 2 * error.noise);
}

}  // namespace cache_error_propagation_tests
