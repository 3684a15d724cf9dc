#pragma once
// What window, command line and scripts see of rendering: they send commands and read snapshots.
// start_session() makes a session with a device and a renderer. Every method may be called from any thread
// and returns at once unless stated otherwise.
#include <array>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "film/exposure.h"
#include "film/io/image_file.h"
#include "film/shown_error.h"
#include "paths/automaton.h"
#include "plan/settings.h"
#include "recording/noise.h"
#include "recording/recording.h"
#include "scene/io/load.h"
#include "scene/scene.h"
#include "scene/texture_source.h"
#include "session/accuracy.h"
#include "session/command_queue.h"
#include "session/held_picture.h"
#include "session/layer_status.h"
#include "session/lights_edit.h"
#include "session/object_edit.h"
#include "session/shown_paths.h"
#include "solvers/report.h"

namespace lucerna::session {

using paths::k_component_names;

/// Relative errors of tiles below which a picture is good enough to work with.
inline constexpr film::ShownError k_usable_error{.median = 0.15, .worst_tenth = 0.3};
inline bool usable(const film::ShownError& e) {
  return e.median < k_usable_error.median && e.worst_tenth < k_usable_error.worst_tenth;
}

struct EffectCosts;

struct ComponentStatus {
  std::string solver = "path";  ///< its solver, or two joined by '+'; or "off"
  std::string reason;           ///< why, if the setting is auto
  double mean_luminance = 0;    ///< of its layer
  std::optional<double> error;  ///< noise as seen; known after two samples a pixel
  double share = 0;             ///< of the mean luminance of the sum, 0..1
  double ms_per_sample = 0;     ///< device time of its rays per sample a pixel, without preparation
};

/// Time of a stage since the image started.
struct StageStatus {
  std::string name;
  double ms = 0;
  bool host = false;  ///< wall time of the host; else device time
};

/// The scale of a layer that does not show light.
struct Legend {
  /// shared::k_layer_albedo, _normal, _depth, or a heat map: _samples, _error (relative), _cost (ms per
  /// pixel); 0: light.
  uint32_t layer = 0;
  uint32_t ramp = 0;  ///< of a heat map: shared::k_ramp_*
  bool logarithmic = false;
  float lo = 0, hi = 1;  ///< values at its ends; of depth [m]
};

/// Everything the window draws: replaced as a whole, never changed after publication.
struct Snapshot {
  uint64_t id = 0;        ///< increases with every published snapshot
  SceneId scene_id = 0;   ///< scene of the picture and the camera below
  uint64_t commands = 0;  ///< commands carried out or refused before it was made (Session::commands)
  /// Numbers, in order, of commands that were refused (an error is logged) or skipped (another scene was
  /// loaded first, or the load was cancelled); null: none. They have changed nothing.
  std::shared_ptr<const std::vector<uint64_t>> refused;
  uint32_t width = 0, height = 0;  ///< of the picture
  uint32_t scale = 1;              ///< of rgba: its pixels per pixel of the picture, along a side
  std::vector<uint8_t> rgba;       ///< width * height * scale^2 * 4, sRGB, top row first; tone-mapped
  Legend legend;                   ///< of the picture's layer
  bool tiles = false;              ///< the picture has its tiles drawn over it
  uint32_t samples = 0;            ///< complete samples a pixel
  double mean_samples = 0;         ///< mean samples a pixel
  uint32_t max_samples = 0;        ///< samples at which it stops
  bool coarse = false;             ///< parts still show the coarse first image
  /// Shares of the shown picture by luminance, 0..1: former light; filtered present light.
  double stale = 0, filtered = 0;
  /// Former light is of this picture's preview, from before the solvers' data was complete; false: from
  /// before the last edit.
  bool stale_is_preview = false;
  /// Error of a preview or filtered picture.
  std::optional<film::ShownError> shown_error;
  /// Why light groups are not separate, so that a mix relights the picture; "" if they are separate.
  std::string lights_together;
  /// Result of the latest measure_effects() for this scene; null: none.
  std::shared_ptr<const EffectCosts> effect_costs;
  bool measures_effects = false;  ///< it is at work; `activity` and `progress` say how far
  std::string tev;                ///< address of the viewer that gets the layers (send_to_tev); "": none
  bool paused = false, finished = false;
  bool resting = false;  ///< nothing is left to do until the next command: finished or paused, and drawn
  /// Current preparation (solvers::Report::preparing), or "".
  std::string preparing;
  double preparing_done = -1;            ///< progress of that, 0..1; -1: unknown
  std::optional<double> preparing_left;  ///< remaining seconds of rendering, estimated (stats::WorkPace)
  std::string refining;                  ///< current solvers::Report::refining, or ""
  /// Pace of pure path tracing (PreviewSamples::path_pace).
  std::optional<stats::SamplePace> path_pace;
  /// Wall time since this image was begun, without pauses: the clock of the ledger's wall_s and of forecasts.
  double seconds = 0;
  double prepared_seconds =
      0;  ///< part of `seconds` until the solvers' data for the first sample was complete
  double mrays_per_second = 0;  ///< while rays are traced
  uint64_t rays = 0;
  ByComponent<ComponentStatus> components;
  std::vector<LayerStatus> layers;  ///< in the setting's order
  std::vector<StageStatus> stages;
  std::shared_ptr<const Accuracy> accuracy;  ///< null before the first picture
  /// One report for each solver with lookups; empty before the first picture.
  std::vector<std::shared_ptr<const solvers::Report>> reports;
  double device_mb = 0, host_mb = 0;
  std::string device, tracer;
  std::string activity;  ///< "" or the current activity: "loading kitchen.gltf: textures 40 %"
  float progress = -1;   ///< of the activity, 0..1, or -1
  scene::Camera camera;  ///< camera of this picture
  uint64_t dropped = 0;  ///< contributions refused because they were not finite
};

struct Options {
  std::string device;  ///< gpu::DeviceOptions::selector
  bool validation = false;
  std::filesystem::path shaders;        ///< empty: ShaderCompiler::default_root()
  scene::LoadOptions scenes = {};       ///< limits on scene files
  std::optional<double> patience = {};  ///< RendererOptions::patience
  /// True: makes no device and carries out nothing, so that commands can be read and explained.
  bool idle = false;
};

/// Patience [s] of a person at the window.
inline constexpr double k_patience = 30;

/// State of the session at one moment.
struct State {
  SceneId scene_id = 0;                        ///< 0 before the first scene
  std::shared_ptr<const scene::Scene> scene;   ///< with edits applied; null before the first
  std::shared_ptr<const scene::Scene> loaded;  ///< as it was read from its file
  plan::Settings settings;
};

/// Result of a file to be written: ready when it is written or has failed; get() then throws the error, which
/// has also been logged.
using Saved = std::shared_future<void>;

/// Answer to a question about the picture; get() throws Error on failure. Nothing is logged.
template <class T>
using Answer = std::shared_future<T>;

class Session {
 public:
  Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  /// Stops the work in progress. Pending saves are written first, with the present samples.
  virtual ~Session() = default;

  // Commands: queued, carried out in order at the next work-item boundary. Failures are logged as errors
  // (log::add_listener) and listed in Snapshot::refused, and change nothing.
  //
  // `scene`: the scene that a command is for, by State::scene_id. If another one has been loaded by its turn,
  // the command is skipped with a warning.
  /// `outside`, `choose`: as of Renderer::load().
  virtual void load(const std::filesystem::path& file, bool outside = false, bool choose = false) = 0;
  virtual void set(const std::string& key, const std::string& value, SceneId scene = k_any_scene) = 0;
  /// If several consecutive ones are in the queue, only the last is used; they share one number.
  virtual void set_camera(const scene::Camera& camera, SceneId scene = k_any_scene) = 0;
  virtual void set_size(uint32_t width, uint32_t height) = 0;
  /// Overlays::set_window_scale.
  virtual void set_window_scale(uint32_t scale) = 0;
  virtual void set_light(uint32_t index, const scene::Light& light, SceneId scene = k_any_scene) = 0;
  /// Replaces the scene's lights: adds, removes, renames (Renderer::set_light_list).
  virtual void set_light_list(const std::vector<scene::Light>& lights, SceneId scene = k_any_scene) = 0;
  virtual void set_environment(float scale, float rotation_degrees, SceneId scene = k_any_scene) = 0;
  /// Renderer::set_environment_file
  virtual void set_environment_file(const std::filesystem::path& file, std::optional<float> scale = {},
                                    std::optional<float> rotation_degrees = {},
                                    SceneId scene = k_any_scene) = 0;
  /// Renderer::set_environment_sky
  virtual void set_environment_sky(const scene::SkyModel& sky, float scale, SceneId scene = k_any_scene) = 0;
  /// Renderer::set_material, with progress in snapshots if it takes long; cancel() ends it too.
  virtual void set_material(uint32_t index, const scene::Material& material,
                            const std::optional<scene::TextureSources>& textures = {},
                            SceneId scene = k_any_scene) = 0;
  virtual void set_lights(const LightsEdit& edit, SceneId scene = k_any_scene) = 0;  ///< Renderer::set_lights
  /// Renderer::set_instances, with progress in snapshots if it takes long; cancel() ends it too.
  virtual void set_instances(const std::vector<ObjectEdit>& edits, SceneId scene = k_any_scene) = 0;
  virtual void set_paused(bool paused) = 0;
  virtual void restart() = 0;  ///< discards all samples and restarts
  /// Compiles again; on error the old kernels stay and the message is logged.
  virtual void reload_shaders() = 0;
  /// Compares the picture with this reference from now on (ImageProgress::set_reference).
  virtual void set_reference(const std::filesystem::path& file, SceneId scene = k_any_scene) = 0;
  virtual void clear_reference() = 0;
  /// Inspects solver data at that place of the picture (0..1 to the right and down): reported in
  /// Snapshot::reports and drawn over the picture from now on; nullopt: ends it.
  virtual void inspect(std::optional<vec2> at, SceneId scene = k_any_scene) = 0;
  /// PictureOutput::measure, as soon as there is an image.
  virtual Answer<film::Brightness> measure(std::optional<vec2> at, SceneId scene = k_any_scene) = 0;
  /// Measures what each effect of the scene costs and contributes (EffectMeasurement), while the picture
  /// waits. Errors are logged, as is the result, which snapshots contain from then on.
  virtual void measure_effects(SceneId scene = k_any_scene) = 0;
  virtual void stop_measuring_effects() = 0;
  /// The layers of the present picture as floats (PictureOutput::film_image_with_halves); Error if it has no
  /// sample.
  virtual Answer<film::FilmImage> layers(SceneId scene = k_any_scene) = 0;
  /// Records the first `samples` paths of the pixel at that place, and draws them over the picture from then
  /// on; as soon as there is a picture.
  virtual Answer<std::shared_ptr<const recording::Recording>> trace_paths(const vec2& at, uint32_t samples,
                                                                          SceneId scene = k_any_scene) = 0;
  /// Draws recorded paths over the picture; nullptr: none.
  virtual void show_paths(const ShownPaths& paths, SceneId scene = k_any_scene) = 0;
  /// Explains the noise of a part of the picture (0..1 to the right and down): PathStudy::explain_noise. As
  /// soon as there is a picture.
  virtual Answer<recording::NoiseReport> explain_noise(const vec2& lo, const vec2& hi,
                                                       SceneId scene = k_any_scene) = 0;
  /// PictureOutput::held_picture, as soon as there is a picture.
  virtual Answer<std::shared_ptr<const HeldPicture>> held_picture(SceneId scene = k_any_scene) = 0;
  /// Sends the layers of the picture to a viewer with tev's protocol from now on (TevLink), at this address
  /// (film::parse_tev_address); nullopt: ends it. A connection that fails ends it with a warning.
  virtual void send_to_tev(const std::optional<std::string>& address) = 0;
  /// Writes EXR or PNG as soon as every pixel has a sample, or at once if rendering rests without.
  /// `as_shown`: a PNG includes the preview's filter, like the snapshots.
  virtual Saved save(const std::filesystem::path& file, bool as_shown = false) = 0;
  /// Writes the sum with what its noise is known by, for film::compare_stochastic(), when save() would.
  virtual Saved save_reference(const std::filesystem::path& file) = 0;
  /// Saves a solver's data (SolverInfo::file) as soon as it is complete; cancelled if another scene is
  /// loaded.
  virtual Saved solver_save(const std::string& solver, const std::filesystem::path& file,
                            SceneId scene = k_any_scene) = 0;
  virtual void solver_load(const std::string& solver, const std::filesystem::path& file,
                           SceneId scene = k_any_scene) = 0;
  /// Runs one of SolverInfo::commands. Resumes paused rendering.
  virtual void solver_command(const std::string& solver, const std::string& command,
                              SceneId scene = k_any_scene) = 0;
  virtual void cancel() = 0;  ///< cancels all loads and set_instances() requested so far and not done

  /// Number of the newest command, from 1 on. A snapshot with that count includes its effect.
  virtual uint64_t commands() const = 0;
  /// Number of commands carried out so far; the picture after the last one may still be missing. The next
  /// one, if any, is in progress.
  virtual uint64_t commands_done() const = 0;

  /// The newest picture; null before the first. Cheap.
  virtual std::shared_ptr<const Snapshot> snapshot() const = 0;
  /// Replaced, never changed; at least as new as an earlier snapshot().
  virtual State state() const = 0;
  /// Parts of it.
  std::shared_ptr<const scene::Scene> scene() const { return state().scene; }
  plan::Settings settings() const { return state().settings; }
  /// Called on the session thread after each publication (for glfwPostEmptyEvent). Set it before the first
  /// command.
  virtual void on_publish(std::function<void()> call) = 0;
};

/// Makes the device and renders on a separate thread. If there is no device, an error is logged and every
/// command is refused.
std::unique_ptr<Session> start_session(const Options& options);

}  // namespace lucerna::session
