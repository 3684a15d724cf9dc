#include "viewer.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/timer.h"
#include "film/io/image_file.h"
#include "recall.h"
#include "runner.h"
#include "setting_lines.h"
#include "shown_lines.h"
#include "solvers/registry.h"
#include "state.h"
#include "thumbnails.h"
#include "widgets.h"
#include "window.h"

namespace lucerna::ui {
namespace {

constexpr double k_settle = 0.15;  // seconds that a viewport size must last before it is sent to the renderer
constexpr size_t k_log_lines = 2000;

class Viewer {
 public:
  Viewer(session::Session& session, const ViewerOptions& options)
      : options_(options),
        ui_(session),
        runner_(ui_.viewport, ui_.areas, ui_.log, ui_.requests, options.report ? *options.report : report_),
        settings_(started(runner_, options)),  // before a window is opened
        window_(options.width, options.height, options.hidden, options.scale) {
    ui_.scripted = !options.script.empty();
    if (remembers()) {
      memory_.emplace(ui_.remembered());
      ui_.cards.welcome = !std::exchange(ui_.welcomed, true);
    }
    if (!theme().font_note.empty()) log::warning("{}", theme().font_note);
    ui_.picture_of = [this](const std::string& file) { return texture_of(file); };
    ui_.thumbnail_of = [this](const std::string& file) { return thumbnail_texture_of(file); };
    ui_.compare.pictures.texture = [this](const std::string& slot, const std::string& content, bool smooth,
                                          const std::function<PictureBytes()>& make) {
      return pictures_.get(slot, content, smooth, make);
    };
    session.on_publish([] { Window::wake(); });
    if (!options.scene.empty() && options.script.empty())
      ui_.open_scene(options.scene.string());
    else if (!options.scene.empty())
      ui_.act("scene.open", options.scene.string());
    for (const std::string& line : settings_) ui_.act_line(line);
  }

  ~Viewer() { ui_.work.session.on_publish({}); }

  commands::ScriptResult result() const { return runner_.scripts.result(); }

  int run() {
    const auto interrupted = [&] { return options_.interrupted && options_.interrupted(); };
    while (!ui_.requests.status && !interrupted()) {
      pause_until_needed();
      if (window_.take_closing()) ui_.act("window.close");
      collect();
      if (memory_) memory_->follow(ui_.work.now);
      runner_.advance();
      inject();
      if (ui_.requests.status) break;
      if (ui_.frames_wanted > 0) draw();
    }
    return ui_.requests.status.value_or(0);
  }

 private:
  /// Reads script and settings; returns the settings as commands. Throws Error.
  std::vector<std::string> started(Runner& runner, const ViewerOptions& options) {
    if (!options.script.empty())
      runner.scripts.start(options.script, options.script_name, options.stay, options.variables);
    return setting_lines(ui_.work.registry, options.set);
  }

  /// Scripted runs save nothing.
  bool remembers() const { return options_.remember && options_.script.empty(); }

  /// Sleeps while there is nothing to draw; otherwise keeps the display's rate.
  void pause_until_needed() {
    double sleep = 1.0;
    if (ui_.frames_wanted > 0)
      sleep = window_.refresh_seconds() - (ui_.time() - last_draw_) - 1e-3;
    else if (runner_.running())
      sleep = 0.02;
    else if (size_changed_at_ >= 0)
      sleep = k_settle;
    else if (ui_.cards.busy.command != 0 || ui_.work.now < ui_.cards.note.until ||
             ui_.work.exposure.measuring() || ui_.work.compare.holding)
      sleep = 0.1;
    if (window_.wait(sleep)) ui_.wake(3), hovering_since_ = ui_.time();
  }

  /// Reads external input: snapshots, log lines, dropped files.
  void collect() {
    // Errors first: the workspace queries whether there were any.
    ui_.work.now = ui_.time();
    for (LogLine& line : inbox_.take()) {
      ui_.work.note_log(line.level, line.text);
      if (line.level == log::Level::error) ui_.fail(line.text);
      ui_.log.lines.push_back(std::move(line));
      if (ui_.log.lines.size() > k_log_lines) ui_.log.lines.pop_front();
      ui_.wake(2);
    }
    const auto snapshot = ui_.open.snapshot;
    const auto scene = ui_.open.scene;
    ui_.work.refresh(ui_.time());
    ui_.camera.resizing = ui_.frames_to_settle > 0 || size_changed_at_ >= 0;
    if (snapshot != ui_.open.snapshot) {
      ui_.wake(1);
      fresh_picture_ = ui_.open.snapshot != nullptr;
      if (ui_.open.snapshot) ui_.accuracy.runs.follow(*ui_.open.snapshot, ui_.open.scene);
    }
    if (scene != ui_.open.scene) {
      ui_.wake(1);
      hold_selection();
    }
    follow_title();
    for (const std::string& file : window_.dropped()) ui_.drop(file);
    ui_.follow_busy();
    if (ui_.cards.busy_seconds(ui_.work.now) > 0) ui_.wake(1);
    if (!ui_.cards.note.text.empty() && ui_.work.now >= ui_.cards.note.until)
      ui_.cards.note.text.clear(), ui_.wake(2);
    // Tooltips and the text cursor need a frame after the pointer has stopped.
    if (ui_.work.now - hovering_since_ < 0.7 || ImGui::GetIO().WantTextInput) ui_.wake(1);
    if (runner_.measuring() || ui_.moves.moving() || ui_.work.compare.holding) ui_.wake(1);
  }

  /// The scene's name, with an asterisk if there is something to save.
  void follow_title() {
    std::string title = "Lucerna";
    if (ui_.open.scene)
      title = (ui_.work.scene_file.unsaved() ? "*" : "") + ui_.open.scene->name + " \xE2\x80\x93 " + title;
    if (title != title_) window_.set_title(title_ = title), ui_.wake(1);
  }

  /// A script's mouse, keyboard and window input takes the same path as a user's.
  void inject() {
    if (ui_.requests.size)
      window_.set_size(ui_.requests.size->first, ui_.requests.size->second), ui_.requests.size.reset();
    if (ui_.requests.scale) window_.set_scale(*ui_.requests.scale), ui_.requests.scale.reset();
    for (const Requests::Input& input : std::exchange(ui_.requests.inputs, {}))
      if (input.button < 0)
        window_.move_mouse(input.x, input.y);
      else
        window_.press_mouse(input.button, input.down);
    for (const auto& [key, down] : std::exchange(ui_.requests.key_holds, {})) window_.hold_key(key, down);
    if (ui_.requests.wheel != 0) window_.turn_wheel(std::exchange(ui_.requests.wheel, 0.0f));
    for (const auto& [key, mods] : std::exchange(ui_.requests.key_strokes, {})) window_.press_key(key, mods);
    if (!ui_.requests.keyboard.empty()) window_.type(std::exchange(ui_.requests.keyboard, {}));
    for (const std::string& file : std::exchange(ui_.requests.drops, {})) window_.drop(file);
  }

  /// A selection survives edits, but not the removal of its object.
  void hold_selection() {
    const auto& s = ui_.camera.selection;
    const size_t count = !ui_.open.scene            ? 0
                         : s.kind == Kind::material ? ui_.open.scene->materials.size()
                         : s.kind == Kind::instance ? ui_.open.scene->instances.size()
                         : s.kind == Kind::light    ? ui_.open.lights().size()
                                                    : 0;
    if (s.index >= count) ui_.camera.selection = {};
  }

  void draw() {
    if (std::exchange(fresh_picture_, false) && !ui_.open.snapshot->rgba.empty()) {
      ui_.viewport.texture =
          window_.upload(ui_.open.snapshot->rgba, ui_.open.snapshot->scale * ui_.open.snapshot->width,
                         ui_.open.snapshot->scale * ui_.open.snapshot->height);
      ui_.viewport.texture_width = ui_.open.snapshot->width,
      ui_.viewport.texture_height = ui_.open.snapshot->height;
    }
    --ui_.frames_wanted;
    ui_.moves.begin_frame();
    ui_.keys.list.clear();
    for (const Window::Key& key : window_.pressed()) ui_.keys.list.emplace_back(key.key, key.mods);

    window_.begin_frame();
    ShownLines::instance().begin_frame();
    ImGui::PushFont(theme().fonts.regular);
    ui_.actions.follow_gesture();
    draw_parts(ui_);
    if (ui_.frames_to_settle > 0) --ui_.frames_to_settle, ui_.wake(1);
    ImGui::PopFont();
    window_.end_frame();
    pictures_.end_frame();
    const bool grabs = ui_.requests.grab && ui_.requests.grab->rgba.empty();
    if (!ui_.requests.shot.file.empty() || grabs) {
      ui_.wake(2);
      // Waits until the picture shows earlier commands, unless a scene is loading.
      const bool waits = ui_.open.snapshot && ui_.open.snapshot->activity.empty() && !ui_.open.up_to_date();
      if (!waits && ui_.requests.shot.settle-- <= 0) {
        if (grabs)
          ui_.requests.grab->rgba = window_.read(ui_.requests.grab->width, ui_.requests.grab->height);
        if (!ui_.requests.shot.file.empty()) screenshot(std::exchange(ui_.requests.shot.file, {}));
      }
    }
    window_.present();
    const double now = ui_.time();
    runner_.presented(1e3 * (now - last_present_));
    last_present_ = now;
    last_draw_ = ui_.work.now;
    send();
  }

  /// Sets the picture's size to the available area once that has stopped changing.
  void send() {
    const ImVec2 ratio = ImGui::GetIO().DisplayFramebufferScale;
    const auto divided = [&](float units, float scale) {
      return static_cast<uint32_t>(std::max(1.0f, units * scale / static_cast<float>(ui_.viewport.divisor)));
    };
    const std::pair<uint32_t, uint32_t> room{divided(ui_.viewport.area.width(), ratio.x),
                                             divided(ui_.viewport.area.height(), ratio.y)};
    const std::pair<uint32_t, uint32_t> size = ui_.picture_size.value_or(room);
    if (std::exchange(sent_scale_, ui_.viewport.divisor) != ui_.viewport.divisor)
      ui_.work.session.set_window_scale(static_cast<uint32_t>(ui_.viewport.divisor));
    const bool first = wanted_size_.first == 0;
    if (size != wanted_size_) wanted_size_ = size, size_changed_at_ = ui_.work.now;
    if (size_changed_at_ >= 0 && (ui_.work.now - size_changed_at_ >= k_settle || first || ui_.picture_size)) {
      ui_.camera.set_size(wanted_size_.first, wanted_size_.second);
      size_changed_at_ = -1;
    } else if (size_changed_at_ >= 0) {
      ui_.wake(1);
    }
  }

  void screenshot(const std::string& file) {
    uint32_t width = 0, height = 0;
    const std::vector<uint8_t> rgba = window_.read(width, height);
    try {
      film::write_png(file, width, height, rgba, {{k_window_mark, LUCERNA_VERSION}});
      log::info("window saved as {}", absolute_path(file).string());
    } catch (const std::exception& error) {
      log::error("{}", error.what());
      ui_.requests.shot.failed = true;
    }
  }

  unsigned thumbnail_texture_of(const std::string& file) {
    const PictureBytes* bytes = thumbnails_.get(file);
    if (!bytes) return 0;
    return pictures_.get("thumbnail of " + file, "made", true, [&] { return *bytes; });
  }

  unsigned texture_of(const std::string& file) {
    const auto [known, fresh] = textures_.try_emplace(file, 0);
    if (!fresh) return known->second;
    try {
      const film::FilmImage image = film::read_exr(file);
      const std::vector<size_t> channels = image.layer("");
      if (channels.size() < 3) return 0;
      std::vector<uint8_t> rgba(size_t{image.width} * image.height * 4, 255);
      for (size_t i = 0; i < rgba.size() / 4; ++i)
        for (size_t c = 0; c < 3; ++c)
          rgba[4 * i + c] = static_cast<uint8_t>(
              std::clamp(image.channels[channels[c]].second[i] * 255 + 0.5f, 0.0f, 255.0f));
      known->second = window_.make_texture(rgba, image.width, image.height);
    } catch (const Error& error) {
      log::warning("{}", error.what());
    }
    return known->second;
  }

  ViewerOptions options_;
  std::map<std::string, unsigned> textures_;  ///< of image files; 0: cannot be read
  LogInbox inbox_;
  Ui ui_;
  std::optional<Memory> memory_;
  commands::ReportFolder report_;
  Runner runner_;
  std::vector<std::string> settings_;
  Window window_;
  TextureCache pictures_{window_};
  Thumbnails thumbnails_{[] { Window::wake(); }};  // its thread ends before the window
  std::string title_;
  bool fresh_picture_ = false;
  double last_draw_ = -1, last_present_ = 0, hovering_since_ = -10;
  std::pair<uint32_t, uint32_t> wanted_size_{0, 0};
  int sent_scale_ = 1;  ///< picture_divisor as the session has it
  double size_changed_at_ = -1;
};

}  // namespace

namespace {

void handle_keys(Ui& ui) {
  ui.compare.flipped = ImGui::GetIO().KeysDown[GLFW_KEY_Y] && !ImGui::GetIO().WantTextInput;
  if (ui.compare.flipped) ui.wake(2);
  if (!handle_window_keys(ui.keys, ui.actions, ui.history, ui.layout.panels,
                          ui.dialog.purpose != Dialog::Purpose::none, ui.viewport.has_picture()))
    return;
  handle_picture_keys(ui.keys, ui.viewport);
  if (!ui.open.snapshot) return;
  handle_solver_keys(ui.keys, ui.controls, ui.cards, ui.side);
  if (ui.keys.pressed(GLFW_KEY_K)) ui.act("window.side", next_side(ui.open, ui.side, ui.shown.right_open));
}

void draw_dialogs(Ui& ui) {
  const bool escape = ui.keys.pressed(GLFW_KEY_ESCAPE);
  draw_file_dialog(ui.actions, ui.open, ui.recent, ui.folders, ui.picture_of, ui.thumbnail_of, ui.dialog,
                   escape);
  if (draw_leaving_dialog(ui.actions, ui.work.files, ui.work.scene_file.file(), ui.leaving, escape))
    ui.finish_leaving();
  draw_key_page(ui.help);
}

}  // namespace

void draw_parts(Ui& ui) {
  handle_keys(ui);
  const Areas areas = arrange(ui.layout, ImGui::GetIO().DisplaySize, theme().scale);
  ui.shown = areas.shown, ui.areas = areas;
  if (ui.layout.panels) {
    draw_splitters(ui.actions, areas);
    draw_menu_bar(ui.viewport, ui.accuracy, ui.log, ui.recent, ui.layout, ui.side, areas);
    draw_light_panel(ui.controls, ui.typed_layer, ui.shown.left_open, areas.left);
    draw_toolbar(ui.actions, ui.open, ui.viewport.dropper, areas.toolbar);
    const Area side =
        draw_side_tabs(ui.actions, ui.side, ui.work.traced || ui.work.noise || ui.side == k_paths_side,
                       !ui.work.compare.results.list().empty() || ui.side == k_compare_side,
                       ui.shown.right_open, areas.right);
    if (const solvers::SolverInfo* solver = solvers::find(ui.side); solver && ui.shown.right_open)
      draw_solver_panel(ui.controls, *solver, side);
    else if (ui.side == k_paths_side && ui.shown.right_open)
      draw_paths_panel(ui.controls, ui.work, ui.paths, side);
    else if (ui.side == k_compare_side && ui.shown.right_open)
      draw_compare_panel(ui.controls, ui.work, ui.compare, side);
    else if (ui.shown.right_open)
      draw_scene_panel(
          ui.controls, ui.camera, ui.scene_view,
          [&ui] { keep_view(ui.actions, ui.open, ui.camera, ui.cards); }, side);
    draw_accuracy(ui.actions, ui.open, ui.accuracy, ui.shown.bottom_open, areas.accuracy);
    draw_passes(ui.open, ui.shown.bottom_open, areas.passes);
    draw_log(ui.actions, ui.work.registry, ui.log, ui.shown.bottom_open, areas.log);
  }
  draw_picture(ui.viewport, ui.keys, ui.recent, ui.side == k_paths_side, areas.picture);
  draw_dialogs(ui);
}

int run_viewer(session::Session& session, const ViewerOptions& options, commands::ScriptResult* result) {
  Viewer viewer(session, options);
  const int status = viewer.run();
  if (result) *result = viewer.result();
  return status;
}

bool display_available() {
  if (!glfwInit()) return false;
  glfwTerminate();
  return true;
}

}  // namespace lucerna::ui
