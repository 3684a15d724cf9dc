#pragma once
// What a script or the console can read: settings by key, and named values of the workspace such as
// "picture.samples" or "light 'Brass lamp' intensity". 'get' prints them, 'expect' compares them.
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace lucerna::commands {

class Workspace;

struct Value {
  std::string name;  ///< dotted, lower case; no setting has it
  std::string help;  ///< what it is, with its unit
  /// Names of the words behind the name: "LIGHT", "PART"; usually none.
  std::vector<std::string> words = {};
  /// Suggestions for the next of these words, given those before it.
  std::function<std::vector<std::string>(const std::vector<std::string>&)> names = {};
  /// The text of the value, given its words: a number, x,y,z, true or false, or any text. Throws Error if
  /// there is none.
  std::function<std::string(const std::vector<std::string>&)> read;
};

/// A value with its words, as written in a line.
struct ValueWords {
  std::string name;
  std::vector<std::string> words;
  bool operator==(const ValueWords&) const = default;
};

class Values {
 public:
  /// The name must be new and no setting's (assertion).
  void add(Value value);
  const std::map<std::string, Value>& all() const { return values_; }

  /// Takes a value from the beginning of `words`, removing those that belong to it. Throws Error: there is no
  /// such value (with a suggestion), or a word is missing.
  ValueWords take(std::vector<std::string>& words) const;
  /// Its present text; of settings as displayed, with edits on their way. Throws Error if there is none.
  std::string read(const Workspace& work, const ValueWords& value) const;
  /// Suggestions for the word behind `before`.
  std::vector<std::string> suggestions(const std::vector<std::string>& before) const;
  /// One line per value.
  std::string manual() const;

 private:
  std::map<std::string, Value> values_;
};

/// Registers the values of the workspace, and the command that prints them.
void add_values(Workspace& work);

}  // namespace lucerna::commands
