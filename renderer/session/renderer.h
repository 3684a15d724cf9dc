#pragma once
// The renderer on one thread: a device, a scene, settings, a film; step() does one bounded work item. The
// batch verbs use it directly; Session runs one on a thread of its own.
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
#include "overlay/sheet.h"
#include "paths/automaton.h"
#include "plan/plan.h"
#include "plan/settings.h"
#include "scene/io/load.h"
#include "scene/scene.h"
#include "session/display.h"
#include "session/engine.h"
#include "session/filtered.h"
#include "session/kept_solvers.h"
#include "session/lights_edit.h"
#include "session/lights_view.h"
#include "session/relight.h"
#include "session/sampling.h"
#include "session/world.h"
#include "stats/forecast.h"
#include "stats/ledger.h"
#include "transport/wavefront.h"

namespace lucerna::session {

struct RendererOptions {
  std::string device;
  bool validation = false;
  std::filesystem::path shaders;
  gpu::Defines defines;      ///< further #defines for the transport's kernels (tests)
  bool interactive = false;  ///< somebody leads preparation from step to step: step() may wait for a command
  scene::LoadOptions scenes = {};  ///< what scenes may read and take
  /// Given: this device, instead of one of its own by `device` and `validation`; its pipelines are kept from
  /// renderer to renderer. Not to be used from two threads at once.
  std::shared_ptr<gpu::Device> on = {};
};

/// A value for a setting, and where it comes from, for messages.
struct SettingChange {
  std::string key, value, where;
};

class Renderer {
 public:
  explicit Renderer(const RendererOptions& options);
  ~Renderer();

  gpu::Device& device() { return *device_; }
  /// Loads a file and makes it ready to render. On failure throws Error and the scene before stays.
  /// `changes`: of settings, above the scene's own.
  void load(const std::filesystem::path& file, const Progress& progress = {},
            const std::vector<SettingChange>& changes = {});
  /// The same for a scene made in memory. Settings start afresh (but for tracer, path.batch and
  /// path.classes), then the scene's own, then `changes`.
  void set_scene(std::shared_ptr<const scene::Scene> scene, const Progress& progress = {},
                 const std::vector<SettingChange>& changes = {});
  /// Null before the first.
  std::shared_ptr<const scene::Scene> scene() const { return world_.scene; }

  plan::Settings& settings() { return settings_; }
  const plan::Settings& settings() const { return settings_; }
  /// Settings changed by hand: applies what differs, restarts if the image depends on it. A target error,
  /// caps on samples and the mode of sampling let the image go on. Throws Error when what they need cannot be
  /// made (kernels, memory): the picture before goes on.
  void apply_settings();
  /// Throws Error as film::check_size; the size before stays.
  void set_size(uint32_t width, uint32_t height);
  /// Throws Error as scene::check_range, as do the edits below; then what was there before stays.
  void set_camera(const scene::Camera& camera);
  const scene::Camera& camera() const { return camera_; }
  /// Camera of the scene by name; Error when there is none such, listing the names.
  void choose_camera(const std::string& name);
  void set_light(uint32_t index, const scene::Light& light);
  void set_environment(float scale, float rotation_degrees);
  /// Lights the scene by this latitude-longitude image instead of its own environment; "": by its own again.
  /// With this factor and rotation, or with those in force. Throws Error as scene::load_environment; the
  /// environment before stays.
  void set_environment_file(const std::filesystem::path& file, std::optional<float> scale = {},
                            std::optional<float> rotation_degrees = {});
  /// Throws Error when there is no such material, or when textures or what a surface lets through (alpha
  /// mode, transmission, thickness) would be others: these are the scene's shape, as rays find it.
  void set_material(uint32_t index, const scene::Material& material);
  /// All of that as one. Where the light is the same as now, mixed by groups before and written into the
  /// lights then, or the other way round, the picture goes on. Throws Error; then nothing has changed.
  void set_lights(const LightsEdit& edit);
  /// The scene's groups of lights, and what the settings make of them.
  const Relight& relight() const { return relight_; }
  /// In the window another mix is shown at once, and the film's own sums follow with the next step(), or with
  /// this.
  bool mix_pending() const { return mix_pending_; }
  void settle_mix();
  void reload_shaders();
  /// Begins the image anew, and what it looks up.
  void restart() { restart(scene::Change::restart); }
  /// Images begun so far.
  uint64_t restarts() const { return restarts_; }
  /// Passes over the picture, or over the tiles at work, that are complete.
  uint32_t passes() const { return sampling_.passes(); }

  bool ready() const { return engine_ != nullptr; }
  bool done() const { return sampling_.done() && !judged_otherwise(); }
  /// Samples that every pixel has.
  uint32_t samples() const { return sampling_.samples(); }
  /// Samples a pixel at which the image is finished; adaptive: that no pixel goes beyond.
  uint32_t max_samples() const { return sampling_.max_samples(); }
  /// The state of every tile; null in uniform sampling.
  const schedule::AdaptiveSchedule* adaptive() const { return sampling_.adaptive(); }
  /// Noise of the picture as it is, from all its pixels. Takes a pass over the film.
  film::ImageError image_error();
  /// The same for every tile of sampling.tile, in raster order, heavy tails marked: as the last image_error()
  /// found it.
  std::vector<film::TileError> tile_errors() const;
  uint32_t tile_side() const;  ///< sampling.tile: pixels
  /// Whether these errors hold all that is told of what lookups may be wrong by (film::RecordsError).
  bool lookup_errors_known() const;
  /// What these errors, which are of the noise, do not tell: plan::Plan::bias of the settings in force;
  /// nothing before the first scene.
  std::optional<double> bias(size_t component) const;
  /// One work item; cancellable between bounces. False when there was nothing to do or it was cancelled, or
  /// while preparation waits.
  bool step(const std::function<bool()>& cancel = {});
  /// For display until the film is filled, where RendererOptions::interactive: another sample of a draft, of
  /// fewer pixels, if it is time for one; the first comes at once, of a quarter of the resolution. Its paths,
  /// rays and time are not in stats(). False when nothing was drawn.
  bool draw_draft(const std::function<bool()>& cancel = {});
  /// Whether there is a draft of the light as it is known now; it begins anew when that gets better.
  bool has_draft() const { return display_ && display_->plan().begun(); }
  /// What path tracing alone would take, as drafts have told before there was any light to be looked up. None
  /// where they have not.
  std::optional<stats::SamplePace> path_pace() const;
  /// Of what draw_draft() has drawn last: DraftPlan::news().
  bool draft_news() const { return display_ && display_->plan().news(); }

  /// The person's clock: seconds since this image's first step() or draw_draft(), whatever else was done
  /// meanwhile; not between rest() and the next of these, nor after the last.
  double seconds() const { return clock_.seconds(); }
  /// The clock stands still from now on: rendering waits, for a person or for a scene.
  void rest() { clock_.stop(); }
  /// Of seconds(), those that step() has spent tracing this image (stats::Entry::render_s).
  double render_seconds() const { return render_s_; }
  /// Of stats(), what was prepared before the first sample.
  const transport::TransportStats& prepared() const { return prepared_; }
  /// Device time of a sample a pixel, by component, without what was prepared before; 0 before the first.
  std::array<double, shared::k_component_count> component_ms_a_sample() const;

  /// Tone-mapped picture with the settings' view, or a heat map on view().heat's scale; tiles over it where
  /// overlay.tiles is on.
  /// `cancel` is asked while solvers draw over it: true when it is out of date already.
  std::vector<uint8_t> picture(bool with_coarse, const std::function<bool()>& cancel = {});
  /// The same as the window shows it while it is made (Display), with the setting preview.filter; where there
  /// is no such thing, picture(with_coarse).
  std::vector<uint8_t> shown_picture(bool with_coarse, const std::function<bool()>& cancel = {});
  /// Whether shown_picture() would bring what it brought last, as far as no setting and no scene has changed
  /// since: there is nothing new, and nothing is drawn over it that may be.
  bool shows_the_same() const;
  /// Whether shown_picture() has something to show before there is any new light: what was there before.
  bool remembers() const;
  /// Pixels of the window per pixel of the picture, along a side: where overlays are on, shown_picture() and
  /// picture() are larger by shown_scale(), at most this.
  void set_window_scale(uint32_t scale) { window_scale_ = std::max(1u, scale); }
  uint32_t shown_scale() { return sheet().scale(); }
  /// Overlays follow the picture's samples until the surfaces of the window's pixels have been traced. Where
  /// RendererOptions::interactive, that waits for trace_overlay(), so that a moving camera does not; the next
  /// picture then shows it.
  bool overlay_waits();
  void trace_overlay(const std::function<bool()>& cancel);
  /// Of the picture that shown_picture() has made last.
  film::PreviewShares preview_shares() const;
  film::View view() const;
  film::Image image() const { return film_->read(); }  ///< without a mix that is pending
  /// The picture's brightness, or that at a point (0..1 to the right and down): of the coarse image while
  /// there is no other. Throws Error when there is none at all.
  film::Brightness measure(std::optional<vec2> at) const;
  /// The image with its layers and metadata (its own noise among them), as EXR files hold it.
  film::FilmImage film_image();
  /// Filters the picture as it is now (film/filter/): from here to its next sample film_image() has the
  /// filtered layers beside its own, and save() writes the filtered picture as PNG. Throws Error where that
  /// cannot be done: there is no picture, or no memory for it.
  const Filtered& filter();
  /// What filter() has made of the picture as it is; null: nothing.
  const Filtered* filtered() const;
  /// Whether the next step() filters the picture for the window (RendererOptions::interactive): from some
  /// samples on and again when there are twice as many, and when it is done. Sampling waits meanwhile.
  bool filter_due() const;
  /// Whether shown_picture() has another filtered picture since this was called last.
  bool filter_news() { return std::exchange(filter_news_, false); }
  /// Writes film_image() as EXR, or what the window shows as PNG: through exposure and tone curve, `as_shown`
  /// with the preview's filter too, where that is on.
  void save(const std::filesystem::path& file, bool as_shown = false);

  // Solvers at work, by name (solvers/registry.h). Path tracing is none: the wavefront is it.

  /// Null where that one computes nothing.
  const solvers::Solver* solver(std::string_view name) const {
    return engine_ ? engine_->find(name) : nullptr;
  }
  solvers::Solver* solver(std::string_view name) { return engine_ ? engine_->find(name) : nullptr; }
  /// Calls f with each, the picture that it can draw over, and the picture as it is told of it.
  using Visit = std::function<void(solvers::Solver&, const overlay::Canvas&, const solvers::Picture&)>;
  void visit_solvers(const Visit& f, const std::function<bool()>& cancel = {});
  /// Some light is looked up.
  bool looks_up() const { return engine_ && !engine_->solvers().empty(); }
  /// Something is to be prepared before the next sample.
  bool preparing() const { return engine_ && engine_->unready(); }
  /// ... and waits for a command.
  bool waits() const { return engine_ && engine_->waits(); }
  /// That is to end as soon as it can, with what there is (solvers::Solver::finish_early).
  void finish_early();
  /// One of SolverInfo::commands; nothing where the solver is not at work.
  void solver_command(const std::string& name, const std::string& command);
  /// Writes the work of a solver (SolverInfo::file), once it is ready. Throws Error located at `file`: the
  /// solver is not at work, not ready, or the file cannot be written (then what was there stays).
  void solver_save(const std::string& name, const std::filesystem::path& file);
  /// Takes the work of a file in place of what there is, and begins the image anew: what this view is missing
  /// is added first. Throws Error as Solver::load; then everything stays as it was.
  void solver_load(const std::string& name, const std::filesystem::path& file);
  /// What the solvers tell a person, of the picture as the last picture() has shown it.
  std::vector<std::shared_ptr<const solvers::Report>> reports();
  /// A figure of the solvers (Solver::figures), added up; 0 where none has it.
  double figure(const std::string& name) const;
  /// What is being prepared has run all its kernels.
  bool prepares_warm() const { return preparing() && engine_->unready()->warm(); }
  /// Figures of the solvers by name, for --stats.
  nlohmann::ordered_json solver_statistics();
  /// Looks up the solvers' light at every pixel that has samples, and forgets it: to be timed.
  void look_up_picture();
  /// Session::inspect; pictures from now on show it.
  void inspect(std::optional<vec2> at);

  /// What this image has cost and how good it was, from its start on; the last line is the present only after
  /// finish_ledger().
  const stats::Ledger& ledger() const { return ledger_; }
  void finish_ledger() { note_progress(true); }

  /// Holds what is rendered from now on against this picture: the ledger's lines then tell the truth. Throws
  /// Error as film::read_reference, or when there is no scene yet; the reference before then stays. Lines are
  /// without truth while the picture is another than the reference's: other size, camera or scene.
  void set_reference(const std::filesystem::path& file);
  void clear_reference() { reference_.reset(); }
  bool has_reference() const { return reference_.has_value(); }
  /// Null when there is none.
  const film::Reference* reference() const { return reference_ ? &*reference_ : nullptr; }
  /// Whether the picture is the one that the reference shows.
  bool reference_applies() const;

  const film::Film& film() const { return *film_; }
  const transport::TransportStats& stats() const { return engine_->wavefront().stats(); }
  std::string tracer_name() const { return world_.host ? "host" : "compute-bvh"; }
  double load_seconds() const { return load_seconds_; }
  double compile_seconds() const { return engine_ ? engine_->compile_seconds() : 0; }
  /// Components that are computed (bit i), by the settings in force; 0 before the first scene.
  uint32_t enabled_components() const;

 private:
  struct Films {
    std::unique_ptr<film::Film> picture, coarse;
  };
  Films make_films(uint32_t width, uint32_t height, const upload::Effects& effects) const;
  /// Whether a film keeps groups of lights apart as paths do that are traced for these.
  static bool keeps(const film::Film& film, const upload::Effects& effects);
  /// Of a scene in a picture of that size.
  Relight make_relight(const plan::Plan& plan, const plan::Settings& settings,
                       std::shared_ptr<const scene::Scene> scene, uint32_t width, uint32_t height) const;
  /// How lights are to be told apart.
  upload::LightSeparation wanted_separation(const plan::Plan& plan, const plan::Settings& settings,
                                            const Relight& relight) const;
  /// Takes it up, and tells what is new of its messages.
  void take(Relight relight);
  /// The film's picture follows another mix.
  void remix();
  /// Makes the scene the one that is rendered. On failure throws Error and everything stays as it was.
  void install(std::shared_ptr<const scene::Scene> scene, plan::Settings settings, scene::Camera camera,
               const Progress& progress, const scene::Changes& changes);
  /// `changes` say what it may take over from the one in use, if there is one. On failure throws Error and
  /// everything stays.
  std::unique_ptr<Engine> make_engine(const World& world, const plan::Plan& plan,
                                      const plan::Settings& settings, const scene::Changes& changes) const;
  /// Puts another engine in the place of the one in use, whose work is kept where it may serve again.
  void use(std::unique_ptr<Engine> engine, const scene::Changes& changes);
  void use(Films films);
  /// The scene with other lights, environment or factors of materials. Kernels are made for what it calls for
  /// now. On failure throws Error and everything stays as it was.
  void edit(std::shared_ptr<const scene::Scene> edited, const scene::Changes& change, bool factors);
  /// `factors`: of the light of each group, where an edit is known to do no more than that
  /// (scene::light_factors).
  void restart(const scene::Changes& changes, const std::optional<std::vector<vec3>>& factors = {});
  PictureView picture_view() const {
    return {automaton_, settings_, world_, camera_, width_, height_, relight_.weights};
  }
  /// What the film has developed, with what solvers draw over it.
  std::vector<uint8_t> finished_picture(const film::View& view, const std::function<bool()>& cancel);
  /// Some view of a solver, or of the lights, is on.
  bool draws_over() const;
  overlay::Sheet& sheet();
  /// To the picture, at most at that scale.
  void fit_sheet(uint32_t scale);
  std::vector<uint8_t> picture_of(const Filtered& filtered, const film::View& view,
                                  const std::function<bool()>& cancel);
  FilterJob filter_job() const;
  /// A piece of the window's filtered picture. When there is no memory for it there will be none.
  void filter_piece(const std::function<bool()>& cancel);
  void judge_filtered();
  /// The window's filtered picture, where that view shows it; null: there is none.
  const Filtered* shown_filtered(const film::View& view) const;
  void forget_filtered();
  /// The views of learned lights, over the picture.
  void draw_lights(const std::function<bool()>& cancel);
  void mark_tiles(const film::View& view);
  bool previewed(const film::View& view) const;  ///< whether the window shows a preview of it
  film::HeatScale heat_scale(uint32_t layer) const;
  film::SeenRange seen_range() const;
  /// Another exposure or tone curve shows other errors than those that tiles have stopped by.
  bool judged_otherwise() const { return adaptive() && seen_ != seen_range(); }
  /// The picture's light is as before, however it is computed and wherever it is seen from.
  bool keeps_light(const scene::Changes& changes) const;
  void start_schedule();
  /// Another way of sampling goes on with the samples there are.
  void change_schedule();
  schedule::AdaptiveOptions adaptive_options() const;
  /// Where the camera is and how it sees, as text: pictures of one scene that agree in it show the same.
  std::string view_text() const;
  solvers::Provenance provenance() const;
  solvers::Solver& solver_for_file(const std::string& name, const std::filesystem::path& file,
                                   const char* nothing, const char* no_scene);
  /// Takes up the plan that the settings make, with new kernels and solvers where it takes any: then true. On
  /// failure throws Error and everything stays.
  bool apply_plan(scene::Changes& changes);
  void notify_settings_changed();  ///< tells the solvers
  bool render_item(const std::function<bool()>& cancel);
  /// Where further work on what paths read takes more from the picture's squared error than as many further
  /// samples do: a piece of it, and whether that was done.
  std::optional<bool> refine(const std::function<bool()>& cancel);
  bool refining_pays(uint64_t paths);
  /// Where the item cannot be traced yet: a piece of the round that it reads, and whether that was done.
  std::optional<bool> prepare_round(const schedule::WorkItem& item, const std::function<bool()>& cancel);
  /// Adds a line to the ledger when one is due, or at once.
  void note_progress(bool at_once);
  /// Another coarse draft has been drawn, which took so long.
  void note_path_pace(double seconds);

  RendererOptions options_;
  std::shared_ptr<gpu::Device> device_;
  std::unique_ptr<gpu::ShaderCompiler> compiler_;
  paths::Automaton automaton_;
  plan::Settings settings_;
  std::map<std::string, std::string> applied_;  ///< settings that the picture is made with
  World world_;
  Relight relight_;
  bool mix_pending_ = false, mix_dragged_ = false;  ///< not yet in the film's sums; by somebody who drags
  std::vector<vec3> mixed_;                         ///< weights of the last mix
  Timer since_mix_;
  std::shared_ptr<const scene::Scene> loaded_;  ///< as set_scene() was given it
  std::unique_ptr<Engine> engine_;              ///< null before the first scene; goes before the world
  KeptSolvers kept_;
  std::unique_ptr<film::Film> film_, coarse_;
  std::optional<Filtered> filtered_;              ///< by filter()
  std::unique_ptr<PictureFilter> window_filter_;  ///< made when it is called for
  std::optional<Filtered> shown_filtered_;        ///< what it has made last of the picture
  bool filter_fails_ = false, filter_news_ = false;
  uint64_t judged_paths_ = 0;                 ///< when the error of shown_filtered_ was estimated last
  double filter_s_ = 0, filter_piece_s_ = 0;  ///< that filtering took: last, and up to now
  double filtered_at_s_ = 0;                  ///< render_s_ then
  std::unique_ptr<Display> display_;          ///< null in batch
  std::unique_ptr<LightsView> lights_view_;   ///< null until it is shown
  std::unique_ptr<overlay::Sheet> sheet_;     ///< null until something is drawn
  uint32_t window_scale_ = 1;
  bool waits_for_overlay_ = false;  ///< pictures wait for the surfaces of overlays
  bool overlay_fails_ = false;      ///< no memory for these
  struct {
    uint64_t version = ~uint64_t{0}, paths = 0;
    bool filtered = false;
  } shown_;                       ///< Display::version() and the paths of the preview that was shown last
  bool draft_preparing_ = false;  ///< when a draft was drawn last
  double coarse_s_ = 0;           ///< of the coarse drafts since they began
  std::optional<stats::SamplePace> path_pace_;  ///< of a picture of one pixel
  scene::Camera camera_;
  uint32_t width_ = 1280, height_ = 720;
  Sampling sampling_;
  film::SeenRange seen_;  ///< seen_range() that the adaptive schedule's errors are of
  uint64_t restarts_ = 0;
  uint64_t errors_restart_ = ~0ull;  ///< the image of which lookups' errors are being estimated ...
  const solvers::Solver* errors_of_ = nullptr;  ///< ... and whose
  uint32_t weighed_at_ = 0;                     ///< samples at which refining_pays() was looked at last
  std::optional<vec2> looked_at_;

  // What is told of it.
  stats::Ledger ledger_;
  std::optional<film::Reference> reference_;
  Stopwatch clock_;        ///< of the person who waits for this image
  double render_s_ = 0;    ///< of that, in step()
  double prepared_s_ = 0;  ///< of the clock, before the image's first sample
  transport::TransportStats prepared_;
  double load_seconds_ = 0;
};

/// Resident memory of this process at its highest, MiB.
double peak_host_mb();

}  // namespace lucerna::session
