#pragma once
// The renderer on one thread: device, scene, settings, film. step() does one bounded work item. Batch verbs
// use it directly; Session runs one on a separate thread.
#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/timer.h"
#include "film/error.h"
#include "film/estimator.h"
#include "film/exposure.h"
#include "film/film.h"
#include "film/io/image_file.h"
#include "film/io/reference.h"
#include "gpu/kernel.h"
#include "paths/automaton.h"
#include "plan/plan.h"
#include "plan/settings.h"
#include "recording/noise.h"
#include "scene/io/load.h"
#include "scene/scene.h"
#include "session/display.h"
#include "session/filtered.h"
#include "session/held_picture.h"
#include "session/image_progress.h"
#include "session/lights_edit.h"
#include "session/object_edit.h"
#include "session/overlays.h"
#include "session/path_recording.h"
#include "session/pilot.h"
#include "session/sampling.h"
#include "session/setup.h"
#include "session/transaction.h"
#include "session/window_filter.h"
#include "stats/forecast.h"
#include "stats/ledger.h"
#include "transport/wavefront.h"

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
  /// `changes`: settings that override the scene's.
  void load(const std::filesystem::path& file, const Progress& progress = {},
            const std::vector<SettingChange>& changes = {});
  /// Likewise, for a scene in memory. Resets the settings (except tracer, path.batch and path.classes), then
  /// applies the scene's, then `changes`.
  void set_scene(std::shared_ptr<const scene::Scene> scene, const Progress& progress = {},
                 const std::vector<SettingChange>& changes = {});
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
  /// Throws Error if there is no such material, or if textures or transparency (alpha mode, transmission,
  /// thickness) would change: rays depend on these.
  void set_material(uint32_t index, const scene::Material& material);
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
  /// In the window, a new mix is shown at once; the film's sums follow with the next step(), or with this
  /// call.
  bool mix_pending() const { return mix_pending_; }
  void settle_mix();
  void reload_shaders();
  /// Restarts the image and all lookup data.
  void restart() { restart(scene::Change::restart); }
  /// Number of images begun so far.
  uint64_t restarts() const { return restarts_; }
  /// Complete passes over the picture, or over the active tiles.
  uint32_t passes() const { return sampling_.passes(); }

  bool ready() const { return setup_.engine != nullptr; }
  bool done() const { return sampling_.done() && !judged_otherwise(); }
  /// Number of samples that every pixel has, or every pixel of the region that gets samples.
  uint32_t samples() const { return sampling_.samples(); }
  /// The setting sampling.region: pixels; nullopt: the whole picture.
  std::optional<schedule::Rectangle> region() const;
  /// Samples a pixel at which the image is finished; adaptive: maximum of any pixel.
  uint32_t max_samples() const { return sampling_.max_samples(); }
  /// State of every tile; null in uniform sampling.
  const schedule::AdaptiveSchedule* adaptive() const { return sampling_.adaptive(); }
  /// Estimated error of the present picture, from all its pixels. Takes a pass over the film.
  film::ImageError image_error();
  /// Likewise, for every tile of sampling.tile, in raster order, with heavy tails marked; as of the last
  /// image_error().
  std::vector<film::TileError> tile_errors() const;
  uint32_t tile_side() const { return setup_.tile_side(); }  ///< sampling.tile [pixels]
  /// True once the lookup-error estimate is complete (film::LookupsError).
  bool lookup_errors_known() const;
  /// False if some solver's lookups have a bias that none of these errors contains.
  bool lookup_bias_estimated() const;
  /// Errors not contained in these, which only estimate noise: plan::Plan::bias of the current settings;
  /// nullopt before the first scene.
  std::optional<double> bias(size_t component) const;
  /// What the scene calls for, without the effects that are off.
  const plan::SceneFacts& facts() const { return facts_; }
  /// Solver of each component, and why it was chosen if the setting is auto; empty before the first scene.
  const std::array<plan::Choice, paths::k_component_count>& choices() const;
  /// The pilot's findings, once solvers have been chosen by it.
  const std::optional<solvers::Findings>& findings() const { return findings_; }
  /// Rendering will end after this many seconds: solvers with the setting auto are chosen for that. Call
  /// before the first step().
  void expect_seconds(std::optional<double> seconds) { seconds_limit_ = seconds; }
  /// True while a pilot must run before solvers are chosen (components.X=auto).
  bool choosing() const { return setup_.engine && setup_.engine->plan().undecided; }
  /// Runs one work item; cancellable between bounces. False if there is nothing to do, if cancelled, or if
  /// preparation waits.
  bool step(const std::function<bool()>& cancel = {});
  /// For display until the film is filled, with RendererOptions::interactive: traces a preview sample at
  /// lower resolution if it is time for one; the first comes at once, at a quarter of the resolution. Its
  /// paths, rays and time are not in stats(). False if nothing was traced.
  bool draw_draft(const std::function<bool()>& cancel = {});
  /// True if there is a preview sample of the present light; preview samples restart when that improves.
  bool has_draft() const { return display_ && display_->plan().begun(); }
  /// Pace of pure path tracing, measured with preview samples before there was lookup data; nullopt without
  /// such samples.
  std::optional<stats::SamplePace> path_pace() const;
  /// DraftPlan::news() of the latest draw_draft().
  bool draft_news() const { return display_ && display_->plan().news(); }

  /// Wall time [s] since this image's first step() or draw_draft(), without the times between rest() and the
  /// next of these calls, and after the last.
  double seconds() const { return progress_.seconds(); }
  /// Part of seconds() until solvers had prepared the data of the first sample.
  double prepared_seconds() const { return progress_.prepared_seconds(); }
  /// Stops that clock: rendering waits for the user or for a scene.
  void rest() { progress_.rest(); }
  /// Part of seconds() that step() has spent tracing this image (stats::Entry::render_s).
  double render_seconds() const { return progress_.render_seconds(); }
  /// Part of stats() from preparation before the first sample.
  const transport::TransportStats& prepared() const { return progress_.prepared(); }
  /// Device time per sample a pixel, by component, without that preparation; 0 before the first sample.
  std::array<double, shared::k_component_count> component_ms_a_sample() const {
    return progress_.component_ms_a_sample();
  }

  /// Tone-mapped picture with the settings' view, or a heat map on view().heat's scale, with tiles if
  /// overlay.tiles is on. `cancel` is called while solvers draw overlays; true: the picture is already out of
  /// date.
  std::vector<uint8_t> picture(bool with_coarse, const std::function<bool()>& cancel = {});
  /// Likewise, as shown in the window during rendering (Display), with the setting preview.filter; without a
  /// preview, picture(with_coarse).
  std::vector<uint8_t> shown_picture(bool with_coarse, const std::function<bool()>& cancel = {});
  /// True if shown_picture() would return the same as before, provided settings and scene are unchanged: no
  /// new samples, and no changed overlay.
  bool shows_the_same() const;
  /// True if shown_picture() can show the former picture before there is new light.
  bool remembers() const;
  /// Sets the pixels of the window per pixel of the picture, along a side: with overlays, shown_picture() and
  /// picture() are larger by shown_scale(), at most this.
  void set_window_scale(uint32_t scale);
  uint32_t shown_scale() { return overlays_.scale(); }
  /// True if the surfaces of the window's pixels are not traced yet; overlays then use the picture's samples.
  /// With RendererOptions::interactive only trace_overlay() traces them, so that a moving camera does not
  /// wait; the next picture shows them.
  bool overlay_waits() { return overlays_.waits(); }
  void trace_overlay(const std::function<bool()>& cancel) { overlays_.trace(cancel); }
  /// Shares of the latest shown_picture().
  film::PreviewShares preview_shares() const;
  /// Display::former_is_preview
  bool former_is_preview() const { return display_ && display_->former_is_preview(); }
  film::View view() const;
  film::Image image() const { return setup_.film->read(); }  ///< without a pending mix
  /// Brightness of the picture, or at a point (0..1 to the right and down): of the coarse image while there
  /// is no other. Throws Error if there is none.
  film::Brightness measure(std::optional<vec2> at) const;
  /// The light of the shown picture: of the layer and the components that view() shows. Throws Error if it
  /// has no sample, or shows a layer that is no light.
  HeldPicture held_picture();
  /// The image with its layers and metadata (including its noise), as in EXR files.
  film::FilmImage film_image();
  /// film_image() with add_noise_layers().
  film::FilmImage film_image_with_halves();
  /// Filters the present picture (film/filter/): until its next sample, film_image() contains the filtered
  /// layers too, and save() writes the filtered picture as PNG. Throws Error if there is no picture, or not
  /// enough memory.
  const Filtered& filter();
  /// Result of filter() for the present picture; null: none.
  const Filtered* filtered() const;
  /// True if the next step() filters the picture for the window (WindowFilter).
  bool filter_due() const;
  /// True if shown_picture() has a new filtered picture since the last call.
  bool filter_news() { return window_filter_ && window_filter_->news(); }
  /// Writes film_image() as EXR, or the picture with exposure and tone curve as PNG; `as_shown`: including
  /// the preview's filter, if on.
  void save(const std::filesystem::path& file, bool as_shown = false);

  // Active solvers by name (solvers/registry.h). Path tracing is not one of them: it is the wavefront.

  /// Null if it computes nothing.
  const solvers::Solver* solver(std::string_view name) const {
    return setup_.engine ? setup_.engine->find(name) : nullptr;
  }
  solvers::Solver* solver(std::string_view name) {
    return setup_.engine ? setup_.engine->find(name) : nullptr;
  }
  /// Overlays::visit_solvers
  void visit_solvers(const Overlays::Visit& f) { overlays_.visit_solvers(f); }
  /// True if some light is looked up.
  bool looks_up() const { return setup_.engine && !setup_.engine->solvers().empty(); }
  /// True if preparation is needed before the next sample.
  bool preparing() const { return setup_.engine && setup_.engine->unready(); }
  /// ... and waits for a command.
  bool waits() const { return setup_.engine && setup_.engine->waits(); }
  /// Ends preparation as soon as possible (solvers::Preparation::finish_early).
  void finish_early();
  /// Runs one of SolverInfo::commands; does nothing if the solver is not active.
  void solver_command(const std::string& name, const std::string& command);
  /// Writes the data of a solver (SolverInfo::file), once it is ready. Throws Error located at `file`: the
  /// solver is not active, not ready, or the file cannot be written (then the old file stays).
  void solver_save(const std::string& name, const std::filesystem::path& file);
  /// Replaces a solver's data by a file, and restarts the image; missing data of this view is added first.
  /// Throws Error like solvers::Persistence::load; then everything stays unchanged.
  void solver_load(const std::string& name, const std::filesystem::path& file);
  /// Reports of the solvers, for the picture that the latest picture() has shown.
  std::vector<std::shared_ptr<const solvers::Report>> reports();
  /// Sum of a figure over the solvers (solvers::Statistics::figures); 0 if none has it.
  double figure(const std::string& name) const;
  /// True if all kernels of preparation have run once.
  bool prepares_warm() const {
    return preparing() && solvers::offered<solvers::Preparation>(*setup_.engine->unready())->warm();
  }
  /// Statistics of the solvers by name, for --stats.
  nlohmann::ordered_json solver_statistics();
  /// Session::inspect; shown in later pictures.
  void inspect(std::optional<vec2> at);

  /// Records paths of the present picture by tracing them again; nothing else changes. Throws Error: no
  /// scene, kernels, memory.
  recording::Recording begin_recording() const;
  /// Appends these paths to such a recording. False if cancelled: then some are missing.
  bool record_paths(std::span<const shared::PathChoice> choices, recording::Recording& into,
                    const std::function<bool()>& cancel = {},
                    uint32_t events_per_path = transport::PathRecorder::k_events);
  /// Explains the noise of a part of the picture, 0..1 to the right and down, from a small seeded trial of
  /// its paths: shares by component, word, light and material, and settings that would reduce it
  /// (plan/choose.h).
  recording::NoiseReport explain_noise(const vec2& lo, const vec2& hi);
  /// Draws recorded paths over later pictures; nullptr: none.
  void show_paths(ShownPaths paths) { overlays_.show_paths(std::move(paths)); }
  const ShownPaths& shown_paths() const { return overlays_.shown_paths(); }

  /// Cost and error of this image over time; the last entry is current only after finish_ledger().
  const stats::Ledger& ledger() const { return progress_.ledger(); }
  void finish_ledger();

  /// Compares further samples with this reference picture: ledger entries then contain the true error. Throws
  /// Error like film::read_reference, or without a scene; the former reference then stays. Entries have no
  /// true error while the picture has another size, camera or scene than the reference.
  void set_reference(const std::filesystem::path& file) { progress_.set_reference(file); }
  void clear_reference() { progress_.clear_reference(); }
  /// Null if there is none.
  const film::Reference* reference() const { return progress_.reference(); }
  /// True if the reference shows the present picture.
  bool reference_applies() const { return progress_.reference_applies(); }

  const film::Film& film() const { return *setup_.film; }
  const transport::TransportStats& stats() const { return setup_.engine->wavefront().stats(); }
  std::string tracer_name() const { return setup_.world.host ? "host" : "compute-bvh"; }
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
  /// (scene::light_factors).
  void restart(const scene::Changes& changes, const std::optional<std::vector<vec3>>& factors = {});
  PictureView picture_view() const { return setup_.view(automaton_); }
  std::vector<uint8_t> picture_of(const Filtered& filtered, const film::View& view,
                                  const std::function<bool()>& cancel);
  FilterJob filter_job() const;
  WindowFilter::Progress filter_progress() const;
  /// The window's filtered picture, if that view shows it; else null.
  const Filtered* shown_filtered(const film::View& view) const;
  void forget_filtered();
  void mark_tiles(const film::View& view);
  bool previewed(const film::View& view) const;  ///< true if the window shows a preview in that view
  film::HeatScale heat_scale(uint32_t layer) const;
  HeldPicture described();  ///< a held picture without its light
  /// The display and view of film.ocio as a table on the device.
  struct OcioTable {
    std::string of;  ///< file, display and view
    gpu::Buffer nodes;
    float white;  ///< film::OcioConfig::white()
  };
  void show_by(std::shared_ptr<const OcioTable> ocio);
  /// The table for these settings: null without film.ocio, the present one if it fits. Throws Error, located.
  std::shared_ptr<const OcioTable> ocio_table(const plan::Settings& settings) const;
  /// Another exposure, tone curve or view changes errors as seen, by which tiles have stopped.
  bool judged_otherwise() const { return adaptive() && seen_ != setup_.seen_range(); }
  /// True if the picture's light is unchanged, whatever its computation and camera.
  bool keeps_light(const scene::Changes& changes) const;
  void start_schedule();
  /// Continues with another sampling mode or region from the present samples.
  void change_schedule();
  /// Blocks that the next schedule gives samples to: all until every pixel has the window's first samples.
  schedule::Rectangle scheduled_region();
  void start_uniform(std::vector<uint32_t> have, const schedule::Rectangle& region);
  schedule::AdaptiveOptions adaptive_options(const schedule::Rectangle& region) const;
  solvers::Provenance provenance() const;
  solvers::Solver& solver_for_file(const std::string& name, const std::filesystem::path& file,
                                   const char* nothing, const char* no_scene);
  /// Applies the plan of the target's settings, with new kernels and solvers if needed: then true. Adds edits
  /// of lights to `changes` if the settings cause them.
  bool apply_plan(Transaction::Target target, scene::Changes& changes);
  void notify_settings_changed();  ///< informs the solvers
  /// Runs a part of the pilot, and then chooses the solvers. False if cancelled.
  bool run_pilot(const std::function<bool()>& cancel);
  bool render_item(const std::function<bool()>& cancel);
  /// If refining lookup data reduces the picture's squared error more than as many samples: runs one work
  /// item of it. True if it did.
  std::optional<bool> refine(const std::function<bool()>& cancel);
  bool refining_pays(uint64_t paths);
  /// If the item waits for a round: runs one work item of that round. True if it did.
  std::optional<bool> prepare_round(const schedule::WorkItem& item, const std::function<bool()>& cancel);
  recording::NoiseCure noise_cure(const recording::NoiseReport& report) const;
  /// Call after a coarse preview sample, with its duration.
  void note_path_pace(double seconds);

  RendererOptions options_;
  std::shared_ptr<gpu::Device> device_;
  std::unique_ptr<gpu::ShaderCompiler> compiler_;
  paths::Automaton automaton_;
  SetupContext context_;
  Setup setup_;
  Overlays overlays_{context_, setup_};
  std::map<std::string, std::string> applied_;      ///< settings of the present picture
  bool mix_pending_ = false, mix_dragged_ = false;  ///< not in the film's sums yet; the mix is being dragged
  std::vector<vec3> mixed_;                         ///< weights of the last mix
  Timer since_mix_;
  std::shared_ptr<const scene::Scene> loaded_;  ///< as passed to set_scene()
  plan::SceneFacts facts_;                      ///< of the scene as it was installed, without effects.off
  std::unique_ptr<Pilot> pilot_;                ///< while it runs
  std::optional<solvers::Findings> findings_;   ///< of this scene's pilot
  std::optional<double> seconds_limit_;
  std::unique_ptr<PathRecording> recording_;     ///< null until paths are recorded
  std::optional<Filtered> filtered_;             ///< by filter()
  std::unique_ptr<WindowFilter> window_filter_;  ///< null in batch
  std::unique_ptr<Display> display_;             ///< null in batch
  struct {
    uint64_t version = ~uint64_t{0}, paths = 0;
    bool filtered = false;
  } shown_;                                     ///< Display::version() and paths of the latest shown preview
  bool draft_preparing_ = false;                ///< state at the latest preview sample
  double coarse_s_ = 0;                         ///< of the coarse preview samples since they began
  std::optional<stats::SamplePace> path_pace_;  ///< for a picture of one pixel
  scene::Lens begun_lens_;                      ///< of the picture begun last
  Sampling sampling_;
  /// Samples of every pixel of the window's picture before only a region gets more: one in each half of the
  /// film, so that their noise is known.
  static constexpr uint32_t k_around_region = 2;
  bool region_waits_ = false;  ///< its schedule starts when every pixel has these samples
  ImageProgress progress_{setup_, sampling_};
  std::shared_ptr<const OcioTable> ocio_;  ///< null: the tone curve
  film::SeenRange seen_;                   ///< seen_range() of the errors in the adaptive schedule
  uint64_t restarts_ = 0;
  uint64_t errors_restart_ = ~0ull;             ///< image whose lookup errors are being estimated ...
  const solvers::Solver* errors_of_ = nullptr;  ///< ... and their solver
  uint32_t weighed_at_ = 0;                     ///< samples at the latest refining_pays()
  double load_seconds_ = 0;
};

/// Peak resident memory of this process [MiB].
double peak_host_mb();

}  // namespace lucerna::session
