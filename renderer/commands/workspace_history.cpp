// Execution of lines: what they send, how they are undone, and their script.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "commands/session_saves.h"
#include "commands/workspace.h"
#include "scene/range.h"

namespace lucerna::commands {
namespace {

constexpr size_t k_steps = 500;  // maximum number of undo steps
const std::string k_script_head =
    "# What was done in a session of Lucerna; lucerna --script FILE does it again.\n";

}  // namespace

Line Workspace::run(const std::string& text, uint64_t gesture, const std::string& where) {
  const Line line = registry.parse(text, where);
  if (!line.command) return line;
  const uint64_t before = session.commands();
  carry_out(line, gesture, where);
  note_sent(before, text, line.command->moves);
  return line;
}

void Workspace::note_sent(uint64_t before, const std::string& line, bool moves) {
  constexpr size_t k_kept = 200;
  const uint64_t now_given = session.commands();
  if (now_given > before)
    given_by_.push_back({before + 1, now_given, line});
  else if (moves && !given_by_.empty() && given_by_.back().last == now_given)
    given_by_.back().line = line;  // the camera has taken the number of the one before
  if (given_by_.size() > k_kept) given_by_.pop_front();
}

std::string Workspace::line_of(uint64_t command) const {
  for (const GivenBy& given : given_by_)
    if (given.first <= command && command <= given.last) return given.line;
  return "";
}

void Workspace::carry_out(const Line& line, uint64_t gesture, const std::string& where) {
  const auto located = [&](auto&& act) {
    try {
      act();
    } catch (const std::exception& error) {
      working_.reset();
      const std::string what = error.what();
      const std::string head = line.command->name + ": ";
      throw Error(where, what.starts_with(head) ? what : head + what);
    }
  };
  const uint64_t first = session.commands(), moves = moves_;
  if (!line.command->undoable) {
    const std::optional<Viewpoint> view_before = view;
    const int camera_before = scene_camera;
    located([&] { line.command->run(line.arguments); });
    const Sent sent = sent_since(first, moves);
    if (line.command->moves && view_before) note_move(line, gesture, *view_before, camera_before, sent);
    record(line, gesture, sent);
    return;
  }
  const std::string target = registry.target(line);
  const bool merges = gesture != 0 && !undo_.empty() && undo_.back().gesture == gesture &&
                      undo_.back().target == target && !undo_.back().move;
  const Document now_seen = document();
  // A step of a drag starts from where the drag began, so that the last step alone gives the same.
  working_ = merges ? undo_.back().before : now_seen;
  touched_.clear();
  located([&] { line.command->run(line.arguments); });
  const Document after = std::move(*working_);
  working_.reset();
  send(now_seen, after);
  const bool requested = loading() && !touched_.empty();
  const Sent sent = sent_since(first, moves);
  if (merges)
    undo_.back().after = after, undo_.back().line = registry.print(line),
    undo_.back().sent.last = std::max(undo_.back().sent.last, sent.last);
  else if (after != now_seen)
    undo_.push_back({registry.print(line), target, gesture, now_seen, after, sent});
  else if (!requested)
    return;
  if (undo_.size() > k_steps) undo_.erase(undo_.begin());
  redo_.clear();
  record(line, gesture, sent);
}

Workspace::Sent Workspace::sent_since(uint64_t before, uint64_t moves) const {
  Sent sent{before + 1, session.commands()};
  // A camera may have taken the number of the one before.
  if (sent.last < sent.first && moves_ != moves) sent.first = sent.last;
  return sent;
}

void Workspace::note_move(const Line& line, uint64_t gesture, const Viewpoint& before, int camera_before,
                          const Sent& sent) {
  if (!view || (same_view(before.camera, view->camera) && before.distance == view->distance &&
                camera_before == scene_camera))
    return;
  const std::string target = registry.target(line);
  if (gesture != 0 && !undo_.empty() && undo_.back().gesture == gesture && undo_.back().move) {
    Step& step = undo_.back();
    step.move->after = *view, step.move->camera_after = scene_camera;
    step.line = registry.print(line), step.target = target;
    step.sent.last = std::max(step.sent.last, sent.last);
  } else {
    undo_.push_back({registry.print(line),
                     target,
                     gesture,
                     {},
                     {},
                     sent,
                     Step::Move{before, *view, camera_before, scene_camera}});
    if (undo_.size() > k_steps) undo_.erase(undo_.begin());
  }
  redo_.clear();
}

void Workspace::take_view(const Viewpoint& to, int camera) {
  scene::Camera checked = to.camera;
  checked.name.clear();  // a view that has been moved is no camera of the scene
  scene::check_range(checked);
  if (!std::isfinite(to.distance)) throw Error("camera", "what it looks at is not a finite distance away");
  const bool same = view && same_view(view->camera, to.camera);
  view = to;
  scene_camera = camera;
  if (same) return;
  session.set_camera(to.camera, view_scene);
  ++moves_;
}

void Workspace::undo() {
  if (undo_.empty()) throw Error("", "there is nothing to undo");
  Step step = std::move(undo_.back());
  undo_.pop_back();
  touched_.clear();
  if (step.move)
    take_view(step.move->before, step.move->camera_before);
  else
    send(document(), step.before);
  step.gesture = 0, step.sent = {};
  redo_.push_back(std::move(step));
}

void Workspace::redo() {
  if (redo_.empty()) throw Error("", "there is nothing to do again");
  const uint64_t first = session.commands(), moves = moves_;
  Step step = std::move(redo_.back());
  redo_.pop_back();
  touched_.clear();
  if (step.move)
    take_view(step.move->after, step.move->camera_after);
  else
    send(document(), step.after);
  step.sent = sent_since(first, moves);
  undo_.push_back(std::move(step));
}

void Workspace::record(const Line& line, uint64_t gesture, const Sent& sent) {
  if (!line.command->recorded) return;
  Recorded entry{line.command->name, registry.target(line), gesture, {}, sent};
  const bool writes = std::any_of(line.command->parameters.begin(), line.command->parameters.end(),
                                  [](const Parameter& p) { return p.writes; });
  if (writes) entry.saved = saved_;
  // Files are named so that the script works from any folder.
  for (const Parameter& p : line.command->parameters) {
    if (!line.arguments.has(p.name)) continue;
    std::string value = line.arguments.text(p.name);
    if (p.type == Type::file) value = absolute_path(value).string();
    entry.line += " " + (p.optional ? p.name + "=" : "") + quote(value);
  }
  if (gesture != 0 && !recorded_.empty() && recorded_.back().gesture == gesture &&
      recorded_.back().target == entry.target)
    recorded_.back() = std::move(entry);
  else
    recorded_.push_back(std::move(entry));
}

std::vector<std::string> Workspace::script() const {
  std::vector<std::string> lines;
  for (const Recorded& entry : recorded_)
    if (!failed(entry.saved)) lines.push_back(entry.line);
  return lines;
}

void Workspace::save_script(const std::string& file) const {
  if (is_plain_file(file) && !read_file(file).starts_with(k_script_head))
    throw Error(file, "exists and is no saved session: choose another name");
  std::string text = k_script_head;
  for (const std::string& line : script()) text += line + '\n';
  write_file(file, text);
}

void Workspace::record_wait() {
  if (!up_to_date() || snapshot->samples == 0) return;
  if (!recorded_.empty() && recorded_.back().line.starts_with("wait_samples ")) recorded_.pop_back();
  Recorded wait{line("wait_samples", snapshot->samples, named("limit", 86400)), "wait_samples"};
  // A picture that rests has the samples that it had when it was stopped: the wait before that is for them.
  if (snapshot->paused) {
    const auto pause = std::find_if(recorded_.rbegin(), recorded_.rend(),
                                    [](const Recorded& entry) { return entry.line == "render.pause"; });
    if (pause != recorded_.rend() && std::next(pause) != recorded_.rend() &&
        std::next(pause)->target == "wait_samples")
      *std::next(pause) = wait;
  }
  // Saving the same picture twice waits only once.
  const auto before = std::find_if(recorded_.rbegin(), recorded_.rend(), [](const Recorded& entry) {
    return !entry.line.starts_with("image.save ");
  });
  if (before == recorded_.rend() || before->line != wait.line) recorded_.push_back(std::move(wait));
}

bool Workspace::saved() const {
  if (saved_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  if (failed(saved_)) throw Error("", "nothing was written");
  return true;
}

}  // namespace lucerna::commands
