#include "base/file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "base/error.h"

namespace lucerna {

namespace fs = std::filesystem;

void write_file(const fs::path& file, std::string_view bytes) {
  OutputFile output(file);
  output.write(bytes);
  output.commit();
}

std::string read_file(const fs::path& file) {
  if (is_folder(file)) throw_error(file.string(), "cannot be read: it is a folder");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  if (in && in.peek() != std::ifstream::traits_type::eof()) text << in.rdbuf();
  if (!in.is_open() || in.bad() || text.fail())
    throw_error(file.string(), "cannot be read{}{}", errno ? ": " : "", errno ? std::strerror(errno) : "");
  return text.str();
}

bool file_exists(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error);
}

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

bool is_plain_file(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error);
}

fs::path absolute_path(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  return error ? path : absolute.lexically_normal();
}

}  // namespace lucerna
