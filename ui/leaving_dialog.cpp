// The question before a scene is left with edits that are not saved: the window closes, or another scene
// opens.
#include <filesystem>

#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

/// True once the scene is written; stays in it if that fails.
bool saved(Actions& actions, const commands::SavedFiles& files, Leaving& leaving) {
  actions.wake(2);
  try {
    return files.latest_written();
  } catch (const std::exception&) {  // the reason is in the log
    leaving = {};
    return false;
  }
}

}  // namespace

bool draw_leaving_dialog(Actions& actions, const commands::SavedFiles& files, const std::string& saves_to,
                         Leaving& leaving, bool escape) {
  using Step = Leaving::Step;
  if (leaving.step == Step::no) return false;
  if (leaving.step == Step::saves) return saved(actions, files, leaving);
  constexpr const char* k_id = "##leaving";
  const std::string opens = leaving.opens;
  bool may_leave = false;
  if (!ImGui::IsPopupOpen(k_id)) ImGui::OpenPopup(k_id);
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * window.x, 0.4f * window.y}, 0, {0.5f, 0.5f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {px(16), px(14)});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {px(8), px(8)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(3));
  if (ImGui::BeginPopupModal(k_id, nullptr,
                             ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                                 ImGuiWindowFlags_NoResize | ImGuiWindowFlags_AlwaysAutoResize)) {
    const std::string file = std::filesystem::path(saves_to).filename().string();
    label(elided(opens.empty() ? "Save the edits before closing?"
                               : "Save the edits before " + std::filesystem::path(opens).filename().string() +
                                     " is opened?",
                 px(420), theme().fonts.strong),
          colour::text, theme().fonts.strong);
    label(elided("They would be written to " + file + ".", px(420), theme().fonts.small), colour::text_dim,
          theme().fonts.small);
    gap(4);
    const float w = px(124);
    bool done = true;
    if (button("##save_scene", "Save", true, w)) {
      actions.act("scene.save");
      leaving.step = Step::saves;
    } else {
      ImGui::SameLine(0, px(8));
      if (button("##discard", "Discard edits", false, w)) {
        may_leave = true;
      } else {
        ImGui::SameLine(0, px(8));
        if (button("##stay", "Cancel", false, w) || escape)
          leaving = {};
        else
          done = false;
      }
    }
    if (done) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
  }
  ImGui::PopStyleVar(3);
  return may_leave;
}

}  // namespace lucerna::ui
