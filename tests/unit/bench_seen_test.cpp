// links: bench
// The bench of interiors without a device: its rooms and settings, the command line of another program, and
// report, page and findings of synthetic results with known figures.
#include <signal.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/compare_reports.h"
#include "bench/interiors.h"
#include "bench/outside.h"
#include "bench/page.h"
#include "bench/program.h"
#include "film/io/image_file.h"
#include "unit/bench_support.h"

namespace bench_seen_tests {

namespace fs = std::filesystem;
using namespace lucerna;
using namespace lucerna::bench;
using Catch::Contains;
using Json = nlohmann::ordered_json;

namespace {

const fs::path k_own = fs::path(LUCERNA_SOURCE_DIR) / "scenes";
const char* const k_help =
    "  components.secondary    Solver. [path] path|cache|off\n"
    "  components.tertiary     Solver. [path] path|cache|off\n"
    "  lights.sampling         How lights are chosen. [power] power|learned\n";

void write_scene(const fs::path& file, const std::string& aspect) {
  fs::create_directories(file.parent_path());
  std::ofstream(file)
      << R"({"asset": {"version": "2.0"}, "cameras": [{"type": "perspective", "perspective": {)"
      << (aspect.empty() ? "" : R"("aspectRatio": )" + aspect + ", ") << R"("yfov": 1, "znear": 0.1}}]})";
}

InteriorsOptions options(const fs::path& folder) {
  return {.own = k_own, .folders = {folder}, .program = "/bin/true", .against = {}};
}

std::vector<std::string> names(const auto& list) {
  std::vector<std::string> all;
  for (const auto& entry : list) all.push_back(entry.name);
  return all;
}

/// Two rooms, path and learned, each by two programs, after 4 and 16 s, twice. Squared errors as seen are c
/// / t with c 0.04 and 0.16; learned has a quarter, the other program twice as much; the seeds' spread is 2 %
/// of the root in either direction.
struct MadeUp {
  test::Folder place;
  Matrix matrix;
  RunSummary summary;

  MadeUp() {
    for (const char* name : {"a", "b"}) write_scene(place / name / (std::string(name) + ".gltf"), "1.5");
    InteriorsOptions o = options(place.path);
    o.against = "/bin/false", o.seconds = {4, 16}, o.repeats = 2, o.settings = {"path", "learned"};
    std::vector<std::string> left_out;
    matrix = interiors_matrix(o, k_help, left_out);
    for (const Cell& c : matrix.cells()) {
      const double t = matrix.budget(c).value, scene = c.scene == 0 ? 0.04 : 0.16,
                   setting = c.setting < 2 ? 1 : 0.25, program = c.setting % 2 ? 2 : 1,
                   luck = c.repeat ? 1.02 : 0.98;
      Result r;
      r.scene = matrix.scenes[c.scene].name, r.setting = matrix.settings[c.setting].name;
      r.budget = matrix.budget(c).text(), r.repeat = c.repeat, r.seed = matrix.seed + uint32_t(c.repeat);
      r.scene_hash = "0", r.reference_hash = "1", r.tracer = "host";
      r.wall_s = t, r.samples = 2 * t, r.rays = uint64_t(1e6 * t), r.paths = r.rays / 5;
      r.seen = scene * setting * program / t * luck * luck, r.seen_all = 2 * r.seen;
      r.relmse = r.seen, r.relmse_all = r.seen, r.truth[0] = std::sqrt(r.seen), r.mse = r.seen;
      r.curve.push_back(
          {.wall_s = t, .rays = r.rays, .samples = r.samples, .truth = r.truth, .seen = r.seen});
      summary.results.emplace(matrix.id(c), r);
    }
    summary.complete = true;
    for (const SceneEntry& s : matrix.scenes)
      summary.references.push_back({.file = s.name + ".exr",
                                    .key = "1",
                                    .samples = 2048,
                                    .seed = 9,
                                    .seconds = 7,
                                    .seen_noise = 0.0001});
  }
  Json report() const { return make_report(matrix, summary, test::fake_about()); }
};

}  // namespace

TEST_CASE("Rooms are those of a folder, by name, rotated where their camera is upright") {
  const test::Folder place;
  write_scene(place / "kitchen/kitchen.gltf", "1.7");
  write_scene(place / "old/kitchen.gltf", "0.5");
  write_scene(place / "stair case/stair case.gltf", "");
  std::ofstream(place / "notes.txt") << "no scene";
  CHECK(camera_aspect(place / "old/kitchen.gltf") == Approx(0.5));
  CHECK(camera_aspect(place / "stair case/stair case.gltf") == 0);
  std::vector<std::string> left_out;
  const Matrix m = interiors_matrix(options(place.path), "", left_out);
  CHECK(names(m.scenes) == std::vector<std::string>{"kitchen", "kitchen-2", "stair-case"});
  CHECK(m.scenes[0].width == 320);
  CHECK(m.scenes[0].height == 180);
  CHECK(m.scenes[1].width == 180);
  CHECK(m.scenes[1].height == 320);
  CHECK(m.as_seen);
  CHECK(m.repeats == 3);
  CHECK(m.scenes[0].budgets[size_t(BudgetKind::seconds)] == std::vector<double>{4, 15, 60});
  CHECK(names(m.settings) == std::vector<std::string>{"path", "learned", "cache", "cache-learned"});
  CHECK(m.settings[0].program == "/bin/true");
  CHECK(m.settings[0].set.at("components.tertiary") == "path");
  CHECK(m.settings[3].set.at("components.tertiary") == "cache");
  CHECK(m.settings[3].set.at("lights.sampling") == "learned");
  // A duplicate is measured once; a file stands for itself.
  InteriorsOptions o = options(place.path);
  o.folders.push_back(place / "kitchen/kitchen.gltf");
  CHECK(interiors_matrix(o, "", left_out).scenes.size() == 3);
  CHECK_THROWS_WITH(interiors_matrix(options(place / "nowhere"), "", left_out),
                    Contains("nowhere: is no folder"));
  fs::create_directories(place / "empty");
  CHECK_THROWS_WITH(interiors_matrix(options(place / "empty"), "", left_out), Contains("no .gltf or .glb"));
}

TEST_CASE("The project's own interiors are found, and three of them in the quick form") {
  InteriorsOptions o = options(k_own);
  std::vector<std::string> left_out;
  CHECK(names(interiors_matrix(o, "", left_out).scenes) == k_own_interiors);
  o.folders.clear();
  CHECK(names(interiors_matrix(o, "", left_out).scenes) == k_own_interiors);
  o.quick = true;
  const Matrix quick = interiors_matrix(o, "", left_out);
  CHECK(names(quick.scenes) == k_quick_interiors);
  CHECK(quick.repeats == 2);
  // Two to three minutes: renders and a second of loading each; times to errors need a factor of four.
  double seconds = 0;
  for (const Cell& c : quick.cells()) seconds += quick.budget(c).value + 1;
  CHECK(seconds < 180);
  const std::vector<double>& times = quick.budgets(0, 0);
  CHECK(times.front() * 1.2 <= times.back() / 4);
}

TEST_CASE("Another program has the settings that it supports, each beside its counterpart") {
  const test::Folder place;
  write_scene(place / "a.gltf", "1.5");
  InteriorsOptions o = options(place.path);
  o.against = "/bin/false";
  std::vector<std::string> left_out;
  const Matrix m = interiors_matrix(o, k_help, left_out);
  CHECK(left_out.empty());
  REQUIRE(m.settings.size() == 8);
  CHECK(m.settings[2].name == "learned");
  CHECK(m.settings[2].beside == "before-learned");
  CHECK(m.settings[3].name == "before-learned");
  CHECK(m.settings[3].program == "/bin/false");
  CHECK(m.settings[3].set == m.settings[2].set);
  // A version without learned lights chooses lights by power.
  const std::string old = std::string(k_help).substr(0, std::string(k_help).find("  lights."));
  const Matrix before = interiors_matrix(o, old, left_out);
  CHECK(left_out == std::vector<std::string>{"learned", "cache-learned"});
  CHECK(names(before.settings) ==
        std::vector<std::string>{"path", "before-path", "learned", "cache", "before-cache", "cache-learned"});
  CHECK_FALSE(before.settings[1].set.contains("lights.sampling"));
  // The matrix is unchanged after write and read.
  CHECK(to_json(parse_matrix(to_json(m).dump(), "m", "/")) == to_json(m));
}

TEST_CASE("Another program gets options that end a render, whatever the scene sets") {
  const test::Folder place;
  write_scene(place / "a.gltf", "1.5");
  InteriorsOptions o = options(place / "a.gltf");
  o.seconds = {2.5};
  std::vector<std::string> left_out;
  const auto line = [&](const scene::LoadOptions& scenes, const fs::path& shown) {
    const Matrix m = interiors_matrix(o, "", left_out);
    std::string text;
    for (const std::string& word : outside_arguments(m, m.cells()[0], m.settings[0].set, "cpu", scenes,
                                                     {.picture = "p.exr", .stats = "s.json", .shown = shown}))
      text += " " + word;
    return text;
  };
  CHECK_THAT(line({}, ""),
             Contains(" --quiet --size 320x180 --seed 1 --stats s.json -o p.exr --device cpu") &&
                 Contains(" --time 2.5 --samples 1048576 ") &&
                 Contains(" --set sampling.max_samples=1048576") &&
                 Contains(" --set lights.sampling=power") && !Contains("--allow-outside"));
  o.seconds.clear(), o.samples = {8};
  CHECK_THAT(line({.outside = true}, "x.png"),
             Contains(" -o p.exr -o x.png") && Contains(" --allow-outside") && Contains(" --samples 8 ") &&
                 !Contains("--time") && !Contains("max_samples"));
}

TEST_CASE("A program's output and exit status are reported, and it ends when the bench does") {
  const ProgramResult said = run_program("/bin/sh", {"-c", "echo one; echo two >&2; exit 3"}, {});
  CHECK(said.status == 3);
  CHECK(said.text == "one\ntwo\n");
  CHECK(said.last_line() == "two");
  CHECK_FALSE(said.interrupted);
  CHECK(run_program("/bin/sh", {"-c", "kill -9 $$"}, {}).status == 128 + SIGKILL);
  CHECK(ProgramResult{}.last_line().empty());
  CHECK(out_of_time({.status = 1, .text = "lucerna: --time: '1': no pixel has a sample\n"}));
  CHECK_FALSE(out_of_time({.status = 1, .text = "lucerna: --set: '1': unknown setting\n"}));
  CHECK_FALSE(out_of_time({.status = 0, .text = "lucerna: --time: after 1 s 20 % of the picture\n"}));
  int queries = 0;
  // A program that ignores SIGTERM is killed.
  const ProgramResult stopped = run_program("/bin/sh", {"-c", "trap '' TERM; while :; do sleep 0.05; done"},
                                            {.interrupted = [&] { return ++queries > 2; }});
  CHECK(stopped.interrupted);
  CHECK(stopped.status == 128 + SIGKILL);
  CHECK_THROWS_WITH(run_program("/no/such/program", {}, {}), Contains("/no/such/program: cannot be run"));
}

TEST_CASE("Figures of the error as seen: after a time, to an error, factors with intervals") {
  const Json r = MadeUp().report();
  REQUIRE(r["scenes"].size() == 2);
  const Json &path = r["scenes"][0]["settings"][0], &before = r["scenes"][0]["settings"][1],
             &learned = r["scenes"][0]["settings"][2];
  CHECK(learned["name"] == "learned");
  CHECK(path["cells"][0]["seen"]["median"].get<double>() == Approx(0.01).epsilon(0.001));
  CHECK(path["cells"][1]["seen"]["median"].get<double>() == Approx(0.0025).epsilon(0.001));
  CHECK_FALSE(path["cells"][0].contains("seen_ratio"));
  CHECK(learned["cells"][0]["seen_ratio"]["ratio"].get<double>() == Approx(4));
  CHECK(learned["cells"][0]["seen_ratio"]["noise"] == false);
  CHECK(before["cells"][0]["seen_ratio"]["ratio"].get<double>() == Approx(0.5));
  CHECK(path["cells"][0]["seen_beside"]["ratio"].get<double>() == Approx(2));
  CHECK(learned["cells"][1]["seen_beside"]["ratio"].get<double>() == Approx(2));
  CHECK_FALSE(before["cells"][0].contains("seen_beside"));
  // sqrt(.04 / t): 5 % at 16 s, which is the end; 2 % at 100 s by 1 / t, because 4 and 16 s make a curve.
  CHECK(path["seen_time_to"][1]["kind"] == "extrapolated");
  CHECK(path["seen_time_to"][1]["seconds"]["median"].get<double>() == Approx(100).epsilon(0.002));
  CHECK(learned["seen_time_to"][0]["kind"] == "at_once");
  CHECK(r["scenes"][1]["settings"][2]["seen_time_to"][0]["seconds"]["median"].get<double>() ==
        Approx(16).epsilon(0.03));
  CHECK(learned["seen_time_to"][1]["ratio"].get<double>() == Approx(4));
  // Over both scenes: the same factors, and an interval that is narrower by the root of two.
  REQUIRE(r["seen_ratios"].size() == 6);
  const Json& mean = r["seen_ratios"][2];
  CHECK(mean["setting"] == "learned");
  CHECK(mean["ratio"].get<double>() == Approx(4));
  CHECK(mean["scenes"] == 2);
  const double one = std::log(learned["cells"][0]["seen_ratio"]["high"].get<double>() / 4);
  CHECK(std::log(mean["high"].get<double>() / 4) == Approx(one / std::sqrt(2)));
  CHECK(r["seen_besides"].size() == 4);
}

TEST_CASE("Page and findings of the error as seen show factors, and mark noise") {
  MadeUp made;
  const Json r = made.report();
  const std::string html = make_page(r, made.place.path);
  CHECK_THAT(html, Contains("How soon rooms are right") && Contains("before-learned") &&
                       Contains("Error as seen after a time") && Contains("<svg") && Contains("/bin/false") &&
                       Contains("10.0 %") && Contains("4.00×") && Contains("± 0.0001"));
  CHECK_THAT(html, !Contains("Nine tiles in ten"));
  const std::vector<std::string> found = findings(r);
  REQUIRE(found.size() == 10);
  CHECK_THAT(found[2], Contains("learned, 4 s: over 2 scenes 4.00× (") && Contains("the efficiency of path"));
  CHECK_THAT(found[9], Contains("learned, 16 s") && Contains("2.00×") && Contains("before-learned"));
  for (auto& [id, result] : made.summary.results)
    result.seen = 0.04 / result.wall_s * (result.repeat ? 1.5 : 0.6);
  CHECK_THAT(findings(made.report())[2], Contains("no difference from path beyond"));
  // An unfinished bench has a page too; without repeats no interval is claimed.
  std::erase_if(made.summary.results, [](const auto& entry) { return entry.second.repeat == 1; });
  made.summary.complete = false;
  const Json half = made.report();
  CHECK_THAT(make_page(half, made.place.path), Contains("Not complete: 16 of 32"));
  CHECK(half["scenes"][0]["settings"][2]["cells"][0]["seen_ratio"].contains("high") == false);
  CHECK_THAT(compare_reports(r, r), Contains("as seen") && Contains("1.00x="));
}

}  // namespace bench_seen_tests
