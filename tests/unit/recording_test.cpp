// links: recording
// Recorded paths as data: words, texts, noise by classes against closed forms, queries against brute force,
// files and damaged files.
#include <fmt/format.h>
#include <sys/stat.h>

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
  CHECK(word_of(second, 7) == "ED (records: [SG]*DL)");
  CHECK(is_open(word_of(second, 7)));
  CHECK_FALSE(is_open(word_of(second, 2)));
  CHECK(by_contribution(all) == std::vector<uint32_t>{0, 1});
  Recording bright = all;
  keep_over(bright, 3);
  REQUIRE(bright.paths.size() == 1);
  CHECK(bright.events.size() == 7);
}

TEST_CASE("what is known of stored light is all that belongs to its component there, and no more") {
  const paths::Automaton automaton = paths::compile_components();
  // All words of up to seven letters.
  std::vector<std::string> ways{""};
  for (size_t begin = 0, length = 0; length < 5; ++length)
    for (const size_t end = ways.size(); begin < end; ++begin)
      for (const char letter : {'D', 'G', 'S'}) ways.push_back(ways[begin] + letter);
  for (const std::string way : {"E", "ES", "ED", "EGSD", "EDD", "EDSGD", "EDDD", "EDDSD"}) {
    const auto diffuse = uint32_t(std::count(way.begin(), way.end(), 'D'));
    for (const uint32_t c : k_components) {
      const std::string rest = rest_of_way(c, diffuse);
      for (const std::string& behind : ways) {
        const bool belongs = automaton.classify(way + behind + "L") == c;
        // The matcher's expressions begin with E.
        const bool said = !rest.empty() && paths::matches("E" + rest, "E" + behind + "L");
        if (belongs != said) FAIL_CHECK(way << " " << behind << "L, component " << c << ", " << rest);
      }
    }
  }
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

namespace {

/// Paths whose events have places in a room of 4 x 4 x 4 m, in chunks of 1000 paths.
Recording placed_recording(const fs::path& file, uint32_t paths) {
  std::mt19937 random(5);
  Recording all = random_recording(paths);
  for (Event& e : all.events)
    for (int k = 0; k < 3; ++k) e.position[k] = float(random() % 4096) / 1024;
  Writer writer(file, all);
  Recording part = empty();
  for (const Path& path : all.paths) {
    const auto events = all.events_of(path);
    add(part, path.pixel, path.sample, {events.begin(), events.end()});
    if (part.paths.size() == 1000) writer.add(part), part = empty();
  }
  writer.add(part);
  writer.finish();
  return all;
}

/// Rows that pass, as text, in the order of the file; and how many paths were read.
std::pair<std::vector<std::string>, size_t> rows_of(const fs::path& file, const Query& query,
                                                    const std::optional<Box>& places) {
  std::vector<std::string> found;
  size_t paths = 0;
  Reader reader(file);
  while (const auto chunk = reader.next(places)) {
    paths += chunk->paths.size();
    visit_rows(*chunk, [&](const Row& row) {
      if (query(row)) found.push_back(fmt::format("{} {} {}", row.path.pixel, row.path.sample, row.event));
    });
  }
  return {found, paths};
}

}  // namespace

TEST_CASE("the place of light is the surface that it lights, or the emitter that is seen directly") {
  Recording all = empty();
  add(all, 0, 0, usual(1, 2));
  for (size_t i = 0; i < all.events.size(); ++i) all.events[i].position = vec3(float(i));
  const auto events = all.events_of(all.paths[0]);
  CHECK(lit_place(events, 2) == vec3(1));  // a light sample at the first surface
  CHECK(lit_place(events, 5) == vec3(3));  // emission of surface 4, received at surface 3
  std::vector<Event> seen{event(shared::k_path_camera, k_none), event(shared::k_path_surface, 0),
                          event(shared::k_path_emission, 1, shared::k_path_by_none, 0, 1)};
  seen[1].position = seen[2].position = vec3(7);
  CHECK(lit_place(seen, 2) == vec3(7));
  // Panes that light passes straight are skipped.
  std::vector<Event> passed{event(shared::k_path_camera, k_none), event(shared::k_path_surface, 0),
                            event(shared::k_path_passed, 1, 0),
                            event(shared::k_path_background, 2, 15, 0, 1)};
  passed[1].position = vec3(3), passed[2].position = vec3(4), passed[3].position = vec3(100);
  CHECK(lit_place(passed, 3) == vec3(3));
  // Damaged parents end the walk.
  CHECK(lit_place(std::vector<Event>{event(shared::k_path_light, 9)}, 0) == vec3(0));
  CHECK(rays_of(events) == 4);
}

TEST_CASE("a path's time is that of its rays, and is kept in files") {
  const std::vector<Event> path{event(shared::k_path_camera, k_none), event(shared::k_path_surface, 0),
                                event(shared::k_path_light, 1),       event(shared::k_path_blocked, 1),
                                event(shared::k_path_passed, 1),      event(shared::k_path_end, 4)};
  CHECK(time_of(path, {.surface = 2, .light = 0.5}) == 2 * 2 + 2 * 0.5);
  CHECK(time_of(path, {}) == 0);
  const test::Folder folder;
  for (const bool measured : {false, true}) {
    Recording names = empty();
    if (measured) names.times = {.surface = 2.25, .light = 0.5};
    Writer writer(folder / "a.lpath", names);
    writer.finish();
    const Recording back = Reader(folder / "a.lpath").names();
    CHECK(back.times.measured() == measured);
    CHECK(back.times.surface == names.times.surface);
    CHECK(back.times.light == names.times.light);
  }
}

TEST_CASE("a search in a part of the scene finds the same rows and reads few paths") {
  const test::Folder folder;
  const fs::path file = folder / "a.lpath";
  const Recording all = placed_recording(file, 2000);
  size_t every = 0;
  double light = 0;
  visit_rows(all, [&](const Row& row) {
    ++every;
    if (contributes_light(row.at())) light += double(luminance(row.at().contribution));
  });
  struct Case {
    const char* query;
    bool bounded;
    std::function<bool(const vec3&)> brute;
  };
  const Case cases[] = {
      {"lit_x < 0.5 and lit_y >= 3 and lit_z < 1", true,
       [](const vec3& p) { return p.x < 0.5f && p.y >= 3 && p.z < 1; }},
      {"(lit_x <= 0.25 and lit_y < 1) or (lit_x == 0.5 and lit_y < 1)", true,
       [](const vec3& p) { return p.y < 1 && (p.x <= 0.25f || p.x == 0.5f); }},
      {"lit_x > 1 and lit_x < 1", true, [](const vec3&) { return false; }},
      {"lit_x > 3.5 or lit_y > 3.5", false, [](const vec3& p) { return p.x > 3.5f || p.y > 3.5f; }},
      {"not lit_x > 1", false, [](const vec3& p) { return !(p.x > 1); }},
      {"lit_x != 2", false, [](const vec3& p) { return p.x != 2; }}};
  for (const Case& c : cases) {
    INFO(c.query);
    const Query query(c.query);
    CHECK(query.places().has_value() == c.bounded);
    const auto [found, read] = rows_of(file, query, query.places());
    std::vector<std::string> expected;
    visit_rows(all, [&](const Row& row) {
      if (c.brute(lit_place(row.of.events_of(row.path), row.event)))
        expected.push_back(fmt::format("{} {} {}", row.path.pixel, row.path.sample, row.event));
    });
    CHECK(found == expected);
    CHECK(rows_of(file, query, {}).first == expected);
    if (&c == cases) CHECK(read < 500);
    if (!c.bounded) CHECK(read == 2000);
  }
  Reader reader(file);
  while (reader.next(Box{vec3(9), vec3(10)})) continue;
  CHECK(reader.paths() == 2000);
  CHECK(reader.rows() == every);
  CHECK(reader.light() == Approx(light));
}

TEST_CASE("damage is found where a search in a part of the scene reads") {
  const test::Folder folder;
  const fs::path file = folder / "a.lpath";
  placed_recording(file, 300);
  const std::string good = bytes_of(file);
  const Query query("lit_x < 4 and lit_x > -1");  // everywhere
  const auto problem = [&](const std::string& bytes) {
    write(folder / "bad.lpath", bytes);
    return failure([&] { rows_of(folder / "bad.lpath", query, query.places()); });
  };
  CHECK(problem(good) == "no error");
  const size_t step = std::max<size_t>(1, good.size() / 97);
  for (size_t at = good.find("CHNK"); at < good.size(); at += step) {
    INFO(at);
    CHECK_THAT(problem(good.substr(0, at)), Contains("bad.lpath: byte "));
    std::string changed = good;
    changed[at] = char(changed[at] ^ 0x40);
    const std::string found = problem(changed);
    // Paths without light are not read.
    if (found != "no error") CHECK_THAT(found, Contains("bad.lpath: byte "));
  }
  std::string many = good;
  many[good.find("TREE") + 14] = 0x7f;
  CHECK_THAT(problem(many), Contains("bytes are left: it was cut"));
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
  REQUIRE(mkfifo((folder / "pipe.lpath").c_str(), 0600) == 0);
  CHECK_THAT(failure([&] { Reader r(folder / "pipe.lpath"); }), Contains("is a pipe or a device"));
  CHECK_THAT(problem(""), Contains("bad.lpath: byte 0: not a file of recorded paths"));
  CHECK_THAT(problem("some other file, longer than this"), Contains("byte 0: not a file of recorded paths"));
  std::string newer = good;
  newer[8] = 3;
  CHECK_THAT(problem(newer), Contains("version 3 of the format; this program reads version 2"));
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
