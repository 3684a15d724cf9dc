#pragma once
// State of the user's work: the session, edits on their way to it, camera and selection. run(line) is the
// only way to change it. Keeps the undo history and the script of what was done. Not thread-safe.
//
// An edit is visible here at once and sent to the session, in the order of the lines, so each line acts on
// the result of the lines before. Until the session has carried it out, the edit overrides the session's
// state. If the session refuses it, it is removed from the undo history and the script.
//
// Edits belong to the shown scene. While another one is being loaded, lines that name objects of a scene are
// refused; camera moves, undo and values derived from the scene's settings are skipped by the session when
// the other scene arrives. Settings by name apply to the new scene.
#include <array>
#include <deque>
#include <future>
#include <memory>
#include <optional>

#include "commands/camera_control.h"
#include "commands/interior.h"
#include "commands/registry.h"
#include "scene/light_mix.h"
#include "session/pick.h"
#include "session/session.h"
#include "solvers/info.h"

namespace lucerna::commands {

/// The undoable state, as plain values. Commands change it; differences are sent to the session.
struct Document {
  struct Light {
    vec3 intensity{0};  ///< all as scene::Light
    bool enabled = true;
    vec3 position{0}, direction{0, 0, -1};
    float inner_cone = 0, outer_cone = 0;
    void put(scene::Light& light) const;
    bool operator==(const Light&) const = default;
  };
  struct Material {
    vec3 color{1};  ///< the rest as scene::Material
    float roughness = 1, metallic = 0;
    vec3 emission{0};
    bool emits = true;  ///< false: its emission is kept, but switched off
    bool operator==(const Material&) const = default;
  };
  static Light of(const scene::Light& light);
  static Material of(const scene::Material& material);  ///< emits
  std::map<std::string, std::string> settings;          ///< by key
  std::vector<Light> lights;                            ///< of the scene, in its order
  std::vector<Material> materials;                      ///< likewise
  float environment_scale = 1;
  float environment_rotation = 0;                          ///< degrees
  std::string environment_file;                            ///< lights in place of the scene's own; "": that
  int solo = -1;                                           ///< component shown alone, or -1
  std::array<bool, session::k_components> shown_before{};  ///< to come back to after solo
  bool operator==(const Document&) const = default;
};

enum class Kind { none, material, instance, light };
struct Selection {
  Kind kind = Kind::none;
  uint32_t index = 0;
  bool operator==(const Selection&) const = default;
};
const char* kind_name(Kind kind);  ///< "object" for an instance

class Workspace {
 public:
  explicit Workspace(session::Session& session);
  virtual ~Workspace() = default;
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  session::Session& session;
  Registry registry;  ///< holds the commands of this module; others may be added
  double now = 0;     ///< seconds on the caller's clock

  /// Takes in what the session has published since. Call before looking and before running commands.
  void refresh(double time);
  std::shared_ptr<const session::Snapshot> snapshot;
  uint64_t inspections = 0;  ///< inspect.at commands so far
  /// True if the newest picture includes all commands so far.
  bool up_to_date() const { return snapshot && snapshot->commands >= session.commands(); }
  std::shared_ptr<const scene::Scene> scene;  ///< with the edits that the session has taken
  /// A scene is being loaded, or loaded without a picture yet.
  bool loading() const { return opened_by_ != 0; }
  /// Number of logged errors so far, counted by a log listener.
  uint64_t error_count = 0;

  /// The line, of a control, a script or the console, that gave the session its command of that number
  /// (Session::commands); "" where no line did, or long ago.
  std::string line_of(uint64_t command) const;

  /// Carries out a line. Lines of one `gesture` (not 0) on the same target are one step to undo and one line
  /// of the script: the last. Throws Error, at `where`, when it is not understood or cannot be done; then
  /// nothing has changed. Returns the line that was understood.
  Line run(const std::string& line, uint64_t gesture = 0, const std::string& where = "");

  // As the person sees it.
  Document document() const;
  const std::string& setting(const std::string& key) const;
  double setting_real(const std::string& key) const;
  bool setting_on(const std::string& key) const { return setting(key) == "true"; }
  scene::Light light(uint32_t index) const;
  scene::Material material(uint32_t index) const;
  /// What a material emits, or would if it were not switched off.
  vec3 emission(uint32_t index) const;
  bool emits(uint32_t index) const { return !dark_.contains(index); }
  /// True if the settings use that solver for some component.
  bool uses(const solvers::SolverInfo& solver) const;
  /// Its report with the newest picture; null if it is not in use.
  const solvers::Report* report(const solvers::SolverInfo& solver) const;
  /// That of a solver whose preparation waits for a command, or null.
  const solvers::Report* waiting() const;
  float environment_scale() const { return environment_().first; }
  float environment_rotation() const { return environment_().second; }
  /// The image that lights in place of the scene's own environment; "" for none.
  const std::string& environment_file() const { return environment_file_; }
  int solo() const { return solo_; }

  /// The scene's groups of lights, by the setting relight.groups; of no scene none.
  const scene::LightGroups& light_groups();
  scene::LightMix light_mix() const;      ///< the setting relight.mix; where that is no good, none
  scene::MixPresets mix_presets() const;  ///< relight.presets likewise

  bool can_undo() const { return !undo_.empty(); }
  bool can_redo() const { return !redo_.empty(); }
  /// The line that undo would take back; "" for none. And that redo would do again.
  std::string undo_text() const { return undo_.empty() ? "" : undo_.back().line; }
  std::string redo_text() const { return redo_.empty() ? "" : redo_.back().line; }
  void undo();
  void redo();

  /// What 'help TOPIC' says; "" for the list of commands. Throws Error when there is no such topic.
  std::string manual(const std::string& topic) const;

  /// The executed lines, without failed ones, so that they can be run again as a script.
  std::vector<std::string> script() const;
  /// Writes it, whole or not at all. Throws Error: cannot be written, or something else than a saved session
  /// is there.
  void save_script(const std::string& file) const;

  // The camera.
  std::optional<Viewpoint> view;  ///< none before the first picture of a scene
  uint64_t view_scene = 0;        ///< scene_id that `view` belongs to
  Box core;                       ///< of the scene: without what stands far away (scene::core_bounds())
  float speed = 1.5f;             ///< of flight, m/s
  float aspect = 1.5f;            ///< width / height of the picture
  int scene_camera = -1;          ///< the one taken last and not moved since
  /// Gives the picture another size, pixels; aspect follows.
  void set_size(uint32_t width, uint32_t height);
  /// The picture is to have another size that the session does not know yet.
  bool resizing = false;
  /// "camera.place ..." that makes exactly this view.
  static std::string place_line(const Viewpoint& view);
  bool walking = false;             ///< keys lead along the floor
  float eye_height = k_eye_height;  ///< above it, metres
  /// Ray queries against the shown scene: null for a moment after a scene has arrived, until they are ready.
  /// `wait`: waits for them.
  const session::Probe* probe(bool wait = false);
  /// What stands in the way, by them; nothing does while there are none.
  Look look();
  /// Views with a name, of all scenes: by the scene's file, then by name, as lines "camera.place ...".
  using Bookmarks = std::map<std::string, std::string>;
  std::map<std::string, Bookmarks> bookmarks;
  /// Those of the scene shown.
  const Bookmarks& bookmarks_here() const;

  /// Where exposure.find and exposure.at wait for what the renderer measures.
  bool measuring() const { return measuring_.has_value(); }

  Selection selection;
  Box selection_bounds() const;  ///< that of the scene (core) when nothing is selected
  std::string selection_name() const;

 protected:
  /// Called when another scene has appeared and the view has been set up for it.
  virtual void scene_changed() {}
  /// Called when what was measured has set the exposure; `text` says to what.
  virtual void measured(const std::string& text) { (void)text; }
  /// Called when the session has refused the latest requested size; the picture keeps this one.
  virtual void size_refused(uint32_t width, uint32_t height) { (void)width, (void)height; }
  /// Called when a picture has been written; `name`: its file and how it was written.
  virtual void written(const std::string& name) { (void)name; }
  /// Settings that change in the same step when one is set to a value, and theirs.
  virtual std::vector<std::pair<std::string, std::string>> set_with(const std::string& key,
                                                                    const std::string& value) {
    (void)key, (void)value;
    return {};
  }
  /// True if exposure is measured for a new scene that sets none.
  virtual bool exposes_at_load() const { return false; }

 private:
  /// Numbers of the session's commands that a line has become.
  struct Sent {
    uint64_t first = 1, last = 0;  ///< none where last < first
    uint64_t refused = 0;          ///< of them
    /// Counts a command that was refused; true if no other one is left.
    bool refuse(uint64_t number) {
      if (number < first || number > last) return false;
      return ++refused == last - first + 1;
    }
  };
  struct Step {
    std::string line, target;
    uint64_t gesture;
    Document before, after;
    Sent sent = {};
    /// Of a move of the camera, which changes nothing else.
    struct Move {
      Viewpoint before, after;
      int camera_before, camera_after;
    };
    std::optional<Move> move = {};
  };
  struct Recorded {
    std::string line, target;
    uint64_t gesture = 0;
    session::Saved saved = {};  ///< that it was to write a file, and how that has ended
    Sent sent = {};
  };
  // Edits sent to the session but not in its snapshots yet; the requested values are shown. `sent`: number of
  // the command (Session::commands); done when a snapshot counts it.
  struct Pending {
    std::string value;
    uint64_t sent;
  };
  struct PendingLight {
    Document::Light value;
    uint64_t sent;
  };
  struct PendingMaterial {
    Document::Material value;
    uint64_t sent;
  };
  struct PendingEnvironment {
    float scale, rotation;
    uint64_t sent;
  };

  void add_document_commands();
  void add_setting_commands();
  void add_light_commands();
  void add_environment_commands();
  void add_material_commands();
  void add_shown_commands();
  void add_camera_commands();
  void add_motion_commands();
  void add_lens_commands();
  /// A command that moves the camera: `act` has the viewpoint that it starts from.
  void add_motion(std::string name, std::string help, std::vector<Parameter> parameters,
                  std::function<void(Viewpoint&, const Arguments&)> act);
  void add_selection_commands();
  void add_interior_commands();
  void add_bookmark_commands();
  void add_exposure_commands();
  void add_mix_commands();
  void add_scene_commands();
  void add_render_commands();
  void add_script_commands();
  void add_wait_commands();
  /// A command without parameters.
  void add_plain(const char* name, const char* help, std::function<void()> run);
  /// True if the picture has that many samples a pixel, or is finished. Throws Error if it never will.
  bool has_samples(int64_t samples);
  void add_inspect_commands();
  void add_solver_commands();
  void add_file_commands(const solvers::SolverInfo& solver);
  void add_leading_commands(const solvers::SolverInfo& solver);
  void carry_out(const Line& line, uint64_t gesture, const std::string& where);
  /// What the session was given since `before`, a number of its commands, and since `moves`.
  Sent sent_since(uint64_t before, uint64_t moves) const;
  /// Notes which line gave the commands since the session had `before`.
  void note_sent(uint64_t before, const std::string& line, bool moves);
  Document& edit();  ///< the document that the running command may change
  /// A setting that the running command names; it acts on a scene that is being loaded, too. Throws Error.
  void give(const std::string& key, const std::string& value);
  void send(const Document& before, const Document& after);
  /// Where strengths of lights and their mix are all that differs: as one. False: there is more, or less.
  bool send_lights(const Document& before, const Document& after);
  void record(const Line& line, uint64_t gesture, const Sent& sent);
  /// Has the script wait for as many samples as the picture has now.
  void record_wait();
  /// True if the file of the latest saving command is written. Throws Error if it never will be.
  bool saved() const;
  void follow_scene();
  /// Takes up the camera and the size that the session has, where it has refused, or chosen, another.
  void follow_picture();
  void drop_refused();
  void drop_taken();
  std::pair<float, float> environment_() const;
  void needs_view() const;
  void needs_scene() const;
  /// Throws Error unless some component is computed by it; or by one whose light is looked up.
  void needs_solver(const solvers::SolverInfo& solver) const;
  void needs_lookup() const;
  uint32_t light_index(const std::string& which) const;
  uint32_t material_index(const std::string& which) const;
  /// Throws Error, listing the names, when there is no such group, or preset.
  std::string group_named(const std::string& which);
  const scene::LightMix& preset_named(const scene::MixPresets& presets, const std::string& name) const;
  /// Says which groups of the preset the scene does not have.
  void warn_of_groups(const std::string& preset, const scene::LightMix& mix);
  void apply_mix();
  int camera_index(const std::string& which) const;
  Selection selection_of(const std::string& kind, const std::string& which) const;
  /// The one way to move the camera: takes the view up and gives it to the session. Throws Error as
  /// scene::check_range; then nothing has changed.
  void take_view(const Viewpoint& view, int camera = -1);
  void note_move(const Line& line, uint64_t gesture, const Viewpoint& before, int camera_before,
                 const Sent& sent);
  std::vector<std::string> bookmark_names() const;
  /// At surfaces for which `wanted` is true; empty: all.
  Look look_at(std::function<bool(const session::Picked&)> wanted);
  /// Ignores selected objects.
  Look look_past_selection();
  /// Measures the brightness of the picture, or at a point; `of_load`: automatic, for a new scene.
  void measure(std::optional<vec2> at, bool of_load);
  void take_measure();
  /// Calls written() for what has been.
  void take_written();

  plan::Settings known_;
  std::map<std::string, Pending> pending_;
  std::map<uint32_t, PendingLight> pending_lights_;
  std::map<uint32_t, PendingMaterial> pending_materials_;
  std::optional<PendingEnvironment> pending_environment_;
  std::map<uint32_t, vec3> dark_;  ///< emission of the materials that are switched off
  std::string environment_file_, environment_in_force_;
  std::pair<float, float> own_environment_{1, 0};  ///< scale and rotation (degrees) that the scene's file has
  std::vector<std::pair<uint64_t, std::string>> environments_sent_;  ///< numbers and files on their way
  std::future<std::shared_ptr<const session::Probe>> probing_;
  std::vector<std::future<std::shared_ptr<const session::Probe>>> retired_;  ///< of scenes that are gone
  std::shared_ptr<const session::Probe> probe_;
  struct Measuring {
    std::shared_future<film::Brightness> result;
    bool at_point, of_load;
    uint64_t scene;
  };
  std::optional<Measuring> measuring_;
  std::string measure_failure_;                    ///< of the latest request
  uint64_t exposure_due_ = 0;                      ///< scene whose exposure is still to be measured; 0: none
  bool exposure_given_ = false;                    ///< film.ev was set after a scene was requested
  std::shared_ptr<const scene::Scene> groups_of_;  ///< that groups_ are of, by these rules
  std::string groups_by_;
  scene::LightGroups groups_;
  int solo_ = -1;
  std::array<bool, session::k_components> shown_before_{};
  std::optional<Document> working_;
  std::vector<std::string> touched_;  ///< settings that the running command set, changed or not
  /// Lines and the last of the session's commands that each has given, the newest last.
  struct GivenBy {
    uint64_t first, last;
    std::string line;
  };
  std::deque<GivenBy> given_by_;
  std::vector<Step> undo_, redo_;
  std::vector<Recorded> recorded_;
  /// Pictures being written, with their names.
  struct Writing {
    std::string name;
    session::Saved saved;
  };
  std::vector<Writing> writing_;
  session::Saved saved_;                        ///< of the last command that writes a file
  bool open_failed_ = false;                    ///< the last scene.open has failed
  uint64_t opened_by_ = 0;                      ///< its number, until its scene is shown or it has failed
  session::SceneId scene_id_ = 0;               ///< of `scene`
  size_t refused_seen_ = 0;                     ///< of the session's refused commands
  uint64_t moves_ = 0;                          ///< cameras given to the session
  std::pair<uint32_t, uint32_t> size_{0, 0};    ///< latest requested size
  double waited_since_ = -1;                    ///< when the current wait began, or last saw a new picture
  uint64_t waited_errors_ = 0, waited_id_ = 0;  ///< errors when it began; picture seen last
};

}  // namespace lucerna::commands
