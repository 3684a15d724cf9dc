#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <glslang/build_info.h>

#include <atomic>
#include <cstdlib>
#include <mutex>

#include "base/file.h"
#include "base/timer.h"
#include "gpu/kernel.h"
#include "gpu/shader_cache.h"
#include "gpu/shader_source.h"
#include "gpu/spirv.h"

namespace lucerna::gpu {

namespace fs = std::filesystem;

namespace {

/// In front of every kernel. Extensions cost nothing unless used, and naming them here lets a library file
/// use one wherever it is included. Everything is laid out as C++ lays it out.
constexpr const char* k_prologue =
    "#version 460\n"
    "#extension GL_GOOGLE_include_directive : require\n"
    "#extension GL_GOOGLE_cpp_style_line_directive : require\n"
    "#extension GL_EXT_scalar_block_layout : require\n"
    "#extension GL_EXT_control_flow_attributes : enable\n"
    "#extension GL_EXT_shader_16bit_storage : enable\n"
    "#extension GL_EXT_shader_8bit_storage : enable\n"
    "#extension GL_EXT_shader_explicit_arithmetic_types_int64 : enable\n"
    "#extension GL_EXT_shader_atomic_int64 : enable\n"
    "#extension GL_EXT_shader_atomic_float : enable\n"
    "#extension GL_KHR_shader_subgroup_basic : enable\n"
    "#extension GL_KHR_shader_subgroup_vote : enable\n"
    "#extension GL_KHR_shader_subgroup_ballot : enable\n"
    "#extension GL_KHR_shader_subgroup_arithmetic : enable\n"
    "#extension GL_EXT_debug_printf : enable\n"
    "layout(scalar) buffer;\n"
    "layout(scalar) uniform;\n";

/// glslang takes the first string's name for the includer of what the kernel's own file includes.
constexpr const char* k_prologue_name = "defines";

class Includer : public glslang::TShader::Includer {
 public:
  Includer(const ShaderSource& source, const std::string& main) : source_(source), main_(main) {}
  IncludeResult* includeLocal(const char* name, const char* includer, size_t depth) override {
    if (depth > 64) return nullptr;
    auto found = source_.include(name, includer == std::string(k_prologue_name) ? main_ : includer);
    if (!found) return nullptr;
    auto* file = new ShaderFile(std::move(*found));
    return new IncludeResult(file->display, file->text.data(), file->text.size(), file);
  }
  void releaseInclude(IncludeResult* result) override {
    if (!result) return;
    delete static_cast<ShaderFile*>(result->userData);
    delete result;
  }

 private:
  const ShaderSource& source_;
  const std::string& main_;
};

void start_glslang() {
  static std::once_flag once;
  std::call_once(once, [] { glslang::InitializeProcess(); });
}

/// "#version" is ours; a line of the source that says it is blanked, so that line numbers hold.
std::string without_version(std::string text) {
  const size_t at = text.find("#version");
  if (at == std::string::npos || (at > 0 && text[at - 1] != '\n')) return text;
  for (size_t i = at; i < text.size() && text[i] != '\n'; ++i) text[i] = ' ';
  return text;
}

/// glslang's log as an Error. glslang gives up at the first error; what it reports after that is about giving
/// up.
[[noreturn]] void throw_compile_error(const std::string& display, const std::string& text) {
  // "ERROR: file:line: message", or "ERROR: message".
  const std::string mark = "ERROR: ";
  const size_t start = text.find(mark);
  if (start == std::string::npos) throw Error(display, "does not compile: " + text);
  std::string line = text.substr(start + mark.size(), text.find('\n', start) - start - mark.size());
  line.erase(line.find_last_not_of(' ') + 1);
  const size_t colon = line.find(": ");
  const size_t number = colon == std::string::npos ? colon : line.rfind(':', colon - 1);
  const bool located = number != std::string::npos && number + 1 < colon &&
                       line.find_first_not_of("0123456789", number + 1) == colon;
  if (!located) throw Error(display, line);
  throw Error(line.substr(0, colon), line.substr(colon + 2));
}

std::string define_lines(const Defines& defines) {
  std::string lines;
  for (const auto& [name, value] : defines)
    if (!name.starts_with(k_include_define)) lines += fmt::format("#define {} {}\n", name, value);
  return lines;
}

/// The files with the texts among the defines in place of some.
ShaderSource source_for(const ShaderSource& source, const Defines& defines) {
  std::map<std::string, std::string> texts;
  for (const auto& [name, value] : defines)
    if (name.starts_with(k_include_define)) texts[name.substr(std::string(k_include_define).size())] = value;
  return source.with(std::move(texts));
}

/// Desktop GLSL treats undefined macros as 0 and silently drops what depends on them. GLSL ES forbids it, so
/// the source is preprocessed as GLSL ES.
void check_macros(const ShaderSource& source, const ShaderFile& file, const Defines& defines) {
  const std::string prologue =
      "#version 320 es\n"
      "#extension GL_GOOGLE_include_directive : require\n"
      "#extension GL_GOOGLE_cpp_style_line_directive : require\n" +
      define_lines(defines);
  const std::string body = without_version(file.text);
  const char* const strings[] = {prologue.c_str(), body.c_str()};
  const int lengths[] = {static_cast<int>(prologue.size()), static_cast<int>(body.size())};
  const char* const names[] = {k_prologue_name, file.display.c_str()};
  glslang::TShader shader(EShLangCompute);
  shader.setStringsWithLengthsAndNames(strings, lengths, names, 2);
  Includer includer(source, file.display);
  std::string out;
  if (shader.preprocess(GetDefaultResources(), 320, EEsProfile, false, false, EShMsgDefault, &out, includer))
    return;
  // "ERROR: file:line: 'preprocessor evaluation' : undefined macro in expression ... NAME", of the first.
  std::string log = shader.getInfoLog();
  const std::string untested = "'preprocessor evaluation' : undefined macro";
  const size_t at = log.find(untested), end = log.find('\n', at);
  if (at != std::string::npos && at < log.find('\n')) {
    const std::string line = log.substr(0, end);
    log = fmt::format("{}'{}' : tested by an #if before it is defined", line.substr(0, at),
                      line.substr(line.find_last_of(' ', line.find_last_not_of(' ')) + 1));
  }
  throw_compile_error(file.display, log);
}

std::vector<uint32_t> compile_glsl(const ShaderSource& source, const ShaderFile& file,
                                   const Defines& defines) {
  start_glslang();
  check_macros(source, file, defines);
  const std::string prologue = k_prologue + define_lines(defines);
  const std::string body = without_version(file.text);
  const char* const strings[] = {prologue.c_str(), body.c_str()};
  const int lengths[] = {static_cast<int>(prologue.size()), static_cast<int>(body.size())};
  const char* const names[] = {k_prologue_name, file.display.c_str()};

  glslang::TShader shader(EShLangCompute);
  shader.setStringsWithLengthsAndNames(strings, lengths, names, 2);
  shader.setEnvInput(glslang::EShSourceGlsl, EShLangCompute, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_2);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_5);
  shader.setAutoMapBindings(true);
  const auto messages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
  Includer includer(source, file.display);
  if (!shader.parse(GetDefaultResources(), 460, false, messages, includer))
    throw_compile_error(file.display, shader.getInfoLog());
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(messages) || !program.mapIO()) throw_compile_error(file.display, program.getInfoLog());
  std::vector<uint32_t> words;
  glslang::SpvOptions options;
  options.disableOptimizer = true;
  spv::SpvBuildLogger logger;
  glslang::GlslangToSpv(*program.getIntermediate(EShLangCompute), words, &logger, &options);
  if (words.empty()) throw Error(file.display, "glslang made no SPIR-V: " + logger.getAllMessages());
  return spirv::trim(words);
}

fs::path executable_folder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

}  // namespace

struct ShaderCompiler::Impl {
  explicit Impl(fs::path root) : source(std::move(root)), cache(ShaderCache::default_folder()) {}
  ShaderSource source;
  ShaderCache cache;
  bool use_cache = true;
  std::mutex mutex;  ///< around the members below
  std::map<std::pair<std::string, Defines>, std::vector<fs::path>> dependencies;
  double seconds = 0;
  uint64_t hits = 0;
};

ShaderCompiler::ShaderCompiler(fs::path root) : impl_(std::make_unique<Impl>(absolute_path(root))) {}
ShaderCompiler::~ShaderCompiler() = default;

fs::path ShaderCompiler::default_root() {
  if (const char* variable = std::getenv("LUCERNA_SHADERS"); variable && *variable) return variable;
  std::error_code error;
  const fs::path installed = executable_folder().parent_path() / "share" / "lucerna" / "shaders";
  if (fs::is_directory(installed, error)) return installed;
  return fs::path(LUCERNA_SOURCE_DIR) / "shaders";
}

const fs::path& ShaderCompiler::root() const { return impl_->source.root(); }
void ShaderCompiler::set_cache(bool enabled) { impl_->use_cache = enabled; }

std::vector<uint32_t> ShaderCompiler::compile(const std::string& file, const Defines& defines) {
  const ShaderSource source = source_for(impl_->source, defines);
  const auto main = source.open(file);
  if (!main) throw_error(file, "there is no such shader in {}", source.root().string());
  const auto files = source.closure(*main);
  Hash hash;
  hash.add(fmt::format("glslang {}.{}.{} {}", GLSLANG_VERSION_MAJOR, GLSLANG_VERSION_MINOR,
                       GLSLANG_VERSION_PATCH, glslang::GetSpirvGeneratorVersion()));
  hash.add("trimmed 1");  // to be changed with what spirv::trim makes
  hash.add("macros checked");
  hash.add(k_prologue);
  for (const auto& [name, value] : defines) hash.add(name), hash.add(value);
  std::vector<fs::path> paths;
  for (const ShaderFile& f : files) {
    hash.add(f.display), hash.add(f.text);
    if (!f.path.empty()) paths.push_back(f.path);
  }
  {
    std::lock_guard lock(impl_->mutex);
    impl_->dependencies[{file, defines}] = std::move(paths);
  }
  const std::string key = hash.hex();
  if (impl_->use_cache) {
    if (auto words = impl_->cache.load(key)) {
      std::lock_guard lock(impl_->mutex);
      ++impl_->hits;
      return std::move(*words);
    }
  }
  const Timer timer;
  std::vector<uint32_t> words = compile_glsl(source, *main, defines);
  {
    std::lock_guard lock(impl_->mutex);
    impl_->seconds += timer.seconds();
  }
  if (impl_->use_cache) impl_->cache.store(key, words);
  return words;
}

void ShaderCompiler::check_macros(const std::string& file, const Defines& defines) const {
  const auto main = impl_->source.open(file);
  if (!main) throw_error(file, "there is no such shader in {}", impl_->source.root().string());
  start_glslang();
  gpu::check_macros(source_for(impl_->source, defines), *main, defines);
}

std::vector<fs::path> ShaderCompiler::dependencies(const std::string& file, const Defines& defines) {
  std::lock_guard lock(impl_->mutex);
  const auto found = impl_->dependencies.find({file, defines});
  return found == impl_->dependencies.end() ? std::vector<fs::path>{} : found->second;
}

double ShaderCompiler::seconds_spent() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->seconds;
}

uint64_t ShaderCompiler::cache_hits() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->hits;
}

}  // namespace lucerna::gpu
