#pragma once
// What an 'expect' line can state. Each kind of expectation is one entry, found by its first word; the kind
// without a name compares a value (values.h):
//
//   expect film.ev is 1.5              expect picture.error < 0.05
//   expect light 2 on is false         expect solver cache records >= 500 within 20
//   expect log "no light"              an error or warning that a line has caused
//   expect picture lamp.png            the shown picture, by the means of cells of 4x4 pixels
//   expect image lamp.exr              the light, within the noise of both pictures
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "commands/report_folder.h"
#include "commands/script_results.h"
#include "commands/text.h"

namespace lucerna::commands {

class Workspace;

/// The words of an expectation, taken from the front. Errors name the position: "word 3 ('=='): expected
/// ...".
class WordReader {
 public:
  explicit WordReader(const std::string& text);
  bool done() const { return at_ == words_.size(); }
  /// Takes the next word if it is `word`.
  bool take(const std::string& word);
  /// Takes the next word; `what`: what is expected there.
  std::string text(const std::string& what);
  double number(const std::string& what, double lo, double hi);
  /// Checks that no word is left; `expected`: what could follow.
  void end(const std::string& expected);
  /// The words from here on, for other readers, which then skip() those that they have taken.
  std::vector<std::string> remaining() const {
    return {words_.begin() + static_cast<long>(at_), words_.end()};
  }
  void skip(size_t count) { at_ += count; }
  [[noreturn]] void refuse(const std::string& expected) const;

 private:
  std::vector<std::string> words_;
  size_t at_ = 0;
};

/// A check in progress: polled until it knows its verdict; throws Error if it never will.
using Check = std::function<std::optional<Verdict>()>;

struct ExpectContext {
  std::string folder;    ///< of the script's file
  ReportFolder& report;  ///< takes the pictures of a failure
  bool keeps = true;     ///< a failure is final: its pictures are written
};

struct ExpectKind {
  std::string name;   ///< first word; "": any other
  std::string usage;  ///< words behind 'expect'
  std::string help;
  bool needs_window = false;
  /// Reads the words behind the name. Throws Error if they are none of this kind.
  std::function<Check(WordReader& words, const ExpectContext& context)> read;
  /// Suggestions for the next word, given those before it behind the name.
  std::function<std::vector<std::string>(const std::vector<std::string>&)> names = {};
};

class Expectations {
 public:
  /// The name must be new (assertion).
  void add(ExpectKind kind);
  /// Reads the text behind 'expect'. Throws Error with the position of the mistake.
  Check read(const std::string& text, const ExpectContext& context) const;
  bool needs_window(const std::string& text) const;
  std::vector<std::string> suggestions(const std::vector<std::string>& before) const;
  /// One line per kind.
  std::string manual() const;

 private:
  const ExpectKind& kind_of(const std::string& word) const;
  std::map<std::string, ExpectKind> kinds_;
};

/// Registers the kinds that need no window: values, log, picture, image.
void add_expectations(Workspace& work, Expectations& expectations);

/// Compares a picture for the display with a file, and keeps both and their difference if they differ.
/// `name`: for the files.
Verdict expect_display(const ExpectContext& context, const std::string& file, const std::string& name,
                       uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba, double within,
                       double share);

}  // namespace lucerna::commands
