#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string_view>

namespace lucerna {

/// Where an output goes, and how its bytes get there:
/// - a regular file, or a name that no file has: under a temporary name beside it, flushed to disk, then
///   renamed by commit(). The old file stays until then, and stays for good where commit() is not reached.
///   The new file has the permissions of the one that it replaces.
/// - a symbolic link: its target, by these same rules. The link stays.
/// - a pipe, a device, or one of the process's own descriptors (/dev/stdout, /dev/fd/3): bytes go into it
///   directly, in order. It stays, and so do bytes that were written before a failure.
/// Every failure is an Error located at the name that was given.
class OutputFile {
 public:
  /// A pipe without a reader is waited for: ten seconds at most.
  explicit OutputFile(const std::filesystem::path& file);
  /// Removes the temporary file unless it was committed.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Whether bytes go straight into what has that name: they can only be appended.
  bool streams() const { return temporary_.empty(); }
  /// Appends bytes.
  void write(std::string_view bytes);
  /// Writes at a place of the temporary file (not where the output streams()). Returns the bytes written,
  /// fewer after a failure, which commit() then reports.
  size_t write_at(const void* bytes, size_t size, int64_t offset);
  bool failed() const { return failure_ != 0; }  ///< in write_at
  /// Gives the file its name. Data first, then the name, then the folder's entry: after a power cut the old
  /// or the new file is there, whole.
  void commit();

 private:
  [[noreturn]] void refuse(int code) const;
  /// `waits`: for a reader.
  void open_stream(bool waits);
  void open_temporary();

  std::filesystem::path name_, target_, temporary_;
  int handle_ = -1;
  int failure_ = 0;  ///< errno of the first write that failed
};

/// What OutputFile would refuse at once: a folder that is missing or closed, a folder's name, links that lead
/// in a circle, a file that may not be written. Throws Error located at `file`; leaves no trace. For long
/// work, before it begins.
void check_writable(const std::filesystem::path& file);

/// The file that an output of that name makes or replaces, behind all links and from the root; "" where it
/// goes into a pipe, a device or a descriptor. Throws Error as check_writable() does.
std::filesystem::path file_behind(const std::filesystem::path& name);

}  // namespace lucerna
