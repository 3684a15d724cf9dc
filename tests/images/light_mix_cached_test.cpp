// links: session
// Per-group light of records (relight.enabled=compact): the unmixed picture equals, bit for bit, the one
// without groups; a mix equals records made in that light, within the records' error, whatever happens to the
// records in between.
#include <catch2/catch.hpp>

#include "images/light_mix_support.h"
#include "support/folder.h"
#include "support/records.h"

namespace light_mix_cached_tests {

using namespace lucerna;
using namespace lucerna::test;

namespace {

/// Radii from distances alone, so records lie at the same positions in any light.
Settings cached(Settings more = {}) {
  const Settings all{{"components.secondary", "cache"}, {"components.tertiary", "cache"},
                     {"cache.metric", "split-sphere"},  {"cache.noise", "1"},
                     {"relight.enabled", "compact"},    {"path.batch", "8192"}};
  more.insert(all.begin(), all.end());
  return more;
}

/// Difference of the 8x8 blocks of two pictures relative to the second's mean: root mean square, and of the
/// whole picture.
struct Off {
  double blocks = 0, mean = 0;
};
Off off(const film::Image& a, const film::Image& b) {
  const std::vector<vec3> p = all_components(a), q = all_components(b);
  double squares = 0, sum = 0, all = 0;
  size_t count = 0;
  for (uint32_t v = 0; v < b.height; v += 8)
    for (uint32_t u = 0; u < b.width; u += 8, ++count) {
      double d = 0, y = 0;
      for (uint32_t i = 0; i < 64; ++i) {
        const size_t at = (v + i / 8) * b.width + u + i % 8;
        d += luminance(p[at]) - luminance(q[at]), y += luminance(q[at]);
      }
      squares += d * d, sum += d, all += y;
    }
  return {std::sqrt(squares / double(count)) / (all / double(count)), sum / all};
}

const irradiance_cache::Records& records(const session::Renderer& r) { return test::cache(r)->records(); }

}  // namespace

TEST_CASE("records with light groups have the same light, and give the same picture, as records without") {
  const scene::Scene even = block_room(true);  // no sun, which would be a separate light
  Bench separate(even, cached()), together(even, cached({{"relight.enabled", "off"}}));
  const film::Image a = separate.image(), b = together.image();
  CHECK(separate.r.relight().separate);
  CHECK(separate.r.film().is_compact());
  CHECK(identical(a, b));
  CHECK(separate.r.stats().rays == together.r.stats().rays);
  const uint32_t count = records(separate.r).size();
  REQUIRE(count > 50);
  CHECK(count == records(together.r).size());
  CHECK(records(together.r).raw(count).groups.empty());
  CHECK(records(separate.r).raw(count).groups.size() == count);
  CHECK(separate.r.device().validation_messages() == 0);
}

TEST_CASE("a mix of records' light equals the mix of path-traced light within the records' error") {
  // The same samples, so direct light is identical.
  Bench b(room(), cached({{"cache.rays", "256"}, {"cache.max_rays", "1024"}, {"cache.noise", "0.02"}}), 256),
      traced(room(), {{"relight.enabled", "compact"}}, 256);
  b.image(), traced.image();
  const uint64_t rays = b.r.stats().rays;
  const auto both = [&](const char* text) {
    b.mix(text), traced.mix(text);
    return off(b.r.image(), traced.r.image());
  };
  const Off as_it_is = both("");
  CHECK(as_it_is.blocks < 0.03);
  for (const char* text :
       {"sky: mute", "lamp: solo factor=10000", "block: solo", "sun: solo", "sky: solo factor=0.0001",
        "spot: solo color=0.1,1,0.2", "sky: color=1,0.2,0.1; lamp: kelvin=9000 ev=1.3"}) {
    const Off o = both(text);
    INFO(text << ": " << o.blocks << " of blocks, " << o.mean << " of the mean");
    // A group that contributes a hundredth of the light gets few of the records' rays.
    CHECK(o.blocks < 0.1);
    CHECK(std::abs(o.mean) < 0.02);
  }
  CHECK(b.r.stats().rays == rays);
}

TEST_CASE("records' groups follow settings and light edits") {
  const scene::Scene s = room();
  const char* const mix = "spot: ev=3; sky: mute";
  const auto fresh = [&](const scene::Scene& of, Settings more) {
    more["relight.mix"] = mix;
    return Bench(of, cached(std::move(more))).image();
  };
  Bench b(s, cached({{"relight.enabled", "off"}}));
  b.image();
  // Groups are tracked from now on: records keep their positions and gather again.
  set(b.r, {{"relight.enabled", "compact"}, {"relight.mix", mix}});
  CHECK(identical(b.image(), fresh(s, {})));
  // Lights change groups; the groups' names and number stay.
  const Settings regrouped{{"relight.groups", "spot=block; block=spot"}};
  set(b.r, regrouped);
  const film::Image other = b.image();
  CHECK(identical(other, fresh(s, regrouped)));
  // A lamp moves.
  scene::Scene moved = s;
  moved.lights[0].position.x += 0.5f;
  b.r.set_light(0, moved.lights[0]);
  CHECK(identical(b.image(), fresh(moved, regrouped)));
  CHECK(b.r.device().validation_messages() == 0);
}

TEST_CASE("a saved cache keeps its light groups and is relit for other groups") {
  const Folder folder;
  const scene::Scene s = room();
  Bench b(s, cached({{"relight.mix", "spot: ev=3; sky: mute"}}));
  const film::Image image = b.image();
  b.r.solvers().save("cache", folder / "a.cache");
  const uint64_t gathered = test::cache(b.r)->status().rays;
  for (const char* groups : {"", "spot=block; block=spot"}) {
    INFO(groups);
    Bench other(s, cached({{"relight.mix", "spot: ev=3; sky: mute"}, {"relight.groups", groups}}));
    other.r.solver_load("cache", folder / "a.cache");
    const film::Image again = other.image();
    if (*groups == 0) CHECK(identical(again, image));
    // Loaded records count too; relit ones have gathered again.
    CHECK(test::cache(other.r)->status().rays == gathered);
    CHECK(test::cache(other.r)->status().records == test::cache(b.r)->status().records);
    if (*groups != 0) CHECK(off(again, image).blocks > 0.02);  // the block is brighter, not the spot
  }
}

TEST_CASE("reported record errors are those of the mixed light") {
  const scene::Scene s = room();
  Bench b(s, cached(), 16);
  b.image();
  const film::ImageError as_it_is = b.r.image_error();
  REQUIRE(as_it_is.lookup_noise_rms > 0);
  // The same factor for all light scales all errors and the blocks' sums of them.
  const std::vector<film::TileError> before = b.r.progress().tile_errors();
  b.mix("sky: ev=2; sun: ev=2; lamp: ev=2; spot: ev=2; block: ev=2");
  const film::ImageError brighter = b.r.image_error();
  CHECK(brighter.luminance[0] == Approx(4 * as_it_is.luminance[0]).epsilon(1e-3));
  CHECK(brighter.lookup_noise_rms == Approx(4 * as_it_is.lookup_noise_rms).epsilon(1e-3));
  CHECK(brighter.relative_lookup_noise() == Approx(as_it_is.relative_lookup_noise()).epsilon(1e-3));
  const std::vector<film::TileError> after = b.r.progress().tile_errors();
  for (size_t t = 0; t < before.size(); ++t)
    CHECK(after[t].lookups.noise == Approx(4 * before[t].lookups.noise).epsilon(1e-3));
  // Without light there is no error.
  b.mix("sky: mute; sun: mute; lamp: mute; spot: mute; block: mute");
  CHECK(b.r.image_error().lookup_noise_rms == 0);
}

}  // namespace light_mix_cached_tests
