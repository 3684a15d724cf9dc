#include "bench/folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/file.h"
#include "base/json_text.h"

namespace lucerna::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const char* const k_claim = "bench.json";

/// Path of the first difference of two values, as "scenes/0/size".
std::string first_difference(Json a, Json b) {
  a.erase("name"), b.erase("name");  // the name of a matrix does not matter
  const nlohmann::json patch = nlohmann::json::diff(nlohmann::json(a), nlohmann::json(b));
  return patch.empty() ? "" : patch[0]["path"].get<std::string>().substr(1);
}

void check_claim(const std::string& where, const std::string& text, const Json& wanted) {
  const Json found = Json::parse(text, nullptr, false);
  if (!found.is_object() || !found.contains("matrix") || !found.contains("identity"))
    throw_error(where, "its {} is not a bench's; name another folder with --report", k_claim);
  if (const std::string at = first_difference(found["matrix"], wanted["matrix"]); !at.empty())
    throw_error(where,
                "holds the results of another matrix (it differs at {}); name another folder with --report",
                at);
  if (const std::string at = first_difference(found["identity"], wanted["identity"]); !at.empty())
    throw_error(where, "was measured elsewhere: {} was {}, now it is {}; name another folder with --report",
                at, found["identity"].value(at, "another"), wanted["identity"].value(at, "another"));
}

/// Tests by writing a file: permissions alone are not sufficient.
void check_writable(const fs::path& folder) {
  const fs::path probe = folder / fmt::format(".bench-{}", getpid());
  const int handle = open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (handle < 0) throw_error(folder.string(), "cannot write into this folder: {}", std::strerror(errno));
  close(handle);
  unlink(probe.c_str());
}

}  // namespace

ReportFolder::ReportFolder(const fs::path& path, const Json& matrix, const Json& identity,
                           std::initializer_list<const char*> parts)
    : path_(path) {
  const std::string where = path.string();
  std::error_code code;
  if (fs::exists(path, code) && !fs::is_directory(path, code))
    throw_error(where, "is a file; --report expects a folder");
  const bool existed = fs::is_directory(path, code);
  const Json claim{{"format", 1}, {"matrix", matrix}, {"identity", identity}};
  const fs::path claim_file = path / k_claim;
  if (existed && fs::exists(claim_file, code)) {
    check_claim(where, read_file(claim_file), claim);
  } else if (existed) {
    for (fs::directory_iterator entry(path, code); !code && entry != fs::directory_iterator();
         entry.increment(code))
      if (entry->path().filename() != "references")
        throw_error(where, "holds '{}', which no bench made; name an empty or a new folder with --report",
                    entry->path().filename().string());
  }
  if (!existed) fs::create_directories(path, code);
  if (code) throw_error(where, "the folder cannot be made: {}", code.message());
  check_writable(path);
  for (const char* part : parts) {
    fs::create_directories(path / part, code);
    if (code) throw_error((path / part).string(), "the folder cannot be made: {}", code.message());
  }
  if (!file_exists(claim_file)) write_file(claim_file, json_text(claim, 2) + "\n");
  lock_ = open(claim_file.c_str(), O_RDONLY | O_CLOEXEC);
  if (lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(lock_);
    throw_error(where, "another bench is at work in this folder");
  }
}

ReportFolder::~ReportFolder() {
  if (lock_ >= 0) close(lock_);
}

Folder::Folder(const fs::path& path, const Matrix& matrix, const Json& identity)
    : ReportFolder(path, to_json(matrix), identity, {"cells", "pictures"}) {}

std::map<std::string, Result> Folder::load(const Matrix& matrix,
                                           const std::map<std::string, std::string>& scene_hashes,
                                           const Message& message) const {
  std::map<std::string, Result> results;
  for (const Cell& c : matrix.cells()) {
    const std::string id = matrix.id(c);
    const fs::path file = path_ / "cells" / (id + ".json");
    if (!file_exists(file)) continue;
    try {
      Result r = parse_result(read_file(file), file.string());
      const SceneEntry& scene = matrix.scenes[c.scene];
      if (r.scene != scene.name || r.setting != matrix.settings[c.setting].name ||
          r.budget != matrix.budget(c).text() || r.repeat != c.repeat ||
          r.seed != matrix.seed + uint32_t(c.repeat))
        throw Error(file.string(), "of another cell");
      const auto hash = scene_hashes.find(scene.name);
      if (hash != scene_hashes.end() && hash->second != r.scene_hash)
        throw Error(file.string(), "the scene has changed since");
      results.emplace(id, std::move(r));
    } catch (const Error& e) {
      message(fmt::format("{}; it is measured again", e.what()));
    }
  }
  return results;
}

void Folder::save(const std::string& id, const Result& result) const {
  write_file(path_ / "cells" / (id + ".json"), json_text(to_json(result), 1) + "\n");
}

}  // namespace lucerna::bench
