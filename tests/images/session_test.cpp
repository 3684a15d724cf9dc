// links: session
// The real session, driven from another thread as by a window: cancelled loads, edits at any time, requested
// files, and shutdown at any time. Clean under the thread sanitizer (preset tsan).
#include "session/session.h"
#include "support/device_name.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <filesystem>
#include <random>
#include <thread>

#include "base/log.h"
#include "film/io/image_file.h"
#include "support/folder.h"

namespace session_tests {

using namespace lucerna;
using session::Session;
using session::Snapshot;

namespace {

std::string gltf(const std::string& name) {
  return std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + name + "/" + name + ".gltf";
}

/// Counts log messages during its lifetime.
struct Heard {
  std::atomic<int> errors{0}, given_up{0}, loaded{0};
  int token = log::add_listener([this](log::Level level, const std::string& text) {
    errors += level == log::Level::error;
    given_up += text.find("loading was cancelled") != std::string::npos;
    loaded += text.find(" loaded: ") != std::string::npos;
  });
  ~Heard() { log::remove_listener(token); }
};

/// Waits without limit until a snapshot satisfies the condition.
template <class Condition>
std::shared_ptr<const Snapshot> until(const Session& session, const Condition& holds) {
  for (;; std::this_thread::sleep_for(std::chrono::milliseconds(2)))
    if (const auto snapshot = session.snapshot(); snapshot && holds(*snapshot)) return snapshot;
}
void settle(const Session& session) {
  const uint64_t commands = session.commands();
  until(session, [&](const Snapshot& s) { return s.commands >= commands; });
}

}  // namespace

TEST_CASE("a cancelled load stays cancelled, whatever is loaded after it") {
  Heard heard;
  const auto made = session::start_session({.device = test::device_name()});
  Session& session = *made;
  session.set_size(32, 24);
  // The first load is running or still queued; the second does not undo its cancellation.
  for (int round = 0; round < 3; ++round) {
    session.load(gltf("hall"));
    if (round == 1) until(session, [](const Snapshot& s) { return s.progress >= 0; });
    session.cancel();
    session.load(gltf("cornell"));
    settle(session);
  }
  CHECK(heard.given_up == 3);
  CHECK(heard.loaded == 3);
  CHECK(heard.errors == 0);
  CHECK(session.scene()->name == "cornell");
  CHECK(session.snapshot()->scene_id == 3);
}

TEST_CASE("a scene opened for the program to choose its solvers, unless it names them") {
  const auto made = session::start_session({.device = test::device_name()});
  Session& session = *made;
  session.set_size(32, 24);
  const auto solvers_of = [&](const char* scene, bool choose) {
    session.load(gltf(scene), false, choose);
    settle(session);
    const plan::Settings settings = session.state().settings;
    return settings.text("components.secondary") + " " + settings.text("components.caustic");
  };
  CHECK(solvers_of("cornell", true) == "auto auto");
  const auto chosen = until(session, [](const Snapshot& s) { return s.samples > 8; });
  CHECK(chosen->components[1].solver == "path");
  CHECK_FALSE(chosen->components[1].reason.empty());
  CHECK(solvers_of("cornell", false) == "path path");
  CHECK(solvers_of("ring", true) == "path photons");
}

TEST_CASE("commands for a replaced scene are skipped, and refusals are listed") {
  Heard heard;
  const auto made = session::start_session({.device = test::device_name()});
  Session& session = *made;
  session.set_size(32, 24);
  session.load(gltf("cornell"));
  settle(session);
  const session::State before = session.state();
  CHECK(before.scene_id == 1);
  scene::Camera camera = scene::starting_camera(*before.scene, "");
  camera.to_world[3].x += 0.25f;
  session.load(gltf("hall"));
  const uint64_t load = session.commands();
  session.set_camera(camera, before.scene_id);
  session.set("film.ev", "2", before.scene_id);
  session.set_environment(3, 90, before.scene_id);
  session.set("samples", "77");
  settle(session);
  auto snapshot = session.snapshot();
  REQUIRE(snapshot->refused);
  CHECK(*snapshot->refused == std::vector<uint64_t>{load + 1, load + 2, load + 3});
  CHECK(snapshot->scene_id == 2);
  CHECK(snapshot->camera.to_world == scene::starting_camera(*session.scene(), "").to_world);
  CHECK(session.settings().real("film.ev") != 2);
  CHECK(session.scene()->environment.scale == 1);
  CHECK(session.settings().integer("samples") == 77);
  CHECK(heard.errors == 0);

  // A camera that cannot be rendered is refused, and the previous picture continues.
  camera.to_world[3].x = 1e19f;
  session.set_camera(camera);
  session.set_environment(std::numeric_limits<float>::infinity(), 0);
  session.set_size(1u << 20, 1u << 20);
  session.load("missing.gltf");
  settle(session);
  snapshot = until(session, [](const Snapshot& s) { return s.samples > 0; });
  CHECK(snapshot->refused->size() == 7);
  CHECK(heard.errors == 4);
  CHECK(snapshot->camera.to_world == scene::starting_camera(*session.scene(), "").to_world);
  CHECK(snapshot->width == 32);
}

TEST_CASE("a picture names the scene that it shows, also while another scene is loading") {
  const auto made = session::start_session({.device = test::device_name()});
  Session& session = *made;
  session.set_size(32, 24);
  session.load(gltf("cornell"));
  settle(session);
  const auto first = session.snapshot()->camera;
  std::mutex mutex;
  std::vector<std::shared_ptr<const Snapshot>> seen;
  session.on_publish([&] {
    std::lock_guard lock(mutex);
    seen.push_back(session.snapshot());
  });
  session.load(gltf("hall"));
  session.load("missing.gltf");
  settle(session);
  session.on_publish({});
  const auto second = scene::starting_camera(*session.scene(), "");
  REQUIRE(first.to_world != second.to_world);
  std::lock_guard lock(mutex);
  for (const auto& s : seen)
    CHECK(s->camera.to_world == (s->scene_id == 1 ? first.to_world : second.to_world));
  CHECK(session.snapshot()->scene_id == 2);
}

TEST_CASE("requested files are written, also when the session ends immediately") {
  const test::Folder folder;
  const auto file = [&](const char* name) { return folder.path / name; };
  session::Saved picture, last, nowhere, cache;
  {
    const auto made = session::start_session({.device = test::device_name()});
    Session& session = *made;
    session.set_size(32, 24);
    session.load(gltf("cornell"));
    picture = session.save(file("a.exr"));
    picture.get();
    const film::FilmImage image = film::read_exr(file("a.exr"));
    const std::vector<float>& samples = *image.find("samples");
    CHECK(*std::min_element(samples.begin(), samples.end()) >= 1);
    nowhere = session.save(file("no") / "such" / "a.exr");
    CHECK_THROWS_WITH(nowhere.get(), Catch::Contains("the folder '"));
    cache = session.solver_save("cache", file("a.cache"));
    CHECK_THROWS_WITH(cache.get(), Catch::Contains("no component is computed by 'cache'"));
    last = session.save(file("b.png"));
  }
  CHECK_NOTHROW(last.get());
  CHECK(std::filesystem::exists(file("b.png")));
}

TEST_CASE("a picture is measured as soon as it exists, also directly after an edit") {
  Heard heard;
  const auto made = session::start_session({.device = test::device_name()});
  Session& session = *made;
  session.set_size(32, 24);
  session.load(gltf("cornell"));
  for (int round = 0; round < 4; ++round) {
    session.set("components.secondary", round % 2 == 0 ? "cache" : "path");
    const film::Brightness found = session.measure(std::nullopt).get();
    CHECK(found.ev.has_value());
  }
  CHECK(heard.errors == 0);
}

TEST_CASE("a session without a device reports failure to callers that wait for files") {
  const auto made = session::start_session({.device = "no such device"});
  Session& session = *made;
  CHECK_THROWS(session.save("/tmp/lucerna-never.exr").get());
}

TEST_CASE("edits from another thread at any time, concurrent reads of pictures, and shutdown during work") {
  Heard heard;
  std::mt19937 random(5);
  const auto below = [&](int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); };
  std::atomic<uint64_t> published{0}, seen{0};
  for (int round = 0; round < 2; ++round) {
    const auto made = session::start_session({.device = test::device_name()});
    Session& session = *made;
    session.on_publish([&] { ++published; });
    session.set_size(32, 24);
    session.load(gltf("cornell"));
    settle(session);
    std::atomic<bool> stop{false};
    std::thread watcher([&] {
      while (!stop)
        if (const auto s = session.snapshot())
          seen += s->rgba.size() + s->samples + session.settings().all().size();
    });
    for (int edit = 0; edit < 40; ++edit) {
      switch (below(9)) {
        case 0:
          session.set("components.secondary", below(2) ? "cache" : "path");
          break;
        case 1:
          session.set_environment(0.5f + 0.1f * float(below(5)), 0);
          break;
        case 2:
          session.set_size(24 + 8 * uint32_t(below(3)), 24);
          break;
        case 3:
          session.set("film.ev", std::to_string(below(3)));
          break;
        case 4:
          session.set_paused(below(2));
          break;
        case 5:
          session.inspect(vec2(0.5f, 0.1f * float(below(9))));
          break;
        case 6:
          session.set("sampling.mode", below(2) ? "adaptive" : "uniform");
          break;
        case 7: {
          const auto scene = session.scene();
          scene::Material m = scene->materials[0];
          m.base_color.x = 0.1f * float(below(9));
          session.set_material(0, m);
          break;
        }
        default:
          session.restart();
      }
      if (below(3) == 0) settle(session);
    }
    stop = true;
    watcher.join();
  }
  CHECK(published > 10);
  CHECK(seen > 0);
  CHECK(heard.errors == 0);
}

}  // namespace session_tests
