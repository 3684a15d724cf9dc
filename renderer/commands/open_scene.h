#pragma once
// The open scene: what the session has published, overridden by edits on their way to it.
//
// An edit is visible here at once and sent to the session. Until the session has executed it, the edit
// overrides the session's state.
//
// Edits belong to the shown scene. While another one is being loaded, functions that need a scene refuse;
// values derived from the scene's settings are skipped by the session when the other scene arrives. Settings
// by name apply to the new scene.
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands/document.h"
#include "plan/facts.h"
#include "scene/light_mix.h"
#include "scene/light_units.h"
#include "session/session.h"
#include "solvers/info.h"

namespace lucerna::commands {

/// The unit in which strengths of lights are shown; `distance` [m]: of lux.
struct ShownUnit {
  scene::LightUnit unit = scene::LightUnit::candela;
  float distance = 1;
};

class OpenScene {
 public:
  explicit OpenScene(session::Session& session) : session(session) {}
  OpenScene(const OpenScene&) = delete;
  OpenScene& operator=(const OpenScene&) = delete;

  session::Session& session;
  // As published.
  std::shared_ptr<const session::Snapshot> snapshot;
  std::shared_ptr<const scene::Scene> scene;   ///< with the edits that the session has executed
  std::shared_ptr<const scene::Scene> loaded;  ///< as it was read from its file
  session::SceneId id() const { return id_; }
  /// True if the newest picture includes all commands so far.
  bool up_to_date() const { return snapshot && snapshot->commands >= session.commands(); }

  /// Reads what the session has published. Returns the numbers of commands that it has refused since.
  std::vector<uint64_t> refresh();
  /// Ends the load in progress if the session has executed it and `shown`: its picture is set up here, or if
  /// drawing it has failed.
  void follow_load(bool shown);
  /// Starts with the scene that has just been shown: no edits are pending.
  void begin_scene();

  /// Requests another scene.
  void load(const std::string& file, bool outside = false, bool choose = false);
  /// A scene is being loaded, or loaded without a picture yet.
  bool loading() const { return loaded_by_ != 0; }
  bool load_failed() const { return load_failed_; }  ///< the last load failed
  ShownUnit light_unit;                              ///< by light.unit

  // The state as displayed.
  Document document() const;
  const std::string& setting(const std::string& key) const;
  double setting_real(const std::string& key) const;
  bool setting_on(const std::string& key) const { return setting(key) == "true"; }
  /// All lights of the scene; none without one.
  const std::vector<scene::Light>& lights() const;
  const scene::Light& light(uint32_t index) const { return lights().at(index); }
  scene::Material material(uint32_t index) const;
  /// The same as the document has it, but for emission that is switched off.
  Document::Material material_state(uint32_t index) const;
  /// Where its textures come from.
  scene::TextureSources textures(uint32_t index) const;
  /// Where an object is, relative to where its file has it.
  scene::ObjectPlace object(uint32_t index) const;
  /// Its box in its own space; cached.
  const Box& object_box(uint32_t index) const;
  /// Its matrix at a place, or at its present one. Throws Error like both scene::check_range: it cannot be
  /// there.
  mat4 object_matrix(uint32_t index, const scene::ObjectPlace& place) const;
  mat4 object_matrix(uint32_t index) const;
  /// True if the session has edits of objects to execute.
  bool moving_objects() const { return !objects_sent_.empty(); }
  /// True if it is not as its file has it.
  bool is_edited(uint32_t object) const { return objects_.contains(object); }
  /// Emission of a material, also if switched off.
  vec3 emission(uint32_t index) const;
  bool emits(uint32_t index) const { return !dark_.contains(index); }
  /// Emitting area of its surfaces [m2] (scene::emitting_area); cached.
  double emitting_area(uint32_t index) const;
  /// Value of luminance 1 of a material's emission in a unit: unit_factor(). Throws Error if it has none:
  /// a texture multiplies its emission, or no surface has the material.
  double emission_factor(uint32_t index, scene::LightUnit unit) const;
  float environment_scale() const { return environment().first; }
  float environment_rotation() const { return environment().second; }
  /// The image that replaces the scene's own environment; "": none.
  const std::string& environment_file() const { return source_.file; }
  /// The sky that replaces the scene's own environment, or that the scene has.
  std::optional<scene::SkyModel> sky() const;
  /// True if a sky has replaced the scene's own environment.
  bool sky_replaces() const { return source_.sky.has_value(); }
  /// The scene as displayed, with edits on their way; without their images.
  scene::Scene edited_scene() const;
  /// Scale and rotation (degrees) in the scene's file.
  std::pair<float, float> own_environment() const { return own_environment_; }
  int solo() const { return solo_; }

  /// The scene's light groups, by the setting relight.groups; none without a scene.
  const scene::LightGroups& light_groups();
  /// What the scene calls for, whatever the setting effects.off; null without a scene.
  const plan::SceneFacts* facts();
  scene::LightMix light_mix() const;      ///< the setting relight.mix; empty if invalid
  scene::MixPresets mix_presets() const;  ///< relight.presets likewise

  /// True if the settings use that solver for some component.
  bool uses(const solvers::SolverInfo& solver) const;
  /// Its report with the newest picture; null if it is not in use.
  const solvers::Report* report(const solvers::SolverInfo& solver) const;
  /// Report of a solver whose preparation waits for a command, or null.
  const solvers::Report* waiting() const;

  // Conditions of commands; each throws Error if it does not hold.
  void needs_scene() const;
  /// The solver computes some component, or another solver uses its lookups.
  void needs_solver(const solvers::SolverInfo& solver) const;
  /// Some solver or view has something to inspect.
  void needs_lookup() const;
  /// Index of the light with that name, or with that number from 1.
  uint32_t light_index(const std::string& which) const;
  uint32_t material_index(const std::string& which) const;
  uint32_t object_index(const std::string& which) const;
  /// An id that no light of the scene has had.
  scene::Id new_light_id() { return next_light_id_++; }

  // Edits of the running command.
  /// Starts an edit with this document.
  void begin_edit(Document from);
  /// The edited document. Only between begin_edit() and end_edit().
  Document& edit();
  /// Puts an object of the edited document there. Throws Error like object_matrix().
  void put_object(uint32_t index, const scene::ObjectPlace& place);
  /// Its place in the edited document.
  scene::ObjectPlace edited_object(uint32_t index);
  /// Sets a setting by name, also for a scene that is being loaded.
  void set_by_name(const std::string& key, const std::string& value);
  /// True if the latest edit has set settings by name, changed or not.
  bool named_settings() const { return !named_.empty(); }
  Document end_edit();
  void cancel_edit() { working_.reset(); }
  /// Sends the differences to the session. Settings of the latest edit by name are sent even if equal.
  void send(const Document& before, const Document& after);
  /// The same without regard to the latest edit.
  void restore(const Document& to);

 private:
  // Edits that the snapshots do not include yet. `sent`: number of the command (Session::commands); done when
  // a snapshot counts it.
  template <class T>
  struct Pending {
    T value;
    uint64_t sent;
  };
  struct Environment {
    float scale, rotation;
  };

  std::vector<uint64_t> take_refused();
  void drop_executed();
  /// Sends strengths of lights and their mix as one command if nothing else differs. False: something else
  /// does.
  bool send_strengths(const Document& before, const Document& after);
  /// Sends lights that differ: one by one if the list has the same lights, else as a whole.
  void send_lights(const std::vector<scene::Light>& before, const std::vector<scene::Light>& after);
  void send_environment(const Document& before, const Document& after);
  void send_objects(const Document& before, const Document& after);
  /// As the file has it.
  scene::ObjectPlace loaded_place(uint32_t index) const;
  std::pair<float, float> environment() const;
  /// Keeps the emission of a material that is switched off.
  void note_dark(uint32_t material, const Document::Material& value);

  plan::Settings known_;
  session::SceneId id_ = 0;
  size_t refused_seen_ = 0;  ///< number of refused commands already processed
  uint64_t loaded_by_ = 0;   ///< number of the last load, until its scene is shown or has failed
  bool load_failed_ = false;
  std::map<std::string, Pending<std::string>> pending_;
  std::optional<Pending<std::vector<scene::Light>>> pending_lights_;  ///< all of them
  std::map<uint32_t, Pending<Document::Material>> pending_materials_;
  std::optional<Pending<Environment>> pending_environment_;
  scene::Id next_light_id_ = scene::k_first_added;
  std::map<uint32_t, vec3> dark_;  ///< emission of the materials that are switched off
  /// What replaces the scene's own environment; neither: nothing does.
  struct EnvironmentSource {
    std::string file;
    std::optional<scene::SkyModel> sky;
  };
  EnvironmentSource source_, source_in_force_;
  std::pair<float, float> own_environment_{1, 0};
  /// Numbers and sources sent to the session.
  std::vector<std::pair<uint64_t, EnvironmentSource>> sources_sent_;
  Objects objects_;  ///< with edits on their way
  struct SentObjects {
    uint64_t number;
    Objects before, after;
  };
  std::vector<SentObjects> objects_sent_;
  mutable std::map<uint32_t, Box> boxes_;     ///< by mesh
  mutable std::map<uint32_t, double> areas_;  ///< by material, in these:
  mutable SharedVector<scene::Instance> areas_in_;
  std::shared_ptr<const scene::Scene> groups_of_;  ///< scene of groups_, with these rules
  std::string groups_by_;
  scene::LightGroups groups_;
  std::shared_ptr<const scene::Scene> facts_of_;  ///< scene of facts_
  plan::SceneFacts facts_;
  int solo_ = -1;
  ByComponent<bool> shown_before_{};
  std::optional<Document> working_;
  std::vector<std::string> named_;  ///< settings that the running command has set by name
};

}  // namespace lucerna::commands
