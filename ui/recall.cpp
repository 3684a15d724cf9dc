#include "recall.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/log.h"

namespace fs = std::filesystem;

namespace lucerna::ui {
namespace {

using Json = nlohmann::ordered_json;
using Files = std::vector<std::string>;

constexpr double k_lasts = 0.5;  // seconds after which a change of the panels is saved

fs::path state_file() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state)
    return fs::path(state) / "lucerna" / "window.json";
  if (const char* home = std::getenv("HOME"); home && *home)
    return fs::path(home) / ".local" / "state" / "lucerna" / "window.json";
  return {};
}

/// A lock on the file for the lifetime of this object, unless another process holds it.
class Lock {
 public:
  explicit Lock(const fs::path& file) : handle_(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
    // Where locks are not supported, as on some network folders, the state is saved without one.
    held_ = handle_ < 0 || flock(handle_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
  }
  ~Lock() {
    if (handle_ >= 0) close(handle_);
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
  bool held() const { return held_; }

 private:
  int handle_;
  bool held_ = false;
};

/// Null if there is no file, or no JSON object.
Json read_state() {
  try {
    const Json json = Json::parse(read_file(state_file()), nullptr, false);
    if (json.is_object()) return json;
  } catch (const Error&) {
  }
  return {};
}

Json state_of(const Remembered& window) {
  Json json;
  json["recent"] = window.recent;
  json["left"] = window.layout.left, json["right"] = window.layout.right,
  json["bottom"] = window.layout.bottom;
  json["strip"] = {{"passes", window.layout.passes_share}, {"log", window.layout.log_share}};
  json["left_open"] = window.layout.left_open, json["right_open"] = window.layout.right_open,
  json["bottom_open"] = window.layout.bottom_open;
  json["arranged"] = {{"left", window.layout.left_arranged},
                      {"right", window.layout.right_arranged},
                      {"bottom", window.layout.bottom_arranged}};
  json["welcomed"] = window.welcomed;
  auto& bookmarks = json["bookmarks"] = Json::object();
  for (const auto& [scene, views] : window.bookmarks)
    if (!views.empty()) bookmarks[scene] = views;
  json["swatches"] = Json::object(), json["folders"] = Json::object();
  for (const auto& [name, words] : window.swatches) json["swatches"][name] = words;
  for (const auto& [ending, folder] : window.folders) json["folders"][ending] = folder;
  json["sections"] = Json(window.sections);
  if (window.sections.empty()) json["sections"] = Json::object();
  return json;
}

struct Lists {
  Files recent;
  std::map<std::string, commands::Navigation::Bookmarks> bookmarks;
  std::map<std::string, std::string> swatches, folders;
};

/// Values of another type are ignored: the file of another program or of an older version.
Lists lists_of(const Json& json) {
  const auto part = [](const Json& from, const std::string& key) {
    const auto found = from.find(key);
    return found == from.end() ? Json() : *found;
  };
  Lists lists;
  for (const auto& file : part(json, "recent"))
    if (file.is_string() && lists.recent.size() < k_recent_files) lists.recent.push_back(file);
  const auto read_texts = [&](const char* key, std::map<std::string, std::string>& into) {
    const Json texts = part(json, key);
    if (!texts.is_object()) return;
    for (const auto& [name, text] : texts.items())
      if (text.is_string()) into[name] = text;
  };
  read_texts("swatches", lists.swatches), read_texts("folders", lists.folders);
  const Json scenes = part(json, "bookmarks");  // items() keeps no temporary alive
  if (!scenes.is_object()) return lists;
  for (const auto& [file, views] : scenes.items()) {
    if (!views.is_object()) continue;
    for (const auto& [name, line] : views.items())
      if (line.is_string()) lists.bookmarks[file][name] = line;
  }
  return lists;
}

void take(const Lists& lists, const Remembered& window) {
  window.recent = lists.recent, window.bookmarks = lists.bookmarks;
  window.swatches = lists.swatches, window.folders = lists.folders;
}

void take_panels(const Json& json, const Remembered& window) {
  try {
    Layout layout;
    layout.left = json.value("left", layout.left);
    layout.right = json.value("right", layout.right);
    layout.bottom = json.value("bottom", layout.bottom);
    const auto shares = json.value("strip", Json::object());
    layout.passes_share = shares.value("passes", layout.passes_share);
    layout.log_share = shares.value("log", layout.log_share);
    layout.left_open = json.value("left_open", true);
    layout.right_open = json.value("right_open", true);
    layout.bottom_open = json.value("bottom_open", true);
    // A file without this holds what the user has changed where it differs from the defaults.
    const auto arranged = json.value("arranged", Json::object());
    const Layout fresh;
    layout.left_arranged = arranged.value("left", !layout.left_open || layout.left != fresh.left);
    layout.right_arranged = arranged.value("right", !layout.right_open || layout.right != fresh.right);
    layout.bottom_arranged = arranged.value("bottom", !layout.bottom_open || layout.bottom != fresh.bottom);
    window.layout = layout;
    window.welcomed = json.value("welcomed", false);
    const auto sections = json.value("sections", Json::object());
    for (const auto& [name, open] : sections.items()) window.sections[name] = open.get<bool>();
  } catch (const nlohmann::json::exception&) {
  }
}

/// `theirs` with the changes from `before` to `mine`.
Json merged(const Json& before, const Json& mine, Json theirs) {
  if (!theirs.is_object()) return mine;
  for (const auto& [key, value] : mine.items()) {
    const auto old = before.find(key);
    if (old != before.end() && *old == value) continue;
    if (value.is_object())
      theirs[key] = merged(old == before.end() ? Json::object() : *old, value,
                           theirs.contains(key) ? theirs[key] : Json::object());
    else
      theirs[key] = value;
  }
  for (const auto& [key, value] : before.items())
    if (!mine.contains(key)) theirs.erase(key);
  return theirs;
}

/// The files added in front of `before` to make `mine`, followed by `theirs`.
Files merged_recent(const Files& before, const Files& mine, const Files& theirs) {
  const auto without = [](const Files& list, const Files& front) {
    Files rest;
    for (const std::string& file : list)
      if (std::find(front.begin(), front.end(), file) == front.end()) rest.push_back(file);
    return rest;
  };
  for (size_t k = 0;; ++k) {
    Files front(mine.begin(), mine.begin() + std::ptrdiff_t(k));
    const Files old = without(before, front), rest(mine.begin() + std::ptrdiff_t(k), mine.end());
    if (rest.size() > old.size() || !std::equal(rest.begin(), rest.end(), old.begin())) continue;
    for (const std::string& file : without(theirs, front)) front.push_back(file);
    if (front.size() > k_recent_files) front.resize(k_recent_files);
    return front;
  }
}

}  // namespace

struct Memory::Kept {
  Json saved;              ///< this window's state when it was last read or written
  Json seen;               ///< the state at the last call of follow()
  double changed_at = -1;  ///< time of the last change of `seen`
  bool warned = false;
};

Memory::Memory(const Remembered& window) : window_(window), kept_(std::make_unique<Kept>()) {
  const Json json = read_state();
  if (json.is_object()) take(lists_of(json), window_), take_panels(json, window_);
  kept_->saved = kept_->seen = state_of(window_);
}

Memory::~Memory() {
  // Waits a limited time for another window that was stopped while holding the lock.
  for (int i = 0; state_of(window_) != kept_->saved && !save() && i < 100; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

void Memory::follow(double now) {
  const Json mine = state_of(window_);
  if (mine == kept_->saved) return;
  if (mine != kept_->seen) kept_->changed_at = now, kept_->seen = mine;
  const auto differs = [&](const char* key) { return mine[key] != kept_->saved[key]; };
  if (differs("bookmarks") || differs("swatches") || differs("recent") || differs("welcomed") ||
      now - kept_->changed_at > k_lasts)
    save();
}

bool Memory::save() {
  const fs::path file = state_file();
  if (file.empty()) return true;
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  const Lock lock(fs::path(file) += ".lock");
  if (!lock.held()) return false;
  Json theirs = read_state();
  if (!theirs.is_object()) theirs = kept_->saved;
  const Json mine = state_of(window_);
  Json all = merged(kept_->saved, mine, theirs);
  all["recent"] =
      merged_recent(lists_of(kept_->saved).recent, lists_of(mine).recent, lists_of(theirs).recent);
  try {
    write_file(file, json_text(all, 2) + "\n");
  } catch (const Error& e) {
    if (!std::exchange(kept_->warned, true))
      log::warning("{}; bookmarks and swatches are not kept", e.what());
    kept_->saved = mine;  // not tried again for the same change
    return true;
  }
  take(lists_of(all), window_);
  kept_->saved = kept_->seen = state_of(window_);
  return true;
}

}  // namespace lucerna::ui
