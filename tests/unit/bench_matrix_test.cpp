// links: bench
// The matrix: its meaning, the order of measurements, and located errors in invalid ones.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/matrix.h"
#include "bench/time_left.h"

namespace bench_matrix_tests {

using namespace lucerna;
using namespace lucerna::bench;

namespace {

const std::string k_scenes = std::string(LUCERNA_SOURCE_DIR) + "/scenes";

const char* const k_good = R"({
  "name": "m", "repeats": 4, "warmup": 2, "seed": 10, "reference": {"samples": 500, "seed": 99},
  "set": {"path.max_depth": 8},
  "budgets": {"samples": [64, 16], "errors": [0.1, 0.2]},
  "scenes": [
    {"file": "cornell/cornell.gltf", "size": "32x24"},
    {"file": "glass/glass.gltf", "name": "ring", "size": "16x16", "reference_samples": 700,
     "budgets": {"samples": [8]}, "set": {"path.max_depth": 12}}
  ],
  "settings": [
    {"name": "plain"},
    {"name": "adaptive", "about": "tiles", "set": {"sampling.mode": "adaptive", "sampling.tile": 8}}
  ]
})";

/// The valid matrix with one part replaced.
std::string with(const std::string& from, const std::string& to) {
  std::string text = k_good;
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

void refused(const std::string& text, const std::string& where, const std::string& what) {
  INFO(text);
  try {
    parse_matrix(text, "m.json", k_scenes);
    FAIL("was accepted");
  } catch (const Error& e) {
    INFO(e.what());
    CHECK(e.where() == where);
    CHECK(std::string(e.what()).find(what) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("A matrix file states what is measured") {
  const Matrix m = parse_matrix(k_good, "m.json", k_scenes);
  CHECK(m.repeats == 4);
  CHECK(m.warmup == 2);
  CHECK(m.reference_seed == 99);
  REQUIRE(m.scenes.size() == 2);
  CHECK(m.scenes[0].name == "cornell");
  CHECK(m.scenes[0].width == 32);
  CHECK(m.scenes[0].height == 24);
  CHECK(m.scenes[0].reference_samples == 500);
  CHECK(m.scenes[1].reference_samples == 700);
  CHECK(m.scenes[1].set.at("path.max_depth") == "12");
  // The smallest effort first, whatever the order in the file; a scene's own list replaces the common one.
  CHECK(m.budgets(0, 0) == std::vector<double>{16, 64});
  CHECK(m.budgets(0, 1) == std::vector<double>{0.2, 0.1});
  CHECK(m.budgets(1, 0) == std::vector<double>{8});
  CHECK(m.budgets(1, 1) == std::vector<double>{0.2, 0.1});
  CHECK(m.settings[1].set.at("sampling.tile") == "8");
  CHECK(m.settings[1].budget == BudgetKind::errors);
  CHECK(m.budget({0, 1, 1, 0}).text() == "error 10 %");
  CHECK(m.budget({0, 0, 1, 0}).text() == "64 samples");
  CHECK(Budget{BudgetKind::seconds, 2.5}.text() == "2.5 s");
}

TEST_CASE("A matrix is unchanged after write and read") {
  const Matrix m = parse_matrix(k_good, "m.json", k_scenes);
  const auto json = to_json(m);
  CHECK(to_json(parse_matrix(json.dump(), "again", "/")) == json);
}

TEST_CASE("Settings can be points of a curve") {
  const std::string text = with("{\"name\": \"plain\"}",
                                "{\"name\": \"plain\"}, {\"name\": \"a\", \"curve\": \"split sphere\", "
                                "\"set\": {\"cache.error\": 0.5}}");
  const Matrix m = parse_matrix(text, "m.json", k_scenes);
  CHECK(m.settings[0].curve.empty());
  CHECK(m.settings[1].curve == "split sphere");
  const auto json = to_json(m);
  CHECK(json["settings"][1]["curve"] == "split sphere");
  CHECK(parse_matrix(json.dump(), "again", "/").settings[1].curve == "split sphere");
  // The folder of a bench without curves can be continued: its matrix is the same.
  CHECK_FALSE(json["settings"][0].contains("curve"));
}

TEST_CASE("The matrix of the cache compares both metrics, and measures cached light alone") {
  const Matrix m = builtin_matrix("cache", k_scenes);
  std::map<std::string, std::set<std::string>> errors;
  for (const Setting& s : m.settings) {
    if (s.curve.empty()) continue;
    CHECK(s.set.at("components.secondary") == "cache");
    CHECK(s.set.at("components.tertiary") == "cache");
    CHECK(errors[s.set.at("cache.metric")].insert(s.set.at("cache.error")).second);
    CHECK((s.curve == "hessian") == (s.set.at("cache.metric") == "hessian"));
  }
  REQUIRE(errors.size() == 2);
  CHECK(errors["hessian"].size() == 5);
  CHECK(errors["hessian"] == errors["split-sphere"]);
  CHECK(m.set.at("components.primary") == "off");
  CHECK(m.set.at("components.caustic") == "off");
  CHECK(m.scenes.size() == 3);
}

TEST_CASE("The built-in matrices are valid") {
  for (const char* name : {"quick", "full", "cache", "indirect", "caustics", "caustic-pictures", "deep"}) {
    const Matrix m = builtin_matrix(name, k_scenes);
    CHECK(m.name == name);
    CHECK(m.repeats >= 3);
    CHECK(m.settings.front().name == "plain");
    CHECK(m.settings.front().set.empty());
  }
  CHECK(builtin_matrix("quick", k_scenes).scenes.size() == 3);
  const Matrix indirect = builtin_matrix("indirect", k_scenes);
  CHECK(indirect.scenes.size() == 5);
  // The metric for many rays.
  CHECK(indirect.set == SettingValues{{"cache.metric", "hessian"},
                                      {"components.caustic", "off"},
                                      {"components.primary", "off"}});
  CHECK_THROWS_AS(builtin_matrix("slow", k_scenes), Error);
}

TEST_CASE("Cells: each once, settings alternate within a repeat, every second repeat is reversed") {
  const Matrix m = parse_matrix(k_good, "m.json", k_scenes);
  const std::vector<Cell> cells = m.cells();
  REQUIRE(cells.size() == 4 * (2 + 2) + 4 * (1 + 2));
  std::set<std::string> ids;
  for (const Cell& c : cells) ids.insert(m.id(c));
  CHECK(ids.size() == cells.size());
  CHECK(m.id(cells[0]) == "cornell.plain.0.0");
  CHECK(m.id(cells[3]) == "cornell.adaptive.1.0");
  CHECK(m.id(cells[4]) == "cornell.adaptive.1.1");
  CHECK(m.id(cells[7]) == "cornell.plain.0.1");
  for (size_t i = 1; i < cells.size(); ++i) CHECK(cells[i].scene >= cells[i - 1].scene);
}

TEST_CASE("Invalid matrices are refused with the location of the error") {
  refused("{\n  \"name\": \"m\",\n  oops\n}", "m.json", "line 3");
  refused("[1]", "m.json", "expected an object");
  refused(with("\"warmup\"", "\"warm\""), "m.json: ", "unknown key 'warm'");
  refused(with("\"repeats\": 4", "\"repeats\": 0"), "m.json: repeats", "from 1 to 100");
  refused(with("\"repeats\": 4", "\"repeats\": \"x\""), "m.json: repeats", "found \"x\"");
  refused(with("\"repeats\": 4", "\"repeats\": 3.5"), "m.json: repeats", "whole number");
  refused(with("\"seed\": 99", "\"seed\": 12"), "m.json: reference.seed", "seed of a repeat");
  refused(with("[64, 16]", "[64, 0]"), "m.json: budgets.samples[1]", "from 1");
  refused(with("[64, 16]", "[]"), "m.json: budgets.samples", "at least one");
  refused(with("[64, 16]", "[64, 64]"), "m.json: budgets.samples", "twice");
  refused(with("[0.1, 0.2]", "[0]"), "m.json: budgets.errors[0]", "0.0001");
  refused(with("[0.1, 0.2]", "[-0.1]"), "m.json: budgets.errors[0]", "0.0001");
  refused(with("\"path.max_depth\": 8", "\"path.colour\": 8"), "m.json: set",
          "unknown setting 'path.colour'");
  refused(with("\"path.max_depth\": 8", "\"seed\": 8"), "m.json: set", "bench's own affair");
  refused(with("\"path.max_depth\": 8", "\"path.max_depth\": [8]"), "m.json: set", "path.max_depth");
  refused(with("\"sampling.tile\": 8", "\"sampling.tile\": 9"), "m.json: settings[1].set", "8, 16");
  refused(with("cornell/cornell.gltf", "cornell/no.gltf"), "m.json: scenes[0].file", "no.gltf");
  refused(with("\"32x24\"", "\"32\""), "m.json: scenes[0].size", "WIDTHxHEIGHT");
  refused(with("\"32x24\"", "\"4x4\""), "m.json: scenes[0].size", "from 8");
  refused(with("\"ring\"", "\"cornell\""), "m.json: scenes[1].name", "two scenes 'cornell'");
  refused(with("\"ring\"", "\"a/b\""), "m.json: scenes[1].name", "letters, digits");
  refused(with("\"plain\"", "\"adaptive\""), "m.json: settings[1].name", "two settings");
  refused(with("{\"name\": \"plain\"}", "{}"), "m.json: settings[0]", "'name' is missing");
  refused(with("{\"name\": \"plain\"}", "{\"name\": \"plain\", \"budget\": \"errors\"}"),
          "m.json: settings[0].budget", "uniform sampling takes samples");
  refused(with("\"about\": \"tiles\"", "\"budget\": \"samples\""), "m.json: settings[1].budget",
          "adaptive sampling takes errors");
  refused(with(", \"errors\": [0.1, 0.2]", ""), "m.json: scenes[0]",
          "no budgets.errors for the setting 'adaptive'");
  refused(with("\"about\": \"tiles\"", "\"curve\": 3"), "m.json: settings[1].curve", "expected a text");
  refused(with("\"about\": \"tiles\"", "\"curve\": \"\""), "m.json: settings[1].curve", "1 to 40");
  refused(with("\"about\": \"tiles\"", "\"curve\": \"" + std::string(41, 'x') + "\""),
          "m.json: settings[1].curve", "1 to 40");
  refused(with("{\"path.max_depth\": 12}", "{\"sampling.mode\": \"adaptive\"}"), "m.json: scenes[1].set",
          "belongs into settings");
  CHECK_THROWS_WITH(read_matrix("/no/such.json"), Catch::Contains("/no/such.json"));
  CHECK_THROWS_WITH(read_matrix("/tmp"), Catch::Contains("/tmp"));
}

TEST_CASE("Remaining time: from renders of the same kind, otherwise from the scene's speed") {
  const Matrix m = parse_matrix(k_good, "m.json", k_scenes);
  TimeLeft left(m);
  const TimeLeft::Unit small{0, 0, 0}, large{0, 0, 1}, reference{0, TimeLeft::k_reference, 0};
  left.add(reference), left.add(small), left.add(small), left.add(large);
  CHECK(left.units() == 4);
  CHECK_FALSE(left.seconds(reference, 0, 0));
  // Half of 500 samples in 50 s: another 50 s, 3.2 s for each 16 and 12.8 s for 64 samples.
  REQUIRE(left.seconds(reference, 0.5, 50));
  CHECK(*left.seconds(reference, 0.5, 50) == Approx(50 + 2 * 3.2 + 12.8));
  left.finished(reference, 100);
  CHECK(*left.seconds(small, 0, 0) == Approx(2 * 3.2 + 12.8));
  left.finished(small, 5);
  CHECK(*left.seconds(small, 0.2, 1) == Approx(4 + 64.0 * 105 / 516).epsilon(0.01));
}

}  // namespace bench_matrix_tests
