#pragma once
// Moves the camera by hand: flight, drags, the wheel; and the turntable. Walls stop it.
#include <set>

#include "cards_view.h"
#include "commands/camera_control.h"
#include "keys.h"

namespace lucerna::ui {

class CameraMoves {
 public:
  /// All must outlive it. `flight`: whose moves are one gesture of `actions`.
  CameraMoves(Actions& actions, commands::Navigation& camera, commands::Flight& flight, CardsView& cards)
      : actions_(actions), camera_(camera), flight_(flight), cards_(cards) {}

  bool flying() const { return flight_.moving(); }
  /// Flies or walks by the held keys, and turns the turntable; once per frame. `keys`: pressed in it. `held`:
  /// the held keys are for the picture. `stops`: the turntable ends. Requires a view.
  void follow(const Keys& keys, bool held, bool stops);
  /// True if W A S D Q E are held for the picture, by the latest follow().
  bool steered() const { return steered_; }
  /// True if the camera has moved by itself in this frame.
  bool moving() const { return moving_; }
  void begin_frame() { moving_ = false; }

  /// Moves to a view reached by a drag.
  void place(const commands::Viewpoint& view);
  /// Likewise, unless a surface is in the way; with Alt through it. By the wheel the camera stops before it,
  /// and turns in quick succession are one step.
  void go(const commands::Viewpoint& to, bool by_wheel);

  /// Turns the camera about what it looks at, once in that many seconds; 0: stops.
  void start_turntable(float seconds);
  float turntable() const { return turntable_; }

 private:
  /// Flies or walks by `metres` to the right, upwards and forwards.
  void advance(const vec3& metres);
  /// Reports that a wall is in the way, at most now and then.
  void say_blocked();

  Actions& actions_;
  commands::Navigation& camera_;
  commands::Flight& flight_;
  CardsView& cards_;
  std::set<int> chorded_;  ///< GLFW keys whose last press was with Ctrl: they do not fly
  float turntable_ = 0;    ///< seconds for a turn; 0: it does not turn
  bool steered_ = false, moving_ = false;
  double wheeled_ = -10, blocked_said_ = -60;
  uint64_t wheel_gesture_ = 0, turn_gesture_ = 0;
};

}  // namespace lucerna::ui
