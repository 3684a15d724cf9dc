// links: bench
// The report folder and its references: what is continued, refused or measured again. No file of the user is
// overwritten.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "bench/folder.h"
#include "bench/reference.h"
#include "film/io/image_file.h"
#include "unit/bench_support.h"

namespace bench_folder_tests {

namespace fs = std::filesystem;
using namespace lucerna;
using namespace lucerna::bench;
using Catch::Contains;

namespace {

const nlohmann::ordered_json k_identity = {{"version", "1"}, {"device", "one"}};

struct Reported {
  std::vector<std::string> lines;
  Message message = [this](const std::string& line) { lines.push_back(line); };
};

}  // namespace

TEST_CASE("A result is unchanged after write and read, bit for bit") {
  const Matrix m = test::small_matrix();
  Result r = test::fake_result(m, m.cells()[3], 0.3, 7.7);
  r.records = 1234, r.record_rays = 5'000'000'000;
  auto json = to_json(r);
  CHECK(to_json(parse_result(json.dump(), "x")) == json);
  CHECK(parse_result(json.dump(), "x").records == 1234);
  CHECK(parse_result(json.dump(), "x").record_rays == 5'000'000'000);
  Result without = r;
  without.forecast.reset();
  CHECK_FALSE(parse_result(to_json(without).dump(), "x").forecast);
  // Files from before records were counted have none; a wrong number of records is an error anyway.
  json.erase("records"), json.erase("record_rays");
  CHECK(parse_result(json.dump(), "x").records == 0);
  CHECK(parse_result(json.dump(), "x").record_rays == 0);
  json["records"] = "many";
  CHECK_THROWS_WITH(parse_result(json.dump(), "x"), Contains("records"));
}

TEST_CASE("A partial or invalid result is distinguished from a complete one") {
  const Matrix m = test::small_matrix();
  const std::string whole = to_json(test::fake_result(m, m.cells()[0], 0.3, 7.7)).dump();
  for (size_t length = 0; length < whole.size(); length += 97)
    CHECK_THROWS_AS(parse_result(whole.substr(0, length), "x"), Error);
  const auto without = [&](const char* key) {
    auto j = nlohmann::ordered_json::parse(whole);
    j.erase(key);
    return j.dump();
  };
  for (const char* key : {"scene", "wall_s", "true", "curve", "tiles_decile"})
    CHECK_THROWS_WITH(parse_result(without(key), "x"), Contains(key));
  auto j = nlohmann::ordered_json::parse(whole);
  j["wall_s"] = nullptr;  // JSON has no NaN, so it is written as null
  CHECK_THROWS_WITH(parse_result(j.dump(), "x"), Contains("wall_s"));
  j = nlohmann::ordered_json::parse(whole);
  j["curve"][1]["wall_s"] = 0;
  CHECK_THROWS_WITH(parse_result(j.dump(), "x"), Contains("forward"));
}

TEST_CASE("A bench keeps the complete cells and measures the others again") {
  const test::Folder temporary;
  const Matrix m = test::small_matrix();
  const auto cells = m.cells();
  const std::map<std::string, std::string> hashes = {{"cornell", "0123456789abcdef"},
                                                     {"glass", "0123456789abcdef"}};
  {
    const Folder folder(temporary / "r", m, k_identity);
    for (size_t i = 0; i < 6; ++i) folder.save(m.id(cells[i]), test::fake_result(m, cells[i], 0.3, 7));
  }
  const Folder folder(temporary / "r", m, k_identity);
  Reported reported;
  CHECK(folder.load(m, hashes, reported.message).size() == 6);
  CHECK(reported.lines.empty());
  // Half a file, and the file of another cell.
  const auto file = [&](size_t i) { return temporary / ("r/cells/" + m.id(cells[i]) + ".json"); };
  const std::string whole = read_file(file(0));
  std::ofstream(file(0)) << whole.substr(0, whole.size() / 2);
  std::ofstream(file(1)) << whole;
  const auto results = folder.load(m, hashes, reported.message);
  CHECK(results.size() == 4);
  CHECK_FALSE(results.contains(m.id(cells[0])));
  REQUIRE(reported.lines.size() == 2);
  CHECK_THAT(reported.lines[0],
             Contains(m.id(cells[0])) && Contains("half a file") && Contains("measured again"));
  CHECK_THAT(reported.lines[1], Contains("another cell"));
  // The scene's files have changed since.
  reported.lines.clear();
  CHECK(folder.load(m, {{"cornell", "new"}, {"glass", "0123456789abcdef"}}, reported.message).empty());
  CHECK_THAT(reported.lines.back(), Contains("the scene has changed"));
  for (const auto& entry : fs::directory_iterator(temporary / "r/cells"))
    CHECK(entry.path().extension() == ".json");
}

TEST_CASE("The folder of another bench is refused and stays unchanged") {
  const test::Folder temporary;
  const Matrix m = test::small_matrix();
  { const Folder folder(temporary / "mine", m, k_identity); }
  Matrix other = m;
  other.scenes[0].width = 32;
  const auto refused = [&](const fs::path& path, const Matrix& matrix, const nlohmann::ordered_json& identity,
                           const std::string& expected) {
    CHECK_THROWS_WITH(Folder(path, matrix, identity), Contains(expected) && Contains(path.string()));
  };
  refused(temporary / "mine", other, k_identity, "another matrix (it differs at scenes/0/size)");
  refused(temporary / "mine", m, {{"version", "1"}, {"device", "two"}}, "device was one, now it is two");
  fs::create_directories(temporary / "theirs");
  std::ofstream(temporary / "theirs/letter.txt") << "dear";
  refused(temporary / "theirs", m, k_identity, "holds 'letter.txt', which no bench made");
  CHECK(read_file(temporary / "theirs/letter.txt") == "dear");
  CHECK(std::distance(fs::directory_iterator(temporary / "theirs"), {}) == 1);
  std::ofstream(temporary / "file") << "x";
  refused(temporary / "file", m, k_identity, "is a file");
  refused(temporary / "file/r", m, k_identity, "cannot be made");
  refused("/proc/nothing", m, k_identity, "cannot be made");
  std::ofstream(temporary / "theirs/bench.json") << "{";
  refused(temporary / "theirs", m, k_identity, "is not a bench's");
  const Folder first(temporary / "mine", m, k_identity);
  refused(temporary / "mine", m, k_identity, "another bench is at work");
}

TEST_CASE("The scene's hash includes every file of the scene") {
  const test::Folder temporary;
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(temporary / name) << text;
  };
  write("s.gltf", R"({"buffers": [{"uri": "a%20b.bin"}], "images": [{"uri": "t.png"}, {"uri": "data:x"}]})");
  write("a b.bin", "one"), write("t.png", "two"), write("sky.hdr", "three"), write("other.txt", "four");
  write("settings.json", R"({"environment": {"file": "sky.hdr"}})");
  const auto hash = [&] { return scene_hash(temporary / "s.gltf"); };
  std::string before = hash();
  CHECK(before.size() == 16);
  CHECK(before == hash());
  write("other.txt", "4");
  CHECK(before == hash());
  for (const char* name : {"a b.bin", "t.png", "sky.hdr", "settings.json", "s.gltf"}) {
    INFO(name);
    write(name, read_file(temporary / name) + " ");
    CHECK(before != hash());
    before = hash();
  }
  fs::remove(temporary / "t.png");
  CHECK(before != hash());
  CHECK_THROWS_AS(scene_hash(temporary / "no.gltf"), Error);
}

TEST_CASE("A reference is used if it is complete and from the same inputs; otherwise it is moved aside") {
  const test::Folder temporary;
  Matrix m = test::small_matrix();
  SceneEntry scene = m.scenes[0];
  scene.reference_samples = 100;
  const std::string key = reference_key(m, scene, "hash");
  const auto write = [&](const std::string& with_key, uint32_t samples, float value, uint32_t width = 16,
                         bool halves = true) {
    film::FilmImage image{.width = width, .height = 16};
    for (const char* layer : {"", "primary.", "secondary.", "tertiary.", "caustic."})
      for (const char* c : {"R", "G", "B"})
        image.channels.emplace_back(layer + std::string(c), std::vector<float>(16 * width, value));
    for (const char* c : {"odd.R", "odd.G", "odd.B"})
      if (halves) image.channels.emplace_back(c, std::vector<float>(16 * width, value + 1));
    image.channels.emplace_back("samples", std::vector<float>(16 * width, float(samples)));
    describe_reference(image.metadata, {.file = {}, .key = with_key, .samples = samples, .seconds = 12});
    image.metadata["noise"] = film::noise_text({0.1, 0.1, 0.1, 0.1, 0.1});
    film::write_exr(reference_file(temporary.path, scene), image);
  };
  Reported reported;
  const auto find = [&] { return find_reference(temporary.path, scene, key, reported.message); };
  CHECK_FALSE(find());
  CHECK(reported.lines.empty());
  write(key, 128, 2);
  const auto found = find();
  REQUIRE(found);
  CHECK(found->samples == 128);
  CHECK(found->noise[0] == Approx(0.05));
  // Halves that differ by 2: their variance is 2 everywhere, over a mean of 2 squared.
  CHECK(found->relmse_noise == Approx(2 / 4.01 / std::sqrt(3) / 16));
  CHECK(reported.lines.empty());

  int old = 0;
  const auto set_aside = [&](const std::string& why) {
    INFO(why);
    CHECK_FALSE(find());
    REQUIRE(reported.lines.size() == size_t(++old));
    CHECK_THAT(reported.lines.back(), Contains(why) && Contains("rendered again"));
    CHECK_FALSE(fs::exists(reference_file(temporary.path, scene)));
    CHECK(fs::exists(reference_file(temporary.path, scene).string() +
                     (old == 1 ? ".old" : ".old" + std::to_string(old))));
  };
  write("of something else", 128, 2);
  set_aside("another scene");
  write(key, 64, 2);
  set_aside("has 64 samples instead of 100");
  write(key, 128, NAN);
  set_aside("not finite");
  write(key, 128, 2, 24);
  set_aside("24x16");
  write("", 128, 2);
  set_aside("no reference of a bench");
  write(key, 128, 2, 16, false);
  set_aside("no channel 'odd.R'");
  write(key, 128, 2);
  const std::string bytes = read_file(reference_file(temporary.path, scene));
  std::ofstream(reference_file(temporary.path, scene)) << bytes.substr(0, bytes.size() / 2);
  set_aside("cornell-16x16.exr");

  // Inputs that change the picture change the key.
  CHECK(reference_key(m, scene, "other") != key);
  SceneEntry changed = scene;
  changed.set["path.max_depth"] = "3";
  CHECK(reference_key(m, changed, "hash") != key);
  changed.set = scene.set;
  changed.set["cache.noise"] = "0.3";  // references use no cache
  CHECK(reference_key(m, changed, "hash") == key);
  changed.set["path.max_depth"] = "3";
  m.set["path.max_depth"] = "3";
  CHECK(reference_key(m, scene, "hash") == reference_key(m, changed, "hash"));
  CHECK(reference_key(m, scene, "hash") != key);
}

}  // namespace bench_folder_tests
