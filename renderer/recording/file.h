#pragma once
// Recordings in files (.lpath): a header with a schema, then chunks of paths, each with a checksum, then an
// end.
//
// All numbers are little-endian. The file begins with "LUCPATHS", its version (uint32), the bytes of the
// header (uint32) and their hash (uint64, FNV-1a). The header is JSON: picture, seed, scene, names of
// materials, lights and groups, what was selected, and `schema`: the fields of a path and of an event with
// type, count and offset. A chunk is "CHNK", its number of paths (uint32) and of events (uint64), the hash of
// its paths and events, then these. The end is "DONE" with the sums over all chunks, and their hash: a file
// without it was cut.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/output_file.h"
#include "recording/recording.h"

namespace lucerna::recording {

inline constexpr const char* k_file_ending = ".lpath";

/// Writes a file in parts; the file is there after finish(). Throws Error located at the file.
class Writer {
 public:
  /// `names`: picture and names; its paths are ignored. `about`: more for the header: what was selected.
  Writer(const std::filesystem::path& file, const Recording& names, const nlohmann::ordered_json& about = {});
  /// Appends the paths of a recording as a chunk.
  void add(const Recording& part);
  void finish();
  uint64_t paths() const { return paths_; }
  uint64_t events() const { return events_; }

 private:
  OutputFile out_;
  uint64_t paths_ = 0, events_ = 0;
};

/// Reads a file chunk by chunk. Errors are located at the file, and say at which byte: foreign, of another
/// version, cut, damaged.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file);
  /// Picture and names, without paths.
  const Recording& names() const { return names_; }
  const nlohmann::ordered_json& header() const { return header_; }
  /// The next chunk's paths and events, with the names; nullopt at the end of the file.
  std::optional<Recording> next();

 private:
  [[noreturn]] void refuse(const std::string& what) const;
  void read(void* to, uint64_t bytes, const char* what);

  std::filesystem::path file_;
  std::ifstream in_;
  uint64_t size_ = 0, at_ = 0;
  Recording names_;
  nlohmann::ordered_json header_;
  uint64_t paths_ = 0, events_ = 0;
};

}  // namespace lucerna::recording
