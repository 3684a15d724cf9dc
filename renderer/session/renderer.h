#pragma once
// The renderer on one thread: device, scene, settings. It edits them and coordinates its parts, which hold a
// picture's schedule, progress, mix, output, preview samples, recorded paths. step() does one bounded work
// item. Batch verbs use it directly; a session runs one on a separate thread.
#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "scene/io/load.h"
#include "scene/texture_source.h"
#include "session/active_solvers.h"
#include "session/choice_review.h"
#include "session/former_light.h"
#include "session/layer_status.h"
#include "session/lights_edit.h"
#include "session/lookup_refinement.h"
#include "session/object_edit.h"
#include "session/path_study.h"
#include "session/pilot.h"
#include "session/preview_samples.h"

namespace lucerna::session {

struct RendererOptions {
  std::string device;
  bool validation = false;
  std::filesystem::path shaders;
  gpu::Defines defines;            ///< additional #defines of the transport kernels (tests)
  bool interactive = false;        ///< a user can step through preparation: step() may wait for a command
  scene::LoadOptions scenes = {};  ///< limits on scene files
  /// If set: uses this device instead of creating one from `device` and `validation`; its pipelines are kept
  /// from renderer to renderer. Not thread-safe.
  std::shared_ptr<gpu::Device> on = {};
  /// Seconds in which a good picture is wanted, or as good as possible: the program chooses solvers for them
  /// (expect_seconds()), and preparation may take plan::k_most_preparation of them if its data are usable
  /// then. nullopt: solvers are chosen for the finished picture, and preparation is completed.
  std::optional<double> patience = {};
};

/// The value of a setting, and where it comes from, for messages.
struct SettingChange {
  std::string key, value, where;
};

class Renderer {
 public:
  explicit Renderer(const RendererOptions& options);
  ~Renderer();

  gpu::Device& device() { return *device_; }
  /// For another renderer on it (RendererOptions::on), used by the same thread.
  std::shared_ptr<gpu::Device> shared_device() const { return device_; }
  /// Loads a file and makes it ready to render. On failure throws Error and the former scene stays.
  /// `changes`: settings that override the scene's; `outside`: LoadOptions::outside, whatever the options
  /// say; `choose`: the program chooses the solvers if no setting does (plan::leave_choice()).
  void load(const std::filesystem::path& file, const Progress& progress = {},
            const std::vector<SettingChange>& changes = {}, bool outside = false, bool choose = false);
  /// Likewise, for a scene in memory. Resets the settings (except tracer, path.batch and path.classes), then
  /// applies the scene's, then `changes`.
  void set_scene(std::shared_ptr<const scene::Scene> scene, const Progress& progress = {},
                 const std::vector<SettingChange>& changes = {}, bool choose = false);
  /// Null before the first scene.
  std::shared_ptr<const scene::Scene> scene() const { return setup_.world.scene; }
  /// As passed to set_scene(), without edits; null before the first scene.
  std::shared_ptr<const scene::Scene> loaded() const { return loaded_; }

  plan::Settings& settings() { return setup_.settings; }
  const plan::Settings& settings() const { return setup_.settings; }
  /// Applies changed settings; restarts the image if it depends on them. Target error, sample limits and
  /// sampling mode let the image continue. Throws Error if kernels or memory for them cannot be made: the
  /// former picture continues.
  void apply_settings();
  /// Throws Error like film::check_size; the former size stays.
  void set_size(uint32_t width, uint32_t height);
  /// Throws Error like scene::check_range, as do the edits below; then nothing changes.
  void set_camera(const scene::Camera& camera);
  const scene::Camera& camera() const { return setup_.camera; }
  /// Selects a camera of the scene by name; Error listing the names if there is none.
  void choose_camera(const std::string& name);
  void set_light(uint32_t index, const scene::Light& light);
  /// Replaces the scene's lights by these. If only names and ids differ, or groups that are not separate, the
  /// picture continues. Throws Error; then nothing changes.
  void set_light_list(const std::vector<scene::Light>& lights);
  void set_environment(float scale, float rotation_degrees);
  /// Replaces the scene's environment by this latitude-longitude image; "": restores it. With this factor and
  /// rotation, or the current ones. Throws Error like scene::load_environment; the former environment stays.
  void set_environment_file(const std::filesystem::path& file, std::optional<float> scale = {},
                            std::optional<float> rotation_degrees = {});
  /// Replaces the scene's environment by a sky, not rotated, and this factor. Throws Error if it is invalid.
  void set_environment_sky(const scene::SkyModel& sky, float scale);
  /// Replaces a material; `textures`: where its textures come from, nullopt: they stay. If the flattened
  /// scene depends on the change (needs_flattening), it is made again: seconds for a large scene. Throws
  /// Error if there is no such material, or a texture cannot be read; `progress` cancels. Then nothing
  /// changes.
  void set_material(uint32_t index, const scene::Material& material,
                    const std::optional<scene::TextureSources>& textures = {}, const Progress& progress = {});
  /// All of these as one edit. If the total light is unchanged, with the former group mix written into the
  /// lights or the reverse, the picture continues. Throws Error; then nothing changes.
  void set_lights(const LightsEdit& edit);
  /// Puts instances of the scene elsewhere, hides or shows them, as one edit. All surfaces are flattened and
  /// their tree is built again: seconds for a large scene. Lights, materials and settings stay; data that
  /// solvers have prepared are dropped, since light changes everywhere. Recorded paths are no longer shown.
  /// Throws Error, located at the object: there is none, its matrix is invalid; memory; `progress` cancels.
  /// Then nothing changes.
  void set_instances(const std::vector<ObjectEdit>& edits, const Progress& progress = {});
  /// The scene's light groups, and what the settings make of them.
  const Relight& relight() const { return setup_.relight; }
  void reload_shaders();
  /// Restarts the image and all lookup data.
  void restart() { restart(scene::Change::restart); }
  /// Number of images begun so far.
  uint64_t restarts() const { return restarts_; }

  // Its parts. They are changed by the renderer; callers read, develop, record.

  /// The present picture for display and files.
  PictureOutput& output() { return output_; }
  const PictureOutput& output() const { return output_; }
  /// Preview samples of the window's picture.
  PreviewSamples& previews() { return previews_; }
  /// Time, cost, error and reference of the image. Errors are those of the film, without a pending mix.
  ImageProgress& progress() { return progress_; }
  const ImageProgress& progress() const { return progress_; }
  const Sampling& sampling() const { return sampling_; }
  /// Commands, files and reports of the active solvers.
  ActiveSolvers& solvers() { return solvers_; }
  const ActiveSolvers& solvers() const { return solvers_; }
  /// What is drawn over the picture.
  Overlays& overlays() { return overlays_; }
  /// Recorded paths of the picture, with the mix settled.
  PathStudy& paths() {
    if (setup_.engine) mix_.settle();
    return paths_;
  }
  /// In the window, a new mix is shown at once; the film's sums follow with the next step().
  GroupMix& mix() { return mix_; }
  const Setup& setup() const { return setup_; }

  bool ready() const { return setup_.engine != nullptr; }
  bool done() const { return sampling_.done(); }
  /// Number of samples that every pixel has, or every pixel of the region that gets samples.
  uint32_t samples() const { return sampling_.samples(); }
  /// Estimated error of the present picture, from all its pixels. Takes a pass over the film.
  film::ImageError image_error();
  /// Makes the ledger's last entry current.
  void finish_ledger();
  /// What the scene calls for, without the effects that are off.
  const plan::SceneFacts& facts() const { return facts_; }
  /// Solver of each component, and why it was chosen if the setting is auto; empty before the first scene.
  const ByComponent<plan::Choice>& choices() const;
  /// The findings of the picture's first samples, once solvers have been chosen by them.
  const std::optional<solvers::Findings>& findings() const { return findings_; }
  /// Rendering will end after this many seconds: solvers with the setting auto are chosen for that. Call
  /// before the first step().
  void expect_seconds(std::optional<double> seconds) { seconds_limit_ = seconds; }
  /// While the choice of solvers waits for a pilot: makes it by the preview samples, if they are complete.
  /// Call after PreviewSamples::draw().
  void choose_by_previews();
  /// True until the first samples of the picture are there, by which solvers are chosen (components.X=auto).
  bool choosing() const { return setup_.engine && setup_.engine->plan().undecided; }
  /// Runs one work item; cancellable between bounces. False if there is nothing to do, if cancelled, or if
  /// preparation waits.
  bool step(const std::function<bool()>& cancel = {});
  film::Image image() const { return setup_.film->read(); }  ///< without a pending mix
  std::vector<LayerStatus> layer_status(const film::Image& image) const {
    return session::layer_status(*setup_.engine, image, progress_.ledger());
  }

  /// The active solver of that name; null if it computes nothing.
  const solvers::Solver* solver(std::string_view name) const {
    return setup_.engine ? setup_.engine->find(name) : nullptr;
  }
  solvers::Solver* solver(std::string_view name) { return solvers_.find(name); }
  /// True if some light is looked up.
  bool looks_up() const { return setup_.engine && !setup_.engine->solvers().empty(); }
  /// True if preparation is needed before the next sample.
  bool preparing() const { return setup_.engine && setup_.engine->unready(); }
  /// ... and waits for a command.
  bool waits() const { return setup_.engine && setup_.engine->waits(); }
  /// Replaces a solver's data by a file, and restarts the image; missing data of this view is added first.
  /// Throws Error like solvers::Persistence::load; then everything stays unchanged.
  void solver_load(const std::string& name, const std::filesystem::path& file);
  /// True if all kernels of preparation have run once.
  bool prepares_warm() const {
    return preparing() && solvers::offered<solvers::Preparation>(*setup_.engine->unready())->warm();
  }
  const film::Film& film() const { return *setup_.film; }
  const transport::TransportStats& stats() const { return setup_.engine->wavefront().stats(); }
  std::string tracer_name() const { return setup_.tracer_name(); }
  double load_seconds() const { return load_seconds_; }
  double compile_seconds() const { return setup_.engine ? setup_.engine->compile_seconds() : 0; }
  /// Computed components (bit i), by the current settings; 0 before the first scene.
  uint32_t enabled_components() const;

 private:
  /// Applies another mix to the film's picture.
  void remix();
  /// Makes the target the current setup, with a new world. On failure throws Error and everything stays
  /// unchanged, as with every function that takes a target.
  void install(Transaction::Target target, const Progress& progress, const scene::Changes& changes);
  /// Commits it, and logs new messages.
  void commit(Transaction& transaction);
  /// Changes lights, environment or material factors (`factors`) of the scene. Makes kernels for its new
  /// features.
  void edit(std::shared_ptr<const scene::Scene> edited, const scene::Changes& changes, bool factors);
  /// Gives the edited scene this environment, with its portals.
  void light_by(std::shared_ptr<scene::Scene> edited, const scene::Environment& environment);
  void edit(Transaction::Target target, const scene::Changes& changes, bool factors);
  /// `factors`: known factor on the light of each group, if the edit is no more than that
  /// (scene::light_factors). `other_sky`: the environment is another one.
  void restart(const scene::Changes& changes, const std::optional<std::vector<vec3>>& factors = {},
               bool other_sky = false);
  PictureView picture_view() const { return setup_.view(automaton_); }
  /// True if the picture's light is unchanged, whatever its computation and camera.
  bool keeps_light(const scene::Changes& changes) const;
  /// Applies the plan of the target's settings, with new kernels and solvers if needed: then true. Adds edits
  /// of lights to `changes` if the settings cause them.
  bool apply_plan(Transaction::Target target, scene::Changes& changes);
  void notify_settings_changed();  ///< informs the solvers
  /// While solvers wait for it: notes a work item of that time [s] and rays; chooses them once the pilot is
  /// complete.
  void judge_pilot(double seconds, uint64_t rays);
  /// Chooses the solvers by the findings; another choice begins another picture.
  void choose_solvers();
  /// With a limit of time: chooses again once the cost of the chosen solvers is measured.
  void review_choice();
  bool render_item(const std::function<bool()>& cancel);
  /// Ends preparation that has taken too long (RendererOptions::patience).
  void hurry();
  /// If the item waits for a round: runs one work item of that round. True if it did.
  std::optional<bool> prepare_round(const schedule::WorkItem& item, const std::function<bool()>& cancel);

  RendererOptions options_;
  std::shared_ptr<gpu::Device> device_;
  std::unique_ptr<gpu::ShaderCompiler> compiler_;
  paths::Automaton automaton_;
  SetupContext context_;
  Setup setup_;
  Sampling sampling_;
  ImageProgress progress_{setup_, sampling_};
  GroupMix mix_{setup_, sampling_, progress_};
  Overlays overlays_{context_, setup_};
  PictureOutput output_{context_, setup_, sampling_, progress_, mix_, overlays_};
  PreviewSamples previews_{context_, setup_, sampling_, progress_, output_};
  ActiveSolvers solvers_{context_, setup_, sampling_, overlays_};
  LookupRefinement lookups_{context_, setup_, sampling_, progress_};
  PathStudy paths_{context_, setup_, sampling_, facts_};
  std::map<std::string, std::string> applied_;  ///< settings of the present picture
  std::shared_ptr<const scene::Scene> loaded_;  ///< as passed to set_scene()
  plan::SceneFacts facts_;                      ///< of the scene as it was installed, without effects.off
  Pilot pilot_;
  std::optional<solvers::Findings> findings_;  ///< of this scene's pilot
  std::optional<double> seconds_limit_;
  ChoiceReview review_;
  bool reviewed_ = false;
  FormerLight former_light_;
  scene::Lens begun_lens_;  ///< of the picture begun last
  uint64_t restarts_ = 0;
  double load_seconds_ = 0;
};

/// Peak resident memory of this process [MiB].
double peak_host_mb();

}  // namespace lucerna::session
