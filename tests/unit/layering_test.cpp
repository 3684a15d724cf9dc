// links: base
// Checks the layers: #include lines against the DEPS of the CMake targets, and the targets against rules that
// a list of dependencies cannot state.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>

namespace layering_tests {

namespace fs = std::filesystem;

namespace {

struct Module {
  std::string folder;           ///< relative to the include root: "scene/io"
  std::set<std::string> files;  ///< without endings; empty: all that no other module lists
  std::set<std::string> deps;   ///< as written
  std::set<std::string> sees;   ///< itself and everything it reaches through deps
};
using Modules = std::map<std::string, Module>;
using Lines = std::vector<std::string>;

std::string read(const fs::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The lucerna_module() calls of one CMake file, added to `modules`; returns complaints about DEPS that are
/// not declared before (which also rules out cycles). `base_folder` is prepended to the path after the first
/// variable of DIR.
Lines parse(const std::string& cmake, const std::string& base_folder, Modules& modules) {
  Lines complaints;
  const std::string text = std::regex_replace(cmake, std::regex("#[^\n]*"), "");
  static const std::regex k_call(R"(lucerna_module\(\s*(\w+)\s+DIR\s+\$\{\w+\}/?([\w/]*)([^)]*)\))");
  for (std::sregex_iterator call(text.begin(), text.end(), k_call), end; call != end; ++call) {
    const std::string name = (*call)[1];
    Module module{.folder = base_folder + (*call)[2].str(), .files = {}, .deps = {}, .sees = {name}};
    std::istringstream words((*call)[3].str());
    std::string list;
    for (std::string word; words >> word;) {
      if (word == "DEPS" || word == "LIBS" || word == "FILES") {
        list = word;
      } else if (list == "FILES") {
        module.files.insert(word);
      } else if (list == "DEPS" && !modules.contains(word)) {
        complaints.push_back(name + ": DEPS names " + word + ", which is not declared before it");
      } else if (list == "DEPS") {
        module.deps.insert(word);
        module.sees.insert(modules[word].sees.begin(), modules[word].sees.end());
      }
    }
    modules[name] = module;
  }
  return complaints;
}

/// The module that lists the file, or otherwise the module whose folder is the longest prefix of `path`
/// ("scene/io/load.h" -> scene_io); "" if there is none.
std::string module_of(const Modules& modules, const std::string& path) {
  std::string best;
  size_t length = 0;
  for (const auto& [name, module] : modules) {
    if (!path.starts_with(module.folder + "/")) continue;
    const std::string rest = path.substr(module.folder.size() + 1);
    if (module.files.contains(rest.substr(0, rest.rfind('.')))) return name;
    if (module.files.empty() && module.folder.size() > length) best = name, length = module.folder.size();
  }
  return best;
}

/// "solvers/NAME/..." -> "NAME" where NAME is one technique; "" for shared files.
std::string technique_of(const std::string& path) {
  static const std::regex k_technique(R"(solvers/(\w+)/.*)");
  std::smatch match;
  if (!std::regex_match(path, match, k_technique) || match[1] == "lookup") return "";
  return match[1];
}

/// Third-party headers that only some folders may include, by the beginnings of their names.
struct Owned {
  std::regex header;
  std::set<std::string> modules;
};
const std::vector<Owned>& owned() {
  static const std::vector<Owned> k_owned = {
      {std::regex("(vulkan/|volk).*|glslang/.*"), {"gpu"}},
      {std::regex("(GLFW|epoxy|GL|imgui|backends/imgui|X11).*"), {"ui"}},
      {std::regex("OpenImageIO/.*"), {"scene_io", "film_io"}},
      {std::regex("tiny_gltf.*"), {"scene_io"}},
      {std::regex("embree.*"), {"bvh_embree"}},
      {std::regex("CLI/.*"), {"app"}},
  };
  return k_owned;
}

/// Complaints about the includes of one file. `path` is relative to the include root: "scene/scene.h",
/// "ui/viewer.cpp", "shaders/shared/ray.h".
Lines check_includes(const Modules& modules, const std::string& path, const std::string& text) {
  Lines complaints;
  const bool shader = path.starts_with("shaders/");
  const std::string own = shader ? "base" : module_of(modules, path);
  if (own.empty()) return {path + ": belongs to no module"};
  const std::set<std::string>& sees = modules.at(own).sees;
  static const std::regex k_include(R"re((?:^|\n)[ \t]*#[ \t]*include[ \t]*(["<])([^">\n]+)[">])re");
  for (std::sregex_iterator line(text.begin(), text.end(), k_include), end; line != end; ++line) {
    const std::string header = (*line)[2];
    const auto complain = [&](const std::string& why) {
      complaints.push_back(path + ": includes " + header + ": " + why);
    };
    if ((*line)[1] == "<") {
      for (const Owned& rule : owned())
        if (std::regex_match(header, rule.header) && !rule.modules.contains(own)) complain("not for " + own);
      continue;
    }
    if (header.find("..") != std::string::npos) complain("a path that climbs");
    if (header.find('/') == std::string::npos || header.starts_with("shaders/shared/")) continue;
    const std::string target = module_of(modules, header);
    if (target.empty()) {
      complain("in the folder of no module");
    } else if (!sees.contains(target)) {
      complain(own + " may not see " + target);
    }
    if (own == "ui" && header.starts_with("gpu/")) complain("ui sees no Vulkan");
    const std::string from = technique_of(path), to = technique_of(header);
    if (!from.empty() && !to.empty() && from != to) complain("solvers do not see each other");
  }
  return complaints;
}

/// The text of a file by its path relative to an include root; empty if it does not exist.
using Files = std::function<std::optional<std::string>(const std::string&)>;

/// All direct and indirect includes of a file: by path, with the file that includes it.
std::map<std::string, std::string> reached(const std::string& path, const Files& files) {
  static const std::regex k_include(R"re((?:^|\n)[ \t]*#[ \t]*include[ \t]*"([^"\n]+)")re");
  std::map<std::string, std::string> found;
  std::vector<std::string> open{path};
  while (!open.empty()) {
    const std::string from = open.back();
    open.pop_back();
    const std::string text = files(from).value_or("");
    for (std::sregex_iterator line(text.begin(), text.end(), k_include), end; line != end; ++line) {
      std::string header = (*line)[1];
      if (header.find('/') == std::string::npos && from.find('/') != std::string::npos)
        header = from.substr(0, from.rfind('/') + 1) + header;
      if (header != path && found.emplace(header, from).second) open.push_back(header);
    }
  }
  return found;
}

/// Checks that window and commands do not reach the device, light transport or any single solver through a
/// chain of includes. They know solvers by their tables and reports only.
Lines check_reach(const std::string& path, const Files& files) {
  Lines complaints;
  const std::map<std::string, std::string> all = reached(path, files);
  for (const auto& [header, from] : all) {
    if (!header.starts_with("gpu/") && !header.starts_with("transport/") && technique_of(header).empty())
      continue;
    std::string chain = header;
    for (auto at = all.find(header); at != all.end(); at = all.find(at->second)) chain += " <- " + at->second;
    complaints.push_back(path + " reaches " + chain);
  }
  return complaints;
}

/// Rules between layers, independent of DEPS: "a: never b".
Lines check_layers(const Modules& modules) {
  static const std::vector<std::pair<std::string, Lines>> k_never = {
      {"scene", {"gpu", "bvh", "upload", "film"}},
      {"gpu", {"scene", "bvh", "paths", "film"}},
      {"paths", {"gpu", "scene"}},
      {"schedule", {"gpu", "scene", "film", "transport"}},
      {"solver_info", {"gpu", "transport"}},
      {"film", {"scene", "upload", "paths", "transport"}},
      {"transport", {"plan", "solvers", "session"}},
      {"overlay", {"solver_info", "lookup", "irradiance_cache", "solvers"}},
      {"solvers", {"plan", "session", "commands", "scene_io", "film_io", "bvh_embree"}},
      {"film_io", {"gpu", "scene"}},
      {"raybench", {"film_io", "scene_io", "ui"}},
  };
  Lines complaints;
  for (const auto& [name, unseen] : k_never)
    for (const std::string& other : unseen)
      if (modules.contains(name) && modules.at(name).sees.contains(other))
        complaints.push_back(name + " may never see " + other);
  for (const auto& [name, module] : modules)
    for (const std::string upper : {"ui", "app"})
      if (name != "ui" && name != "app" && module.sees.contains(upper))
        complaints.push_back(name + " may never see " + upper);
  return complaints;
}

Modules project_modules(Lines& complaints) {
  const fs::path root = LUCERNA_SOURCE_DIR;
  Modules modules;
  const auto add = [&](const Lines& lines) {
    complaints.insert(complaints.end(), lines.begin(), lines.end());
  };
  add(parse(read(root / "renderer" / "CMakeLists.txt"), "", modules));
  add(parse(read(root / "ui" / "CMakeLists.txt"), "ui", modules));
  Module app{.folder = "app", .deps = {}, .sees = {"app"}};  // the program's entry point sees everything
  for (const auto& [name, module] : modules) app.sees.insert(name);
  modules["app"] = app;
  return modules;
}

std::string joined(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace

TEST_CASE("Every file includes only what its folder may see") {
  Lines complaints;
  const Modules modules = project_modules(complaints);
  REQUIRE(modules.size() > 15);  // fewer: the CMake files are not understood
  REQUIRE(modules.contains("ui"));
  REQUIRE(modules.at("session").sees.contains("base"));
  const fs::path root = LUCERNA_SOURCE_DIR;
  const auto scan = [&](const fs::path& folder, const fs::path& include_root) {
    size_t files = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
      const std::string ending = entry.path().extension().string();
      if (!entry.is_regular_file() || (ending != ".h" && ending != ".cpp" && ending != ".c")) continue;
      const std::string path = entry.path().lexically_relative(include_root).generic_string();
      if (path == "CMakeLists.txt") continue;
      const Lines lines = check_includes(modules, path, read(entry.path()));
      complaints.insert(complaints.end(), lines.begin(), lines.end());
      ++files;
    }
    CHECK(files > 0);
  };
  scan(root / "renderer", root / "renderer");
  scan(root / "ui", root);
  scan(root / "app", root);
  scan(root / "shaders" / "shared", root);
  INFO(joined(complaints));
  CHECK(complaints.empty());
}

TEST_CASE("Window and commands include neither the device nor any single solver, directly or indirectly") {
  const fs::path root = LUCERNA_SOURCE_DIR;
  const Files files = [&](const std::string& path) -> std::optional<std::string> {
    for (const fs::path& folder : {root / "renderer", root})
      if (fs::is_regular_file(folder / path)) return read(folder / path);
    return std::nullopt;
  };
  REQUIRE(reached("ui/viewer.cpp", files).contains("session/session.h"));  // fewer: paths are not understood
  REQUIRE(reached("ui/viewer.cpp", files).contains("solvers/report.h"));
  Lines complaints;
  size_t looked_at = 0;
  for (const auto& [folder, head] :
       {std::pair{root / "ui", "ui/"}, {root / "renderer/commands", "commands/"}})
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      const std::string ending = entry.path().extension().string();
      if (ending != ".h" && ending != ".cpp") continue;
      const Lines lines = check_reach(head + entry.path().filename().string(), files);
      complaints.insert(complaints.end(), lines.begin(), lines.end());
      ++looked_at;
    }
  CHECK(looked_at > 30);
  INFO(joined(complaints));
  CHECK(complaints.empty());
}

TEST_CASE("The layers separate what must not depend on each other") {
  Lines complaints;
  const Modules modules = project_modules(complaints);
  const Lines layers = check_layers(modules);
  INFO(joined(layers));
  CHECK(layers.empty());
  for (const char* name : {"scene", "gpu", "paths", "schedule", "film", "solver_info", "transport", "overlay",
                           "solvers", "film_io"}) {
    INFO(name);
    CHECK(modules.contains(name));  // a renamed module would silently lose its rule
  }
}

TEST_CASE("The checker detects each kind of violation") {
  Lines none;
  const Modules modules = project_modules(none);
  const auto complaints = [&](const std::string& path, const std::string& text) {
    return joined(check_includes(modules, path, text));
  };
  using Catch::Contains;
  CHECK_THAT(complaints("scene/x.cpp", "#include \"gpu/device.h\"\n"), Contains("scene may not see gpu"));
  CHECK_THAT(complaints("gpu/x.h", "\n  # include \"scene/scene.h\"\n"), Contains("gpu may not see scene"));
  CHECK_THAT(complaints("scene/x.h", "#include \"scene/io/load.h\""), Contains("scene may not see scene_io"));
  CHECK_THAT(complaints("paths/x.h", "#include \"ui/viewer.h\""), Contains("paths may not see ui"));
  CHECK_THAT(complaints("film/x.h", "#include \"nowhere/x.h\""), Contains("no module"));
  CHECK_THAT(complaints("film/x.h", "#include \"../scene/scene.h\""), Contains("climbs"));
  CHECK_THAT(complaints("nowhere/x.h", ""), Contains("belongs to no module"));
  CHECK_THAT(complaints("ui/x.cpp", "#include <vulkan/vulkan.h>"), Contains("not for ui"));
  CHECK_THAT(complaints("ui/x.cpp", "#include \"gpu/vulkan.h\""), Contains("ui sees no Vulkan"));
  CHECK_THAT(complaints("transport/x.cpp", "#include <volk.h>"), Contains("not for transport"));
  CHECK_THAT(complaints("session/x.cpp", "#include <imgui.h>"), Contains("not for session"));
  CHECK_THAT(complaints("bvh/x.cpp", "#include <embree3/rtcore.h>"), Contains("not for bvh"));
  CHECK_THAT(complaints("shaders/shared/x.h", "#include \"scene/scene.h\""), Contains("may not see scene"));
  CHECK_THAT(complaints("solvers/path_tracing/x.cpp", "#include \"solvers/irradiance_cache/y.h\""),
             Contains("solvers do not see each other"));
  CHECK_THAT(complaints("solvers/path_tracing/x.cpp", "#include \"solvers/registry.h\""),
             Contains("path_tracing may not see solvers"));

  const Files files = [](const std::string& path) -> std::optional<std::string> {
    static const std::map<std::string, std::string> k_files = {
        {"ui/a.cpp", "#include \"b.h\"\n#include <vector>\n"},
        {"ui/b.h", "#include \"session/c.h\"\n#include \"b.h\"\n"},
        {"session/c.h", "#include \"gpu/d.h\"\n#include \"solvers/photons/e.h\"\n"},
        {"gpu/d.h", "#include \"session/c.h\"\n"},
        {"ui/clean.cpp", "#include \"solvers/info.h\"\n// #include \"gpu/d.h\"\n"}};
    const auto found = k_files.find(path);
    return found == k_files.end() ? std::nullopt : std::optional(found->second);
  };
  CHECK_THAT(joined(check_reach("ui/a.cpp", files)),
             Contains("ui/a.cpp reaches gpu/d.h <- session/c.h <- ui/b.h <- ui/a.cpp") &&
                 Contains("ui/a.cpp reaches solvers/photons/e.h <- session/c.h"));
  CHECK(check_reach("ui/clean.cpp", files).empty());

  CHECK(complaints("solvers/irradiance_cache/x.cpp",
                   "#include \"solvers/lookup/y.h\"\n#include \"solvers/report.h\"")
            .empty());
  CHECK(complaints("scene/io/x.cpp", "#include \"scene/scene.h\"\n#include <OpenImageIO/imageio.h>").empty());
  CHECK(
      complaints("session/x.cpp", "#include \"base/error.h\"\n#include \"x.h\"\n#include <vector>").empty());
  CHECK(complaints("scene/x.cpp", "// #include \"gpu/device.h\"\n").empty());
}

TEST_CASE("The checker of layers detects a list of dependencies that breaks a rule") {
  Modules modules;
  const std::string cmake = R"(
# lucerna_module(ghost DIR ${here}/ghost DEPS nothing)
lucerna_module(base DIR ${here}/base LIBS fmt::fmt)
lucerna_module(gpu DIR ${here}/gpu DEPS base LIBS dl)
lucerna_module(scene DIR ${here}/scene
  DEPS base gpu LIBS a::b)
)";
  CHECK(parse(cmake, "", modules).empty());
  REQUIRE(modules.size() == 3);
  CHECK(modules.at("scene").folder == "scene");
  CHECK(modules.at("scene").sees == std::set<std::string>{"base", "gpu", "scene"});
  CHECK_THAT(joined(check_layers(modules)), Catch::Contains("scene may never see gpu"));
  CHECK_THAT(joined(parse("lucerna_module(a DIR ${here}/a DEPS later)", "", modules)),
             Catch::Contains("later"));
}

}  // namespace layering_tests
