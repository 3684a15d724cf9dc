#include "recall.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/json_text.h"

namespace fs = std::filesystem;

namespace lucerna::ui {
namespace {

fs::path state_file() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state)
    return fs::path(state) / "lucerna" / "window.json";
  if (const char* home = std::getenv("HOME"); home && *home)
    return fs::path(home) / ".local" / "state" / "lucerna" / "window.json";
  return {};
}

}  // namespace

void recall(Ui& ui) {
  std::ifstream stream(state_file());
  const auto json = nlohmann::json::parse(stream, nullptr, false);
  if (!json.is_object()) return;
  try {
    for (const auto& file : json.value("recent", nlohmann::json::array()))
      if (ui.recent.size() < 8) ui.recent.push_back(file.get<std::string>());
    Layout layout;
    layout.left = json.value("left", layout.left);
    layout.right = json.value("right", layout.right);
    layout.bottom = json.value("bottom", layout.bottom);
    const auto shares = json.value("strip", nlohmann::json::object());
    layout.passes_share = shares.value("passes", layout.passes_share);
    layout.log_share = shares.value("log", layout.log_share);
    layout.left_open = json.value("left_open", true);
    layout.right_open = json.value("right_open", true);
    layout.bottom_open = json.value("bottom_open", true);
    ui.layout = layout;
    ui.welcomed = json.value("welcomed", false);
    // items() keeps no temporary alive.
    const auto bookmarks = json.value("bookmarks", nlohmann::json::object());
    for (const auto& [file, views] : bookmarks.items())
      for (const auto& [name, line] : views.items()) ui.bookmarks[file][name] = line.get<std::string>();
    const auto sections = json.value("sections", nlohmann::json::object());
    for (const auto& [name, open] : sections.items()) ui.sections[name] = open.get<bool>();
  } catch (const nlohmann::json::exception&) {
    // Somebody else's file, or an older one: what was read so far holds.
  }
}

void remember(const Ui& ui) {
  const fs::path file = state_file();
  if (file.empty()) return;
  nlohmann::ordered_json json;
  json["recent"] = ui.recent;
  json["left"] = ui.layout.left, json["right"] = ui.layout.right, json["bottom"] = ui.layout.bottom;
  json["strip"] = {{"passes", ui.layout.passes_share}, {"log", ui.layout.log_share}};
  json["left_open"] = ui.layout.left_open, json["right_open"] = ui.layout.right_open,
  json["bottom_open"] = ui.layout.bottom_open;
  json["welcomed"] = ui.welcomed;
  auto& bookmarks = json["bookmarks"] = nlohmann::ordered_json::object();
  for (const auto& [scene, views] : ui.bookmarks)
    if (!views.empty()) bookmarks[scene] = views;
  json["sections"] = ui.sections;
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  const fs::path temporary = fs::path(file) += ".new";
  {
    std::ofstream stream(temporary);
    stream << json_text(json, 2) << '\n';
    if (!stream) return;
  }
  fs::rename(temporary, file, error);
}

}  // namespace lucerna::ui
