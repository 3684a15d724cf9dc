// links: film_io
// Pictures for tev: bytes of packets, and viewers that read, are missing, hang up or do not read.
#include <catch2/catch.hpp>

#include "base/timer.h"
#include "film/io/tev.h"
#include "support/tev_receiver.h"

namespace film_io_tev_tests {

using namespace lucerna;
using Catch::Contains;
using test::TevReceiver;

namespace {

film::FilmImage picture(uint32_t width, uint32_t height, float add = 0) {
  film::FilmImage image;
  image.width = width, image.height = height;
  for (const char* name : {"R", "primary.G", "Z"}) {
    std::vector<float> values(size_t{width} * height);
    for (size_t i = 0; i < values.size(); ++i) values[i] = float(i) + add;
    image.channels.emplace_back(name, std::move(values));
    add += 0.25f;
  }
  return image;
}

/// Waits until the sender has ended with a problem, which it returns.
std::string problem_of(film::TevSender& sender, double seconds = 20) {
  const Timer since;
  while (!sender.ended() && since.seconds() < seconds)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  return sender.take_problem();
}

}  // namespace

TEST_CASE("packets have the bytes that tev reads") {
  using namespace std::string_literals;
  CHECK(film::tev_open("a.exr", true) == "\x0d\0\0\0\7\1a.exr\0\0"s);
  CHECK(film::tev_reload("a", false) == "\x08\0\0\0\1\0a\0"s);
  const std::vector<std::string> channels{"R", "Z"};
  CHECK(film::tev_create("n", 3, 258, channels, true) == "\x18\0\0\0\4\1n\0\3\0\0\0\2\1\0\0\2\0\0\0R\0Z\0"s);
  const std::vector<float> values{1, -2};
  CHECK(film::tev_update("n", "R", 5, 2, values) ==
        "\x36\0\0\0\6\0n\0\1\0\0\0R\0\0\0\0\0\5\0\0\0\2\0\0\0\1\0\0\0"s + std::string(8, '\0') +
            "\1\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\xc0"s);
  // A zero would end the text, and shift all that follows.
  CHECK(film::tev_reload("a\0b"s, false) == film::tev_reload("a", false));
}

TEST_CASE("addresses are read, and bad ones are refused with an example") {
  CHECK(film::parse_tev_address("", "").text() == "127.0.0.1:14158");
  CHECK(film::parse_tev_address("localhost", "").text() == "127.0.0.1:14158");
  CHECK(film::parse_tev_address(":80", "").text() == "127.0.0.1:80");
  CHECK(film::parse_tev_address("10.0.0.2", "").text() == "10.0.0.2:14158");
  CHECK(film::parse_tev_address("10.0.0.2:65535", "").text() == "10.0.0.2:65535");
  for (const char* bad : {"host", "1.2.3", "127.0.0.1:", "127.0.0.1:0", "127.0.0.1:65536", "127.0.0.1:-1",
                          "::1", "127.0.0.1:80x", "127.0.0.1 "})
    CHECK_THROWS_WITH(
        film::parse_tev_address(bad, "--tev"),
        Contains(fmt::format("--tev: '{}': expected HOST:PORT", bad)) && Contains("127.0.0.1:14158"));
}

TEST_CASE("a viewer gets all channels, again with every picture, and a new image for another size") {
  TevReceiver viewer;
  film::TevSender sender(film::parse_tev_address(viewer.address(), ""), "test");
  CHECK_FALSE(sender.busy());
  const film::FilmImage first = picture(1500, 900);
  sender.send(first);
  REQUIRE(sender.finish());
  // What was sent may still be on its way.
  const auto received = [&](const film::FilmImage& wanted) {
    for (const Timer since; since.seconds() < 20;) {
      const auto images = viewer.images();
      const auto at = images.find("test");
      if (at != images.end() && at->second.width == int32_t(wanted.width) &&
          at->second.values.at("Z") == wanted.channels[2].second) {
        CHECK(at->second.height == int32_t(wanted.height));
        CHECK(at->second.channels == std::vector<std::string>{"R", "primary.G", "Z"});
        CHECK(at->second.values.at("R") == wanted.channels[0].second);
        CHECK(at->second.values.at("primary.G") == wanted.channels[1].second);
        return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  };
  CHECK(received(first));
  const film::FilmImage second = picture(1500, 900, 7), third = picture(20, 10, 3);
  sender.send(second);
  REQUIRE(sender.finish());
  CHECK(received(second));
  sender.send(third);
  REQUIRE(sender.finish());
  CHECK(received(third));
  CHECK(viewer.problem().empty());
  CHECK(viewer.connections() == 1);
  CHECK(sender.take_problem().empty());
}

TEST_CASE("a viewer that is missing ends the sender with one problem, and no call waits for it") {
  uint16_t port = 0;
  {
    const TevReceiver gone;
    port = gone.port();
  }
  const std::string address = "127.0.0.1:" + std::to_string(port);
  film::TevSender sender(film::parse_tev_address(address, ""), "test");
  sender.send(picture(8, 8));
  CHECK_FALSE(sender.finish());
  CHECK_THAT(sender.take_problem(),
             Catch::StartsWith(address + ": no connection to a viewer: ") && Contains("Start tev first"));
  CHECK(sender.take_problem().empty());
  const Timer since;
  for (int i = 0; i < 100; ++i) sender.send(picture(8, 8));
  CHECK_FALSE(sender.busy());
  CHECK_FALSE(sender.finish());
  CHECK(since.seconds() < 1);
}

TEST_CASE("a viewer that hangs up in the middle of a picture ends the sender") {
  TevReceiver viewer(TevReceiver::Manner::hangs_up);
  film::TevSender sender(film::parse_tev_address(viewer.address(), ""), "test");
  sender.send(picture(2000, 1000));
  CHECK_THAT(problem_of(sender), Contains(viewer.address() + ": the viewer has hung up (") &&
                                     Contains("nothing more is sent to it"));
}

TEST_CASE("a viewer that never reads ends the sender after a while; sending and destroying do not wait") {
  TevReceiver viewer(TevReceiver::Manner::never_reads);
  film::TevSender sender(film::parse_tev_address(viewer.address(), ""), "test", 0.5);
  const film::FilmImage large = picture(2000, 1000);
  sender.send(large);
  CHECK(sender.busy());
  sender.send(large);
  CHECK_THAT(problem_of(sender), Contains("the viewer has read nothing for 0.5 s"));
  CHECK_FALSE(sender.busy());
  TevReceiver other(TevReceiver::Manner::never_reads);
  const Timer ending;
  {
    film::TevSender patient(film::parse_tev_address(other.address(), ""), "test", 60);
    patient.send(picture(2000, 1000));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  CHECK(ending.seconds() < 5);
}

TEST_CASE("files are opened, and read again the second time; a problem goes to the report") {
  TevReceiver viewer;
  film::TevSender sender(film::parse_tev_address(viewer.address(), ""), "");
  sender.open("/a b.exr");
  sender.open("/c.exr");
  sender.open("/a b.exr");
  REQUIRE(sender.finish());
  for (const Timer since; since.seconds() < 20 && viewer.images()["reload /a b.exr"].updates == 0;)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  auto seen = viewer.images();
  CHECK(seen["open /a b.exr"].updates == 1);
  CHECK(seen["open /c.exr"].updates == 1);
  CHECK(seen["reload /a b.exr"].updates == 1);
  CHECK(viewer.problem().empty());
  std::string problem;
  {
    film::TevSender alone(film::parse_tev_address("127.0.0.1:1", ""), "", 5,
                          [&](const std::string& what) { problem = what; });
    alone.open("/a.exr");
    CHECK_FALSE(alone.finish());
    CHECK(alone.take_problem().empty());
  }
  CHECK_THAT(problem, Contains("127.0.0.1:1: no connection to a viewer"));
}

}  // namespace film_io_tev_tests
