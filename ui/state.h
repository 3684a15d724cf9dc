#pragma once
// What the window knows and what its parts share: the session, the newest snapshot, edits on their way,
// navigation, the log, and requests to the loop that draws.
#include <deque>
#include <map>
#include <mutex>
#include <optional>

#include "base/log.h"
#include "camera_control.h"
#include "layout.h"
#include "session/session.h"

namespace lucerna::ui {

struct LogLine {
  log::Level level;
  double time;  ///< seconds since the window opened
  std::string text;
};

/// Takes log lines from any thread.
class LogInbox {
 public:
  LogInbox();
  ~LogInbox();
  LogInbox(const LogInbox&) = delete;
  LogInbox& operator=(const LogInbox&) = delete;
  std::vector<LogLine> take();

 private:
  std::mutex mutex_;
  std::vector<LogLine> lines_;
  int token_ = 0;
};

/// Settings as the person sees them: the session's, with edits on top until the session has taken them.
class SettingsView {
 public:
  explicit SettingsView(session::Session& session) : session_(session) {}
  void refresh(double now);
  void set(const std::string& key, const std::string& value);
  const std::string& text(const std::string& key) const;
  double real(const std::string& key) const;
  bool boolean(const std::string& key) const { return text(key) == "true"; }

 private:
  struct Pending {
    std::string value;
    double since;
  };
  session::Session& session_;
  plan::Settings known_;
  std::map<std::string, Pending> pending_;
  double now_ = 0;
};

enum class Kind { none, material, instance, light };
struct Selection {
  Kind kind = Kind::none;
  uint32_t index = 0;
};

struct Dialog {
  enum class Purpose { none, open, save } purpose = Purpose::none;
  std::string path;
  bool fresh = false;   ///< to be opened in the next frame
  bool focus = false;   ///< its field takes the keyboard in the next frame
  bool to_end = false;  ///< the cursor goes behind the text once the field has the keyboard
  int marked = -1;      ///< entry of the completion list
};

struct Ui {
  explicit Ui(session::Session& s) : session(s), settings(s) {}

  session::Session& session;
  std::shared_ptr<const session::Snapshot> snapshot;
  std::shared_ptr<const scene::Scene> scene;
  SettingsView settings;
  double now = 0;        ///< seconds since the window opened, at the start of the frame
  static double time();  ///< the same, right now

  // Scene edits that the session may not have taken yet, with the time of the last change.
  struct LightEdit {
    scene::Light light;
    double since;
  };
  std::map<uint32_t, LightEdit> light_edits;
  std::map<uint32_t, vec3> light_colours;  ///< of lights turned down to nothing
  struct EnvironmentEdit {
    float scale, rotation;
    double since;
  };
  std::optional<EnvironmentEdit> environment_edit;
  /// The light as the person sees it.
  scene::Light light(uint32_t index) const;
  void edit_light(uint32_t index, const scene::Light& light);
  void edit_environment(float scale, float rotation);
  void drop_taken_edits();

  // Navigation.
  std::optional<Viewpoint> view;  ///< none before the first picture of a scene
  uint64_t view_scene = 0;        ///< scene_id that `view` belongs to
  Box bounds;
  Flight flight;
  float speed = 1.5f;         ///< m/s
  int scene_camera = -1;      ///< the one taken last and not moved since
  bool camera_moved = false;  ///< to be sent after this frame
  void take_camera(int index);
  void moved();
  void frame_selection();
  /// Follows the session to a new scene.
  void follow_scene();

  Selection selection;
  Box selection_bounds() const;
  std::string selection_name() const;

  int solo = -1;
  std::array<bool, session::k_components> shown_before{};
  void toggle_solo(int component);
  void toggle_show(int component);

  // The window.
  Layout layout;
  std::map<std::string, bool> sections;  ///< open or not, by title
  bool& open(const char* section, bool fallback = true) {
    return sections.emplace(section, fallback).first->second;
  }
  std::deque<LogLine> log;
  bool log_follows = true;
  std::array<bool, 4> log_levels{false, true, true, true};
  std::vector<std::string> errors;  ///< the strip's, newest last
  uint64_t error_count = 0;         ///< errors logged so far
  Dialog dialog;
  bool help = false;
  std::vector<std::string> recent;  ///< files, newest first
  unsigned texture = 0;             ///< OpenGL name of the picture
  uint32_t texture_width = 0, texture_height = 0;
  int picture_divisor = 1;  ///< window pixels per picture pixel
  Area picture;             ///< where the picture may be
  bool picture_hovered = false;

  // Requests to the loop.
  std::vector<std::pair<int, int>> keys;  ///< pressed since the last frame: GLFW key and modifiers
  bool pressed(int key,
               int mods = 0) const;  ///< among `keys`, with exactly these modifiers (Shift is not looked at)
  int frames_wanted = 3;             ///< to be drawn even when nothing happens
  bool moving = false;               ///< something on screen moves by itself
  bool quit = false;
  bool screenshot = false;  ///< F12
  void wake(int frames = 2) { frames_wanted = frames_wanted < frames ? frames : frames_wanted; }

  void open_scene(const std::string& file);
  void save_picture(const std::string& file);
  void start_dialog(Dialog::Purpose purpose);
  void fail(const std::string& message);  ///< to the strip
  bool loading() const { return snapshot && snapshot->progress >= 0; }
};

// The parts, each in a file of its own; called once a frame in this order. Coordinates are window pixels.
void draw_menu_bar(Ui& ui, const Area& area);
void draw_light_panel(Ui& ui, const Area& area);
void draw_scene_panel(Ui& ui, const Area& area);
void draw_toolbar(Ui& ui, const Area& area);
void draw_picture(Ui& ui, const Area& area);
void draw_timings(Ui& ui, const Area& area);
void draw_log(Ui& ui, const Area& area);
void draw_splitters(Ui& ui, const Areas& areas);
void draw_dialogs(Ui& ui);
void handle_keys(Ui& ui);

/// Begins a bare panel at an area; end with ImGui::End().
void begin_panel(const char* name, const Area& area, ImU32 background, bool scrolls);
/// A control for an option of the settings table, by its type; the tooltip is its help.
void option_control(Ui& ui, const std::string& key, const std::string& name);

}  // namespace lucerna::ui
