// links: film_io
// Outputs of a batch render: all are written even if one fails, under any name, into links and pipes.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "film/io/image_file.h"
#include "support/folder.h"
#include "support/ocio.h"
#include "support/run.h"
#include "support/tev_receiver.h"

namespace outputs_tests {

namespace fs = std::filesystem;
using namespace lucerna;
using Catch::Contains;
using test::run;
using test::Run;

namespace {

const std::string k_cornell = std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/";

/// A render of a tiny picture with more arguments.
Run render(const std::string& more, const std::string& scene = k_cornell + "cornell.gltf") {
  return run("render '" + scene + "' --size 16x16 --samples 2 --quiet " + more);
}

std::string read_text(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("a failing output does not prevent the others from being written") {
  const test::Folder f;
  const std::string at = f.path.string() + "/";
  for (const char* name : {"full.exr", "full.csv", "full.cache"}) fs::create_symlink("/dev/full", f / name);
  const Run r = render("--set components.secondary=cache --set cache.error=0.5 -o " + at + "full.exr -o " +
                       at + "a.png -o " + at + "a.exr --ledger " + at + "full.csv --stats " + at +
                       "a.json --cache-save " + at + "full.cache");
  INFO(r.out);
  CHECK(r.status == 1);
  for (const char* name : {"full.exr", "full.csv", "full.cache"}) {
    CHECK_THAT(r.out, Contains(at + name + ": cannot be written: No space left on device"));
    CHECK(fs::is_symlink(f / name));
  }
  CHECK(fs::is_character_file("/dev/full"));
  CHECK(film::read_exr(f / "a.exr").width == 16);
  CHECK(film::read_exr(f / "a.png").width == 16);
  CHECK(nlohmann::json::parse(read_text(f / "a.json")).contains("settings"));
}

TEST_CASE("two outputs with the same target are refused, however they are named") {
  const test::Folder f;
  const std::string at = f.path.string() + "/";
  fs::create_symlink("a.exr", f / "b.exr");
  for (const std::string& other :
       {at + "a.exr", at + "../" + f.path.filename().string() + "/a.exr", at + "b.exr"}) {
    const Run r = render("-o " + at + "a.exr -o " + other);
    INFO(r.out);
    CHECK(r.status == 1);
    CHECK_THAT(r.out, Contains("two outputs have this name"));
  }
  CHECK_FALSE(fs::exists(f / "a.exr"));
  CHECK(render("--stats /dev/null --ledger /dev/null").status == 0);
}

TEST_CASE("file names that are not UTF-8 are written with replacement characters") {
  const test::Folder f;
  const std::string scene = (f / "f\xFCr.gltf").string();
  fs::copy_file(k_cornell + "cornell.gltf", scene);
  fs::copy_file(k_cornell + "cornell.bin", f / "cornell.bin");
  const Run r = render("--set 'relight.groups=A\xE9=light' -o '" + (f / "\xFF.exr").string() + "' --stats '" +
                           (f / "\xFF.json").string() + "'",
                       scene);
  INFO(r.out);
  CHECK(r.status == 0);
  const auto stats = nlohmann::json::parse(read_text(f / "\xFF.json"));
  CHECK_THAT(stats["scene"].get<std::string>(), Contains("f\xEF\xBF\xBDr.gltf"));
  CHECK(stats["effects"]["emission"]["called_for"] == true);
  CHECK(stats["effects"]["sheen"]["called_for"] == false);
  CHECK_THAT(film::read_exr(f / "\xFF.exr").metadata.at("settings"), Contains("A\xEF\xBF\xBD=light"));
  const Run info = run("info --json '" + scene + "'");
  CHECK(info.status == 0);
  CHECK(nlohmann::json::accept(info.out));
}

TEST_CASE("outputs are written into pipes, through links and to standard output, which stay") {
  const test::Folder f;
  const std::string at = f.path.string() + "/";
  REQUIRE(mkfifo((f / "pipe.exr").c_str(), 0600) == 0);
  fs::create_symlink("target.png", f / "link.png");
  const Run r =
      test::run_command("cat " + at + "pipe.exr > " + at + "read.exr & " + LUCERNA_BINARY + " render " +
                        k_cornell + "cornell.gltf --size 16x16 --samples 2 --quiet -o " + at +
                        "pipe.exr -o " + at + "link.png --ledger /dev/null --stats /dev/stdout; wait");
  INFO(r.out);
  CHECK(r.status == 0);
  CHECK(nlohmann::json::parse(r.out).at("samples") == 2);
  CHECK(film::read_exr(f / "read.exr").find("primary.R"));
  CHECK(film::read_exr(f / "target.png").width == 16);
  CHECK(fs::is_fifo(f / "pipe.exr"));
  CHECK(fs::is_symlink(f / "link.png"));
  CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("--region renders these pixels only; an EXR stores them as its data window") {
  const test::Folder f;
  const std::string at = f.path.string() + "/";
  REQUIRE(render("-o " + at + "all.exr").status == 0);
  const Run r = render("--region 5 3 6 40 -o " + at + "part.exr -o " + at + "part.png --record-paths " + at +
                       "part.lpath --record-every 1");
  INFO(r.out);
  REQUIRE(r.status == 0);
  const film::FilmImage all = film::read_exr(f / "all.exr"), part = film::read_exr(f / "part.exr");
  REQUIRE(part.width == 16);
  REQUIRE(part.height == 16);
  for (const char* channel : {"R", "primary.G", "Z", "samples"})
    for (uint32_t i = 0; i < 256; ++i) {
      const uint32_t x = i % 16, y = i / 16;
      const bool inside = x >= 5 && x < 11 && y >= 3;
      REQUIRE((*part.find(channel))[i] == (inside ? (*all.find(channel))[i] : 0));
    }
  CHECK(film::read_exr(f / "part.png").width == 16);
  CHECK(fs::file_size(f / "part.exr") < fs::file_size(f / "all.exr"));
  for (const auto& [arguments, problem] : std::map<std::string, std::string>{
           {"--region 16 0 4 4", "--region: no pixel of the picture of 16x16 is in this region"},
           {"--region 0 0 0 4", "--region: no pixel"},
           {"--region 0 0 4", "--region"},
           {"--region 0 0 -4 4", "--region"},
           {"--region 0 0 4 4 --filter", "--filter: a region is not filtered"},
           {"--set sampling.region=half",
            "--set: sampling.region: 'half': expected LEFT,TOP,WIDTH,HEIGHT"}}) {
    const Run bad = render(arguments + " -o " + at + "bad.exr");
    INFO(arguments << ": " << bad.out);
    CHECK(bad.status == 1);
    CHECK_THAT(bad.out, Contains(problem));
    CHECK_FALSE(fs::exists(f / "bad.exr"));
  }
  const Run elsewhere = render("--region 0 0 8 8 --record-region 8 8 8 8 --record-paths " + at + "b.lpath");
  CHECK(elsewhere.status == 1);
  CHECK_THAT(elsewhere.out, Contains("--record-region: none of these pixels has samples"));
}

TEST_CASE("--turntable writes numbered pictures around the camera's target; the first is the scene's view") {
  const test::Folder f;
  const std::string at = f.path.string() + "/";
  REQUIRE(render("-o " + at + "one.exr").status == 0);
  const Run r = render("--turntable 24 -o " + at + "a.b.exr -o " + at + "a.png");
  INFO(r.out);
  REQUIRE(r.status == 0);
  const auto light = [&](const std::string& name) { return *film::read_exr(f / name).find("R"); };
  CHECK(light("a.b.0001.exr") == light("one.exr"));
  CHECK(light("a.b.0002.exr") != light("a.b.0001.exr"));
  CHECK(light("a.b.0003.exr") != light("a.b.0002.exr"));
  CHECK(fs::exists(f / "a.0024.png"));
  CHECK_FALSE(fs::exists(f / "a.png"));
  CHECK_FALSE(fs::exists(f / "a.0025.png"));
  const std::string first = film::read_metadata(f / "a.b.0001.exr").at("view");
  CHECK(film::read_metadata(f / "a.b.0002.exr").at("view") != first);
  for (const auto& [arguments, problem] : std::map<std::string, std::string>{
           {"--turntable 0 -o " + at + "c.png", "--turntable"},
           {"--turntable 10000 -o " + at + "c.png", "--turntable"},
           {"--turntable 2 --stats " + at + "c.json", "--turntable: writes pictures only"},
           {"--turntable 2 -o " + at + "none/c.png", "none/c.0001.png: "}}) {
    const Run bad = render(arguments);
    INFO(arguments << ": " << bad.out);
    CHECK(bad.status == 1);
    CHECK_THAT(bad.out, Contains(problem));
  }
}

TEST_CASE("--tev sends the layers; a missing viewer is one warning, and the files are written") {
  const test::Folder f;
  const std::string at = f.path.string() + "/";
  test::TevReceiver viewer;
  const Run r = render("--tev " + viewer.address() + " -o " + at + "a.exr");
  INFO(r.out);
  REQUIRE(r.status == 0);
  const film::FilmImage written = film::read_exr(f / "a.exr");
  for (int i = 0;
       i < 1000 && viewer.images()["Lucerna: cornell"].values["samples"] != *written.find("samples"); ++i)
    usleep(10000);
  auto seen = viewer.images()["Lucerna: cornell"];
  CHECK(seen.channels.size() == written.channels.size());
  CHECK(seen.values["caustic.B"] == *written.find("caustic.B"));
  CHECK(viewer.problem().empty());
  const Run alone = render("--tev 127.0.0.1:1 -o " + at + "b.exr");
  CHECK(alone.status == 0);
  CHECK_THAT(alone.out, Contains("127.0.0.1:1: no connection to a viewer"));
  CHECK(film::read_exr(f / "b.exr").width == 16);
  const Run bad = render("--tev nowhere:x -o " + at + "c.exr");
  CHECK(bad.status == 1);
  CHECK_THAT(bad.out, Contains("--tev: 'nowhere:x': expected HOST:PORT"));
  // Without a file, the viewer is the output.
  CHECK(render("--tev " + viewer.address()).status == 0);
}

TEST_CASE("film.ocio needs a configuration, and shows PNG files by it") {
  const test::Folder f;
  const std::string at = f.path.string() + "/";
  const std::string ocio = "OCIO=" + test::write_ocio(f.path).string();
  const Run none = render("--set film.ocio=Other -o " + at + "a.png");
  CHECK(none.status == 1);
  CHECK_THAT(none.out, Contains("the environment variable OCIO names no configuration"));
  const auto with = [&](const std::string& more) {
    return run("render " + k_cornell + "cornell.gltf --size 16x16 --samples 2 --quiet " + more,
               "env " + ocio);
  };
  CHECK(with("-o " + at + "plain.png").status == 0);
  CHECK(with("--set 'film.ocio=Other: Plain' -o " + at + "b.png").status == 0);
  REQUIRE(render("-o " + at + "standard.png").status == 0);
  const auto pixels = [&](const char* name) { return *film::read_exr(f / name).find("G"); };
  CHECK(pixels("plain.png") == pixels("standard.png"));
  CHECK(pixels("b.png") != pixels("standard.png"));
  const Run bad = with("--set film.ocio=None -o " + at + "c.png");
  CHECK(bad.status == 1);
  CHECK_THAT(bad.out, Contains("config.ocio: there is no display 'None'; there are: Screen: sRGB, Other"));
}

}  // namespace outputs_tests
