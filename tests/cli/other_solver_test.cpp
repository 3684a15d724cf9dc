// links: base
// The program with a solver of the tests (programs/ambient_main.cpp): the command line supports it.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "support/folder.h"
#include "support/run.h"

namespace other_solver_tests {

using namespace lucerna;

TEST_CASE("a registered solver is in --help, computes its component and is in the figures") {
  const test::Folder folder;
  const std::string program = std::string(LUCERNA_BINARY) + "-ambient";
  const auto help = test::run_command(program + " render --help");
  CHECK(help.status == 0);
  CHECK_THAT(help.out,
             Catch::Contains("ambient.radiance") && Catch::Contains("path|cache|photons|ambient|auto|off"));
  const std::string stats = (folder.path / "stats.json").string();
  const std::string scene = std::string(LUCERNA_SOURCE_DIR) + "/scenes/furnace-closed/furnace-closed.gltf";
  const auto rendered = test::run_command(program + " render " + scene +
                                          " --size 16x16 --samples 2 --set components.tertiary=ambient "
                                          "--set ambient.radiance=2 --stats " +
                                          stats);
  INFO(rendered.out);
  REQUIRE(rendered.status == 0);
  const auto json = nlohmann::json::parse(read_file(stats));
  CHECK(json.at("components").at("tertiary").at("solver") == "ambient");
  CHECK(json.at("ambient").at("radiance") == 2.0);
  // The normal program does not know it.
  CHECK(test::run("render x.gltf --set components.tertiary=ambient -o x.png").status != 0);
}

}  // namespace other_solver_tests
