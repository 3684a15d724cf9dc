// links: session
// The picture in a viewer while it is rendered: all layers, the final ones at the end; a bad viewer changes
// nothing.
#include <catch2/catch.hpp>

#include "base/log.h"
#include "session/renderer.h"
#include "session/session.h"
#include "session/tev_link.h"
#include "support/render.h"
#include "support/tev_receiver.h"

namespace tev_tests {

using namespace lucerna;
using Catch::Contains;
using test::TevReceiver;

namespace {

const std::string k_cornell = std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf";

/// Warnings while it exists.
class Warnings {
 public:
  Warnings()
      : token_(log::add_listener([this](log::Level level, const std::string& text) {
          std::lock_guard lock(mutex_);
          if (level == log::Level::warning) all_.push_back(text);
        })) {}
  ~Warnings() { log::remove_listener(token_); }
  std::vector<std::string> all() const {
    std::lock_guard lock(mutex_);
    return all_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> all_;
  int token_;
};

template <class F>
bool soon(F&& holds) {
  for (const Timer since; since.seconds() < 60;) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

}  // namespace

TEST_CASE("the viewer ends with the layers of the finished picture, by its samples bit for bit") {
  TevReceiver viewer;
  session::Renderer r(test::renderer_options(false));
  r.settings().set("path.batch", test::k_batch);
  r.set_size(40, 30);
  r.load(k_cornell);
  test::set(r, {{"samples", "8"}});
  session::TevLink link(film::parse_tev_address(viewer.address(), ""), "cornell");
  while (r.step()) CHECK(link.follow(r));
  link.finish(r);
  const film::FilmImage image = r.output().film_image();
  REQUIRE(soon([&] {
    const auto images = viewer.images();
    const auto at = images.find("Lucerna: cornell");
    return at != images.end() && at->second.values.at("samples") == *image.find("samples");
  }));
  const TevReceiver::Image seen = viewer.images().at("Lucerna: cornell");
  CHECK(seen.width == 40);
  CHECK(seen.channels.size() == image.channels.size());
  for (const auto& [name, values] : image.channels) {
    INFO(name);
    CHECK(seen.values.at(name) == values);
  }
  CHECK(viewer.problem().empty());
}

TEST_CASE("in the window a viewer is followed; one that hangs up or never reads is reported once") {
  for (const auto manner :
       {TevReceiver::Manner::reads, TevReceiver::Manner::hangs_up, TevReceiver::Manner::never_reads}) {
    CAPTURE(int(manner));
    const Warnings warnings;
    TevReceiver viewer(manner);
    const auto made = session::start_session({.device = "cpu"});
    session::Session& s = *made;
    // Large enough to fill the buffers of the connection.
    s.set_size(400, 300);
    s.load(k_cornell);
    s.set("preview.filter", "off");
    s.set("samples", "4");
    s.send_to_tev(viewer.address());
    REQUIRE(soon([&] { return s.snapshot() && s.snapshot()->finished; }));
    if (manner == TevReceiver::Manner::reads) {
      CHECK(soon([&] {
        const auto images = viewer.images();
        return !images.empty() && images.begin()->second.values.at("samples").back() == 4;
      }));
      CHECK(s.snapshot()->tev == viewer.address());
      // Another size is another image; a stopped viewer gets nothing.
      s.set_size(32, 24);
      CHECK(soon([&] { return viewer.images().begin()->second.width == 32; }));
      s.send_to_tev(std::nullopt);
      CHECK(soon([&] { return s.snapshot()->tev.empty(); }));
      CHECK(warnings.all().empty());
    } else {
      CHECK(soon([&] { return s.snapshot()->tev.empty(); }));
      const std::vector<std::string> all = warnings.all();
      REQUIRE(all.size() == 1);
      CHECK_THAT(all[0], Contains(viewer.address() + ": the viewer has "));
      // Rendering goes on.
      s.set_size(32, 24);
      CHECK(soon([&] { return s.snapshot()->finished && s.snapshot()->width == 32; }));
    }
  }
}

TEST_CASE("a bad address is an error of the command; a missing viewer a warning") {
  const Warnings warnings;
  const auto made = session::start_session({.device = "cpu"});
  session::Session& s = *made;
  s.set_size(16, 16);
  s.load(k_cornell);
  s.set("samples", "2");
  s.send_to_tev("nowhere");
  CHECK(soon([&] { return s.snapshot() && s.snapshot()->refused && s.snapshot()->refused->size() == 1; }));
  s.send_to_tev("127.0.0.1:1");
  CHECK(soon([&] { return !warnings.all().empty(); }));
  CHECK_THAT(warnings.all().at(0), Contains("127.0.0.1:1: no connection to a viewer: Connection refused"));
  CHECK(soon([&] { return s.snapshot()->finished && s.snapshot()->tev.empty(); }));
  CHECK(warnings.all().size() == 1);
}

}  // namespace tev_tests
