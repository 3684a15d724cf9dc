#pragma once
// The report folder: bench.json identifies it (matrix, device, version), cells/ has one file per finished
// render, pictures/ the pictures of the page. Every file is written under a temporary name and renamed, so
// that an interruption leaves only complete files; incomplete ones from elsewhere are recognised and measured
// again.
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "base/file.h"
#include "bench/matrix.h"
#include "bench/result.h"

namespace lucerna::bench {

/// Receives a one-line message.
using Message = std::function<void(const std::string&)>;

/// A folder in exclusive use by one bench.
class ReportFolder {
 public:
  /// Makes the folder with folders `parts` in it, or continues one with the same measurement (`matrix`: any
  /// JSON object that describes it, apart from its "name"), by the same version on the same device
  /// (`identity`: likewise; differing keys are named). Throws Error, located at the folder, and changes
  /// nothing, if it cannot be written, belongs to another bench, contains other files, or is in use by
  /// another bench.
  ReportFolder(const std::filesystem::path& path, const nlohmann::ordered_json& matrix,
               const nlohmann::ordered_json& identity, std::initializer_list<const char*> parts);
  ~ReportFolder();
  ReportFolder(const ReportFolder&) = delete;
  ReportFolder& operator=(const ReportFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 protected:
  std::filesystem::path path_;

 private:
  int lock_ = -1;
};

/// Report folder of a matrix.
class Folder : public ReportFolder {
 public:
  /// Throws Error as ReportFolder.
  Folder(const std::filesystem::path& path, const Matrix& matrix, const nlohmann::ordered_json& identity);

  std::filesystem::path pictures() const { return path_ / "pictures"; }

  /// Stored results of the matrix, by Matrix::id(). Those that cannot be read, belong to another cell or to a
  /// changed scene (`scene_hashes` by scene name) are reported and left out.
  std::map<std::string, Result> load(const Matrix& matrix,
                                     const std::map<std::string, std::string>& scene_hashes,
                                     const Message& message) const;
  void save(const std::string& id, const Result& result) const;
};

}  // namespace lucerna::bench
