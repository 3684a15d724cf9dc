#pragma once
// The one object that runs. It owns the device, the scene and the renderer on a thread of its own; the
// outside talks to it through commands and reads snapshots. Every method here may be called from any thread
// and returns at once unless it says otherwise.
#include <array>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "film/exposure.h"
#include "film/shown_error.h"
#include "plan/settings.h"
#include "scene/io/load.h"
#include "scene/scene.h"
#include "session/accuracy.h"
#include "session/command_queue.h"
#include "session/lights_edit.h"
#include "solvers/report.h"

namespace lucerna::session {

inline constexpr int k_components = 4;  ///< primary, secondary, tertiary, caustic
extern const std::array<const char*, k_components> k_component_names;

/// Relative errors of tiles below which a picture is good to work with.
inline constexpr film::ShownError k_usable_error{.median = 0.15, .worst_tenth = 0.3};
inline bool usable(const film::ShownError& e) {
  return e.median < k_usable_error.median && e.worst_tenth < k_usable_error.worst_tenth;
}

struct ComponentStatus {
  std::string solver = "path";  ///< "path" or "off"
  double mean_luminance = 0;    ///< of its layer
  double share = 0;             ///< of the sum's mean luminance, 0..1
  double ms_per_sample = 0;     ///< device time its rays cost, per sample a pixel; without what was prepared
};

struct StageStatus {
  std::string name;
  double ms = 0;
  bool host = false;
};  ///< since the image started

/// The scale of a layer that does not show light.
struct Legend {
  /// shared::k_layer_albedo, _normal, _depth, or a heat map: _samples, _error (relative), _cost (ms per
  /// pixel); 0: light.
  uint32_t layer = 0;
  uint32_t ramp = 0;  ///< of a heat map: shared::k_ramp_*
  bool logarithmic = false;
  float lo = 0, hi = 1;  ///< values at its ends; of depth [m]
};

/// What the window draws: replaced as a whole, never changed after publishing.
struct Snapshot {
  uint64_t id = 0;        ///< grows with every published snapshot
  SceneId scene_id = 0;   ///< of the scene that the picture and the camera below are of
  uint64_t commands = 0;  ///< carried out, or refused, before it was made (Session::commands)
  /// Numbers of the commands that were refused (with an error logged) or left out (another scene was loaded
  /// before their turn, or the load was given up), in order; null: none. What was there before them stays.
  std::shared_ptr<const std::vector<uint64_t>> refused;
  uint32_t width = 0, height = 0;  ///< of the picture
  uint32_t scale = 1;              ///< of rgba: its pixels per pixel of the picture, along a side
  std::vector<uint8_t> rgba;       ///< width * height * scale^2 * 4, sRGB, top row first; tone-mapped
  Legend legend;                   ///< of the picture's layer
  bool tiles = false;              ///< the picture has its tiles drawn over it
  uint32_t samples = 0;            ///< complete samples a pixel
  double mean_samples = 0;         ///< a pixel, of those there are
  uint32_t max_samples = 0;        ///< where it stops
  bool coarse = false;             ///< some of the picture still is the coarse first image
  /// Of what is shown, by luminance, 0..1: light from before the last edit; filtered light of the present.
  double stale = 0, filtered = 0;
  /// Of what is shown, where that is a preview or filtered.
  std::optional<film::ShownError> shown_error;
  /// Why the light of groups of lights is not kept apart, so that a mix of them lights the picture anew; ""
  /// where it is.
  std::string lights_together;
  bool paused = false, finished = false;
  /// "" or what is made before the first sample (solvers::Report::preparing).
  std::string preparing;
  double preparing_done = -1;            ///< of that, 0..1; -1: it cannot be told
  std::optional<double> preparing_left;  ///< seconds of rendering, about (stats::WorkPace)
  /// What path tracing alone would take (Renderer::path_pace).
  std::optional<stats::SamplePace> path_pace;
  /// Wall time since this image was begun, pauses left out: the clock of the ledger's wall_s and of
  /// forecasts.
  double seconds = 0;
  double mrays_per_second = 0;  ///< while rays are traced
  uint64_t rays = 0;
  std::array<ComponentStatus, k_components> components;
  std::vector<StageStatus> stages;
  std::shared_ptr<const Accuracy> accuracy;  ///< null before the first picture
  /// One of each solver whose light is looked up; none before the first picture.
  std::vector<std::shared_ptr<const solvers::Report>> reports;
  double device_mb = 0, host_mb = 0;
  std::string device, tracer;
  std::string activity;  ///< "" or what is going on: "loading kitchen.gltf: textures 40 %"
  float progress = -1;   ///< of the activity, 0..1, or -1
  scene::Camera camera;  ///< that this picture was made with
  uint64_t dropped = 0;  ///< contributions refused because they were not finite
};

struct Options {
  std::string device;  ///< gpu::DeviceOptions::selector
  bool validation = false;
  std::filesystem::path shaders;   ///< empty: ShaderCompiler::default_root()
  scene::LoadOptions scenes = {};  ///< what scenes may read and take
};

/// What the session holds, at one moment.
struct State {
  SceneId scene_id = 0;                       ///< 0 before the first scene
  std::shared_ptr<const scene::Scene> scene;  ///< as loaded, with edits applied; null before the first
  plan::Settings settings;
};

/// Of a file that is to be written: ready when it is, or will never be; get() then throws what kept it from
/// being (which has been logged as well).
using Saved = std::shared_future<void>;

class Session {
 public:
  explicit Session(const Options& options);
  /// Stops the work in progress and joins. Pictures that were to be saved are written first, as they are.
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Commands: queued, carried out in order at the next work-item boundary. Failures are logged as errors
  // (log::add_listener) and listed in Snapshot::refused, and what was there before stays.
  //
  // `scene`: the scene that a command means, by State::scene_id. If another one has been loaded by its turn
  // the command is left out, with a warning.
  void load(const std::filesystem::path& file);
  void set(const std::string& key, const std::string& value, SceneId scene = k_any_scene);
  /// Of several in a row that are not carried out yet only the last one counts; they have one number.
  void set_camera(const scene::Camera& camera, SceneId scene = k_any_scene);
  void set_size(uint32_t width, uint32_t height);
  /// Renderer::set_window_scale.
  void set_window_scale(uint32_t scale);
  void set_light(uint32_t index, const scene::Light& light, SceneId scene = k_any_scene);
  void set_environment(float scale, float rotation_degrees, SceneId scene = k_any_scene);
  /// Renderer::set_environment_file
  void set_environment_file(const std::filesystem::path& file, std::optional<float> scale = {},
                            std::optional<float> rotation_degrees = {}, SceneId scene = k_any_scene);
  /// Renderer::set_material
  void set_material(uint32_t index, const scene::Material& material, SceneId scene = k_any_scene);
  void set_lights(const LightsEdit& edit, SceneId scene = k_any_scene);  ///< Renderer::set_lights
  void set_paused(bool paused);
  void restart();         ///< throws the samples away and starts anew
  void reload_shaders();  ///< compiles again; on error the old kernels stay and the message is logged
  /// Holds the picture against this one from now on (Renderer::set_reference).
  void set_reference(const std::filesystem::path& file, SceneId scene = k_any_scene);
  void clear_reference();
  /// What solvers hold at that point of the picture (0..1 to the right and down): told by Snapshot::reports
  /// and drawn over the picture from now on; nothing: no longer.
  void inspect(std::optional<vec2> at, SceneId scene = k_any_scene);
  /// Renderer::measure, as soon as there is an image; get() throws what kept it from being. Nothing is
  /// logged.
  std::shared_future<film::Brightness> measure(std::optional<vec2> at, SceneId scene = k_any_scene);
  /// EXR or PNG of what there is, as soon as every pixel has a sample; where rendering rests without, at
  /// once. `as_shown`: a PNG has the filter of the first samples, as the snapshots have it.
  Saved save(const std::filesystem::path& file, bool as_shown = false);
  /// Keeps a solver's work (SolverInfo::file) as soon as it is complete; given up when another scene is
  /// loaded.
  Saved solver_save(const std::string& solver, const std::filesystem::path& file,
                    SceneId scene = k_any_scene);
  void solver_load(const std::string& solver, const std::filesystem::path& file, SceneId scene = k_any_scene);
  /// One of SolverInfo::commands. Rendering that was paused goes on, too.
  void solver_command(const std::string& solver, const std::string& command, SceneId scene = k_any_scene);
  void cancel();  ///< gives up all loads that were asked for so far and are not done

  /// The number of the newest command, from 1 on. A snapshot that counts it shows what it has done.
  uint64_t commands() const;
  /// Those carried out so far; the picture that shows the last of them may be still to come. The one after
  /// them, if given, is in progress.
  uint64_t commands_done() const;

  /// The newest picture; null before the first. Cheap.
  std::shared_ptr<const Snapshot> snapshot() const;
  /// Replaced, never changed; as new as snapshot() was before, or newer.
  State state() const;
  /// Parts of it.
  std::shared_ptr<const scene::Scene> scene() const { return state().scene; }
  plan::Settings settings() const { return state().settings; }
  /// Called on the session thread after each publication (for glfwPostEmptyEvent). Set before the first
  /// command.
  void on_publish(std::function<void()> call);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::session
