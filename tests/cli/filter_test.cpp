// links: film_io
// lucerna render --filter: the filtered picture beside the samples, which stay unchanged.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "film/io/image_file.h"
#include "support/folder.h"
#include "support/run.h"

namespace filter_tests {

using namespace lucerna;
using Catch::Contains;
using test::Run;

namespace {

Run render(const test::Folder& folder, const std::string& name, const std::string& more, int samples = 16,
           const std::string& size = "48x40") {
  const std::string at = folder.path.string() + "/" + name;
  return test::run("render '" + std::string(LUCERNA_SOURCE_DIR) +
                   "/scenes/cornell/cornell.gltf' --quiet --size " + size + " --samples " +
                   std::to_string(samples) + " -o " + at + ".exr -o " + at + ".png --stats " + at + ".json " +
                   more);
}

nlohmann::json figures(const test::Folder& folder, const std::string& name) {
  std::ifstream in(folder / (name + ".json"));
  return nlohmann::json::parse(in);
}

double mean_square(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::pow(double{a[i]} - double{b[i]}, 2);
  return sum / double(a.size());
}

}  // namespace

TEST_CASE("--filter: layers beside the samples, a picture without noise, and its error") {
  const test::Folder f;
  // In smaller pictures the reported error is mostly that of a few pixels at the lamp's edges.
  const std::string size = "96x80";
  REQUIRE(render(f, "plain", "", 16, size).status == 0);
  REQUIRE(render(f, "truth", "--seed 9", 1024, size).status == 0);
  for (const char* name : {"a", "b"}) {
    const Run r = render(f, name, "--filter", 16, size);
    INFO(r.out);
    REQUIRE(r.status == 0);
  }
  const film::FilmImage plain = film::read_exr(f / "plain.exr"), a = film::read_exr(f / "a.exr"),
                        b = film::read_exr(f / "b.exr"), truth = film::read_exr(f / "truth.exr");
  // Existing layers are unchanged bit for bit; new ones are reproducible.
  for (const auto& [name, values] : plain.channels) {
    INFO(name);
    CHECK(*a.find(name) == values);
  }
  CHECK(a.channels == b.channels);
  CHECK(a.channels.size() == plain.channels.size() + 3 * 5 + 1);
  for (const char k : {'R', 'G', 'B'}) {
    const auto channel = [&](const std::string& layer) { return *a.find(layer + k); };
    const std::vector<float> sum = channel("filtered.");
    std::vector<float> of_components(sum.size(), 0);
    for (const char* c : {"primary", "secondary", "tertiary", "caustic"})
      for (size_t i = 0; i < sum.size(); ++i)
        of_components[i] += channel("filtered." + std::string(c) + ".")[i];
    CHECK(sum == of_components);
    // By component: in the sum the edges of the directly visible lamp are most of the difference.
    for (const char* c : {"secondary.", "tertiary."}) {
      const std::vector<float> converged = *truth.find(c + std::string(1, k));
      const double before = mean_square(channel(c), converged);
      CHECK(mean_square(channel(std::string("filtered.") + c), converged) < before / 3);
    }
  }
  CHECK_THAT(a.metadata.at("filter"), Contains("filtered; estimated error"));
  CHECK(plain.metadata.count("filter") == 0);
  CHECK_THAT(film::read_metadata(f / "a.png").at("filter"), Contains("filtered"));
  CHECK(film::read_metadata(f / "plain.png").count("filter") == 0);
  CHECK(film::read_exr(f / "a.png").channels != film::read_exr(f / "plain.png").channels);
  const nlohmann::json with = figures(f, "a"), without = figures(f, "plain");
  CHECK_FALSE(without.contains("filtered"));
  CHECK(with["error"] == without["error"]);
  const double reported = with["filtered"]["of_mean"], before = with["error"]["of_mean"];
  CHECK(reported > 0);
  CHECK(reported < 0.7 * before);
}

TEST_CASE("--filter: one sample per pixel has no noise estimate") {
  const test::Folder f;
  const Run r = render(f, "a", "--filter", 1);
  CHECK(r.status == 0);
  CHECK_THAT(r.out, Contains("--filter: pixels with fewer than two samples stay unfiltered"));
  const film::FilmImage a = film::read_exr(f / "a.exr");
  for (const char* k : {"R", "G", "B"}) CHECK(*a.find("filtered." + std::string(k)) == *a.find(k));
}

TEST_CASE("--filter --error: the render ends when the filtered picture's error is at the target") {
  const test::Folder f;
  const int most = 4096;
  std::vector<double> samples;
  for (const auto& [name, target] : {std::pair("rough", 0.2), {"fine", 0.05}, {"again", 0.05}}) {
    const Run r = render(f, name, "--filter --error " + std::to_string(target), most);
    INFO(r.out);
    REQUIRE(r.status == 0);
    const nlohmann::json j = figures(f, name);
    CHECK(j["filtered"]["of_mean"] <= target);
    CHECK(j["filtered"]["of_mean"] < j["error"]["of_mean"]);
    CHECK(j["samples"] < most);
    CHECK(j["filtered"]["target_error"] == target);
    CHECK(j["filtered"]["reached"] == true);
    samples.push_back(j["samples"]);
  }
  CHECK(samples[0] < samples[1]);
  CHECK(film::read_exr(f / "fine.exr").channels == film::read_exr(f / "again.exr").channels);

  const Run r = render(f, "capped", "--filter --error 0.0001");
  CHECK(r.status == 0);
  CHECK_THAT(r.out, Contains("after 16 samples, over the error of 0.0001") && Contains("--samples N"));
  CHECK(figures(f, "capped")["samples"] == 16);
  CHECK(figures(f, "capped")["filtered"]["reached"] == false);
  CHECK(figures(f, "capped")["filtered"]["of_mean"] > 0.0001);
}

}  // namespace filter_tests
