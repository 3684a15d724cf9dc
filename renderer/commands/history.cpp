#include "commands/history.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "commands/refusal.h"
#include "commands/scene_file.h"
#include "commands/session_saves.h"

namespace lucerna::commands {
namespace {

constexpr size_t k_steps = 500;  // maximum number of undo steps
const std::string k_script_head =
    "# What was done in a session of Lucerna; lucerna --script FILE does it again.\n";

}  // namespace

void History::note_sent(uint64_t before, const std::string& line, bool moves) {
  constexpr size_t k_kept = 200;
  const uint64_t now_given = open_.session.commands();
  if (now_given > before)
    given_by_.push_back({before + 1, now_given, line});
  else if (moves && !given_by_.empty() && given_by_.back().last == now_given)
    given_by_.back().line = line;  // the camera has taken the number of the one before
  if (given_by_.size() > k_kept) given_by_.pop_front();
}

std::string History::line_of(uint64_t command) const {
  for (const GivenBy& given : given_by_)
    if (given.first <= command && command <= given.last) return given.line;
  return "";
}

History::Sent History::sent_since(const Mark& mark) const {
  Sent sent{mark.commands + 1, open_.session.commands()};
  // A camera may have taken the number of the one before.
  if (sent.last < sent.first && camera_.moves() != mark.moves) sent.first = sent.last;
  return sent;
}

const Document* History::merged(uint64_t gesture, const std::string& target) const {
  const bool merges = gesture != 0 && !undo_.empty() && undo_.back().gesture == gesture &&
                      undo_.back().target == target && !undo_.back().move;
  return merges ? &undo_.back().before : nullptr;
}

void History::add_edit(const Executed& executed, const Document& before, const Document& after, bool merges) {
  if (merges) {
    Step& step = undo_.back();
    step.after = after, step.line = executed.line;
    step.sent.last = std::max(step.sent.last, executed.sent.last);
  } else {
    undo_.push_back({executed.line, executed.target, executed.gesture, executed.sent, before, after});
  }
  undo_.back().position = same_scene(undo_.back().before, after) ? 0 : ++positions_;
  forget_oldest();
}

void History::join_latest(uint64_t position) {
  if (undo_.size() < 2) return;
  const Step &last = undo_.back(), &whole = undo_[undo_.size() - 2];
  if (last.move || whole.move || position == 0 || whole.position != position) return;
  Step joined = whole;
  joined.after = last.after;
  joined.sent.last = std::max(whole.sent.last, last.sent.last);
  if (last.position != 0) joined.position = last.position;
  undo_.pop_back();
  undo_.back() = std::move(joined);
}

void History::forget_oldest() {
  if (undo_.size() <= k_steps) return;
  if (undo_.front().position != 0) base_ = undo_.front().position;
  undo_.erase(undo_.begin());
}

uint64_t History::position() const {
  for (auto step = undo_.rbegin(); step != undo_.rend(); ++step)
    if (step->position != 0) return step->position;
  return base_;
}

void History::add_move(const Executed& executed, const Viewpoint& before, int camera_before) {
  const Viewpoint& now_seen = *camera_.view;
  if (same_view(before.camera, now_seen.camera) && before.distance == now_seen.distance &&
      camera_before == camera_.scene_camera)
    return;
  if (executed.gesture != 0 && !undo_.empty() && undo_.back().gesture == executed.gesture &&
      undo_.back().move) {
    Step& step = undo_.back();
    step.move->after = now_seen, step.move->camera_after = camera_.scene_camera;
    step.line = executed.line, step.target = executed.target;
    step.sent.last = std::max(step.sent.last, executed.sent.last);
  } else {
    undo_.push_back({executed.line,
                     executed.target,
                     executed.gesture,
                     executed.sent,
                     {},
                     {},
                     Step::Move{before, now_seen, camera_before, camera_.scene_camera}});
    forget_oldest();
  }
  redo_.clear();
}

void History::restore(const Document& to) {
  camera_.follow_lights(open_.lights(), to.lights);
  open_.restore(to);
}

void History::undo() {
  if (undo_.empty()) throw Error("", "there is nothing to undo");
  Step step = std::move(undo_.back());
  undo_.pop_back();
  if (step.move)
    camera_.take_view(step.move->before, step.move->camera_before);
  else
    restore(step.before);
  step.gesture = 0, step.sent = {};
  redo_.push_back(std::move(step));
}

void History::cancel(uint64_t gesture) {
  if (gesture == 0 || undo_.empty() || undo_.back().gesture != gesture || undo_.back().move) return;
  const Step step = std::move(undo_.back());
  undo_.pop_back();
  restore(step.before);
  std::erase_if(recorded_, [&](const Recorded& entry) {
    return entry.gesture == gesture && entry.target == step.target;
  });
}

void History::redo() {
  if (redo_.empty()) throw Error("", "there is nothing to do again");
  const Mark before = mark();
  Step step = std::move(redo_.back());
  redo_.pop_back();
  if (step.move)
    camera_.take_view(step.move->after, step.move->camera_after);
  else
    restore(step.after);
  step.sent = sent_since(before);
  undo_.push_back(std::move(step));
}

void History::refuse(const std::vector<uint64_t>& numbers) {
  for (const uint64_t number : numbers) {
    std::vector<Step> gone;
    for (std::vector<Step>* steps : {&undo_, &redo_})
      std::erase_if(*steps, [&](Step& step) {
        const bool refused = step.sent.refuse(number);
        if (refused && !step.move) gone.push_back(step);
        return refused;
      });
    // Steps that were made before the refusal was known hold the change, too.
    for (const Step& refused : gone)
      for (std::vector<Step>* steps : {&undo_, &redo_})
        for (Step& step : *steps)
          for (Document* d : {&step.before, &step.after})
            if (!step.move) take_back(*d, refused.before, refused.after);
    std::erase_if(recorded_, [&](Recorded& entry) { return entry.sent.refuse(number); });
  }
}

void History::record(Executed executed, session::Saved saved) {
  Recorded entry{std::move(executed.line), std::move(executed.target), executed.gesture, std::move(saved),
                 executed.sent};
  if (entry.gesture != 0 && !recorded_.empty() && recorded_.back().gesture == entry.gesture &&
      recorded_.back().target == entry.target)
    recorded_.back() = std::move(entry);
  else
    recorded_.push_back(std::move(entry));
}

std::vector<std::string> History::script() const {
  std::vector<std::string> lines;
  for (const Recorded& entry : recorded_)
    if (!failed(entry.saved)) lines.push_back(entry.line);
  return lines;
}

void History::save_script(const std::string& file) const {
  if (is_plain_file(file) && !read_file(file).starts_with(k_script_head))
    throw Error(file, "exists and is no saved session: choose another name");
  std::string text = k_script_head;
  for (const std::string& line : script()) text += line + '\n';
  write_file(file, text);
}

void History::record_wait() {
  if (!open_.up_to_date() || open_.snapshot->samples == 0) return;
  if (!recorded_.empty() && recorded_.back().line.starts_with("wait_samples ")) recorded_.pop_back();
  Recorded wait{line("wait_samples", open_.snapshot->samples, named("limit", 86400)), "wait_samples"};
  // A picture that rests has the samples that it had when it was stopped: the wait before that is for them.
  if (open_.snapshot->paused) {
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

}  // namespace lucerna::commands
