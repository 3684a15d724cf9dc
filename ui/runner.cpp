#include "runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lucerna::ui {
namespace {

constexpr double k_longest_wait = 300;   // seconds
constexpr double k_between_moves = 1.5;  // seconds

}  // namespace

void Runner::fail(const Step& step, const std::string& why) {
  log::error("{}: {}: {}", step.where, step.verb, why);
  status = 1;
}

void Runner::advance(Ui& ui) {
  while (running() && !status) {
    const Step& current = steps_[next_];
    if (began_ < 0) began_ = ui.now, errors_before_ = ui.error_count, frames_left_ = 3;
    if (!step(ui, current)) {
      if (ui.now - began_ > k_longest_wait && !measure_)
        fail(current, fmt::format("gave up after {:.0f} s", k_longest_wait));
      return;
    }
    ++next_;
    began_ = -1;
    ui.wake(3);
  }
}

bool Runner::step(Ui& ui, const Step& s) {
  const auto number = [&](size_t i) { return static_cast<float>(s.number[i]); };
  const auto needs_view = [&] {
    if (!ui.view) fail(s, "there is no picture yet; wait_scene first");
    return ui.view.has_value();
  };
  if (s.verb == "wait") return ui.now - began_ >= s.number[0];
  if (s.verb == "wait_scene") {
    if (ui.view && !ui.loading()) return true;
    if (ui.error_count > errors_before_ || (!ui.errors.empty() && !ui.loading()))
      fail(s, "no scene was loaded");
    return false;
  }
  if (s.verb == "wait_samples") {
    if (!ui.snapshot || ui.camera_moved) return false;
    // A picture of an earlier camera does not count.
    if (ui.view && !same_view(ui.snapshot->camera, ui.view->camera)) return false;
    return ui.snapshot->finished ||
           (!ui.snapshot->coarse && ui.snapshot->samples >= static_cast<uint32_t>(s.number[0]));
  }
  if (s.verb == "load") return ui.open_scene(s.text[0]), true;
  if (s.verb == "set") {
    if (!plan::find_option(s.text[0]))
      return fail(s, fmt::format("there is no setting '{}'", s.text[0])), false;
    return ui.settings.set(s.text[0], s.text[1]), true;
  }
  if (s.verb == "camera") {
    if (!ui.scene) return fail(s, "no scene is loaded"), false;
    const auto& cameras = ui.scene->cameras;
    for (size_t i = 0; i < cameras.size(); ++i)
      if (cameras[i].name == s.text[0] || s.number[0] == static_cast<double>(i + 1))
        return ui.take_camera(static_cast<int>(i)), true;
    return fail(s, fmt::format("the scene has no camera '{}'", s.text[0])), false;
  }
  if (s.verb == "orbit") return needs_view() && (orbit(*ui.view, {number(0), number(1)}), ui.moved(), true);
  if (s.verb == "look") return needs_view() && (look(*ui.view, {number(0), number(1)}), ui.moved(), true);
  if (s.verb == "pan")
    return needs_view() && (pan(*ui.view, {number(0), number(1)}, ui.picture.height()), ui.moved(), true);
  if (s.verb == "dolly") return needs_view() && (dolly(*ui.view, number(0)), ui.moved(), true);
  if (s.verb == "fly")
    return needs_view() && (fly(*ui.view, {number(0), number(1), number(2)}), ui.moved(), true);
  if (s.verb == "frame") return needs_view() && (ui.frame_selection(), true);
  if (s.verb == "select") {
    if (!ui.scene) return fail(s, "no scene is loaded"), false;
    const Kind kind = s.text[0] == "material"   ? Kind::material
                      : s.text[0] == "instance" ? Kind::instance
                      : s.text[0] == "light"    ? Kind::light
                                                : Kind::none;
    const size_t count = kind == Kind::material   ? ui.scene->materials.size()
                         : kind == Kind::instance ? ui.scene->instances.size()
                         : kind == Kind::light    ? ui.scene->lights.size()
                                                  : 0;
    if (s.number[1] < 1 || s.number[1] > static_cast<double>(count))
      return fail(s, fmt::format("there is no {} {}", s.text[0], s.text[1])), false;
    return ui.selection = {kind, static_cast<uint32_t>(s.number[1]) - 1}, true;
  }
  if (s.verb == "solo") {
    if (s.number[0] < 1 || s.number[0] > session::k_components)
      return fail(s, "expected a component from 1 to 4"), false;
    return ui.toggle_solo(static_cast<int>(s.number[0]) - 1), true;
  }
  if (s.verb == "size") {
    if (frames_left_ == 3) size = std::pair{static_cast<int>(s.number[0]), static_cast<int>(s.number[1])};
    ui.wake();
    return --frames_left_ < 0;
  }
  if (s.verb == "tab") return ui.layout.panels = !ui.layout.panels, true;
  if (s.verb == "open_dialog") return ui.start_dialog(Dialog::Purpose::open), true;
  if (s.verb == "save_dialog") return ui.start_dialog(Dialog::Purpose::save), true;
  if (s.verb == "dismiss") {
    if (ui.dialog.purpose != Dialog::Purpose::none)
      ui.dialog = {};
    else if (!ui.errors.empty())
      ui.errors.pop_back();
    return true;
  }
  if (s.verb == "pause") return ui.session.set_paused(true), true;
  if (s.verb == "resume") return ui.session.set_paused(false), true;
  if (s.verb == "restart") return ui.session.restart(), true;
  if (s.verb == "reload") return ui.session.reload_shaders(), true;
  if (s.verb == "cancel") return ui.session.cancel(), true;
  if (s.verb == "save") return ui.save_picture(s.text[0]), true;
  if (s.verb == "screenshot") {
    // The panels settle for a frame or two after what came before.
    if (frames_left_-- > 0) return ui.wake(2), false;
    if (frames_left_ == -1) return screenshot = s.text[0], ui.wake(1), false;
    return !screenshot;
  }
  if (s.verb == "measure") return measure(ui, s);
  if (s.verb == "quit") return status = s.number.empty() ? 0 : static_cast<int>(s.number[0]), true;
  return fail(s, "unknown step"), false;
}

bool Runner::measure(Ui& ui, const Step& s) {
  if (!measure_) {
    if (!ui.view) return fail(s, "there is no picture yet; wait_scene first"), false;
    measure_.emplace();
    measure_->start = ui.now, measure_->end = ui.now + s.number[0],
    measure_->next_move = ui.now + 0.5 * k_between_moves;
  }
  Measure& m = *measure_;
  const bool answered = m.moved_at < 0;
  if (ui.now >= m.next_move && answered && ui.now < m.end) {
    orbit(*ui.view, {m.moves % 2 ? -0.1f : 0.1f, 0});
    ui.moved();
    m.target = ui.view->camera;
    m.moved_at = ui.now;
    m.next_move = ui.now + k_between_moves;
    ++m.moves;
  }
  // The answer to the last move is waited for, but not for ever.
  if (ui.now < m.end || (!answered && ui.now < m.end + 10)) return false;
  std::fputs(
      fmt::format("{{\"measure\": {{\"seconds\": {:.2f}, \"frames\": {}, \"frame_ms_p50\": {:.2f}, "
                  "\"frame_ms_p95\": {:.2f}, \"frame_ms_max\": {:.2f}, "
                  "\"coarse_ms_median\": {:.1f}, \"coarse_ms_max\": {:.1f}, \"moves\": {}, \"answered\": {}, "
                  "\"picture\": [{}, {}]}}}}\n",
                  ui.now - m.start, m.frames.size(), percentile(m.frames, 0.5), percentile(m.frames, 0.95),
                  percentile(m.frames, 1), percentile(m.coarse, 0.5), percentile(m.coarse, 1), m.moves,
                  m.coarse.size(), ui.texture_width, ui.texture_height)
          .c_str(),
      stdout);
  std::fflush(stdout);
  measure_.reset();
  return true;
}

void Runner::presented(Ui& ui, double interval_ms) {
  if (!measure_) return;
  Measure& m = *measure_;
  m.frames.push_back(interval_ms);
  // The first picture on the screen that was made with the new camera.
  if (m.moved_at >= 0 && ui.snapshot && same_view(ui.snapshot->camera, m.target)) {
    m.coarse.push_back(1e3 * (ui.time() - m.moved_at));
    m.moved_at = -1;
  }
}

}  // namespace lucerna::ui
