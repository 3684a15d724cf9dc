#pragma once
// Queue of a session's commands, carried out in order. No locks: the session guards it.
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <utility>

namespace lucerna::session {

/// Number of a loaded scene, from 1 on; it grows with every load.
using SceneId = uint64_t;
/// For a command that acts on any current scene.
inline constexpr SceneId k_any_scene = 0;

/// `Target`: on which it acts, the renderer.
template <class Target>
struct Command {
  std::function<void(Target&)> run;
  std::string subject;  ///< its target, for messages: "the camera"
  /// The scene it is for. If another one is loaded by its turn, it is skipped.
  SceneId scene = k_any_scene;
  bool saves = false;  ///< carried out even before the session ends
  /// Of several consecutive ones with the same value, not 0, only the last counts: steps of a drag.
  uint64_t replaces = 0;
  uint64_t number = 0;  ///< from 1 on, in order; set by push()
};

template <class Target>
class CommandQueue {
 public:
  /// Appends it, or replaces the last in the queue, with its number: see Command::replaces. They are for the
  /// same scene.
  void push(Command<Target> command) {
    if (command.replaces != 0 && !queue_.empty() && queue_.back().replaces == command.replaces &&
        queue_.back().scene == command.scene) {
      command.number = queue_.back().number;
      queue_.back() = std::move(command);
      return;
    }
    command.number = ++given_;
    queue_.push_back(std::move(command));
  }
  Command<Target> pop() {
    Command<Target> first = std::move(queue_.front());
    queue_.pop_front();
    return first;
  }
  bool empty() const { return queue_.empty(); }
  /// The number of the newest command; 0 before the first.
  uint64_t given() const { return given_; }

 private:
  std::deque<Command<Target>> queue_;
  uint64_t given_ = 0;
};

}  // namespace lucerna::session
