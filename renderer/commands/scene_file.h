#pragma once
// Saving the open scene, and whether there is something to save.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "commands/history.h"
#include "commands/navigation.h"
#include "commands/open_scene.h"
#include "scene/io/save.h"

namespace lucerna::commands {

/// True if a saved scene keeps the setting's value once it was changed: exposure and tone curve, light groups
/// and their mix, effects. Others are kept if the scene's files set them.
bool is_kept(const std::string& key);
/// True if both documents give the same saved scene.
bool same_scene(const Document& a, const Document& b);

class SceneFile {
 public:
  SceneFile(OpenScene& open, const History& history) : open_(open), history_(history) {}
  SceneFile(const SceneFile&) = delete;
  SceneFile& operator=(const SceneFile&) = delete;

  /// True if edits would be lost without saving.
  bool unsaved() const { return open_.scene && history_.position() != saved_at_; }
  /// The file to which it was saved last, else the scene's own; "" without a scene.
  std::string file() const;

  /// Starts writing the scene, with these cameras added (SaveRequest). The result logs what it has written;
  /// failures are logged, too. Throws Error without a scene.
  session::Saved save(const std::string& file, bool replace, std::vector<scene::Camera> cameras);
  /// Call regularly: notes what has been written.
  void follow();
  /// Call for another scene: it has no unsaved edits.
  void begin_scene();
  /// The present state needs no saving: the program has made the last change by itself.
  void note_clean() { saved_at_ = history_.position(); }

 private:
  struct Writing {
    std::string file;
    uint64_t position;
    session::Saved saved;
    std::shared_ptr<scene::SavedScene> result;
  };
  std::vector<std::pair<std::string, std::string>> kept_settings() const;

  OpenScene& open_;
  const History& history_;
  uint64_t saved_at_ = 0;
  std::string file_;
  std::vector<Writing> writing_;
  std::map<std::string, std::shared_ptr<const std::string>> written_;  ///< JSON by absolute path
};

}  // namespace lucerna::commands
