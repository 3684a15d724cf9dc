#pragma once
// For tests that open a window: a display (xvfb-run starts one if there is none), and checks of the drawn
// window.
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/file.h"
#include "base/math.h"
#include "film/io/image_file.h"
#include "support/folder.h"

namespace lucerna::test {

/// A file for the display's authority. xvfb-run sometimes fails to remove the folder of its own file, and
/// then returns an exit status of its own.
inline const std::string& authority() {
  struct File {
    std::string path =
        (std::filesystem::temp_directory_path() / ("lucerna-xauthority-" + std::to_string(getpid())))
            .string();
    ~File() {
      std::error_code error;
      std::filesystem::remove(path, error);
    }
  };
  static const File file;
  return file.path;
}

/// A command line that runs `command` with a display, or "" if neither a display nor xvfb-run exists.
inline std::string with_display(const std::string& command) {
  const char* display = std::getenv("DISPLAY");
  if (display && *display) return command;
  if (std::system("command -v xvfb-run >/dev/null 2>&1") != 0) return "";
  // Different first display numbers, so concurrent tests do not race for one.
  return "xvfb-run -a -n " + std::to_string(100 + getpid() % 20000) + " -f " + authority() +
         " -s '-screen 0 1600x1000x24 -noreset' " + command;
}

/// Warns if a test is skipped because no window can be opened.
inline bool no_display() {
  if (!with_display("x").empty()) return false;
  WARN("skipped: neither a display nor xvfb-run");
  return true;
}
/// Warns if a test is skipped because there is no program either.
inline bool no_program() {
  if (std::filesystem::exists(LUCERNA_BINARY)) return no_display();
  WARN("skipped: the program is not built");
  return true;
}

struct Outcome {
  int status = -1;
  std::string output;
};

/// Runs through the shell; returns standard output and error together. The limit of ten minutes ends programs
/// that hang, and is far above the minute or two that compiling all shaders beside other tests can take.
inline Outcome run(const std::string& command) {
  Outcome outcome;
  FILE* pipe = popen(("timeout 600 " + command + " 2>&1").c_str(), "r");
  if (!pipe) return outcome;
  std::array<char, 4096> block;
  size_t n = 0;
  while ((n = std::fread(block.data(), 1, block.size(), pipe)) > 0) outcome.output.append(block.data(), n);
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  return outcome;
}

/// A file with these steps, valid until the next call.
inline std::string script_of(const std::string& steps) {
  static const Folder folder;
  const auto script = folder.path / "steps.txt";
  std::ofstream(script) << steps;
  return script.string();
}

/// Runs the steps in a window of the test program itself, in its test case '[inside]' (inside.h);
/// `environment`: NAME=value, for the shell.
inline Outcome window(const std::string& steps, const std::string& environment = "") {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  return run("env LUCERNA_TEST_SCRIPT='" + script_of(steps) + "' " + environment + " " +
             with_display(self + " '[inside]'"));
}

/// Runs the steps in a window of the program with `arguments`.
inline Outcome program(const std::string& arguments, const std::string& steps) {
  return run(with_display(std::string(LUCERNA_BINARY) + " " + arguments + " --script " + script_of(steps)));
}

/// A PNG of the window as numbers 0..1 (encoded values).
struct Picture {
  film::FilmImage image;
  explicit Picture(const std::filesystem::path& file) : image(film::read_exr(file)) {}
  vec3 at(uint32_t x, uint32_t y) const {
    const size_t i = size_t{y} * image.width + x;
    return {image.channels[0].second[i], image.channels[1].second[i], image.channels[2].second[i]};
  }
  /// Standard deviation of the luminance in a rectangle.
  double contrast(uint32_t x0, uint32_t y0, uint32_t x1, uint32_t y1) const {
    double sum = 0, squares = 0, n = 0;
    for (uint32_t y = y0; y < y1; ++y)
      for (uint32_t x = x0; x < x1; ++x) {
        const double v = luminance(at(x, y));
        sum += v, squares += v * v, ++n;
      }
    return n > 0 ? std::sqrt(std::max(0.0, squares / n - sum / n * (sum / n))) : 0;
  }
};

/// The number of pixels of a rectangle near a colour (0..255).
inline int near_colour(const Picture& p, int x0, int y0, int x1, int y1, vec3 colour, float reach = 0.06f) {
  int n = 0;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const vec3 d = glm::abs(p.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y)) - colour / 255.0f);
      n += std::max({d.x, d.y, d.z}) < reach;
    }
  return n;
}

}  // namespace lucerna::test
