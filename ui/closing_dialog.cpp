// The question before the window closes with edits that are not saved.
#include <GLFW/glfw3.h>

#include <filesystem>

#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

/// Closes once the scene is written; stays open if that fails.
void follow_saving(Ui& ui) {
  try {
    if (ui.work.files.latest_written()) ui.requests.status = 0;
  } catch (const std::exception&) {  // the reason is in the log
    ui.closing = Ui::Closing::no;
  }
  ui.wake(2);
}

}  // namespace

void draw_closing_dialog(Ui& ui) {
  if (ui.closing == Ui::Closing::no) return;
  if (ui.closing == Ui::Closing::saves) return follow_saving(ui);
  constexpr const char* k_id = "##closing";
  if (!ImGui::IsPopupOpen(k_id)) ImGui::OpenPopup(k_id);
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * window.x, 0.4f * window.y}, 0, {0.5f, 0.5f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {px(16), px(14)});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {px(8), px(8)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(3));
  if (ImGui::BeginPopupModal(k_id, nullptr,
                             ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                                 ImGuiWindowFlags_NoResize | ImGuiWindowFlags_AlwaysAutoResize)) {
    const std::string file = std::filesystem::path(ui.work.scene_file.file()).filename().string();
    label("Save the edits before closing?", colour::text, theme().fonts.strong);
    label(elided("They would be written to " + file + ".", px(420), theme().fonts.small), colour::text_dim,
          theme().fonts.small);
    gap(4);
    const float w = px(124);
    bool done = true;
    if (button("##save_scene", "Save", true, w)) {
      ui.act("scene.save");
      ui.closing = Ui::Closing::saves;
    } else {
      ImGui::SameLine(0, px(8));
      if (button("##discard", "Discard edits", false, w)) {
        ui.closing = Ui::Closing::no;
        ui.requests.status = 0;
      } else {
        ImGui::SameLine(0, px(8));
        if (button("##stay", "Cancel", false, w) || ui.pressed(GLFW_KEY_ESCAPE))
          ui.closing = Ui::Closing::no;
        else
          done = false;
      }
    }
    if (done) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
  }
  ImGui::PopStyleVar(3);
}

}  // namespace lucerna::ui
