#pragma once
// Registry of commands, with dotted names, typed parameters and help. Window, command line, scripts and tests
// all use lines of text that it parses:
//
//   camera.orbit 0.3 -0.1
//   light.set "Brass lamp" intensity=12 color=1,0.8,0.5
//
// Words are separated by blanks (text.h). Parameters are given by position, required ones first, or as
// name=value. Every parsed line is printed so that it parses to the same again.
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands/text.h"

namespace lucerna::commands {

enum class Type {
  boolean,  ///< true or false (also on, off)
  integer,
  real,
  vector,  ///< three numbers: x,y,z without blanks
  choice,  ///< one of `choices`
  text,    ///< anything on one line
  file,    ///< a path
  rest,    ///< the rest of the line, as written; only as the last parameter
};

struct Parameter {
  std::string name;
  Type type = Type::text;
  std::string help;
  double lo =
      -std::numeric_limits<double>::infinity();  ///< integer, real and each part of a vector; inclusive
  double hi = std::numeric_limits<double>::infinity();
  std::string unit;                     ///< "m", "EV", "degrees"; "" for none
  std::vector<std::string> choices;     ///< of a choice; for a file: its endings (".png")
  std::vector<std::string> words = {};  ///< of a file: words that stand for none ("none")
  bool optional = false;                ///< optional
  bool writes = false;                  ///< a written file: its name must have one of its endings
  /// Identifies the object of the command: two commands that differ only in other parameters are steps of one
  /// drag.
  bool which = false;
  /// Suggested words for a text, given the values of the parameters before it.
  std::function<std::vector<std::string>(const std::vector<std::string>&)> names = {};
  /// True if the value is a path.
  bool names_file(const std::string& value) const;
};

/// Optional time limit of a waiting script command: "limit".
Parameter time_limit();
/// A file to read, whose name usually has one of these endings.
Parameter file_named(std::vector<std::string> endings);
/// A file to write, whose name must have one of these endings.
Parameter file_to_write(std::vector<std::string> endings);

/// The checked values of one command. Reading a missing parameter is a logic error (throws
/// std::out_of_range); see has().
class Arguments {
 public:
  bool has(const std::string& name) const { return values_.count(name) > 0; }
  const std::string& text(const std::string& name) const { return values_.at(name); }
  bool boolean(const std::string& name) const { return values_.at(name) == "true"; }
  double real(const std::string& name) const;
  float number(const std::string& name) const { return static_cast<float>(real(name)); }
  int64_t integer(const std::string& name) const { return static_cast<int64_t>(real(name)); }
  vec3 vector(const std::string& name) const;
  bool operator==(const Arguments&) const = default;

 private:
  friend class Registry;
  std::map<std::string, std::string> values_;  ///< in canonical form
};

struct Command {
  std::string name;  ///< dotted, lower case
  std::string help;  ///< one or two sentences
  std::vector<Parameter> parameters;
  /// Checks that types cannot express, before execution; throws Error. May be empty.
  std::function<void(const Arguments&)> check = {};
  /// Executes it; throws Error if it cannot.
  std::function<void(const Arguments&)> run;
  /// For commands that answer a question: the answer, which run() logs if no other is given.
  std::function<std::string(const Arguments&)> answer = {};
  /// For commands that take time: scripts call it after run() until it returns true; a console does not wait.
  std::function<bool(const Arguments&)> done = {};
  bool undoable = false;  ///< changes the document (workspace.h)
  /// True if it can change the sun's strength by orders of magnitude, so that the exposure is measured again;
  /// empty: never.
  std::function<bool(const Arguments&)> replaces_sunlight = {};
  bool moves = false;    ///< moves the camera, which can be undone too
  bool recorded = true;  ///< recorded in the script of a session
  /// It reads the results of earlier lines, or which of them were refused, so a script waits for those.
  bool needs_outcome = false;
  /// True if it needs a window on a display, not only the window's state; empty: never.
  std::function<bool(const Arguments&)> needs_window = {};
};

/// A parsed line.
struct Line {
  const Command* command = nullptr;
  Arguments arguments;
};

class Registry {
 public:
  /// Adds a command with run() or answer(); the name must be new (assertion). References to commands stay
  /// valid.
  void add(Command command);
  /// Adds a word that expands to the beginning of a line unless a command has that name: "film.ev" -> "set
  /// film.ev".
  void add_prefix(const std::string& word, const std::string& line_head);

  const std::map<std::string, Command>& all() const { return commands_; }
  const Command* find(const std::string& name) const;

  /// Parses a line. Empty lines and comments give a Line without a command. Throws Error, located at `where`,
  /// with the mistake and, for a mistyped name, a suggestion.
  Line parse(const std::string& line, const std::string& where = "") const;
  /// The line in canonical form.
  std::string print(const Line& line) const;
  /// The target of a line: its command, the values of its `which` parameters and the names of the given
  /// options.
  std::string target(const Line& line) const;

  /// "light.set LIGHT [intensity=W/sr] [color=r,g,b] [on=true|false]"
  std::string usage(const Command& command) const;
  /// Usage, help, and one line a parameter with its unit and range.
  std::string manual(const Command& command) const;
  /// Completions of the last word of an unfinished line; each entry is the whole word.
  std::vector<std::string> complete(const std::string& line) const;

 private:
  std::vector<std::string> names() const;
  Arguments bind(const Command& command, const std::string& line, std::vector<Word> words,
                 const std::string& where) const;

  std::map<std::string, Command> commands_;
  std::map<std::string, std::string> prefixes_;
};

}  // namespace lucerna::commands
