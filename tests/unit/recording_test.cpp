// links: recording
// Recorded paths as data: words, texts, noise by classes against closed forms, queries against brute force,
// files and damaged files.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include "recording/file.h"
#include "recording/noise.h"
#include "recording/query.h"
#include "support/folder.h"

namespace recording_tests {

using namespace lucerna;
using namespace lucerna::recording;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

constexpr uint32_t k_none = shared::k_path_no_event;

Event event(uint32_t kind, uint32_t parent, uint32_t lobe = shared::k_path_by_none, uint32_t component = 15,
            float light = 0, uint32_t material = k_none, uint32_t lamp = k_none) {
  Event e{};
  e.parent = parent;
  e.bits = kind | lobe << shared::k_path_by_shift | component << shared::k_path_component_shift |
           255u << shared::k_path_group_shift;
  e.contribution = vec3(light);
  e.material = material, e.light = lamp, e.primitive = e.record = k_none;
  return e;
}

void add(Recording& all, uint32_t pixel, uint32_t sample, std::vector<Event> events) {
  all.paths.push_back({pixel, sample, uint32_t(all.events.size()), uint32_t(events.size()), 0});
  all.events.insert(all.events.end(), events.begin(), events.end());
}

/// Camera, wall, then a light sample that arrives (or not), then by way of glass to a lamp: E D L and E D S
/// L.
std::vector<Event> usual(float direct, float caustic, bool arrives = true) {
  return {event(shared::k_path_camera, k_none),
          event(shared::k_path_surface, 0, shared::k_path_by_none, 15, 0, 0),
          event(arrives ? shared::k_path_light : shared::k_path_blocked, 1, 0, 0, direct, k_none, 0),
          event(shared::k_path_surface, 1, 0, 15, 0, 1),
          event(shared::k_path_surface, 3, 2, 15, 0, 2),
          event(shared::k_path_emission, 4, shared::k_path_by_none, 3, caustic, 2),
          event(shared::k_path_end, 4)};
}

Recording empty() {
  Recording all;
  all.width = 4, all.height = 2, all.seed = 7, all.scene = "made \"here\"";
  all.materials = {"wall", "glass", "bulb"};
  all.lights = {"Lamp"};
  return all;
}

/// Paths of every kind, at random.
Recording random_recording(uint32_t paths) {
  std::mt19937 random(3);
  Recording all = empty();
  for (uint32_t i = 0; i < paths; ++i) {
    const float a = float(random() % 1000) / 100, b = random() % 5 == 0 ? float(random() % 10000) / 100 : 0;
    std::vector<Event> events = usual(a, b, random() % 3 != 0);
    if (random() % 4 == 0) events.push_back(event(shared::k_path_records, 1, 0, 1, a));
    add(all, i % 8, i / 8, events);
  }
  return all;
}

std::string failure(const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
void write(const fs::path& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

Recording read_all(const fs::path& file) {
  Reader reader(file);
  Recording all = reader.names();
  while (const auto chunk = reader.next())
    for (const Path& path : chunk->paths) {
      Path moved = path;
      moved.first = uint32_t(all.events.size());
      all.paths.push_back(moved);
      const auto events = chunk->events_of(path);
      all.events.insert(all.events.end(), events.begin(), events.end());
    }
  return all;
}

}  // namespace

TEST_CASE("words, light and texts of a path") {
  Recording all = empty();
  add(all, 5, 2, usual(1, 4));
  const auto events = all.events_of(all.paths[0]);
  CHECK(word_of(events, 0) == "E");
  CHECK(word_of(events, 2) == "EDL");
  CHECK(word_of(events, 4) == "EDS");
  CHECK(word_of(events, 5) == "EDSL");
  CHECK(depth_of(events, 5) == 2);
  CHECK(light_of(events)[0][1] == 1);
  CHECK(light_of(events)[3][1] == 4);
  CHECK(luminance_of(events) == Approx(5));
  CHECK(main_component(events) == paths::k_caustic);
  CHECK(path_text(all, 0) == "EDSL caustic 5, 7 events");
  const auto lines = event_lines(all, 0);
  REQUIRE(lines.size() == 7);
  CHECK_THAT(lines[2], Contains("light 'Lamp' arrives") && Contains("contributes primary 1 1 1"));
  CHECK_THAT(lines[5], Contains("emission of 'bulb'"));
  // A blocked light sample contributes nothing; stored light has an open word.
  add(all, 5, 3, usual(9, 0, false));
  all.events.push_back(event(shared::k_path_records, 1, 0, 1, 2));
  ++all.paths[1].count;
  const auto second = all.events_of(all.paths[1]);
  CHECK(luminance_of(second) == Approx(2));
  CHECK(word_of(second, 7) == "ED...L");
  CHECK(by_contribution(all) == std::vector<uint32_t>{0, 1});
  Recording bright = all;
  keep_over(bright, 3);
  REQUIRE(bright.paths.size() == 1);
  CHECK(bright.events.size() == 7);
}

TEST_CASE("parents that are wrong do not make the walk endless") {
  Recording all = empty();
  add(all, 0, 0,
      {event(shared::k_path_camera, 1), event(shared::k_path_surface, 1, 0),
       event(shared::k_path_light, 700, 0, 0, 1)});
  const auto events = all.events_of(all.paths[0]);
  CHECK(word_of(events, 1) == "ED");
  CHECK(word_of(events, 2) == "EDL");
  CHECK(word_of(events, 99) == "E");
}

TEST_CASE("noise by components, words, lights and materials") {
  // Direct light is 1 or 3, caustic light 0 or 8, independently: variances 4/3 and 64/3 of four samples, no
  // covariance.
  Recording all = empty();
  for (const uint32_t pixel : {0u, 6u})
    for (uint32_t s = 0; s < 4; ++s) add(all, pixel, s, usual(s % 2 == 0 ? 1 : 3, s < 2 ? 0 : 8));
  std::vector<double> around(8, 2.0);
  for (size_t i = 4; i < 8; ++i) around[i] = 4;
  const NoiseReport report = analyse_noise(all, around, 1e9);
  CHECK(report.pixels == 2);
  CHECK(report.paths == 8);
  const double total = 4.0 / 3 + 64.0 / 3;
  CHECK(report.of_sample == Approx(std::sqrt(total * (1.0 / 4 + 1.0 / 16) / 2)));
  REQUIRE(report.components.size() == 2);
  CHECK(report.components[0].name == "caustic");
  CHECK(report.components[0].noise == Approx(64.0 / 3 / total));
  CHECK(report.components[0].light == Approx(4.0 / 6));
  CHECK(report.components[1].noise == Approx(4.0 / 3 / total));
  CHECK(report.variance[3] == Approx(64.0 / 3 * (1.0 / 4 + 1.0 / 16) / 2));
  CHECK(report.light[0] == Approx(2.0 / 6));
  CHECK(report.words[0].name == "EDSL");
  CHECK(report.lights[0].name == "bulb");
  CHECK(report.lights[1].name == "Lamp");
  CHECK(report.materials[0].name == "glass");
  CHECK(report.materials[1].name == "wall");
  CHECK_THAT(noise_sentence(report, false), Contains("Caustic light makes 94 % of the noise here") &&
                                                Contains("EDSL") && Contains("'glass'"));
  // Pixels that are not seen do not count; without noise there is no sentence.
  std::vector<double> unseen(8, 0.0);
  CHECK(analyse_noise(all, unseen, 1e9).pixels == 0);
  CHECK(noise_sentence(analyse_noise(all, unseen, 1e9), true).empty());
  // A firefly counts with its bound.
  CHECK(analyse_noise(all, around, 0.5).of_sample == Approx(std::sqrt(0.5)));
}

TEST_CASE("queries against brute force") {
  const Recording all = random_recording(400);
  const auto rows = [&](const std::string& query) {
    const Query q(query);
    size_t n = 0;
    visit_rows(all, [&](const Row& row) { n += q(row) ? 1 : 0; });
    return n;
  };
  const auto brute = [&](const std::function<bool(const Path&, std::span<const Event>, uint32_t)>& f) {
    size_t n = 0;
    for (const Path& path : all.paths)
      for (uint32_t i = 0; i < path.count; ++i)
        if (component_of(all.events[path.first + i]) < 4 && f(path, all.events_of(path), i)) ++n;
    return n;
  };
  const size_t every = brute([](auto&, auto, auto) { return true; });
  CHECK(rows("") == every);
  CHECK(rows("component == caustic and contribution > 5 and material == \"glass\"") ==
        brute([](auto&, auto e, uint32_t i) {
          return component_of(e[i]) == 3 && luminance(e[i].contribution) > 5;
        }));
  CHECK(rows("material == glass") ==
        brute([](auto&, auto e, uint32_t i) { return kind_of(e[i]) == shared::k_path_emission; }));
  CHECK(rows("event == blocked or not event != records") == brute([](auto&, auto e, uint32_t i) {
          return kind_of(e[i]) == shared::k_path_blocked || kind_of(e[i]) == shared::k_path_records;
        }));
  CHECK(rows("x >= 2 and (y == 1 or sample < 3) and light == 'Lamp'") ==
        brute([](auto& p, auto e, uint32_t i) {
          return p.pixel % 4 >= 2 && (p.pixel / 4 == 1 || p.sample < 3) && e[i].light == 0;
        }));
  CHECK(rows("word ~ 'E[SG]*DL'") == brute([](auto&, auto e, uint32_t i) { return word_of(e, i) == "EDL"; }));
  CHECK(rows("word ~ 'ED.*L' and depth == 2") ==
        brute([](auto&, auto e, uint32_t i) { return word_of(e, i) == "EDSL"; }));
  CHECK(rows("not component == caustic") + rows("component == caustic") == every);
  CHECK(rows("contribution > 1e9") == 0);
}

TEST_CASE("queries that cannot be read say where") {
  const auto problem = [](const std::string& text) { return failure([&] { Query q(text); }); };
  CHECK_THAT(problem("colour == 1"),
             Contains("--where: position 1: expected a field: component") && Contains("found 'colour'"));
  CHECK_THAT(problem("x = 1"), Contains("position 3: '==' compares"));
  CHECK_THAT(problem("x == "), Contains("position 6: expected a value, found the end"));
  CHECK_THAT(problem("x == glass"), Contains("position 6: expected a number for x, found 'glass'"));
  CHECK_THAT(problem("component == blue"), Contains("position 14: expected one of primary, secondary"));
  CHECK_THAT(problem("light < 'a'"), Contains("light is a text: expected == or !="));
  CHECK_THAT(problem("light ~ 'EDL'"), Contains("only a word is compared with ~"));
  CHECK_THAT(problem("word ~ 'E[D'"), Contains("position 8: not a path expression"));
  CHECK_THAT(problem("light == 'Lamp"), Contains("position 10: a text without its closing quote"));
  CHECK_THAT(problem("(x == 1 or y == 2"), Contains("position 18: expected ')', found the end"));
  CHECK_THAT(problem("x == 1 y == 2"), Contains("position 8: expected 'and', 'or' or the end, found 'y'"));
  CHECK_THAT(problem("x == 1e999"), Contains("expected a number"));
  CHECK_THAT(problem(std::string(1000, '(')), Contains("too many parentheses"));
}

TEST_CASE("files of recorded paths are read as they were written") {
  const test::Folder folder;
  const fs::path file = folder / "a.lpath";
  const Recording all = random_recording(300);
  {
    Writer writer(file, all, {{"every", 3}});
    Recording part = empty();
    for (size_t i = 0; i < all.paths.size(); ++i) {
      const auto events = all.events_of(all.paths[i]);
      add(part, all.paths[i].pixel, all.paths[i].sample, {events.begin(), events.end()});
      if (part.paths.size() == 128 || i + 1 == all.paths.size()) writer.add(part), part = empty();
    }
    writer.finish();
    CHECK(writer.paths() == 300);
  }
  Reader reader(file);
  CHECK(reader.header().at("every") == 3);
  CHECK(reader.header().at("schema").at("event").at("bytes") == sizeof(Event));
  const Recording back = read_all(file);
  CHECK(back.scene == all.scene);
  CHECK(back.materials == all.materials);
  CHECK(back.lights == all.lights);
  CHECK((back.width == 4 && back.height == 2 && back.seed == 7));
  REQUIRE(back.paths == all.paths);
  CHECK(std::memcmp(back.events.data(), all.events.data(), all.events.size() * sizeof(Event)) == 0);
}

TEST_CASE("damaged, cut and foreign files are refused with their place") {
  const test::Folder folder;
  const fs::path file = folder / "a.lpath", bad = folder / "bad.lpath";
  {
    Writer writer(file, empty());
    const Recording all = random_recording(16);
    writer.add(all);
    writer.finish();
  }
  const std::string good = bytes_of(file);
  const auto problem = [&](const std::string& bytes) {
    write(bad, bytes);
    return failure([&] { read_all(bad); });
  };
  CHECK(problem(good) == "no error");
  CHECK_THAT(failure([&] { Reader r(folder / "none.lpath"); }),
             Contains("none.lpath") && Contains("cannot be opened"));
  CHECK_THAT(failure([&] { Reader r(folder.path); }), Contains("is a folder"));
  CHECK_THAT(problem(""), Contains("bad.lpath: byte 0: not a file of recorded paths"));
  CHECK_THAT(problem("some other file, longer than this"), Contains("byte 0: not a file of recorded paths"));
  std::string newer = good;
  newer[8] = 2;
  CHECK_THAT(problem(newer), Contains("version 2 of the format; this program reads version 1"));
  // Every cut is found, and every changed byte.
  const size_t step = std::max<size_t>(1, good.size() / 97);
  for (size_t at = 0; at < good.size(); at += step) {
    INFO(at);
    CHECK_THAT(problem(good.substr(0, at)), Contains("bad.lpath: byte "));
    std::string changed = good;
    changed[at] = char(changed[at] ^ 0x40);
    CHECK_THAT(problem(changed), Contains("bad.lpath: byte "));
  }
  CHECK_THAT(problem(good.substr(0, good.size() - 40)), Contains("was cut"));
  CHECK_THAT(problem(good + "x"), Contains("1 bytes behind the end"));
  // A damaged number of events does not allocate them.
  std::string many = good;
  const size_t chunk = good.find("CHNK");
  REQUIRE(chunk != std::string::npos);
  many[chunk + 14] = 0x7f;
  CHECK_THAT(problem(many), Contains("bytes are left: it was cut"));
}

}  // namespace recording_tests
