#pragma once
// The renderer on one thread: a device, a scene, settings, a film; step() does one bounded work item. The
// batch verbs use it directly; Session runs one on a thread of its own.
#include <array>
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/timer.h"
#include "bvh/embree/host_tracer.h"
#include "film/developer.h"
#include "film/error.h"
#include "film/estimator.h"
#include "film/film.h"
#include "film/io/image_file.h"
#include "film/io/reference.h"
#include "gpu/kernel.h"
#include "paths/automaton.h"
#include "plan/settings.h"
#include "scene/io/load.h"
#include "scene/scene.h"
#include "schedule/adaptive.h"
#include "schedule/uniform.h"
#include "session/cache_report.h"
#include "solvers/irradiance_cache/cache.h"
#include "solvers/irradiance_cache/file.h"
#include "solvers/irradiance_cache/info.h"
#include "solvers/registry.h"
#include "stats/ledger.h"
#include "transport/wavefront.h"

namespace lucerna::irradiance_cache {
class PlacementView;
}

namespace lucerna::session {

struct RendererOptions {
  std::string device;
  bool validation = false;
  std::filesystem::path shaders;
  gpu::Defines defines;            ///< further #defines for the transport's kernels (tests)
  bool pauses = false;             ///< the setting cache.pause is heeded: step() may wait for step_cache()
  scene::LoadOptions scenes = {};  ///< what scenes may read and take
  /// Given: this device, instead of one of its own by `device` and `validation`; its pipelines are kept from
  /// renderer to renderer. Not to be used from two threads at once.
  std::shared_ptr<gpu::Device> on = {};
};

/// Of the irradiance cache.
inline solvers::Spoils spoiled(scene::Change edit) {
  return solvers::spoiled_by(irradiance_cache::info(), edit);
}

/// fraction 0..1 and what is going on; returning false cancels (an Error "cancelled" is thrown).
using Progress = std::function<bool(float, const std::string&)>;

class Renderer {
 public:
  explicit Renderer(const RendererOptions& options);
  ~Renderer();

  gpu::Device& device() { return *device_; }
  /// Loads a file and makes it ready to render. On failure throws Error and the scene before stays.
  void load(const std::filesystem::path& file, const Progress& progress = {});
  /// The same for a scene made in memory. Settings start afresh (but for tracer and path.batch), then the
  /// scene's own.
  void set_scene(std::shared_ptr<const scene::Scene> scene, const Progress& progress = {});
  std::shared_ptr<const scene::Scene> scene() const { return scene_; }

  plan::Settings& settings() { return settings_; }
  const plan::Settings& settings() const { return settings_; }
  /// Settings changed by hand: applies what differs, restarts if the image depends on it. A target error,
  /// caps on samples and the mode of sampling let the image go on.
  void apply_settings();
  /// Throws Error as film::check_size; the size before stays.
  void set_size(uint32_t width, uint32_t height);
  void set_camera(const scene::Camera& camera);
  const scene::Camera& camera() const { return camera_; }
  /// Camera of the scene by name; Error when there is none such, listing the names.
  void choose_camera(const std::string& name);
  void set_light(uint32_t index, const scene::Light& light);
  void set_environment(float scale, float rotation_degrees);
  /// Throws Error when there is no such material, or when textures or what a surface lets through (alpha
  /// mode, transmission, thickness) would be others: these are the scene's shape, as rays find it.
  void set_material(uint32_t index, const scene::Material& material);
  void reload_shaders();
  /// Begins the image anew, and what it looks up.
  void restart() { restart(spoiled(scene::Change::restart)); }
  /// Images begun so far.
  uint64_t restarts() const { return restarts_; }
  /// Passes over the picture, or over the tiles at work, that are complete.
  uint32_t passes() const { return adaptive_ ? adaptive_->rounds() : schedule_.passes(); }

  bool ready() const { return wavefront_ != nullptr; }
  bool done() const { return adaptive_ ? adaptive_->done() : schedule_.done(); }
  /// Samples that every pixel has.
  uint32_t samples() const { return adaptive_ ? adaptive_->least_samples() : schedule_.complete(); }
  /// Samples a pixel at which the image is finished; adaptive: that no pixel goes beyond.
  uint32_t max_samples() const { return adaptive_ ? adaptive_->options().max_samples : schedule_.samples(); }
  /// The state of every tile; null in uniform sampling.
  const schedule::AdaptiveSchedule* adaptive() const { return adaptive_ ? &*adaptive_ : nullptr; }
  /// Noise of the picture as it is, from all its pixels. Takes a pass over the film.
  film::ImageError image_error();
  /// The same for every tile of sampling.tile, in raster order, heavy tails marked: as the last image_error()
  /// found it.
  std::vector<film::TileError> tile_errors() const;
  uint32_t tile_side() const;  ///< sampling.tile: pixels
  /// What these errors, which are of the noise, do not tell: plan::Plan::bias of the settings in force.
  std::optional<double> bias(size_t component) const;
  /// One work item; cancellable between bounces. False when there was nothing to do or it was cancelled, or
  /// while building of the cache waits.
  bool step(const std::function<bool()>& cancel = {});
  /// A quick image of a quarter of the resolution, for display until the film is filled.
  /// Its paths, rays and time are not in stats().
  void render_coarse(const std::function<bool()>& cancel = {});

  /// The person's clock: seconds since this image's first step() or render_coarse(), whatever else was done
  /// meanwhile; not between rest() and the next of these, nor after the last.
  double seconds() const { return clock_.seconds(); }
  /// The clock stands still from now on: rendering waits, for a person or for a scene.
  void rest() { clock_.stop(); }
  /// Of seconds(), those that step() has spent tracing this image (stats::Entry::render_s).
  double render_seconds() const { return render_s_; }
  /// Of stats(), what was prepared before the first sample: the records that paths look up.
  const transport::TransportStats& prepared() const { return prepared_; }
  /// Device time of a sample a pixel, by component, without what was prepared before; 0 before the first.
  std::array<double, shared::k_component_count> component_ms_a_sample() const;

  /// Tone-mapped picture with the settings' view, or a heat map on view().heat's scale; tiles over it where
  /// overlay.tiles is on.
  std::vector<uint8_t> picture(bool with_coarse);
  film::View view() const;
  film::Image image() const { return film_->read(); }
  /// The image with its layers and metadata (its own noise among them), as EXR files hold it.
  film::FilmImage film_image();
  void save(const std::filesystem::path& file);
  /// Writes the records that paths look up, once they are complete. Throws Error located at `file`: there are
  /// none, they are still being built, the file cannot be written (then what was there stays).
  void save_cache(const std::filesystem::path& file);
  /// Takes the records of a file in place of those there are, and begins the image anew: what this view is
  /// missing is added first; the view that they were complete for is missing nothing. Throws Error as
  /// irradiance_cache::read_cache and check_fits; then everything stays as it was.
  void load_cache(const std::filesystem::path& file);

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
  const transport::TransportStats& stats() const { return wavefront_->stats(); }
  std::string tracer_name() const { return host_ ? "host" : "compute-bvh"; }
  double load_seconds() const { return load_seconds_; }
  double compile_seconds() const { return compile_seconds_; }
  uint32_t enabled_components() const;
  /// Null where nothing is looked up.
  const irradiance_cache::Cache* cache() const { return cache_.get(); }
  /// Looks up the cache's light at every pixel that has samples, and forgets it: to be timed.
  void look_up_picture();
  /// Session::inspect; pictures from now on show it.
  void inspect(std::optional<vec2> at) { looked_at_ = at; }
  /// Whether building of the cache waits for one of these (Session::step_cache), and these; nothing where
  /// nothing is looked up.
  bool cache_waits() const { return cache_ && cache_->status().waits; }
  void step_cache();
  void run_cache();
  /// Of the cache as the last picture() has shown it; null where there is none. How many records serve each
  /// pixel is looked at once, when there are samples: a pass over the film.
  std::shared_ptr<const CacheReport> cache_report();

 private:
  /// Makes the scene the one that is rendered. On failure throws Error and everything stays as it was.
  void install(std::shared_ptr<const scene::Scene> scene, plan::Settings settings, scene::Camera camera,
               const Progress& progress, solvers::Spoils spoilt = spoiled(scene::Change::shape));
  /// `keep`: of the same scene, so that records serve on. Returns what of them does not.
  solvers::Spoils build_wavefront(const upload::DeviceScene& device_scene, bool keep);
  /// The scene with other lights or another environment: uploads these anew. Kernels are made for what it
  /// calls for now.
  void relight(std::shared_ptr<const scene::Scene> edited, solvers::Spoils spoilt);
  void make_film(solvers::Spoils spoilt);
  /// `spoilt`: of the records that paths look up.
  void restart(solvers::Spoils spoilt);
  shared::Frame make_frame(uint32_t width, uint32_t height) const;  ///< of the picture's paths
  shared::Frame make_frame(uint32_t width, uint32_t height, const paths::LookupRoutes& routes,
                           uint32_t fallback, const paths::LookupRoutes& gather) const;
  film::HeatScale heat_scale(uint32_t layer) const;
  float luminance_floor() const;
  void start_schedule();
  /// Another way of sampling goes on with the samples there are.
  void change_schedule();
  schedule::AdaptiveOptions adaptive_options() const;
  irradiance_cache::Making cache_making() const;
  void warn_of_full_cache();
  /// All that decides which records this picture asks for, as text.
  std::string cache_view_text() const;
  /// Where the camera is and how it sees, as text: pictures of one scene that agree in it show the same.
  std::string view_text() const;
  void heed_pauses();  ///< tells the cache of the settings'
  void draw_cache();   ///< over the film's picture, as the settings say
  overlay::Canvas canvas();
  irradiance_cache::Inspector& inspector();
  bool render_item(const std::function<bool()>& cancel);
  irradiance_cache::CacheOptions cache_options() const;
  irradiance_cache::CacheView cache_view() const;
  paths::LookupRoutes wanted_routes(const upload::Effects& effects) const;  ///< by the settings
  paths::LookupRoutes wanted_record_routes(
      const upload::Effects& effects) const;  ///< ... of the rays of records
  /// upload::FlatScene::sun_threshold that they ask for.
  float wanted_sun_threshold(const plan::Settings& settings) const;
  /// Adds a line to the ledger when one is due, or at once.
  void note_progress(bool at_once);

  RendererOptions options_;
  std::shared_ptr<gpu::Device> device_;
  std::unique_ptr<gpu::ShaderCompiler> compiler_;
  paths::Automaton automaton_;
  plan::Settings settings_;
  std::shared_ptr<const scene::Scene> scene_;
  upload::FlatScene flat_;
  std::unique_ptr<upload::DeviceScene> device_scene_;
  std::unique_ptr<bvh::HostTracer> host_;
  gpu::Defines compiled_;                                            ///< of the scene, in the kernels in use
  paths::LookupRoutes routes_, record_routes_;                       ///< of the kernels in use
  std::unique_ptr<irradiance_cache::Cache> cache_;                   ///< null: nothing is looked up
  std::unique_ptr<irradiance_cache::Inspector> inspector_;           ///< made when it is called for
  std::unique_ptr<irradiance_cache::PlacementView> placement_view_;  ///< the same
  uint32_t full_at_ = 0;  ///< records at which a person was last told that there is no room for more
  std::optional<vec2> looked_at_;
  irradiance_cache::Inspection inspection_;
  std::pair<uint64_t, irradiance_cache::Overlap> overlap_{~0ull, {}};  ///< and the restart that it is of
  std::unique_ptr<transport::Wavefront> wavefront_;
  std::unique_ptr<film::Developer> developer_;
  std::unique_ptr<film::ErrorEstimator> estimator_;
  std::unique_ptr<film::Film> film_, coarse_;
  scene::Camera camera_;
  schedule::UniformSchedule schedule_;
  stats::Ledger ledger_;
  std::optional<film::Reference> reference_;
  uint64_t restarts_ = 0;
  uint64_t told_restart_ = ~0ull;  ///< the image of which the records' errors are being told
  Stopwatch clock_;                ///< of the person who waits for this image
  double render_s_ = 0;            ///< of that, in step()
  double prepared_s_ = 0;          ///< of the clock, before the image's first sample
  transport::TransportStats prepared_;
  std::optional<schedule::AdaptiveSchedule> adaptive_;  ///< instead of schedule_
  uint32_t width_ = 1280, height_ = 720;
  std::map<std::string, std::string> applied_;  ///< settings that the film was made with
  double load_seconds_ = 0, compile_seconds_ = 0;
};

/// Resident memory of this process at its highest, MiB.
double peak_host_mb();

}  // namespace lucerna::session
