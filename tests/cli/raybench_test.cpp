// links: base
// The ray benches: the output of `lucerna bench rays`, and the separate bench that reads it.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "support/run.h"

namespace raybench_tests {

namespace fs = std::filesystem;
using lucerna::test::Run;
using lucerna::test::run_command;

namespace {

const std::string k_bench = std::string(LUCERNA_BINARY) + " bench rays ";
const std::string k_alone =
    (fs::path(LUCERNA_BINARY).parent_path().parent_path() / "raybench" / "bin" / "lucerna-raybench").string();
const std::string k_scene = std::string(LUCERNA_SOURCE_DIR) + "/scenes/glass/glass.gltf";
const std::string k_small = " --rays 4096 --repeats 1 --samples 2 --width 32 --height 32 --device cpu";

}  // namespace

TEST_CASE(
    "the bench measures every tracer with the same rays, and its flattened scene is enough for the separate "
    "one") {
  const fs::path folder = fs::temp_directory_path() / ("lucerna-raybench-" + std::to_string(getpid()));
  fs::create_directories(folder);
  const std::string flat = (folder / "glass.flat").string();
  const Run full = run_command(k_bench + k_scene + k_small + " --flat " + flat);
  INFO(full.out);
  REQUIRE(full.status == 0);
  for (const char* part : {"compute-bvh", "host", "embree single", "primary", "diffuse", "shadow",
                           "path-traced frame", "times as fast as", "disagree: 0"})
    CHECK(full.out.find(part) != std::string::npos);

  const Run alone = run_command(k_alone + " " + flat + k_small + " --json");
  INFO(alone.out);
  CHECK(alone.status == 0);
  for (const char* part :
       {"\"compute-bvh\"", "\"primary\"", "\"diffuse\"", "\"shadow\"", "\"seconds\"", "\"stages_ms\""})
    CHECK(alone.out.find(part) != std::string::npos);

  // A file truncated anywhere is refused in one line.
  const auto size = fs::file_size(flat);
  for (const double part : {0.0, 0.0001, 0.3, 0.7, 0.9999}) {
    const std::string cut = (folder / "cut.flat").string();
    fs::copy_file(flat, cut, fs::copy_options::overwrite_existing);
    fs::resize_file(cut, std::uintmax_t(double(size) * part));
    const Run r = run_command(k_alone + " " + cut + k_small);
    INFO(part << "\n" << r.out);
    CHECK(r.status == 1);
    CHECK(r.out.find("cut.flat: ") != std::string::npos);
  }
  CHECK(run_command(k_alone + " " + k_scene + k_small).out.find("not a flattened scene") !=
        std::string::npos);
  CHECK(run_command(k_alone + " /no/such.flat").status == 1);
  CHECK(run_command(k_bench + k_scene + k_small + " --camera nowhere").out.find("no camera 'nowhere'") !=
        std::string::npos);
  CHECK(run_command(k_bench + k_scene + k_small + " --flat /no/such/folder/x.flat").status == 1);
  fs::remove_all(folder);
}

TEST_CASE("the separate bench needs neither image IO, nor Embree, nor a window") {
  const Run r = run_command("ldd " + k_alone);
  REQUIRE(r.status == 0);
  for (const char* library : {"OpenImageIO", "embree", "glfw", "libGL", "libX11", "tinygltf"}) {
    INFO(library);
    CHECK(r.out.find(library) == std::string::npos);
  }
  CHECK(r.out.find("not found") == std::string::npos);
}

}  // namespace raybench_tests
