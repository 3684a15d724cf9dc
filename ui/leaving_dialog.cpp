// The question before a scene is left with edits that are not saved: the window closes, or another scene
// opens.
#include <GLFW/glfw3.h>

#include <filesystem>

#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

/// Leaves the scene once it is written; stays if that fails.
void follow_saving(Ui& ui) {
  try {
    if (ui.work.files.latest_written()) ui.finish_leaving();
  } catch (const std::exception&) {  // the reason is in the log
    ui.leaving = {};
  }
  ui.wake(2);
}

}  // namespace

void draw_leaving_dialog(Ui& ui) {
  using Step = Ui::Leaving::Step;
  if (ui.leaving.step == Step::no) return;
  if (ui.leaving.step == Step::saves) return follow_saving(ui);
  constexpr const char* k_id = "##leaving";
  const std::string opens = ui.leaving.opens;
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
      ui.act("scene.save");
      ui.leaving.step = Step::saves;
    } else {
      ImGui::SameLine(0, px(8));
      if (button("##discard", "Discard edits", false, w)) {
        ui.finish_leaving();
      } else {
        ImGui::SameLine(0, px(8));
        if (button("##stay", "Cancel", false, w) || ui.keys.pressed(GLFW_KEY_ESCAPE))
          ui.leaving = {};
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
