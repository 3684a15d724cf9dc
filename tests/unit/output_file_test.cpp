// links: base
// Outputs: an existing file keeps its type and permissions, a file is written completely or not at all, and
// failures are located.
#include "base/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <future>

#include "base/error.h"
#include "base/file.h"
#include "support/folder.h"

namespace output_file_tests {

namespace fs = std::filesystem;
using namespace lucerna;
using Catch::Contains;

namespace {

size_t entries(const test::Folder& folder) {
  return size_t(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()));
}

mode_t mode_of(const fs::path& file) {
  struct stat status {};
  REQUIRE(lstat(file.c_str(), &status) == 0);
  return status.st_mode;
}

/// What another program reads from it, up to its end.
std::string read_all(const fs::path& file) {
  const int handle = open(file.c_str(), O_RDONLY);
  std::string all;
  char buffer[1000];
  for (ssize_t n = 0; (n = read(handle, buffer, sizeof buffer)) > 0;) all.append(buffer, size_t(n));
  close(handle);
  return all;
}

}  // namespace

TEST_CASE("an output follows symbolic links, which stay") {
  const test::Folder folder;
  fs::create_directory(folder / "far");
  write_file(folder / "far/target", "old");
  fs::create_symlink("far/target", folder / "relative");
  fs::create_symlink(folder / "relative", folder / "twice");
  fs::create_symlink("far/new", folder / "dangling");
  write_file(folder / "twice", "new");
  write_file(folder / "dangling", "made");
  CHECK(read_file(folder / "far/target") == "new");
  CHECK(read_file(folder / "far/new") == "made");
  for (const char* link : {"relative", "twice", "dangling"}) CHECK(S_ISLNK(mode_of(folder / link)));
  CHECK(S_ISREG(mode_of(folder / "far/target")));

  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  CHECK_THROWS_WITH(write_file(folder / "a", "x"), Contains("symbolic links"));
  CHECK_THROWS_WITH(check_writable(folder / "a"), Contains("symbolic links"));
  fs::create_symlink("none/x", folder / "nowhere");
  CHECK_THROWS_WITH(check_writable(folder / "nowhere"), Contains("does not exist"));
  fs::create_symlink("far", folder / "to_folder");
  CHECK_THROWS_WITH(write_file(folder / "to_folder", "x"), Contains("is a folder"));
  CHECK(entries(folder) == 8);
}

TEST_CASE("a read-only file is refused, also through a link, and stays") {
  const test::Folder folder;
  write_file(folder / "locked", "precious");
  REQUIRE(chmod((folder / "locked").c_str(), 0444) == 0);
  fs::create_symlink("locked", folder / "link");
  for (const char* name : {"locked", "link"}) {
    const std::string said = std::string(folder / name) + ": cannot be written: the file is read-only";
    CHECK_THROWS_WITH(write_file(folder / name, "new"), Contains(said));
    CHECK_THROWS_WITH(check_writable(folder / name), Contains(said));
  }
  CHECK(read_file(folder / "locked") == "precious");
  CHECK(entries(folder) == 2);
  REQUIRE(chmod((folder / "locked").c_str(), 0644) == 0);
  write_file(folder / "link", "new");
  CHECK(read_file(folder / "locked") == "new");
}

TEST_CASE("a new file has the permissions of the one that it replaces; a failed write keeps the old one") {
  const test::Folder folder;
  write_file(folder / "secret", "old");
  REQUIRE(chmod((folder / "secret").c_str(), 0600) == 0);
  write_file(folder / "secret", "new");
  CHECK((mode_of(folder / "secret") & 0777) == 0600);
  {
    OutputFile given_up(folder / "secret");
    given_up.write("half");
  }
  CHECK(read_file(folder / "secret") == "new");
  CHECK(entries(folder) == 1);
  // A name of the maximum length: the temporary name is not longer.
  const std::string longest(255, 'n');
  write_file(folder / longest, "x");
  CHECK(read_file(folder / longest) == "x");
  CHECK_THROWS_WITH(write_file(folder / (longest + "n"), "x"),
                    Contains("cannot be written: File name too long"));
}

TEST_CASE("a pipe is written into and stays a pipe") {
  const test::Folder folder;
  const fs::path pipe = folder / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_NOTHROW(check_writable(pipe));  // without a reader, and without waiting for one
  // More than a pipe holds; the reader starts before or after the writer.
  const std::string text(300000, 'x');
  auto read = std::async(std::launch::async, [&] { return read_all(pipe); });
  write_file(pipe, text);
  CHECK(read.get() == text);
  CHECK(S_ISFIFO(mode_of(pipe)));
  CHECK(entries(folder) == 1);
}

TEST_CASE("a reader that closes early gives an error and does not end the program") {
  const test::Folder folder;
  const fs::path pipe = folder / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  auto reader = std::async(std::launch::async, [&] { close(open(pipe.c_str(), O_RDONLY)); });
  CHECK_THROWS_WITH(write_file(pipe, std::string(300000, 'x')), Contains("cannot be written: Broken pipe"));
}

TEST_CASE("devices and the process's own descriptors are written into") {
  const test::Folder folder;
  write_file("/dev/null", "x");
  CHECK(S_ISCHR(mode_of("/dev/null")));
  CHECK_THROWS_WITH(write_file("/dev/full", "x"), Contains("/dev/full: cannot be written: No space left"));

  // A file opened for this process continues at its position, as the shell's > and >> require.
  const fs::path file = folder / "file";
  const int handle = open(file.c_str(), O_RDWR | O_CREAT, 0600);
  REQUIRE(write(handle, "before ", 7) == 7);
  const fs::path name = fmt::format("/dev/fd/{}", handle);
  check_writable(name);
  write_file(name, "between ");
  fs::create_symlink(name, folder / "link");
  write_file(folder / "link", "and ");
  REQUIRE(write(handle, "after", 5) == 5);
  close(handle);
  CHECK(read_file(file) == "before between and after");
  CHECK_THROWS_WITH(write_file(name, "x"), Contains("cannot be written"));
}

TEST_CASE("read errors are located, also for files that do not exist") {
  const test::Folder folder;
  CHECK_THROWS_WITH(read_file(folder.path), Contains("cannot be read: it is a folder"));
  CHECK_THROWS_WITH(read_file(folder / "none"), Contains("none: cannot be read: No such file"));
  CHECK_THROWS_AS(read_file(folder / std::string(300, 'n')), Error);
  CHECK_THROWS_AS(check_writable(folder / std::string("none/x")), Error);
  write_file(folder / "empty", "");
  CHECK(read_file(folder / "empty").empty());
}

TEST_CASE("if the working folder is deleted paths stay as given and outputs fail with a location") {
  const fs::path before = fs::current_path();
  {
    const test::Folder folder;
    fs::current_path(folder.path);
  }
  CHECK(absolute_path("a/b") == "a/b");
  CHECK(absolute_path("/a/../b") == "/b");
  CHECK_THROWS_WITH(write_file("a", "x"), Contains("a: cannot be written: No such file or directory"));
  CHECK_THROWS_WITH(check_writable("a"), Contains("a: cannot be written"));
  CHECK_FALSE(file_exists("a"));
  fs::current_path(before);
  CHECK(absolute_path("a") == before / "a");
}

}  // namespace output_file_tests
