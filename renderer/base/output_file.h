#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string_view>

namespace lucerna {

/// An output file:
/// - A regular or new file is written under a temporary name beside it, flushed to disk, and renamed by
///   commit(). Until then, and if commit() is never called, the old file stays. The new file gets the old
///   one's permissions. A read-only file is refused, also for root.
/// - For a symbolic link the same applies to its target; the link stays.
/// - Into a pipe, a device or a descriptor (/dev/stdout, /dev/fd/3) bytes are written directly, in order;
///   bytes written before a failure stay.
/// Every failure is an Error located at the given name.
class OutputFile {
 public:
  /// Waits up to ten seconds for a pipe's reader.
  explicit OutputFile(const std::filesystem::path& file);
  /// Removes the temporary file unless it was committed.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// True if bytes go directly to the target and can only be appended.
  bool streams() const { return temporary_.empty(); }
  /// Appends bytes.
  void write(std::string_view bytes);
  /// Writes at an offset of the temporary file (not if streams()). Returns the bytes written; fewer after a
  /// failure, which commit() reports.
  size_t write_at(const void* bytes, size_t size, int64_t offset);
  bool failed() const { return failure_ != 0; }  ///< in write_at
  /// Renames the file. Data, name and folder entry are flushed in this order: after a power failure the old
  /// or the new file is there, complete.
  void commit();

 private:
  [[noreturn]] void refuse(int code) const;
  /// `waits`: wait for a reader.
  void open_stream(bool waits);
  void open_temporary();

  std::filesystem::path name_, target_, temporary_;
  int handle_ = -1;
  int failure_ = 0;  ///< errno of the first write that failed
};

/// Throws Error located at `file` if OutputFile would: missing or unwritable folder, a folder's name, cyclic
/// links, an unwritable file. Writes nothing. Call it before long work.
void check_writable(const std::filesystem::path& file);

/// The absolute path, links followed, of the file that an output of that name creates or replaces; "" for a
/// pipe, device or descriptor. Throws Error like check_writable().
std::filesystem::path file_behind(const std::filesystem::path& name);

}  // namespace lucerna
