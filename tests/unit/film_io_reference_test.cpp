// links: film_io
// References: refusals and their reasons, and the true error of a synthetic picture.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "film/io/planes.h"
#include "film/io/reference.h"

namespace film_io_reference_tests {

using namespace lucerna;
namespace fs = std::filesystem;

namespace {

constexpr uint32_t k_width = 60, k_height = 40;

struct File {
  fs::path path = fs::temp_directory_path() / ("lucerna-reference-" + std::to_string(getpid()) + ".exr");
  ~File() { fs::remove(path); }
};

film::FilmImage grey(float value) {
  film::FilmImage image;
  image.width = k_width;
  image.height = k_height;
  for (const char* layer : {"", "primary.", "secondary.", "tertiary.", "caustic."})
    for (const char channel : {'R', 'G', 'B'})
      image.channels.emplace_back(std::string(layer) + channel,
                                  std::vector<float>(k_width * k_height, *layer ? value / 4 : value));
  return image;
}

std::string refusal(const film::FilmImage& image, uint32_t width = k_width, uint32_t height = k_height) {
  const File file;
  film::write_exr(file.path, image);
  try {
    film::read_reference(file.path, width, height);
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

bool says(const std::string& message, const std::string& part) {
  INFO(message);
  return message.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("an unsuitable reference is refused with the reason") {
  CHECK(refusal(grey(1)) == "accepted");
  CHECK(says(refusal(grey(1), k_width, k_height + 1), "60x40 pixels, the picture 60x41"));
  for (const char* missing : {"G", "tertiary.B"}) {
    film::FilmImage image = grey(1);
    std::erase_if(image.channels, [&](const auto& c) { return c.first == missing; });
    CHECK(says(refusal(image), std::string("no channel '") + missing + "'"));
  }
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    film::FilmImage image = grey(1);
    image.channels[7].second[k_width * 3 + 5] = bad;  // secondary.G
    CHECK(says(refusal(image), "secondary layer is not finite at x 5 y 3"));
  }
  CHECK(says(refusal(grey(0)), "black"));
  CHECK_THROWS_WITH(film::read_reference("/no/such/reference.exr", 1, 1),
                    Catch::Contains("/no/such/reference.exr"));
}

TEST_CASE("the noise stated in a file is read back; invalid noise counts as none") {
  const film::LayerFigures rms{0.5, 0.1, 0.2, 0.3, 0};
  const File file;
  const auto read_with = [&](const std::string& text) {
    film::FilmImage image = grey(1);
    if (!text.empty()) image.metadata["noise"] = text;
    image.metadata["scene"] = "hall";
    image.metadata["seed"] = "17";
    film::write_exr(file.path, image);
    return film::read_reference(file.path, k_width, k_height);
  };
  const film::Reference reported = read_with(film::noise_text(rms));
  REQUIRE(reported.noise);
  CHECK(*reported.noise == rms);
  CHECK(reported.scene == "hall");
  CHECK(reported.seed == "17");
  CHECK(reported.view.empty());
  CHECK(reported.mean_luminance == Approx(1));
  for (const char* text : {"", "0.5", "{}", "{\"sum\":0.5}", "not json"}) CHECK_FALSE(read_with(text).noise);
  CHECK_FALSE(read_with(film::noise_text({0.5, -1, 0, 0, 0})).noise);
}

TEST_CASE("a reference's own layers are compared by name, their noise taken off") {
  film::FilmImage image = grey(2);
  const size_t pixels = size_t{k_width} * k_height;
  film::add_plane(image, "mirrored.", "RGB", std::vector<vec3>(pixels, vec3(0.5f)));
  film::add_plane(image, "odd.mirrored.", "RGB", std::vector<vec3>(pixels, vec3(0.5f)));
  film::add_plane(image, "albedo.", "RGB", std::vector<vec3>(pixels, vec3(0.5f)));
  const std::pair<std::string, double> own[] = {{"mirrored", 0.3}};
  image.metadata["noise"] = film::noise_text({0, 0, 0, 0, 0}, own);
  const File file;
  film::write_exr(file.path, image);
  const film::Reference reference = film::read_reference(file.path, k_width, k_height);
  REQUIRE(reference.own_layers.size() == 1);
  CHECK(reference.own_layers.at("mirrored").noise == 0.3);
  std::vector<uint32_t> samples(pixels, 4);
  samples[7] = 0;
  std::vector<vec3> there(pixels, vec3(1));
  there[7] = vec3(100);  // not sampled
  // Off by 0.5, of which the reference's noise is 0.3: 0.4, over the mean of 2.
  CHECK(film::true_error(reference, "mirrored", there, samples).value() == Approx(0.2));
  CHECK_FALSE(film::true_error(reference, "near", there, samples));
}

TEST_CASE("the true error is the picture's noise without the reference's own") {
  // Picture = truth + noise of 0.2, reference = truth + noise of 0.15, which it states; both Gaussian, in the
  // primary layer only. 2400 pixels: the root mean square has a relative standard error of 1/sqrt(4800) = 1.4
  // % each, and subtracting the reference's adds to it; 6 % is more than 3 of them.
  std::mt19937 random(4);
  std::normal_distribution<float> gauss;
  film::FilmImage image = grey(2);
  for (size_t i = 0; i < k_width * k_height; ++i) {
    const float noise = 0.15f * gauss(random);
    for (size_t channel : {0u, 1u, 2u, 3u, 4u, 5u}) image.channels[channel].second[i] += noise;
  }
  image.metadata["noise"] = film::noise_text({0.15, 0.15, 0, 0, 0});
  const File file;
  film::write_exr(file.path, image);
  const film::Reference reference = film::read_reference(file.path, k_width, k_height);
  std::array<std::vector<vec3>, 4> components;
  components.fill(std::vector<vec3>(k_width * k_height, vec3(0.5f)));
  std::vector<uint32_t> samples(k_width * k_height, 8);
  for (vec3& p : components[0]) p += 0.2f * gauss(random);
  film::LayerFigures errors = film::true_errors(reference, components, samples);
  CHECK(errors[0] == Approx(0.2 / 2).epsilon(0.06));
  CHECK(errors[1] == Approx(0.2 / 2).epsilon(0.06));
  CHECK(errors[2] == 0);
  CHECK(errors[4] == 0);
  // Pixels without samples are ignored, whatever their values.
  for (size_t i = 0; i < 100; ++i) components[2][i * 7] = vec3(1e6f), samples[i * 7] = 0;
  CHECK(film::true_errors(reference, components, samples)[0] == Approx(0.1).epsilon(0.06));
  // A constant offset is an error that no noise explains.
  for (vec3& p : components[3]) p += 1.0f;
  CHECK(film::true_errors(reference, components, samples)[4] == Approx(0.5).epsilon(0.01));
  // With the same noise as the reference states the error is zero, never negative.
  components.fill(std::vector<vec3>(k_width * k_height, vec3(0.5f)));
  film::Reference noisier = reference;
  (*noisier.noise)[0] = 0.2;
  CHECK(film::true_errors(noisier, components, samples)[0] == 0);
}

}  // namespace film_io_reference_tests
