#pragma once
// The test case that opens the window of test::window(): over a session without a renderer. Included by one
// file of an executable.
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "fake_session.h"
#include "support.h"
#include "ui/viewer.h"

/// LUCERNA_TEST_SCENE: the scene, default hall.gltf; LUCERNA_TEST_SCALE: scale of text; LUCERNA_TEST_SIZE:
/// WIDTHxHEIGHT.
TEST_CASE("inside: one window", "[.][inside]") {
  using namespace lucerna;
  log::set_console_level(log::Level::info);
  ui::ViewerOptions options;
  options.remember = false, options.scene = "hall.gltf";
  if (const char* scene = std::getenv("LUCERNA_TEST_SCENE")) options.scene = scene;
  if (const char* scale = std::getenv("LUCERNA_TEST_SCALE")) options.scale = std::stof(scale);
  if (const char* size = std::getenv("LUCERNA_TEST_SIZE"))
    std::sscanf(size, "%dx%d", &options.width, &options.height);
  if (const char* script = std::getenv("LUCERNA_TEST_SCRIPT")) {
    std::ifstream stream(script);
    for (std::string line; std::getline(stream, line);) options.script.push_back(line);
  }
  session::FakeSession session;
  REQUIRE(ui::run_viewer(session, options) == 0);
}
