#include "base/file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "base/error.h"

namespace lucerna {

namespace fs = std::filesystem;

void write_file(const fs::path& file, const std::string& bytes) {
  const auto refuse = [&](int code) {
    throw_error(file.string(), "cannot be written: {}", std::strerror(code));
  };
  // A name that no file has, nor a link.
  static std::atomic<uint32_t> counter = 0;
  fs::path temporary;
  int handle = -1;
  do {
    temporary = file.parent_path() / fmt::format(".{}.{}-{}", file.filename().string(), getpid(), counter++);
    handle = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (handle < 0 && errno == EEXIST);
  if (handle < 0) refuse(errno);
  const auto fail = [&](int code) {
    unlink(temporary.c_str());
    refuse(code);
  };
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::write(handle, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      const int code = n < 0 ? errno : ENOSPC;
      close(handle);
      fail(code);
    }
    done += size_t(n);
  }
  if (fsync(handle) != 0) {
    const int code = errno;
    close(handle);
    fail(code);
  }
  close(handle);
  if (std::rename(temporary.c_str(), file.c_str()) != 0) fail(errno);
}

std::string read_file(const fs::path& file) {
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  if (in && !fs::is_directory(file)) text << in.rdbuf();
  if (fs::is_directory(file)) throw_error(file.string(), "cannot be read: it is a folder");
  if (!in || in.bad())
    throw_error(file.string(), "cannot be read{}{}", errno ? ": " : "", errno ? std::strerror(errno) : "");
  return text.str();
}

void check_writable(const fs::path& file) {
  const fs::path folder = file.parent_path();
  if (access(folder.empty() ? "." : folder.c_str(), W_OK) != 0 || fs::is_directory(file))
    throw_error(file.string(), "cannot write here; check that the folder exists and may be written");
}

}  // namespace lucerna
