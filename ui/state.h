#pragma once
// What the window knows and what its parts share: the workspace, what the panels show, the log, and requests
// to the loop that draws.
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>

#include "accuracy_plot.h"
#include "base/log.h"
#include "commands/workspace.h"
#include "lamp_handles.h"
#include "layout.h"
#include "solvers/info.h"

namespace lucerna::ui {

using commands::Flight;
using commands::Kind;
using commands::named;
using commands::Selection;
using commands::Viewpoint;

/// The right panel's name for the scene, beside the names of solvers.
inline constexpr const char* k_scene_side = "scene";

inline constexpr size_t k_recent_files = 8;  ///< that are kept

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

struct Dialog {
  enum class Purpose { none, open, save, script, reference, solver_load, solver_save };
  Purpose purpose = Purpose::none;
  const solvers::SolverInfo* solver = nullptr;  ///< whose work is loaded or saved
  std::string path;
  bool fresh = false;     ///< to be opened in the next frame
  bool focus = false;     ///< its field takes the keyboard in the next frame
  bool to_end = false;    ///< the cursor goes behind the text once the field has the keyboard
  int marked = -1;        ///< entry of the completion list
  bool pictures = false;  ///< the program's scenes are shown in its place
  bool as_shown = true;   ///< a PNG is saved with the filter that the window shows
};

/// The line under the log.
struct Console {
  std::string text;
  std::vector<std::string> history;
  int at = -1;         ///< entry of the history that is shown, or -1
  bool focus = false;  ///< takes the keyboard in the next frame
  bool active = false;
};

/// A workspace with a window around it.
struct Ui : commands::Workspace {
  explicit Ui(session::Session& s);

  static double time();  ///< seconds since the window opened

  /// Carries out a command that a control stands for; a failure goes to the log and the strip of errors. What
  /// is done while one control is held, or in one flight, is one gesture.
  template <class... A>
  void act(const std::string& command, const A&... words) {
    act_line(commands::line(command, words...));
  }
  void act_line(const std::string& line);
  /// Turns a boolean setting over.
  void toggle(const std::string& key) { act("set", key, setting_on(key) ? "false" : "true"); }
  uint64_t gesture = 0;  ///< of the control that is held now; 0: none
  /// Finds out which control is held; call once a frame.
  void follow_gesture();

  /// Lines typed at the console, to be carried out by the runner.
  std::vector<std::string> typed;

  Flight flight;
  std::set<int> chorded;  ///< GLFW keys whose last press was with Ctrl: they do not fly
  /// Whether the selection is new since the last call, and was not made in the list (`chosen_in_list`): then
  /// its row is to be shown.
  bool reveals();
  /// A row has been pressed, which is in view; an emissive material has two.
  bool chosen_in_list = false;
  /// Puts the camera where a drag or a flight has taken it.
  void place(const Viewpoint& view);
  /// The same for turns of the wheel: those that follow one another closely are one step.
  void place_by_wheel(const Viewpoint& view);
  /// What a drag in the picture began on.
  struct {
    std::optional<vec3> point;       ///< of the scene
    float azimuth = 0;               ///< of what is turned by it, degrees
    std::optional<LampHandle> lamp;  ///< as it was then
  } drag;
  /// The next click in the picture sets the exposure by what it hits.
  bool dropper = false;

  /// A sentence over the picture that goes by itself.
  struct {
    std::string text;
    double until = 0;
  } note;
  void notice(const std::string& text, double seconds = 6);
  /// Says that a wall stands in the way, now and then.
  void say_blocked();

  /// Carried out without anybody at the window: nothing is remembered, nothing done unasked.
  bool scripted = false;
  bool welcome = false;   ///< the first steps are shown
  bool welcomed = false;  ///< ... and were, now or in an earlier run

  /// What the renderer does now, and since when. A command that is carried out is not shown any more: then
  /// the first picture of it is in progress.
  struct {
    uint64_t command = 0;  ///< the session's number of it; 0: nothing is to be waited for
    bool done = false;     ///< it is carried out, and no picture shows it yet
    double since = 0;
    std::string text;  ///< the line that gave it; "" for none
  } busy;
  /// Seconds that the renderer has been at one thing; 0 while that is not worth telling.
  double busy_seconds() const;
  void follow_busy();

  // The window.
  Layout layout;                         ///< as chosen
  Layout shown;                          ///< as this frame has room for
  std::map<std::string, bool> sections;  ///< open or not, by title
  std::deque<LogLine> log;
  bool log_follows = true;
  std::array<bool, 4> log_levels{false, true, true, true};
  std::vector<std::string> errors;  ///< the strip's, newest last
  Console console;
  Dialog dialog;
  bool help = false;
  std::vector<std::string> recent;  ///< files, newest first, from the root
  unsigned texture = 0;             ///< OpenGL name of the picture
  uint32_t texture_width = 0, texture_height = 0;
  /// OpenGL name of an image file's picture, made when it is first asked for; 0 where it cannot be read. Null
  /// without a window.
  std::function<unsigned(const std::string&)> picture_of;
  int picture_divisor = 1;  ///< window pixels per picture pixel
  /// Frames to be drawn until the room for the picture is as the commands so far have it.
  int frames_to_settle = 0;
  /// Pixels of the picture; none: as many as the window has room for.
  std::optional<std::pair<uint32_t, uint32_t>> picture_size;
  bool light_marks = false;  ///< lights are marked in the picture
  bool brackets = true;      ///< the selected object is marked in the picture
  Area picture;              ///< where the picture may be
  bool picture_hovered = false;

  // Solvers.
  std::string side = k_scene_side;  ///< what the right panel shows: the scene, or the solver of that name
  /// What the key K shows next: the panels of solvers that are in use, then the scene again.
  std::string next_side() const;
  bool view_on(const solvers::ViewInfo& view) const;
  /// On or off; of a choice the next of its ring.
  void turn_view(const solvers::ViewInfo& view);
  /// Whether a view lies over the picture of which the pointer asks what is under it.
  bool asks_pointer() const;
  /// Where the pointer has asked last, as inspect.at takes it.
  std::optional<vec2> asked;

  // Accuracy.
  Runs runs;
  double what_if = 0.01;  ///< relative error that is asked about in uniform sampling
  /// It was asked about since the target was set last: adaptive sampling begins with it.
  bool what_if_asked = false;
  /// What the target's line stands at: the setting in adaptive sampling, the question in uniform.
  double target() const;
  /// Seconds of rendering until it is reached.
  std::optional<stats::Band> forecast();
  std::optional<PlotRange> held_range;  ///< the plot's, while the target is dragged
  float held_offset = 0;                ///< of the pointer from the line

  // Requests to the loop.
  std::vector<std::pair<int, int>> keys;  ///< pressed since the last frame: GLFW key and modifiers
  bool pressed(int key,
               int mods = 0) const;  ///< among `keys`, with exactly these modifiers (Shift is not looked at)
  int frames_wanted = 3;             ///< to be drawn even when nothing happens
  bool moving = false;               ///< something on screen moves by itself
  std::optional<int> status;         ///< the program's, when it is to end with one
  struct Shot {
    std::string file;     ///< "" for none
    int settle = 0;       ///< frames to draw before it is taken
    bool failed = false;  ///< the last one could not be written
  } shot;
  std::optional<std::pair<int, int>> size;  ///< window size wanted
  std::optional<float> scale;               ///< of text and controls wanted
  /// Mouse and keys as a script moves them.
  struct Input {
    float x = 0, y = 0;  ///< window pixels
    int button = -1;     ///< -1: the pointer moves; otherwise the button changes, where the pointer is
    bool down = false;
  };
  std::vector<Input> inputs;
  std::vector<std::pair<int, bool>> key_holds;   ///< GLFW keys that go down and stay, or come up
  float wheel = 0;                               ///< notches that it is turned
  std::vector<std::pair<int, int>> key_strokes;  ///< GLFW keys with their modifiers
  std::string keyboard;                          ///< text typed
  std::vector<std::string> drops;                ///< files that a script drops on the window
  void wake(int frames = 2) { frames_wanted = frames_wanted < frames ? frames : frames_wanted; }

  /// A file was dropped on the window.
  void drop(const std::string& file);
  void start_dialog(Dialog::Purpose purpose, const solvers::SolverInfo* solver = nullptr);
  void fail(const std::string& message);                  ///< to the strip
  void print(log::Level level, const std::string& text);  ///< to the log panel alone
  bool has_picture() const { return snapshot && !snapshot->rgba.empty(); }

 protected:
  void scene_changed() override;
  void measured(const std::string& text) override;
  void size_refused(uint32_t width, uint32_t height) override {
    if (picture_size) picture_size.emplace(width, height);
  }
  void written(const std::string& name) override;
  std::vector<std::pair<std::string, std::string>> set_with(const std::string& key,
                                                            const std::string& value) override;
  bool exposes_at_load() const override { return !scripted; }

 private:
  Selection revealed_;
  unsigned held_ = 0;  ///< id of the control that is held
  bool flying_ = false;
  uint64_t gestures_ = 0;
  double wheeled_ = -10, blocked_said_ = -60;
  uint64_t wheel_gesture_ = 0;
  struct {
    std::shared_ptr<const session::Accuracy> of;
    double target = 0;
    std::optional<stats::Band> band;
  } forecast_;
};

/// Handles the keys pressed and draws all parts of the window where the layout puts them; once a frame.
void draw_parts(Ui& ui);

// The parts, each in a file of its own; called once a frame in this order. Coordinates are window pixels.
void draw_menu_bar(Ui& ui, const Area& area);
void draw_light_panel(Ui& ui, const Area& area);
void draw_mix(Ui& ui);  ///< the light mix, into a section of that panel
/// The titles of what the right panel may show; returns what is left of its area below them.
Area draw_side_tabs(Ui& ui, const Area& area);
void draw_scene_panel(Ui& ui, const Area& area);
void draw_solver_panel(Ui& ui, const solvers::SolverInfo& solver, const Area& area);
void draw_toolbar(Ui& ui, const Area& area);
void draw_picture(Ui& ui, const Area& area);
void draw_accuracy(Ui& ui, const Area& area);
void draw_passes(Ui& ui, const Area& area);
void draw_log(Ui& ui, const Area& area);
/// What may be opened, where there is no picture; part of draw_picture. Nothing while something goes on.
void draw_empty_state(Ui& ui, const Area& area);
/// What goes on, what went wrong and the first steps, over the picture; part of draw_picture.
void draw_cards(Ui& ui, const Area& area);
/// Over the picture's lower left; part of draw_picture.
void draw_legend(Ui& ui, const Area& area);
/// What inspect.at has found, in a card over the picture; part of draw_picture.
void draw_inspection(Ui& ui, const Area& area);
/// Keeps the view under the next free name, and says so.
void keep_view(Ui& ui);
void draw_splitters(Ui& ui, const Areas& areas);
void draw_dialogs(Ui& ui);
void draw_file_dialog(Ui& ui);  ///< part of draw_dialogs
void handle_keys(Ui& ui);

/// GLFW's key and modifiers of a name such as "ctrl+z". Throws Error when there is none such.
std::pair<int, int> key_of(const std::string& name);
/// Registers what only a window can do: panels, dialogs, the log.
void add_window_commands(Ui& ui);

/// Begins a bare panel at an area; end with ImGui::End().
void begin_panel(const char* name, const Area& area, ImU32 background, bool scrolls);
/// The heading of a panel of the bottom strip; returns the x where its content at the right may start.
float panel_heading(const char* title, const Area& area);
/// A section of a panel, whose fold is a command; `fallback`: whether it is open before anybody has said so.
bool panel_section(Ui& ui, const char* title, bool fallback, const std::string& note = "");
/// What the panel of a solver holds, in a sentence.
std::string panel_help(const solvers::SolverInfo& solver);
/// Its first letter as a capital, or as a small one.
std::string capitalised(std::string text);
std::string uncapitalised(std::string text);
/// A control for an option of the settings table, by its type; the tooltip is its help.
void option_control(Ui& ui, const std::string& key, const std::string& name);

}  // namespace lucerna::ui
