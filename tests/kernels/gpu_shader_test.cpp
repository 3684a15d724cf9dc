// links: gpu
#include <cstdlib>
#include <fstream>
#include <optional>
#include <thread>

#include "gpu/spirv.h"
#include "kernels/gpu_support.h"

namespace gpu_shader_tests {

using namespace lucerna;
using namespace lucerna::gpu;
using Catch::Matchers::Contains;
using test::error_of;
using test::shader;

namespace fs = std::filesystem;

namespace {

/// An empty disk cache.
struct OwnCache {
  OwnCache() { set(folder.path.c_str()); }
  ~OwnCache() { set(before ? before->c_str() : nullptr); }
  static void set(const char* value) {
    value ? setenv("XDG_CACHE_HOME", value, 1) : unsetenv("XDG_CACHE_HOME");
  }
  static std::optional<std::string> get() {
    const char* value = std::getenv("XDG_CACHE_HOME");
    return value ? std::optional<std::string>(value) : std::nullopt;
  }
  const std::optional<std::string> before = get();
  test::Folder folder;
};

void write_text(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

std::vector<fs::path> cached_files(const OwnCache& cache) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(cache.folder.path))
    if (entry.is_regular_file()) found.push_back(entry.path());
  return found;
}

std::vector<std::string> names(const std::vector<uint32_t>& words) {
  std::vector<std::string> list;
  for (const auto& resource : spirv::reflect(words).resources) list.push_back(resource.name);
  std::sort(list.begin(), list.end());
  return list;
}

/// The number of buffers that the words decorate as Aliased.
size_t aliased(const std::vector<uint32_t>& words) {
  constexpr uint32_t k_decorate = 71, k_aliased = 20;  // OpDecorate, Aliased
  size_t count = 0;
  for (size_t at = 5; at < words.size(); at += words[at] >> 16)
    count += (words[at] & 0xffff) == k_decorate && words[at + 2] == k_aliased;
  return count;
}

}  // namespace

TEST_CASE("a kernel declares only what it uses, whatever its includes declare") {
  const OwnCache cache;
  ShaderCompiler compiler;
  const auto words = compiler.compile(shader("gpu_scale.comp"), {{"OFFSET", "1.5"}});
  CHECK(names(words) == std::vector<std::string>{"Source", "Target"});
  const auto module = spirv::reflect(words);
  CHECK(module.push_constant_bytes == 8);
  CHECK(module.workgroup[0] == 64);
  CHECK(module.resources[0].binding == 0);
  CHECK(module.resources[1].binding == 1);
  CHECK(aliased(words) == 2);
}

TEST_CASE("an error names the file and the line") {
  const OwnCache cache;
  ShaderCompiler compiler;
  CHECK_THAT(error_of([&] {
               compiler.compile(shader("gpu_version.comp"), {{"BREAK", ""}});
             }),
             Contains("gpu_version.comp:8: ") && Contains("'mistake' : undeclared identifier"));
  CHECK_THAT(error_of([&] {
               compiler.compile(shader("gpu_scale.comp"), {{"OFFSET", "0"}, {"BREAK_THE_INCLUDE", "1"}});
             }),
             Contains("lib/gpu_offset.glsl:6: ") && Contains("no_such_name"));
  CHECK_THAT(error_of([&] { compiler.compile("no/such.comp"); }),
             Contains("no/such.comp") && Contains("no such shader"));
}

TEST_CASE("files below the root are called shaders/...; includes are found from the root and from the file") {
  const OwnCache cache;
  const test::Folder root;
  write_text(root.path / "a/kernel.comp",
             "#include \"b/common.glsl\"\n#include \"beside.glsl\"\n#include \"shaders/b/common.glsl\"\n"
             "layout(local_size_x = 1) in;\nbuffer Target { float target[]; };\n"
             "void main() { target[0] = common_value() + beside(); }\n");
  write_text(root.path / "a/beside.glsl", "float beside() {\n  return 1.0 BREAK;\n}\n");
  // No newline at the end, a guard, and an include of the file itself.
  write_text(root.path / "b/common.glsl",
             "#ifndef COMMON\n#define COMMON\n#include \"b/common.glsl\"\nfloat common_value() { return 2.0; "
             "}\n#endif");
  ShaderCompiler compiler(root.path);
  CHECK_NOTHROW(compiler.compile("a/kernel.comp", {{"BREAK", ""}}));
  CHECK_NOTHROW(compiler.compile("shaders/a/kernel.comp", {{"BREAK", ""}}));
  CHECK_THAT(error_of([&] {
               compiler.compile("a/kernel.comp", {{"BREAK", "* wrong"}});
             }),
             Contains("shaders/a/beside.glsl:2: ") && Contains("wrong"));

  write_text(root.path / "lost.comp", "void main() {}\n\n#include \"nowhere.glsl\"\n");
  CHECK_THAT(error_of([&] { compiler.compile("lost.comp"); }),
             Contains("shaders/lost.comp:3: ") && Contains("nowhere.glsl"));
}

TEST_CASE("a macro that is tested before its definition is an error, not 0") {
  const OwnCache cache;
  const test::Folder root;
  write_text(root.path / "late.comp",
             "#include \"first.glsl\"\n#include \"second.glsl\"\n"
             "buffer T { float t[]; };\nvoid main() { t[0] = first() + second(); }\n");
  // Like a library file that reads a macro which a later include defines.
  write_text(root.path / "first.glsl",
             "float first() {\n#if ASKED || DERIVED\n  return 1.0;\n#else\n  return 2.0;\n#endif\n}\n");
  write_text(root.path / "second.glsl",
             "#define DERIVED 1\nfloat second() {\n#if DERIVED\n  return 1.0;\n#endif\n}\n");
  ShaderCompiler compiler(root.path);
  CHECK(error_of([&] {
          compiler.compile("late.comp", {{"ASKED", "0"}});
        }) == "shaders/first.glsl:2: 'DERIVED' : tested by an #if before it is defined");
  CHECK(error_of([&] {
          compiler.check_macros("late.comp", {{"ASKED", "0"}});
        }) == "shaders/first.glsl:2: 'DERIVED' : tested by an #if before it is defined");
  CHECK_THAT(error_of([&] { compiler.compile("late.comp"); }),
             Contains("shaders/first.glsl:2: 'ASKED' : tested"));
  // Skipped operands have no effect.
  CHECK_NOTHROW(compiler.compile("late.comp", {{"ASKED", "1"}}));
  CHECK_NOTHROW(compiler.compile("late.comp", {{"ASKED", "0"}, {"DERIVED", "1"}}));
}

TEST_CASE("dependencies are the files to watch") {
  const OwnCache cache;
  ShaderCompiler compiler;
  const Defines defines{{"OFFSET", "1"}};
  compiler.compile(shader("gpu_scale.comp"), defines);
  std::vector<std::string> files;
  for (const auto& path : compiler.dependencies(shader("gpu_scale.comp"), defines)) {
    CHECK(fs::exists(path));
    files.push_back(path.filename().string());
  }
  std::sort(files.begin(), files.end());
  CHECK(files == std::vector<std::string>{"gpu_offset.glsl", "gpu_scale.comp", "invocation.glsl"});
  CHECK(compiler.dependencies("never/compiled.comp").empty());
}

TEST_CASE("a changed include is noticed; a file that does not compile is still watched") {
  const OwnCache cache;
  const test::Folder root;
  const std::string body =
      "#include \"value.glsl\"\nbuffer T { float t[]; };\nvoid main() { t[0] = VALUE; }\n";
  write_text(root.path / "k.comp", body);
  write_text(root.path / "value.glsl", "#define VALUE 1.0\n");
  ShaderCompiler compiler(root.path);
  const auto first = compiler.compile("k.comp");
  write_text(root.path / "value.glsl", "#define VALUE 2.0\n");
  CHECK(compiler.compile("k.comp") != first);
  write_text(root.path / "value.glsl", "#define VALUE oops\n");
  CHECK_THROWS_AS(compiler.compile("k.comp"), Error);
  CHECK(compiler.dependencies("k.comp").size() == 2);
  write_text(root.path / "value.glsl", "#define VALUE 1.0\n");
  CHECK(compiler.compile("k.comp") == first);
  CHECK(compiler.cache_hits() == 1);
}

TEST_CASE("the disk cache saves compiles, distinguishes defines and recovers from damage") {
  const OwnCache cache;
  const std::string file = shader("gpu_scale.comp");
  ShaderCompiler first;
  const auto words = first.compile(file, {{"OFFSET", "1"}});
  CHECK(first.cache_hits() == 0);
  CHECK(first.seconds_spent() > 0);
  REQUIRE(cached_files(cache).size() == 1);
  const fs::path stored = cached_files(cache).front();

  ShaderCompiler second;
  CHECK(second.compile(file, {{"OFFSET", "1"}}) == words);
  CHECK(second.cache_hits() == 1);
  CHECK(second.seconds_spent() == 0);
  CHECK(second.compile(file, {{"OFFSET", "2"}}) != words);
  CHECK(second.cache_hits() == 1);

  const auto size = fs::file_size(stored);
  const auto break_it = [&](const std::string& how) {
    if (how == "empty") fs::resize_file(stored, 0);
    if (how == "half") fs::resize_file(stored, size / 2);
    if (how == "one byte short") fs::resize_file(stored, size - 1);
    if (how == "longer") std::ofstream(stored, std::ios::app) << "more";
    if (how == "altered") {
      std::fstream f(stored, std::ios::in | std::ios::out | std::ios::binary);
      f.seekp(static_cast<std::streamoff>(size / 2));
      f.put('\x5a').put('\x5a').put('\x5a').put('\x5a');
    }
  };
  for (const char* how : {"empty", "half", "one byte short", "longer", "altered"}) {
    INFO(how);
    break_it(how);
    ShaderCompiler again;
    CHECK(again.compile(file, {{"OFFSET", "1"}}) == words);
    CHECK(again.cache_hits() == 0);
    CHECK(fs::file_size(stored) == size);
  }
  ShaderCompiler without;
  without.set_cache(false);
  CHECK(without.compile(file, {{"OFFSET", "1"}}) == words);
  CHECK(without.cache_hits() == 0);
  for (const auto& path : cached_files(cache)) CHECK(path.extension() != ".new");
}

TEST_CASE("a read-only cache folder is not an error") {
  const OwnCache cache;
  OwnCache::set("/dev/null/nowhere");
  ShaderCompiler compiler;
  CHECK_NOTHROW(compiler.compile(shader("gpu_scale.comp"), {{"OFFSET", "1"}}));
}

TEST_CASE("several threads compile at once") {
  const OwnCache cache;
  ShaderCompiler compiler;
  std::vector<std::thread> threads;
  std::vector<std::vector<uint32_t>> results(6);
  for (size_t i = 0; i < results.size(); ++i)
    threads.emplace_back([&, i] {
      results[i] = compiler.compile(shader("gpu_scale.comp"), {{"OFFSET", i % 2 ? "1" : "2"}});
    });
  for (auto& thread : threads) thread.join();
  for (size_t i = 2; i < results.size(); ++i) CHECK(results[i] == results[i - 2]);
  CHECK(results[0] != results[1]);
}

}  // namespace gpu_shader_tests
