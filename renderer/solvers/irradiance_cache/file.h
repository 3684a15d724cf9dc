#pragma once
// Irradiance caches as files: all complete records, with what they were made of, so that they are read again
// only where their light is the light. Little-endian:
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
// Whoever changes the meaning of a record's texels changes k_record_layout beside them.
#include <filesystem>
#include <map>
#include <string>

#include "solvers/irradiance_cache/cache.h"

namespace lucerna::irradiance_cache {

inline constexpr uint32_t k_cache_file_version = 3;

/// What decides the light that records hold.
struct MadeWith {
  std::string scene;                            ///< its name, for messages
  std::map<std::string, uint64_t> hashes;       ///< of the scene: "geometry", "lights", ...
  std::map<std::string, std::string> settings;  ///< those that decide what a record holds, by key
  uint32_t parts = 0;                           ///< bit p: the records hold part p
  /// Their tertiary light was looked up in other records, not path traced.
  bool recursive = false;
  bool elsewhere = false;  ///< ... or another solver looked it up
  /// Decides which of the equally good caches it is: kept, not compared.
  std::string seed;
};

struct CacheFile {
  std::string program;  ///< version of the one that wrote it
  MadeWith made_with;
  /// What the picture saw when the cache was complete for it, as a text that only that view gives.
  std::string view;
  CacheStatus status;  ///< pass, asked, paths, rays, stop
  /// Tells which light was of which group, where records keep their shares; 0: they do not. Records of other
  /// groups fit, and their light is then gathered anew.
  uint64_t grouping = 0;
  RawRecords records;
};

std::string encode(const CacheFile& cache);
/// Throws Error at `where`: not a cache, of another version or layout, cut short, damaged.
CacheFile decode(const std::string& bytes, const std::string& where);

/// Whole or not at all (write_file). Throws Error located at `file`.
void write_cache(const std::filesystem::path& file, const CacheFile& cache);
/// Throws Error located at `file`: cannot be read, or as decode().
CacheFile read_cache(const std::filesystem::path& file);

/// Throws Error at `where` unless these records can serve what is made with `wanted` and room for `room`
/// records: naming what of the scene, which settings, which parts or what gathered tertiary light (where that
/// is wanted) differ, or the setting that would fit.
void check_fits(const CacheFile& cache, const MadeWith& wanted, uint32_t room, const std::string& where);

}  // namespace lucerna::irradiance_cache
