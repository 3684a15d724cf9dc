#include "gpu/shader_source.h"

#include <fstream>
#include <iterator>
#include <set>

namespace lucerna::gpu {

namespace fs = std::filesystem;

namespace {

constexpr const char* k_prefix = "shaders/";

/// The names in the #include "..." lines of a text.
std::vector<std::string> includes_of(const std::string& text) {
  std::vector<std::string> names;
  const char* const blanks = " \t";
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    size_t i = text.find_first_not_of(blanks, at);
    if (i < end && text[i] == '#') {
      i = text.find_first_not_of(blanks, i + 1);
      if (i < end && text.compare(i, 7, "include") == 0) {
        const size_t open = text.find('"', i);
        const size_t close = open < end ? text.find('"', open + 1) : std::string::npos;
        if (close < end) names.push_back(text.substr(open + 1, close - open - 1));
      }
    }
    at = end + 1;
  }
  return names;
}

}  // namespace

std::optional<ShaderFile> ShaderSource::read(const fs::path& path) const {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  ShaderFile out;
  out.path = path.lexically_normal();
  out.text.assign(std::istreambuf_iterator<char>(file), {});
  const fs::path relative = out.path.lexically_relative(root_.lexically_normal());
  const bool below = !relative.empty() && *relative.begin() != "..";
  out.display = below ? k_prefix + relative.generic_string() : out.path.generic_string();
  return out;
}

fs::path ShaderSource::path_of(const std::string& display) const {
  return display.rfind(k_prefix, 0) == 0 ? root_ / display.substr(std::string(k_prefix).size())
                                         : fs::path(display);
}

std::optional<ShaderFile> ShaderSource::open(const std::string& file) const {
  if (auto found = read(root_ / file)) return found;  // an absolute path replaces the root
  return read(path_of(file));
}

std::optional<ShaderFile> ShaderSource::include(const std::string& name, const std::string& includer) const {
  if (const auto made = texts_.find(name); made != texts_.end())
    return ShaderFile{.path = {}, .display = k_prefix + name, .text = made->second};
  if (name.rfind(k_prefix, 0) == 0) return read(path_of(name));
  if (auto found = read(path_of(includer).parent_path() / name)) return found;
  return read(root_ / name);
}

std::vector<ShaderFile> ShaderSource::closure(const ShaderFile& file) const {
  std::vector<ShaderFile> files{file};
  std::set<std::string> seen{file.display};
  for (size_t i = 0; i < files.size(); ++i) {
    const std::string includer = files[i].display;
    for (const std::string& name : includes_of(files[i].text))
      if (auto found = include(name, includer); found && seen.insert(found->display).second)
        files.push_back(std::move(*found));
  }
  return files;
}

}  // namespace lucerna::gpu
