#pragma once
// Files of irradiance caches: all complete records and what they were made with, so that they are reused only
// for the same light. Little-endian:
//
//   8 bytes      "LUCCACHE"
//   2 x u32      version of the format, layout of the records: k_cache_file_version, shared::k_record_layout
//   u32, u64     bytes of a record, bytes of the whole file
//   entries      program's version, what the records were made with, view, status; texts as u32 length and
//                bytes, lists as u32 count
//   2 x u32      records, and texels of each one's shares of groups of lights: 0 where none are kept
//   texels       the records: RawRecords, list by list
//   u64          checksum of all before, Hash::low()
//
// If the meaning of record texels changes, change k_record_layout too.
#include <filesystem>
#include <map>
#include <string>

#include "solvers/irradiance_cache/cache.h"

namespace lucerna::irradiance_cache {

inline constexpr uint32_t k_cache_file_version = 3;

/// Everything that determines the light in records.
struct MadeWith {
  std::string scene;                            ///< scene name for messages
  std::map<std::string, uint64_t> hashes;       ///< of the scene: "geometry", "lights", ...
  std::map<std::string, std::string> settings;  ///< settings that affect records, by key
  uint32_t parts = 0;                           ///< bit p: the records hold part p
  /// Tertiary light was looked up in other records, not path traced.
  bool recursive = false;
  bool elsewhere = false;  ///< ... or provided by another solver
  /// Selects one of the equally valid caches: stored, not compared.
  std::string seed;
};

struct CacheFile {
  std::string program;  ///< version of the program that wrote the file
  MadeWith made_with;
  /// Unique text of the view for which the cache was complete.
  std::string view;
  CacheStatus status;  ///< pass, uncovered, paths, rays, stop
  /// Hash of the assignment of lights to groups, if records store group shares; 0: they do not. Records of
  /// another grouping fit; their light is gathered again.
  uint64_t grouping = 0;
  RawRecords records;
};

std::string encode(const CacheFile& cache);
/// Throws Error at `where`: not a cache, another version or layout, truncated, damaged.
CacheFile decode(const std::string& bytes, const std::string& where);

/// Writes the file atomically (write_file). Throws Error located at `file`.
void write_cache(const std::filesystem::path& file, const CacheFile& cache);
/// Throws Error located at `file`: not readable, or as decode().
CacheFile read_cache(const std::filesystem::path& file);

/// Throws Error at `where` unless these records serve `wanted` and fit into `room` records. The message names
/// what differs: part of the scene, settings, parts, source of tertiary light (if wanted), or the setting to
/// change.
void check_fits(const CacheFile& cache, const MadeWith& wanted, uint32_t room, const std::string& where);

}  // namespace lucerna::irradiance_cache
