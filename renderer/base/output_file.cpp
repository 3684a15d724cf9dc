#include "base/output_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <optional>
#include <thread>
#include <utility>

#include "base/error.h"

namespace lucerna {

namespace fs = std::filesystem;

namespace {

constexpr std::chrono::seconds k_reader_wait{10};

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// Final destination of a name, through links.
struct Place {
  fs::path path;               ///< behind all symbolic links
  std::optional<int> own;      ///< or the descriptor of this process that the name refers to
  std::optional<mode_t> mode;  ///< of the existing file
};

/// "/proc/self/fd/1" -> 1. Links in that folder lead to open files, whatever the names that they show.
std::optional<int> own_descriptor(const fs::path& path) {
  std::error_code error;
  const fs::path folder = fs::canonical(folder_of(path), error);
  if (error || folder != fmt::format("/proc/{}/fd", getpid())) return std::nullopt;
  int number = -1;
  if (std::sscanf(path.filename().c_str(), "%d", &number) != 1 || fcntl(number, F_GETFD) < 0)
    return std::nullopt;
  return number;
}

Place place_of(const fs::path& file) {
  const std::string where = file.string();
  if (file.filename().empty()) throw_error(where.empty() ? "output" : where, "expected a file name");
  Place place{.path = file, .own = {}, .mode = {}};
  struct stat status {};
  for (int links = 0;; ++links) {
    if (place.own = own_descriptor(place.path); place.own) return place;
    if (lstat(place.path.c_str(), &status) != 0) break;
    if (!S_ISLNK(status.st_mode)) {
      place.mode = status.st_mode;
      break;
    }
    if (links == 40) throw_error(where, "cannot be written: {}", std::strerror(ELOOP));
    std::error_code error;
    const fs::path next = fs::read_symlink(place.path, error);
    if (error) throw_error(where, "cannot be written: {}", error.message());
    place.path = folder_of(place.path) / next;  // an absolute `next` stands alone
  }
  if (place.mode && S_ISDIR(*place.mode)) throw_error(where, "is a folder, expected a file name");
  // Renaming would replace such a file all the same, and root may write into any.
  if (place.mode && S_ISREG(*place.mode) &&
      ((*place.mode & 0222) == 0 || access(place.path.c_str(), W_OK) != 0))
    throw_error(where,
                "cannot be written: the file is read-only; choose another name, or allow writing to it");
  const fs::path folder = folder_of(place.path);
  if (stat(folder.c_str(), &status) != 0) {
    const int code = errno;
    throw_error(where, "cannot be written: {}: the folder '{}' {}", std::strerror(code), folder.string(),
                code == ENOENT ? "does not exist" : "cannot be reached");
  }
  if (status.st_nlink == 0)
    throw_error(where, "cannot be written: {}: the folder '{}' was removed", std::strerror(ENOENT),
                folder.string());
  if (!S_ISDIR(status.st_mode))
    throw_error(where, "cannot be written: '{}' is not a folder", folder.string());
  return place;
}

/// Writing into a closed pipe returns an error (EPIPE) in this thread instead of ending the program.
ssize_t write_without_signal(int handle, const char* bytes, size_t size) {
  sigset_t pipe, before, pending;
  sigemptyset(&pipe);
  sigaddset(&pipe, SIGPIPE);
  sigpending(&pending);
  const bool was_pending = sigismember(&pending, SIGPIPE) == 1;
  pthread_sigmask(SIG_BLOCK, &pipe, &before);
  const ssize_t n = ::write(handle, bytes, size);
  const int code = errno;
  // It is raised after a part was written, too, which is no error yet.
  const timespec none{};
  if (!was_pending) sigtimedwait(&pipe, nullptr, &none);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = code;
  return n;
}

}  // namespace

OutputFile::OutputFile(const fs::path& file) : name_(file) {
  const Place place = place_of(file);
  target_ = place.path;
  if (place.own) {
    std::fflush(nullptr);  // earlier output comes first
    handle_ = fcntl(*place.own, F_DUPFD_CLOEXEC, 3);
    if (handle_ < 0) refuse(errno);
  } else if (place.mode && !S_ISREG(*place.mode)) {
    open_stream(S_ISFIFO(*place.mode));
  } else {
    open_temporary();
    if (place.mode) fchmod(handle_, *place.mode & 07777);
  }
}

void OutputFile::open_stream(bool waits) {
  // Without O_NONBLOCK a pipe would be waited for without end. Bytes are waited for later.
  const auto give_up = std::chrono::steady_clock::now() + k_reader_wait;
  while ((handle_ = open(target_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK)) < 0) {
    if (errno != ENXIO || !waits) refuse(errno);
    if (std::chrono::steady_clock::now() > give_up)
      throw_error(name_.string(), "cannot be written: no program reads from it");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  fcntl(handle_, F_SETFL, fcntl(handle_, F_GETFL) & ~O_NONBLOCK);
}

void OutputFile::open_temporary() {
  // A name that no file has, nor a link. Mode 0666 rather than mkstemp, whose files are for their owner
  // alone: an output file follows the umask like any other.
  static std::atomic<uint32_t> counter = 0;
  do {
    temporary_ = folder_of(target_) /
                 fmt::format(".{}.{}-{}", target_.filename().string().substr(0, 200), getpid(), counter++);
    handle_ = open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (handle_ < 0 && errno == EEXIST);
  if (handle_ >= 0) return;
  const int code = errno;
  temporary_.clear();
  refuse(code);
}

OutputFile::~OutputFile() {
  if (handle_ >= 0) close(handle_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

void OutputFile::refuse(int code) const {
  throw_error(name_.string(), "cannot be written: {}", std::strerror(code));
}

void OutputFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write_without_signal(handle_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) refuse(n < 0 ? errno : ENOSPC);
    bytes.remove_prefix(size_t(n));
  }
}

size_t OutputFile::write_at(const void* bytes, size_t size, int64_t offset) {
  size_t done = 0;
  while (done < size) {
    const ssize_t n =
        pwrite(handle_, static_cast<const char*>(bytes) + done, size - done, offset + int64_t(done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      if (failure_ == 0) failure_ = n < 0 ? errno : ENOSPC;
      break;
    }
    done += size_t(n);
  }
  return done;
}

void OutputFile::commit() {
  if (failure_ != 0) refuse(failure_);
  if (streams()) {
    if (close(std::exchange(handle_, -1)) != 0) refuse(errno);
    return;
  }
  if (fsync(handle_) != 0) refuse(errno);
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) refuse(errno);
  temporary_.clear();
  const int folder = open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) fsync(folder), close(folder);
}

void check_writable(const fs::path& file) {
  const Place place = place_of(file);
  const auto check = [&](bool good) {
    if (!good) throw_error(file.string(), "cannot be written: {}", std::strerror(errno));
  };
  if (place.own)
    check((fcntl(*place.own, F_GETFL) & O_ACCMODE) != O_RDONLY);
  else if (place.mode && !S_ISREG(*place.mode))
    check(access(place.path.c_str(), W_OK) == 0);
  else
    check(access(folder_of(place.path).c_str(), W_OK | X_OK) == 0);
}

fs::path file_behind(const fs::path& name) {
  const Place place = place_of(name);
  if (place.own || (place.mode && !S_ISREG(*place.mode))) return {};
  std::error_code error;
  return fs::canonical(folder_of(place.path), error) / place.path.filename();
}

}  // namespace lucerna
