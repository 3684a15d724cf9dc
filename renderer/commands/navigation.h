#pragma once
// Camera, obstacles and selection in the shown scene.
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands/camera_control.h"
#include "commands/interior.h"
#include "session/pick.h"
#include "session/session.h"

namespace lucerna::commands {

enum class Kind { none, material, instance, light };
struct Selection {
  Kind kind = Kind::none;
  uint32_t index = 0;
  bool operator==(const Selection&) const = default;
};
const char* kind_name(Kind kind);  ///< "object" for an instance

/// Bounds of what is selected; `core` if nothing is. `lights`: of the scene, with edits on their way.
Box selection_bounds(const scene::Scene* scene, const std::vector<scene::Light>& lights,
                     const Selection& selection, const Box& core);
std::string selection_name(const scene::Scene* scene, const std::vector<scene::Light>& lights,
                           const Selection& selection);

class Navigation {
 public:
  explicit Navigation(session::Session& session) : session_(session) {}
  Navigation(const Navigation&) = delete;
  Navigation& operator=(const Navigation&) = delete;

  std::optional<Viewpoint> view;    ///< none before the first picture of a scene
  uint64_t view_scene = 0;          ///< scene_id that `view` belongs to
  Box core;                         ///< of the scene, without distant outliers (scene::core_bounds())
  float speed = 1.5f;               ///< of flight, m/s
  int scene_camera = -1;            ///< last selected scene camera, not moved since; -1: none
  bool walking = false;             ///< keys move along the floor
  float eye_height = k_eye_height;  ///< above it, metres
  Selection selection;
  /// Another list of lights: a selected light stays selected, or nothing is if it is gone.
  void follow_lights(const std::vector<scene::Light>& before, const std::vector<scene::Light>& after);

  float aspect = 1.5f;  ///< width / height of the picture
  /// Sets the size of the picture [pixels]; aspect follows.
  void set_size(uint32_t width, uint32_t height);
  /// True if the session does not have the requested size yet.
  bool resizing = false;

  /// Starts in another scene with the view of its picture.
  void begin_scene(std::shared_ptr<const scene::Scene> scene, const session::Snapshot& picture);
  /// Takes the camera and the size from a picture of the shown scene that includes all commands, if the
  /// session has refused or chosen one. True if it has refused the latest size.
  bool follow(const session::Snapshot& picture);

  /// The only way to move the camera: sets the view and sends it to the session. Throws Error like
  /// scene::check_range; then nothing has changed.
  void take_view(const Viewpoint& view, int camera = -1);
  /// Number of cameras sent to the session.
  uint64_t moves() const { return moves_; }
  /// Throws Error before the first picture.
  void needs_view() const;
  /// "camera.place ..." for exactly this view.
  static std::string place_line(const Viewpoint& view);

  /// Ray queries against the shown scene; null until they are ready, shortly after a new scene. `wait`: waits
  /// for them.
  const session::Probe* probe(bool wait = false);
  /// Objects were moved: further queries are against this scene, once they are ready. Call regularly.
  void follow_objects(std::shared_ptr<const scene::Scene> scene);
  /// Obstacles by these queries; none until they are ready.
  Look look();
  /// Ignores selected objects.
  Look look_past_selection();

  /// Bookmarks of all scenes: by the scene's file, then by name, as lines "camera.place ...".
  using Bookmarks = std::map<std::string, std::string>;
  std::map<std::string, Bookmarks> bookmarks;
  /// Bookmarks of a scene; none for null.
  const Bookmarks& bookmarks_of(const scene::Scene* scene) const;
  Bookmarks& bookmarks_of(const scene::Scene& scene);

 private:
  /// At surfaces with `wanted`; empty: all.
  Look look_at(std::function<bool(const session::Picked&)> wanted);

  session::Session& session_;
  uint64_t moves_ = 0;
  std::pair<uint32_t, uint32_t> size_{0, 0};  ///< latest requested size
  std::future<std::shared_ptr<const session::Probe>> probing_;
  std::vector<std::future<std::shared_ptr<const session::Probe>>> retired_;  ///< of former scenes
  std::shared_ptr<const session::Probe> probe_;
  std::shared_ptr<const scene::Scene> probed_, to_probe_;  ///< scene of the latest queries; wanted next
  void probe_next();
};

}  // namespace lucerna::commands
