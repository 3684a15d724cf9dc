// links: commands film_io
// Held results and their comparison with the live picture.
#include <catch2/catch.hpp>
#include <filesystem>
#include <mutex>

#include "commands/held_results.h"
#include "commands/view_transform.h"
#include "film/io/image_file.h"
#include "film/io/planes.h"
#include "support/folder.h"
#include "workspace_bench.h"

namespace held_results_tests {

using namespace lucerna;
using namespace lucerna::commands;
using Catch::Contains;

namespace {

std::shared_ptr<const session::HeldPicture> picture(const session::ComponentMethods& methods = {}) {
  auto held = std::make_shared<session::HeldPicture>();
  held->width = held->height = 2;
  held->light.assign(4, vec3(1));
  held->methods = methods;
  return held;
}

std::string write_picture(const test::Folder& folder, const std::string& name, uint32_t width,
                          uint32_t height, float value = 0.5f) {
  film::FilmImage image{.width = width, .height = height};
  std::vector<vec3> light(size_t{width} * height, vec3(0.5f));
  light.back() = vec3(value);
  film::add_plane(image, "", "RGB", light);
  image.channels.emplace_back("samples", std::vector<float>(light.size(), 64.0f));
  const std::string file = (folder.path / name).string();
  film::write_exr(file, image);
  return file;
}

}  // namespace

TEST_CASE("methods in words: those of secondary light first, others where they differ") {
  using session::methods_text;
  CHECK(methods_text({"path", "path", "path", "path"}) == "path");
  CHECK(methods_text({"path", "cache", "cache", "path"}) == "cache");
  CHECK(methods_text({"path", "cache", "cache", "photons"}) == "cache, photons for caustics");
  CHECK(methods_text({"cache", "cache", "path", "off"}) ==
        "cache, path for tertiary light, without caustics");
  CHECK(methods_text({"path", "off", "off", "light"}) ==
        "light, without secondary light, without tertiary light");
  CHECK(methods_text({"off", "off", "off", "off"}) == "no light");
  CHECK(methods_text({}) == "");
}

TEST_CASE("results are held under unique names, up to a number, and the first one is compared") {
  HeldResults results;
  CHECK_THROWS_WITH(results.named("path"), Contains("no result is held"));
  CHECK_THROWS_WITH(results.set_view(CompareView::wipe), Contains("no result is held"));
  results.add("", "result", "Entrance", picture({"path", "path", "path", "path"}));
  results.add("", "result", "", picture({"path", "path", "path", "path"}));
  results.add("", "reference", "", picture());
  CHECK(results.list()[0].name == "path");
  CHECK(results.list()[1].name == "path 2");
  CHECK(results.list()[2].name == "reference");
  REQUIRE(results.compared());
  CHECK(results.compared()->name == "path");
  CHECK_THROWS_WITH(results.needs_room("path 2"), Contains("named 'path 2' already"));
  CHECK_THROWS_WITH(results.rename("path", "reference"), Contains("named 'reference' already"));
  CHECK_THROWS_WITH(results.rename("path", ""), Contains("expected a name"));
  results.rename("path", "noisy");
  CHECK(results.compared()->name == "noisy");
  CHECK_THROWS_WITH(results.forget("nosy"), Contains("did you mean 'noisy'"));
  results.set_view(CompareView::difference);
  results.forget("path 2");
  CHECK(results.view() == CompareView::difference);
  results.forget("noisy");
  CHECK(results.view() == CompareView::off);
  CHECK_FALSE(results.compared());
  CHECK_THROWS_WITH(results.set_view(CompareView::wipe), Contains("no held result is chosen"));
  while (results.list().size() < HeldResults::k_most) results.add("", "more", "", picture());
  CHECK_THROWS_WITH(results.add("ninth", "", "", picture()),
                    Contains("8 results are held already") && Contains("compare.forget reference"));
  CHECK(results.list().size() == HeldResults::k_most);
  results.forget_all();
  CHECK(results.list().empty());
}

TEST_CASE("a result is held and compared with the live picture") {
  test::WorkspaceBench b;
  const auto value = [&](const std::string& name) { return b.work.values.read(b.work, {name, {}}); };
  CHECK_THAT(b.failure("compare.hold"), Contains("no scene is open"));
  CHECK_THAT(b.failure("compare.view wipe"), Contains("no result is held"));
  CHECK_THAT(b.failure("compare.measure"), Contains("no held result is chosen"));
  CHECK(value("compare.held") == "0");
  b.open();
  b.run("set samples 8");
  b.run("wait_samples 8");
  b.run("set film.layer albedo");
  CHECK_THAT(b.failure("compare.hold"), Contains("the layer 'albedo' shows no light"));
  b.run("set film.layer beauty");
  b.run("camera.select 1");
  b.run("wait_samples 8");
  b.run("compare.hold");
  REQUIRE(b.work.compare.results.list().size() == 1);
  const std::string name = b.work.compare.results.list()[0].name;
  CHECK(value("compare.with") == name);
  const auto held = [&](const std::string& part) {
    return b.work.values.read(b.work, {"held", {name, part}});
  };
  CHECK(held("samples") == "8");
  CHECK(held("seconds") == "1.6");
  CHECK(held("error") == "0.1");
  CHECK(held("camera") == "Entrance");
  CHECK_THROWS_WITH(held("sample"), Contains("did you mean 'samples'"));
  CHECK_THAT(b.failure("compare.hold " + quote(name)), Contains("already; choose another name"));

  b.run("compare.measure");
  CHECK(value("compare.squared_error") == "0");
  CHECK(value("compare.flip") == "0");
  // The cache of this session has half of the light.
  b.run("set components.secondary cache");
  b.run("cache.pause off");
  b.run("wait_samples 8");
  b.run("compare.measure");
  double error = 0, seen = 0;
  REQUIRE(read_number(value("compare.squared_error"), error));
  REQUIRE(read_number(value("compare.seen_error"), seen));
  CHECK(error == Approx(0.25 * 0.25 / (0.25 + 0.01)).epsilon(1e-3));
  CHECK(seen == Approx(0.25 / (0.5 + 0.05 * 0.5)).epsilon(1e-3));
  b.run("compare.view difference");
  b.run("compare.times 4");
  CHECK(value("compare.view") == "difference");
  CHECK(value("compare.times") == "4");

  // Another view: a sentence in place of the figures.
  b.run("camera.select 2");
  b.run("wait_samples 1");
  CHECK(b.until([&] { return !value("compare.problem").empty(); }));
  CHECK_THAT(value("compare.problem"), Contains("shows another view (camera 'Entrance')"));
  CHECK_THROWS_WITH(value("compare.flip"), Contains("not measured yet"));
  CHECK_THAT(b.failure("compare.measure"), Contains("shows another view"));
  b.run("compare.forget");
  CHECK(value("compare.view") == "off");
  CHECK(b.until([&] { return value("compare.problem").empty(); }));
}

namespace {

/// A workspace that loads files, with the last error.
struct Loading : test::WorkspaceBench {
  std::mutex mutex;
  std::string last;
  int listener;
  Loading() {
    listener = log::add_listener([this](log::Level level, const std::string& text) {
      const std::lock_guard lock(mutex);
      if (level == log::Level::error) last = text;
    });
    open();
    run("wait_samples 2");
  }
  ~Loading() { log::remove_listener(listener); }
  /// Loads a file; the error, or "".
  std::string load(const std::string& file) {
    last.clear();
    if (const std::string at_once = failure("compare.load " + quote(file)); !at_once.empty()) return at_once;
    REQUIRE(until([&] { return !work.compare.holding; }));
    const std::lock_guard lock(mutex);
    return last;
  }
  std::string value(const std::string& name) { return work.values.read(work, {name, {}}); }
};

}  // namespace

TEST_CASE("a picture from a file is held; a missing, damaged or foreign one is refused") {
  const test::Folder folder;
  Loading b;
  const std::string missing = (folder.path / "none.exr").string();
  CHECK_THAT(b.load(missing), Contains("compare.load") && Contains(missing));
  const std::string good = write_picture(folder, "good.exr", 64, 36);
  const std::string damaged = (folder.path / "damaged.exr").string();
  std::filesystem::copy_file(good, damaged);
  std::filesystem::resize_file(damaged, 300);
  CHECK_THAT(b.load(damaged), Contains("compare.load: " + damaged));
  CHECK_THAT(b.load(folder.path.string()), Contains("is a folder, expected an image"));
  const std::string other = write_picture(folder, "other.exr", 32, 32);
  CHECK_THAT(b.load(other), Contains(other) && Contains("32 x 32 pixels, the picture has 64 x 36"));
  const std::string infinite = write_picture(folder, "infinite.exr", 64, 36, INFINITY);
  CHECK_THAT(b.load(infinite), Contains(infinite) && Contains("pixel 63 35 is not finite"));
  CHECK(b.work.compare.results.list().empty());
  CHECK(b.load(good) == "");
  CHECK(b.load(good) == "");
  REQUIRE(b.work.compare.results.list().size() == 2);
  CHECK(b.work.compare.results.list()[1].name == "good 2");
  CHECK(b.work.compare.results.list()[0].picture->samples == 64);
  CHECK(b.work.compare.results.list()[0].picture->is_foreign);
  b.run("compare.measure");
  CHECK(b.value("compare.flip") == "0");
  // Eight are held: the ninth is refused before the file is read.
  while (b.work.compare.results.list().size() < HeldResults::k_most) CHECK(b.load(good) == "");
  CHECK_THAT(b.load(missing), Contains("8 results are held already"));
  CHECK_THAT(b.failure("compare.hold"), Contains("8 results are held already"));
}

TEST_CASE("a file is read on a thread, and reading can be cancelled") {
  const test::Folder folder;
  const std::string good = write_picture(folder, "good.exr", 64, 36);
  Loading b;
  CHECK_THAT(b.failure("compare.cancel"), Contains("no file is being read"));
  CHECK(b.failure("compare.load " + quote(good)) == "");
  CHECK(b.work.compare.holding);
  // Between two refreshes the file is on its way, whatever its thread does.
  CHECK_THAT(
      [&] {
        try {
          b.work.run("compare.load " + quote(good));
        } catch (const Error& e) {
          return std::string(e.what());
        }
        return std::string();
      }(),
      Contains("another picture is being held"));
  b.work.run("compare.cancel");
  REQUIRE(b.until([&] { return !b.work.compare.holding; }));
  CHECK(b.work.compare.results.list().empty());
  CHECK(b.last.empty());
  double done = -1;
  CHECK_THROWS_WITH(session::read_held_picture(good, [&](double share) { return done = share, true; }),
                    Contains(good + ": reading was stopped"));
  CHECK(done == 0);
}

TEST_CASE("a file keeps how its picture was computed and what that took") {
  const test::Folder folder;
  session::HeldPicture made{.width = 64, .height = 36, .light = {}};
  made.methods = {"path", "cache", "cache", "light+photons"};
  made.seconds = 12.5, made.error = 0.021;
  for (const double part : {0.25, 0.5}) {
    stats::Entry e;
    e.paths = uint64_t(1000 * part), e.wall_s = part * 10, e.has_error = true;
    e.error[0] = 0.1 / part, e.records = 0.01;
    made.ledger.add(e);
  }
  film::FilmImage image{.width = 64, .height = 36};
  film::add_plane(image, "", "RGB", std::vector<vec3>(64 * 36, vec3(0.5f)));
  const auto read_back = [&] {
    film::write_exr(folder.path / "made.exr", image);
    return session::read_held_picture((folder.path / "made.exr").string());
  };
  session::describe(made, image.metadata);
  const session::HeldPicture held = read_back();
  CHECK(held.methods == made.methods);
  CHECK(held.seconds == 12.5);
  REQUIRE(held.error);
  CHECK(*held.error == 0.021);
  CHECK_FALSE(held.is_foreign);
  REQUIRE(held.ledger.entries().size() == 2);
  for (size_t i = 0; i < 2; ++i) {
    CHECK(held.ledger.entries()[i].wall_s == made.ledger.entries()[i].wall_s);
    CHECK(held.ledger.entries()[i].sum() == Approx(made.ledger.entries()[i].sum()).epsilon(1e-3));
  }
  // The name is the file's.
  Loading b;
  CHECK(b.load((folder.path / "made.exr").string()) == "");
  CHECK(b.work.compare.results.list()[0].name == "made");
  // What cannot be read is unknown.
  for (const auto& [seconds, error, accuracy] :
       {std::array{"soon", "-1", "1 2 3, , 4"}, {"inf", "0", "2 0.1, 1 0.2, nan 3"}, {"-3", "", ",,, "}}) {
    image.metadata["seconds"] = seconds, image.metadata["error"] = error;
    image.metadata["accuracy"] = accuracy, image.metadata["methods"] = "primary, other path";
    const session::HeldPicture damaged = read_back();
    CHECK(damaged.is_foreign);
    CHECK(damaged.seconds == 0);
    CHECK_FALSE(damaged.error);
    CHECK(damaged.ledger.entries().size() <= 1);
  }
}

TEST_CASE("an 8-bit picture is compared with the picture as it is shown") {
  const test::Folder folder;
  Loading b;
  const std::string file = (folder.path / "shown.png").string();
  b.run("set film.tone_curve agx");
  b.run("set film.ev 1");
  const std::vector<uint8_t> shown =
      film::shown_picture(view_transform(b.work.open), std::vector<vec3>(64 * 36, vec3(0.5f)));
  film::write_png(file, 64, 36, shown);
  CHECK(b.load(file) == "");
  REQUIRE(b.work.compare.results.list().size() == 1);
  CHECK(b.work.compare.results.list()[0].picture->displayed);
  const auto flip = [&] {
    b.run("compare.measure");
    double value = -1;
    REQUIRE(read_number(b.value("compare.flip"), value));
    return value;
  };
  CHECK(flip() < 0.01);
  CHECK_THROWS_WITH(b.value("compare.squared_error"), Contains("in display colours"));
  CHECK_THROWS_WITH(b.value("compare.seen_error"), Contains("in display colours"));
  // Another exposure of the live picture shows another picture.
  b.run("set film.ev -1");
  CHECK(flip() > 0.1);
}

}  // namespace held_results_tests
