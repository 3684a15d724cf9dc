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
};

struct Parameter {
  std::string name;
  Type type = Type::text;
  std::string help;
  double lo =
      -std::numeric_limits<double>::infinity();  ///< integer, real and each part of a vector; inclusive
  double hi = std::numeric_limits<double>::infinity();
  std::string unit;                  ///< "m", "EV", "degrees"; "" for none
  std::vector<std::string> choices;  ///< of a choice; of a file: its endings (".png")
  bool optional = false;             ///< optional
  bool writes = false;               ///< a file that is written: its name must have one of its endings
  /// Identifies the object of the command: two commands that differ only in other parameters are steps of one
  /// drag.
  bool which = false;
  /// Words to offer for a text; given the values of the parameters before it.
  std::function<std::vector<std::string>(const std::vector<std::string>&)> names = {};
};

/// Optional time limit of a waiting script command: "limit".
Parameter time_limit();
/// A "file" to read, whose name most likely has one of these endings.
Parameter file_named(std::vector<std::string> endings);
/// A "file" to write, whose name must have one of these endings.
Parameter file_to_write(std::vector<std::string> endings);

/// The values of one command, checked. Asking for a parameter that was not given is a logic error (throws
/// std::out_of_range); has() says.
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
  std::map<std::string, std::string> values_;  ///< in the one form that each value has
};

struct Command {
  std::string name;  ///< dotted, lower case
  std::string help;  ///< one sentence or two
  std::vector<Parameter> parameters;
  /// Looks at what the types cannot say, before anything is done; throws Error. May be empty.
  std::function<void(const Arguments&)> check = {};
  /// Does it; throws Error when it cannot be done.
  std::function<void(const Arguments&)> run;
  /// For commands that take time: scripts call it after run() until it returns true; a console does not wait.
  std::function<bool(const Arguments&)> done = {};
  bool undoable = false;  ///< changes the document (workspace.h)
  bool moves = false;     ///< moves the camera, which can be undone too
  bool recorded = true;   ///< belongs into the script of a session
  /// It reads which of the lines before were refused: a script waits for that.
  bool needs_outcome = false;
};

/// A line that has been understood.
struct Line {
  const Command* command = nullptr;
  Arguments arguments;
};

class Registry {
 public:
  /// Adds a command; the name must be new (assertion). References to commands stay valid.
  void add(Command command);
  /// Adds a word that expands to the beginning of a line unless a command has that name: "film.ev" -> "set
  /// film.ev".
  void add_prefix(const std::string& word, const std::string& line_head);

  const std::map<std::string, Command>& all() const { return commands_; }
  const Command* find(const std::string& name) const;

  /// Parses a line. Empty lines and comments give a Line without a command. Throws Error, located at `where`,
  /// with the mistake and, for a mistyped name, a suggestion.
  Line parse(const std::string& line, const std::string& where = "") const;
  /// The line in its one form.
  std::string print(const Line& line) const;
  /// What a line acts upon: its command, the values of its `which` parameters and the names of the options
  /// given.
  std::string target(const Line& line) const;

  /// "light.set LIGHT [intensity=W/sr] [color=r,g,b] [on=true|false]"
  std::string usage(const Command& command) const;
  /// Usage, help, and one line a parameter with its unit and range.
  std::string manual(const Command& command) const;
  /// What the last word of an unfinished line may become; each entry is the whole word.
  std::vector<std::string> complete(const std::string& line) const;

 private:
  std::vector<std::string> names() const;
  Arguments bind(const Command& command, std::vector<Word> words, const std::string& where) const;

  std::map<std::string, Command> commands_;
  std::map<std::string, std::string> prefixes_;
};

}  // namespace lucerna::commands
