// links: session film_io
// The image is a function of scene, settings and seed; it does not depend on threads, time slices or
// cancelled work.
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "support/render.h"

namespace determinism_tests {

using namespace lucerna;

namespace {

std::string scene_file(const std::string& name) {
  return std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + name + "/" + name + ".gltf";
}

film::FilmImage render_with(const std::string& environment, const std::string& tracer,
                            const std::string& scene = "glass") {
  const auto file =
      std::filesystem::temp_directory_path() / ("lucerna-threads-" + std::to_string(getpid()) + ".exr");
  const std::string command = environment + " " + LUCERNA_BINARY + " render " + scene_file(scene) +
                              " --device cpu --size 48x40 --samples 8 --quiet --set tracer=" + tracer +
                              " -o " + file.string();
  INFO(command);
  REQUIRE(std::system(command.c_str()) == 0);
  film::FilmImage image = film::read_exr(file);
  std::filesystem::remove(file);
  return image;
}

bool identical(const film::FilmImage& a, const film::FilmImage& b) {
  if (a.channels.size() != b.channels.size()) return false;
  for (size_t c = 0; c < a.channels.size(); ++c) {
    const auto& x = a.channels[c].second;
    const auto& y = b.channels[c].second;
    if (x.size() != y.size() || std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) != 0) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("bit-identical for any number of threads, of the device and of the host tracer") {
  for (const char* tracer : {"host", "compute-bvh"}) {
    INFO(tracer);
    const film::FilmImage usual = render_with("", tracer);
    CHECK(usual.channels.size() > 15);
    CHECK(identical(usual, render_with("LP_NUM_THREADS=1 taskset -c 0", tracer)));
    CHECK(identical(usual, render_with("LP_NUM_THREADS=7", tracer)));
    const std::string adaptive = std::string(tracer) + " --error 0.3 --set sampling.min_samples=8";
    CHECK(identical(render_with("", adaptive), render_with("LP_NUM_THREADS=7", adaptive)));
  }
}

TEST_CASE("bit-identical for any previous content of memory") {
  // glibc fills allocated memory with the complement of the byte; lavapipe allocates device memory with it.
  // Scenes without glossy, emissive or refracting surfaces have separate kernels, which skip fields that
  // nothing reads.
  for (const char* scene : {"cornell", "glass", "studio", "furnace-open", "furnace-disk"})
    for (const char* tracer : {"host", "compute-bvh --error 0.3 --set sampling.min_samples=8"}) {
      INFO(scene << ' ' << tracer);
      CHECK(identical(render_with("MALLOC_PERTURB_=1", tracer, scene),
                      render_with("MALLOC_PERTURB_=165", tracer, scene)));
    }
}

TEST_CASE("bit-identical for any time slices: work cancelled between bounces is repeated") {
  session::Renderer r(test::renderer_options(true));
  r.settings().set("path.batch", "1024");
  r.set_size(40, 36);
  r.load(scene_file("glass"));
  const std::string mode = GENERATE("uniform", "adaptive", "balanced");
  CAPTURE(mode);
  r.settings().set("sampling.mode", mode);
  r.settings().set("samples", mode == "balanced" ? "24" : "8");
  r.settings().set("sampling.min_samples", "8");
  r.settings().set("sampling.max_samples", "32");
  r.settings().set("sampling.target_error", "0.3");
  r.apply_settings();
  while (r.step()) {
  }
  const film::FilmImage whole = r.output().film_image();
  r.restart();
  // Two attempts in three are cancelled, after 0 to 3 bounces.
  uint32_t attempts = 0, cancelled = 0;
  while (!r.done()) {
    uint32_t patience = ++attempts * 2654435761u >> 30;
    cancelled += !r.step([&] { return attempts % 3 != 0 && patience-- == 0; });
    REQUIRE(attempts < 10000);
  }
  CHECK(cancelled > 10);
  CHECK(identical(whole, r.output().film_image()));
}

TEST_CASE("memory of paths in flight does not grow with the picture") {
  const auto peak = [](uint32_t side) {
    session::Renderer r(test::renderer_options(false));
    r.settings().set("path.batch", "65536");
    r.set_size(side, side);
    r.load(scene_file("cornell"));
    r.settings().set("samples", "1");
    r.apply_settings();
    while (r.step()) {
    }
    return r.device().peak_bytes();
  };
  const uint64_t small = peak(64), large = peak(512);
  // The film: 4 components of 48 bytes, albedo and normal of 16, a count and a picture of 4, plus a sixteenth
  // of that for the coarse level.
  const double per_pixel = 4 * 48 + 2 * 16 + 2 * 4, more = 512.0 * 512 - 64.0 * 64;
  CHECK(double(large - small) < 1.1 * per_pixel * (1 + 1.0 / 16) * more);
  CHECK(double(large - small) > 0.9 * per_pixel * more);
}

}  // namespace determinism_tests
