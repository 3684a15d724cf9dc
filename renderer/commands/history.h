#pragma once
// History of edits: steps to undo, and the executed lines, so that they can be run again as a script. What
// the session refuses is removed from both.
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "commands/navigation.h"
#include "commands/open_scene.h"
#include "commands/registry.h"

namespace lucerna::commands {

class History {
 public:
  History(OpenScene& open, Navigation& camera) : open_(open), camera_(camera) {}
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  bool can_undo() const { return !undo_.empty(); }
  bool can_redo() const { return !redo_.empty(); }
  /// Numbers of steps that can be undone and done again.
  size_t undo_steps() const { return undo_.size(); }
  size_t redo_steps() const { return redo_.size(); }
  /// The lines that undo would revert and redo would repeat; "": none.
  std::string undo_text() const { return undo_.empty() ? "" : undo_.back().line; }
  std::string redo_text() const { return redo_.empty() ? "" : redo_.back().line; }
  /// Identifies the state of what a saved scene keeps: equal after undo and redo.
  uint64_t position() const;
  void undo();  ///< throws Error if there is nothing to undo
  void redo();
  /// Reverts the latest step if it is an edit of that gesture (not 0), as if its lines had not been run: a
  /// drag that is given up. The steps that its first line took from redo stay forgotten.
  void cancel(uint64_t gesture);

  /// The executed lines, without failed ones, so that they can be run again as a script.
  std::vector<std::string> script() const;
  /// Writes the script, completely or not at all. Throws Error: cannot be written, or the file exists and is
  /// not a saved session.
  void save_script(const std::string& file) const;

  /// The line (of a control, a script or the console) that caused the session's command of that number
  /// (Session::commands); "" if none did, or long ago.
  std::string line_of(uint64_t command) const;

  // Below: called while lines are executed.

  /// A point in the stream of the session's commands.
  struct Mark {
    uint64_t commands = 0, moves = 0;
  };
  Mark mark() const { return {open_.session.commands(), camera_.moves()}; }
  /// Numbers of the session's commands caused by a line.
  struct Sent {
    uint64_t first = 1, last = 0;  ///< none if last < first
    uint64_t refused = 0;          ///< number of refused ones
    /// Counts a refused command; true if no other one is left.
    bool refuse(uint64_t number) {
      if (number < first || number > last) return false;
      return ++refused == last - first + 1;
    }
  };
  Sent sent_since(const Mark& mark) const;
  /// A line that was executed.
  struct Executed {
    std::string line, target;  ///< printed; Registry::target
    uint64_t gesture = 0;
    Sent sent = {};
  };

  /// The document before the latest step if that is one of the same gesture (not 0) on the same target, which
  /// the next edit replaces; else null.
  const Document* merged(uint64_t gesture, const std::string& target) const;
  /// Adds a step, or replaces the latest one if `merges`.
  void add_edit(const Executed& executed, const Document& before, const Document& after, bool merges);
  /// Adds a step if the camera has moved from there. Moves of one gesture are one step.
  void add_move(const Executed& executed, const Viewpoint& before, int camera_before);
  /// Makes the latest step part of the one before it, if position() was `position` after that one.
  void join_latest(uint64_t position);
  void forget_redo() { redo_.clear(); }
  /// Another scene: nothing can be undone.
  void forget_steps() { undo_.clear(), redo_.clear(), base_ = ++positions_; }

  /// Adds a line to the script, in place of the latest of the same gesture (not 0) and target. `saved`: state
  /// of writing its file.
  void record(Executed executed, session::Saved saved = {});
  /// Makes the script wait for the present number of samples.
  void record_wait();
  /// Notes the line that caused the session's commands since `before`.
  void note_sent(uint64_t before, const std::string& line, bool moves);
  /// Removes what was caused by refused commands alone.
  void refuse(const std::vector<uint64_t>& numbers);

 private:
  struct Step {
    std::string line, target;
    uint64_t gesture;
    Sent sent;
    Document before, after;
    /// For a camera move, which changes nothing else.
    struct Move {
      Viewpoint before, after;
      int camera_before, camera_after;
    };
    std::optional<Move> move = {};
    uint64_t position = 0;  ///< after it, if it changes what a saved scene keeps; else 0
  };
  void forget_oldest();
  struct Recorded {
    std::string line, target;
    uint64_t gesture = 0;
    session::Saved saved = {};
    Sent sent = {};
  };
  /// Lines and the last of the session's commands that each has caused, the newest last.
  struct GivenBy {
    uint64_t first, last;
    std::string line;
  };

  void restore(const Document& to);

  OpenScene& open_;
  Navigation& camera_;
  uint64_t base_ = 0, positions_ = 0;  ///< position before the oldest step; the newest position
  std::deque<GivenBy> given_by_;
  std::vector<Step> undo_, redo_;
  std::vector<Recorded> recorded_;
};

}  // namespace lucerna::commands
