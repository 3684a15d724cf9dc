// links: recording film_io
// Recorded paths of a batch render, and the search in them.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "film/io/image_file.h"
#include "recording/file.h"
#include "support/folder.h"
#include "support/run.h"

namespace paths_tests {

namespace fs = std::filesystem;
using namespace lucerna;
using Catch::Contains;
using test::run;
using test::Run;

namespace {

const std::string k_ring = std::string("'") + LUCERNA_SOURCE_DIR + "/scenes/ring/ring.gltf'";

Run render(const std::string& more) {
  return run("render " + k_ring +
             " --size 16x16 --samples 4 --quiet --device cpu --set lights.sampling=power --set "
             "components.caustic=path " +
             more);
}

size_t lines(const std::string& text) { return size_t(std::count(text.begin(), text.end(), '\n')); }

}  // namespace

TEST_CASE("a render records its paths, and changes no pixel; the search finds them") {
  const test::Folder f;
  const std::string at = f.path.string() + "/";
  REQUIRE(render("-o " + at + "plain.exr").status == 0);
  const Run r = render("--record-paths " + at + "all.lpath --record-every 1 -o " + at + "recorded.exr");
  INFO(r.out);
  REQUIRE(r.status == 0);
  const film::FilmImage plain = film::read_exr(f / "plain.exr"),
                        recorded = film::read_exr(f / "recorded.exr");
  for (const char* channel : {"R", "caustic.G"}) CHECK(*plain.find(channel) == *recorded.find(channel));

  // The light of all paths is that of the picture.
  recording::Reader reader(f / "all.lpath");
  CHECK(reader.header().at("samples") == 4);
  double light = 0, film = 0;
  size_t paths = 0;
  while (const auto chunk = reader.next()) {
    paths += chunk->paths.size();
    for (const recording::Path& path : chunk->paths)
      light += recording::luminance_of(chunk->events_of(path)) / 4;
  }
  CHECK(paths == 16 * 16 * 4);
  for (size_t i = 0; i < 256; ++i)
    film += double(luminance(vec3((*plain.find("R"))[i], (*plain.find("G"))[i], (*plain.find("B"))[i])));
  CHECK(light == Approx(film).epsilon(2e-3));  // the EXR has 16-bit floats at most

  const auto search = [&](const std::string& more) { return run("paths " + at + "all.lpath " + more); };
  const Run words = search("--group-by component --json");
  REQUIRE(words.status == 0);
  const auto sums = nlohmann::json::parse(words.out);
  double sum = 0;
  for (const auto& s : sums) sum += s.at("light").get<double>() / 4;
  CHECK(sum == Approx(light));
  const Run caustics = search("--where \"component == caustic and word ~ 'E[SG]*D[SG]+L'\" --csv");
  CHECK(caustics.status == 0);
  CHECK_THAT(caustics.out, Catch::StartsWith("x,y,sample,component,event,word,"));
  const Run all = search("--where 'component == caustic' --csv");
  CHECK(lines(caustics.out) > 1);
  CHECK(lines(all.out) == lines(caustics.out));
  CHECK_THAT(search("--most 3").out, Contains(" paths\n") && Contains("contribution"));
  CHECK(lines(search("--most 3").out) == 5);

  // A search in a part of the scene reads that part only; its rows and shares are those of all.
  const Run here = search("--where 'lit_x > -0.1 and lit_x < 0.1' --csv");
  CHECK(here.status == 0);
  CHECK(here.out == search("--where 'not (lit_x <= -0.1 or lit_x >= 0.1)' --csv").out);
  CHECK(lines(here.out) > 1);
  CHECK(lines(here.out) < lines(search("--csv").out));
  const auto end_of = [](const Run& r) { return r.out.substr(r.out.rfind(" rows, ")); };
  CHECK(end_of(search("--where 'lit_x > -0.1 and lit_x < 0.1' --group-by component")) ==
        end_of(search("--where 'not (lit_x <= -0.1 or lit_x >= 0.1)' --group-by component")));

  CHECK_THAT(search("--where 'colour == 1'").out, Contains("--where: position 1: expected a field"));
  CHECK_THAT(search("--group-by colour").out, Contains("--group-by: 'colour': expected one of component"));
  CHECK(search("--csv --json").status == 1);
  std::ofstream(f / "cut.lpath", std::ios::binary)
      << std::ifstream(f / "all.lpath", std::ios::binary).rdbuf();
  fs::resize_file(f / "cut.lpath", fs::file_size(f / "cut.lpath") - 100);
  const Run cut = run("paths " + at + "cut.lpath");
  CHECK(cut.status == 1);
  CHECK_THAT(cut.out, Contains("cut.lpath: byte ") && Contains("cut"));
}

TEST_CASE("recording is limited to every n-th path, a region, or bright paths") {
  const test::Folder f;
  const std::string at = f.path.string() + "/";
  REQUIRE(
      render("--record-paths " + at + "a.lpath --record-every 3 --record-region 4 8 100 2 --record-over 0.01")
          .status == 0);
  recording::Reader reader(f / "a.lpath");
  size_t paths = 0;
  while (const auto chunk = reader.next())
    for (const recording::Path& path : chunk->paths) {
      const uint32_t x = path.pixel % 16, y = path.pixel / 16;
      CHECK((x >= 4 && (y == 8 || y == 9)));
      CHECK((((y - 8) * 12 + x - 4) * 4 + path.sample) % 3 == 0);
      CHECK(recording::luminance_of(chunk->events_of(path)) > 0.01);
      ++paths;
    }
  CHECK(paths > 0);
  CHECK_THAT(render("--record-paths " + at + "b.exr").out, Contains("need the ending .lpath"));
  CHECK_THAT(render("--record-paths " + at + "b.lpath --record-region 16 0 1 1").out,
             Contains("--record-region: no pixel of the picture of 16x16"));
  CHECK_THAT(render("--record-over 1 -o " + at + "b.exr").out, Contains("--record-paths: name the file"));
  CHECK_FALSE(fs::exists(f / "b.lpath"));
}

}  // namespace paths_tests
