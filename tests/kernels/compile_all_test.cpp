// links: gpu upload
// Every kernel compiles in the smallest and in the largest variant that the host can request; no variant
// tests a macro before its definition.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>
#include <regex>
#include <set>
#include <sstream>

#include "gpu/kernel.h"
#include "upload/device_scene.h"

namespace compile_all_tests {

using namespace lucerna;
namespace fs = std::filesystem;

namespace {

const fs::path& root() {
  static const fs::path path = fs::path(LUCERNA_SOURCE_DIR) / "shaders";
  return path;
}
std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}
std::vector<fs::path> files(std::initializer_list<const char*> extensions) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(root()))
    for (const char* extension : extensions)
      if (entry.path().extension() == extension) found.push_back(entry.path());
  return found;
}
std::vector<std::string> kernels() {
  std::vector<std::string> names;
  for (const fs::path& file : files({".comp"})) names.push_back(fs::relative(file, root()).string());
  return names;
}

/// Macros for which lib/variants.glsl defines a 0 if the host omits them.
std::vector<std::string> variants() {
  static const std::regex line("#ifndef (LUCERNA_\\w+)\n#define \\1 0\n#endif\n");
  const std::string text = text_of(root() / "lib/variants.glsl");
  std::vector<std::string> names;
  for (std::sregex_iterator m(text.begin(), text.end(), line), end; m != end; ++m)
    names.push_back((*m)[1].str());
  return names;
}

/// Values that the host defines with them in all variants; they are read only where a variant needs them.
gpu::Defines values() {
  gpu::Defines defines{{"LUCERNA_CACHE_PARTS", "15u"}};
  for (const char* use : {"BASE", "METALLIC_ROUGHNESS", "NORMAL", "EMISSION", "SPECULAR", "SPECULAR_COLOR",
                          "TRANSMISSION", "DIFFUSE_T", "DIFFUSE_T_COLOR", "CLEARCOAT", "CLEARCOAT_ROUGHNESS",
                          "CLEARCOAT_NORMAL", "SHEEN_COLOR", "SHEEN_ROUGHNESS", "ANISOTROPY", "IRIDESCENCE",
                          "IRIDESCENCE_THICKNESS", "DIFFUSE_ROUGHNESS", "HEIGHT"})
    defines[std::string("LUCERNA_") + use + "_BUCKETS"] = "63u";
  return defines;
}
std::string full(const std::string& variant) {
  if (variant == "LUCERNA_BUCKETS") return "6";
  if (variant == "LUCERNA_COHERENT") return "4";
  if (variant == "LUCERNA_LIGHT_GROUPS") return "8";
  if (variant == "LUCERNA_NEIGHBOURS") return "27";
  return "1";
}

}  // namespace

TEST_CASE("every kernel compiles with no feature and with every feature") {
  gpu::ShaderCompiler compiler(root());
  compiler.set_cache(false);
  CHECK(kernels().size() > 50);
  for (const std::string& file : kernels())
    for (const bool on : {false, true}) {
      gpu::Defines defines = values();
      if (on)
        for (const std::string& name : variants())
          if (name != "LUCERNA_NO_AUTOMATON") defines[name] = full(name);
      INFO(file << (on ? " with everything" : " with nothing"));
      CHECK_NOTHROW(compiler.compile(file, defines));
    }
}

TEST_CASE("no kernel tests a macro before its definition, in any variant") {
  const gpu::ShaderCompiler compiler(root());
  const std::vector<std::string> names = variants();
  REQUIRE(names.size() > 40);
  // Operands that && and || skip are not evaluated: random variants cover all of them, each of two with every
  // value of the other.
  std::mt19937 random(1);
  for (const std::string& file : kernels())
    for (int round = 0; round < 16; ++round) {
      gpu::Defines defines = values();
      for (const std::string& name : names)
        if (random() & 1u) defines[name] = full(name);
      INFO(file);
      CHECK_NOTHROW(compiler.check_macros(file, defines));
    }
}

TEST_CASE("macros are tested by #if only, which the check above covers") {
  // #ifdef, #ifndef and defined() test existence, not order. #ifndef may start a file or define a missing
  // value.
  const std::regex existence("^\\s*#\\s*(ifdef|ifndef)\\s+(\\w+).*$|\\bdefined\\b");
  for (const fs::path& file : files({".comp", ".glsl", ".h"})) {
    std::istringstream text(text_of(file));
    std::string line, next;
    for (int number = 1; std::getline(text, line); ++number) {
      std::smatch m;
      if (line[0] != '#' || !std::regex_search(line, m, existence) || m[2] == "__cplusplus") continue;
      INFO(file.string() << ":" << number << ": " << line);
      REQUIRE(m[1] == "ifndef");
      std::getline(text, next), ++number;
      CHECK(next.rfind("#define " + m[2].str(), 0) == 0);
    }
  }
}

TEST_CASE("every macro that the host defines for a scene is used by kernels") {
  gpu::Device device({"", true});
  const std::vector<std::string> list = variants();
  std::set<std::string> known(list.begin(), list.end());
  for (const auto& [name, value] : values()) known.insert(name);
  const upload::DeviceScene scene(device, {}, {});
  for (const auto& [name, value] : scene.defines()) {
    INFO(name);
    CHECK(known.contains(name));
  }
}

}  // namespace compile_all_tests
