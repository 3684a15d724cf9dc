#pragma once
// State that the window's parts share: the workspace, what the panels show, the log, and requests to the main
// loop.
#include <deque>
#include <functional>
#include <map>
#include <optional>

#include "accuracy_view.h"
#include "actions.h"
#include "camera_moves.h"
#include "cards_view.h"
#include "commands/workspace.h"
#include "compare_panel.h"
#include "controls.h"
#include "keys.h"
#include "layers_block.h"
#include "layout.h"
#include "log_view.h"
#include "paths_panel.h"
#include "recall.h"
#include "region_view.h"
#include "requests.h"
#include "scene_view.h"
#include "solvers/info.h"
#include "viewport.h"

namespace lucerna::ui {

using commands::Flight;
using commands::Kind;
using commands::named;
using commands::Selection;
using commands::Viewpoint;

/// Name of the scene's panel on the right, beside the names of solvers.
inline constexpr const char* k_scene_side = "scene";

struct Dialog {
  enum class Purpose {
    none,
    open,
    save,
    scene,
    script,
    test,
    reference,
    held,
    environment,
    value,
    solver_load,
    solver_save
  };
  Purpose purpose = Purpose::none;
  const solvers::SolverInfo* solver = nullptr;  ///< for solver_load and solver_save
  std::string line, title;           ///< for value: a command that ends in "WORD=", and what the file is for
  std::vector<std::string> endings;  ///< for value: of its files
  std::string path;
  bool fresh = false;     ///< opens in the next frame
  bool focus = false;     ///< its field gets the keyboard in the next frame
  bool to_end = false;    ///< the cursor moves behind the text once the field has the keyboard
  int marked = -1;        ///< entry of the completion list
  bool pictures = false;  ///< shows the program's scenes
  bool as_shown = true;   ///< a PNG is saved as the window shows it
};

/// The scene is to be left with edits that are not saved: a dialog asks what to do with them.
struct Leaving {
  enum class Step { no, asks, saves } step = Step::no;
  std::string opens;  ///< the scene that follows; "": the window closes
};

/// OpenGL name of an image file's picture, created on first use; 0 if it cannot be read.
using PictureOf = std::function<unsigned(const std::string&)>;

/// The window's state over a workspace.
struct Ui {
  explicit Ui(session::Session& session);
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  commands::Workspace work;
  // Its parts.
  commands::OpenScene& open = work.open;
  commands::Navigation& camera = work.camera;
  const commands::History& history = work.history;

  static double time();  ///< seconds since the window opened

  Flight flight;
  Actions actions{work, flight, [this](int frames) { wake(frames); }};
  // Short forms.
  template <class... A>
  void act(const std::string& command, const A&... words) {
    actions.act(command, words...);
  }
  void act_line(const std::string& line) { actions.act_line(line); }
  void toggle(const std::string& key) { actions.toggle(key); }

  PathsView paths;
  RegionView region;
  CompareState compare{open};
  TypedLayer typed_layer;

  CardsView cards{actions};
  CameraMoves moves{actions, camera, flight, cards};

  /// Runs a script without a user: nothing is kept, nothing happens by itself.
  bool scripted = false;
  bool welcomed = false;  ///< the first steps were shown, now or in an earlier run

  void follow_busy();  ///< determines the command in progress

  // The window.
  Layout layout;                         ///< as chosen
  Layout shown;                          ///< as it fits this frame
  Areas areas;                           ///< of the parts in this frame
  std::map<std::string, bool> sections;  ///< open or not, by title
  Controls controls{actions, open, sections};
  SceneView scene_view;
  LogView log{actions};
  Dialog dialog;
  bool help = false;
  Leaving leaving;
  /// Leaves the scene for another one, or closes the window if `opens` is "". Asks before edits are lost.
  void leave(const std::string& opens);
  /// Leaves it, with or without edits, for leaving.opens.
  void finish_leaving();
  /// Opens a scene whose solvers the program chooses, if the scene does not.
  void open_scene(const std::string& file);
  std::vector<std::string> recent;  ///< files, newest first, from the root; at most k_recent_files
  /// What is kept between runs.
  Remembered remembered() {
    return {recent, camera.bookmarks, scene_view.swatches, folders, layout, sections, welcomed};
  }
  /// Folders from which files were chosen last, by the first of their endings.
  std::map<std::string, std::string> folders;
  Viewport viewport{controls, work, moves, scene_view, paths, region, compare, cards};
  PictureOf picture_of;    ///< null without a window
  PictureOf thumbnail_of;  ///< likewise: small, made in the background; 0 until it is there
  /// Frames to draw until the picture's area reflects the commands so far.
  int frames_to_settle = 0;
  /// Size of the picture in pixels; none: as large as the window allows.
  std::optional<std::pair<uint32_t, uint32_t>> picture_size;
  // Solvers.
  std::string side =
      k_scene_side;  ///< what the right panel shows: the scene, paths, held results, or that solver
  AccuracyView accuracy{open};

  // Keys, frames, and requests to the loop.
  Keys keys;
  int frames_wanted = 3;  ///< to draw even if nothing happens
  Requests requests;
  void wake(int frames = 2) { frames_wanted = frames_wanted < frames ? frames : frames_wanted; }

  /// A file was dropped on the window.
  void drop(const std::string& file);
  void start_dialog(Dialog::Purpose purpose, const solvers::SolverInfo* solver = nullptr,
                    const std::string& line = "", const std::string& what = "",
                    const std::vector<std::string>& endings = {});
  /// A dialog for a file that becomes the last word of `line`, which ends in "WORD="; `what`: what it is for.
  void choose_file(const std::string& line, const std::string& what, const std::vector<std::string>& endings);
  void fail(const std::string& message);  ///< to the strip

 private:
  /// What the window does about changes of the workspace.
  commands::WorkspaceEvents events();
  void scene_changed();
};

/// The panel that K shows next: those of solvers in use, then the scene. `side`: the present one, which is
/// `shown` or folded.
std::string next_side(const commands::OpenScene& open, const std::string& side, bool shown);

/// Handles pressed keys and draws all parts of the window; once per frame.
void draw_parts(Ui& ui);

// The parts, each in its file; called once per frame in this order. Coordinates are window pixels.
/// `chosen`: the layout as chosen; `side`: content of the right panel.
void draw_menu_bar(Viewport& view, AccuracyView& accuracy, LogView& log,
                   const std::vector<std::string>& recent, const Layout& chosen, const std::string& side,
                   const Areas& areas);
void draw_light_panel(Controls& controls, TypedLayer& typed_layer, bool expanded, const Area& area);
/// The light mix, into a section of that panel.
void draw_mix(Actions& actions, commands::OpenScene& open);
/// The tabs of the right panel; returns the area below them.
/// `paths`, `compare`: there is a tab for the panel of paths, of held results.
Area draw_side_tabs(Actions& actions, const std::string& side, bool paths, bool compare, bool expanded,
                    const Area& area);
void draw_scene_panel(Controls& controls, const commands::Navigation& camera, SceneView& view,
                      const std::function<void()>& keep_view, const Area& area);
void draw_solver_panel(Controls& controls, const solvers::SolverInfo& solver, const Area& area);
void draw_accuracy(Actions& actions, const commands::OpenScene& open, AccuracyView& view, bool expanded,
                   const Area& area);
void draw_passes(const commands::OpenScene& open, bool expanded, const Area& area);
void draw_log(Actions& actions, const commands::Registry& registry, LogView& log, bool expanded,
              const Area& area);
/// What can be opened while there is no picture; part of draw_picture. Draws nothing during a load.
void draw_empty_state(Actions& actions, const commands::OpenScene& open,
                      const std::vector<std::string>& recent, const Area& area);
/// Progress, errors and first steps over the picture, notices beside `legend`; part of draw_picture.
void draw_cards(Actions& actions, const commands::OpenScene& open, CardsView& view, double now,
                const Area& area, const Area& legend);
/// Over the lower left corner of the picture, or of the `room` around a small one; part of draw_picture.
/// Returns its area, which is empty if there is no legend. Requires a snapshot.
Area draw_legend(const commands::OpenScene& open, bool light_marks, const Area& frame, const Area& room);
/// The result of inspect.at, in a card over the picture that does not cover `legend`; part of draw_picture.
void draw_inspection(const session::Snapshot& picture, const Area& area, const Area& legend);
/// Bookmarks the view under the next free name, with a notice.
void keep_view(Actions& actions, const commands::OpenScene& open, const commands::Navigation& camera,
               CardsView& cards);
void draw_splitters(Actions& actions, const Areas& areas);
// Dialogs. `escape`: Esc was pressed.
void draw_file_dialog(Actions& actions, const commands::OpenScene& open,
                      const std::vector<std::string>& recent, std::map<std::string, std::string>& folders,
                      const PictureOf& picture_of, const PictureOf& thumbnail_of, Dialog& dialog,
                      bool escape);
/// True once the scene may be left: it is saved, or its edits are not wanted. `saves_to`: the scene's file.
bool draw_leaving_dialog(Actions& actions, const commands::SavedFiles& files, const std::string& saves_to,
                         Leaving& leaving, bool escape);
/// Keys and mouse; `open` becomes false when it closes.
void draw_key_page(bool& open);
/// Keys of the window, whatever it shows. `panels`: they are shown; `dialog`: one is open. False if a dialog,
/// a menu or a text field has the other keys.
bool handle_window_keys(const Keys& keys, Actions& actions, const commands::History& history, bool panels,
                        bool dialog, bool picture);
/// Keys that act on the picture; of them Esc is for what is in progress.
void handle_picture_keys(const Keys& keys, Viewport& viewport);
/// Keys of views and commands of the solvers in use. If two share a key, the one whose panel is shown
/// (`side`) has it, otherwise the first. Keys of views that no solver in use has say so.
void handle_solver_keys(const Keys& keys, Controls& controls, CardsView& cards, const std::string& side);

/// GLFW's key and modifiers of a name such as "ctrl+z". Throws Error if there is none.
std::pair<int, int> key_of(const std::string& name);
/// Registers the commands that need a window: panels, dialogs, the log.
void add_window_commands(Ui& ui);

/// Begins a bare panel at an area; end with ImGui::End().
void begin_panel(const char* name, const Area& area, ImU32 background, bool scrolls);
/// The heading of a panel in the bottom strip; returns the x where content on the right may start.
float panel_heading(const char* title, const Area& area);
/// One sentence about the panel of a solver.
std::string panel_help(const solvers::SolverInfo& solver);
/// Makes the first letter a capital, or a small one.
std::string capitalised(std::string text);
std::string uncapitalised(std::string text);

}  // namespace lucerna::ui
