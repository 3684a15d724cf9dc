#include "camera_moves.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>

namespace lucerna::ui {

using commands::Viewpoint;

void CameraMoves::follow(const Keys& keys, bool held, bool stops) {
  const ImGuiIO& io = ImGui::GetIO();
  // A key pressed with Ctrl is a command until it is released, even if Ctrl is released before it.
  for (const auto& [key, mods] : keys.list)
    if (mods & (GLFW_MOD_CONTROL | GLFW_MOD_SUPER))
      chorded_.insert(key);
    else
      chorded_.erase(key);
  vec3 wish(0);
  if (held && !io.KeyCtrl) {
    const auto down = [&](int key) { return io.KeysDown[key] && !chorded_.contains(key) ? 1.0f : 0.0f; };
    wish = {down(GLFW_KEY_D) - down(GLFW_KEY_A), down(GLFW_KEY_E) - down(GLFW_KEY_Q),
            down(GLFW_KEY_W) - down(GLFW_KEY_S)};
  }
  steered_ = wish != vec3(0);
  if (steered_ || flying()) {
    const float seconds = std::min(io.DeltaTime, 0.1f);
    const vec3 metres =
        commands::advance(flight_, wish, camera_.speed * (io.KeyShift ? 4.0f : 1.0f), seconds);
    if (steered_) actions_.follow_gesture();  // the first move belongs to the flight already
    advance(metres);
    moving_ = true;
  }
  if (stops || steered_) turntable_ = 0;
  if (turntable_ > 0) {
    Viewpoint view = *camera_.view;
    commands::orbit(view, {2 * k_pi * std::min(io.DeltaTime, 0.1f) / turntable_, 0});
    actions_.act_in(turn_gesture_, commands::Navigation::place_line(view));
    moving_ = true;
  }
}

void CameraMoves::place(const Viewpoint& to) { actions_.act_line(commands::Navigation::place_line(to)); }

void CameraMoves::go(const Viewpoint& to, bool by_wheel) {
  Viewpoint view = to;
  const vec3 from = commands::eye_of(camera_.view->camera), step = commands::eye_of(to.camera) - from;
  if (!ImGui::GetIO().KeyAlt && !to.camera.orthographic && glm::length(step) > 0) {
    bool blocked = false;
    // Closer than a walker, for close-ups of small objects.
    const float clear = 0.25f * commands::clearance(to.extent);
    const vec3 end = commands::step_straight(camera_.look(), from, step, clear, &blocked);
    if (blocked) {
      say_blocked();
      if (!by_wheel) return;
      view.camera.to_world[3] = vec4(end, 1);
    }
  }
  if (!by_wheel) return place(view);
  if (actions_.now() - wheeled_ > 0.8) wheel_gesture_ = actions_.new_gesture();
  wheeled_ = actions_.now();
  actions_.act_in(wheel_gesture_, commands::Navigation::place_line(view));
}

void CameraMoves::advance(const vec3& metres) {
  Viewpoint view = *camera_.view;
  const bool through = ImGui::GetIO().KeyAlt;
  bool blocked = false;
  if (camera_.walking && !view.camera.orthographic) {
    if (metres.y != 0)
      actions_.act("camera.eye_height", std::clamp(camera_.eye_height + metres.y, 0.05f, 100.0f));
    if (metres.x == 0 && metres.z == 0) return;
    view = *camera_.view;
    blocked = commands::walk(view, camera_.look(), {metres.x, metres.z}, camera_.eye_height, through);
  } else if (through || view.camera.orthographic) {
    commands::fly(view, metres);
  } else {
    const vec3 step = metres.x * commands::right_of(view.camera) + metres.y * commands::up_of(view.camera) +
                      metres.z * commands::forward_of(view.camera);
    view.camera.to_world[3] = vec4(commands::step_among(camera_.look(), commands::eye_of(view.camera), step,
                                                        commands::clearance(view.extent), &blocked),
                                   1);
  }
  if (blocked) say_blocked();
  place(view);
}

void CameraMoves::start_turntable(float seconds) {
  turntable_ = seconds;
  turn_gesture_ = actions_.new_gesture();
  actions_.wake(3);
}

void CameraMoves::say_blocked() {
  if (actions_.now() - blocked_said_ < 20) return;
  blocked_said_ = actions_.now();
  cards_.notice("A surface is in the way. Hold Alt to pass through it.", 4);
}

}  // namespace lucerna::ui
