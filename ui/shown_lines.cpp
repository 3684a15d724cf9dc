#include "shown_lines.h"

#include <imgui_internal.h>

#include <algorithm>

namespace lucerna::ui {

const std::vector<std::string> k_parts{"bar",      "left",   "toolbar", "picture", "right",
                                       "accuracy", "passes", "log",     "dialog"};

namespace {

/// The part of an ImGui window, by the name of its outermost parent.
std::string part_of(const ImGuiWindow* window) {
  if (!window) return "";
  const std::string name = window->RootWindow ? window->RootWindow->Name : window->Name;
  const std::string plain = name.starts_with("##") ? name.substr(2) : name;
  if (plain.starts_with("light")) return "left";
  if (plain.starts_with("scene") || plain.starts_with("side") || plain.starts_with("solver")) return "right";
  return std::find(k_parts.begin(), k_parts.end(), plain) != k_parts.end() ? plain : "dialog";
}

}  // namespace

ShownLines& ShownLines::instance() {
  static ShownLines lines;
  return lines;
}

void ShownLines::begin_frame() {
  lines_.clear();
  if (recording_) ++frames_;
}

void ShownLines::note(const std::string& text) {
  if (!recording_ || text.empty()) return;
  lines_.emplace_back(
      part_of(ImGui::GetCurrentContext() ? ImGui::GetCurrentContext()->CurrentWindow : nullptr), text);
}

std::vector<std::string> ShownLines::lines(const std::string& part) const {
  std::vector<std::string> found;
  for (const auto& [of, text] : lines_)
    if (part.empty() || of == part) found.push_back(text);
  return found;
}

}  // namespace lucerna::ui
