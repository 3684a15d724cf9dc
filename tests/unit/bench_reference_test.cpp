// links: bench
// The two halves of a reference, each a reference itself.
#include "bench/reference.h"

#include <catch2/catch.hpp>

namespace bench_reference_tests {

using namespace lucerna;
using Catch::Contains;

namespace {

/// Two pixels of one component: the even samples of the first are 3, 1, its odd one is 8.
film::Image image() {
  film::Image i{.width = 2, .height = 1};
  for (const int c : k_components) {
    i.components[size_t(c)].assign(2, vec3(0));
    i.odd_half[size_t(c)].assign(2, vec3(0));
  }
  i.components[1] = {vec3(4, 0, 0), vec3(2.5f)};
  i.odd_half[1] = {vec3(8, 0, 0), vec3(1)};
  i.components[2] = {vec3(0, 1, 0), vec3(0)};
  i.odd_half[2] = {vec3(0, 3, 0), vec3(0)};
  i.samples = {3, 4};
  return i;
}

film::FilmImage picture() {
  film::FilmImage p{.width = 2, .height = 1};
  p.channels = {{"R", {4, 2.5f}}, {"G", {1, 2.5f}}, {"B", {0, 2.5f}}, {"samples", {3, 4}}};
  return p;
}

std::string error_of(const film::FilmImage& p) {
  try {
    bench::read_halves(p, "a.exr");
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("Either half of a reference is the mean of its own samples") {
  film::FilmImage p = picture();
  bench::add_odd_half(p, image());
  const film::ReferencePair halves = bench::read_halves(p, "a.exr");
  CHECK(halves.width == 2);
  CHECK(halves.first == std::vector<vec3>{vec3(8, 3, 0), vec3(1)});
  CHECK(halves.second == std::vector<vec3>{vec3(2, 0, 0), vec3(4)});
}

TEST_CASE("A picture without halves is no reference") {
  film::FilmImage p = picture();
  CHECK_THAT(error_of(p), Contains("a.exr: no channel 'odd.R'"));
  bench::add_odd_half(p, image());
  CHECK(error_of(p).empty());
  p.channels[3].second[1] = 1;
  CHECK_THAT(error_of(p), Contains("pixel 1 has 1 samples"));
  p.channels.erase(p.channels.begin() + 3);
  CHECK_THAT(error_of(p), Contains("'samples'"));
}

}  // namespace bench_reference_tests
