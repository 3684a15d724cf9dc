#pragma once
// A workspace over a session without a renderer, for tests of its commands.
#include <catch2/catch.hpp>
#include <fstream>

#include "base/timer.h"
#include "commands/workspace.h"
#include "viewer/fake_session.h"

namespace lucerna::test {

/// A workspace whose session runs until a condition holds.
struct WorkspaceBench {
  session::FakeSession fake;
  session::Session& session = fake;
  commands::Workspace work{session};
  Timer timer;
  int token;

  WorkspaceBench() {
    log::set_console_level(log::Level::error);
    token = log::add_listener([this](log::Level level, const std::string&) {
      if (level == log::Level::error) ++errors;
    });
    session.set_size(64, 36);
  }
  ~WorkspaceBench() { log::remove_listener(token); }

  void refresh() {
    work.error_count = errors;
    work.refresh(timer.seconds());
  }
  bool until(const std::function<bool()>& holds, double seconds = 10) {
    const Timer waited;
    for (refresh(); !holds(); refresh()) {
      if (waited.seconds() > seconds) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }
  /// Runs a line to its end, as a script does.
  void run(const std::string& line, uint64_t gesture = 0) {
    refresh();
    const commands::Line done = work.run(line, gesture);
    if (done.command && done.command->done)
      REQUIRE(until([&] { return done.command->done(done.arguments); }));
  }
  void open(const std::string& file = "hall.gltf") { run("scene.open " + file), run("wait_scene"); }
  /// A material as the session has it.
  commands::Document::Material session_material(const scene::Scene& scene, uint32_t index) const {
    commands::Document::Material m(scene.materials[index]);
    m.textures = scene::texture_sources(*work.open.loaded, scene, index);
    return m;
  }
  /// Every command has reached the session.
  bool settled() {
    return until([&] {
      const commands::Document d = work.open.document();
      if (work.open.loading() || session.settings().all() != d.settings) return false;
      const auto scene = session.scene();
      if (!scene) return true;
      if (scene->lights != d.lights || scene->environment.sky != d.sky) return false;
      for (size_t i = 0; i < scene->materials.size(); ++i) {
        commands::Document::Material m = d.materials[i];
        if (!std::exchange(m.emits, true)) m.emission = vec3(0);
        if (!(session_material(*scene, uint32_t(i)) == m)) return false;
      }
      for (uint32_t i = 0; i < scene->instances.size(); ++i)
        if (scene->instances[i].to_world != work.open.object_matrix(i) ||
            scene->instances[i].hidden != work.open.object(i).hidden)
          return false;
      return scene->environment.scale == d.environment_scale &&
             scene->environment.rotation == d.environment_rotation;
    });
  }
  std::string failure(const std::string& line) {
    refresh();
    try {
      work.run(line);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  std::atomic<uint64_t> errors{0};
};

}  // namespace lucerna::test
