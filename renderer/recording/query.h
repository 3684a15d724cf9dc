#pragma once
// Queries over recorded light: "component == caustic and contribution > 5 and material == 'glass'".
//
//   query      = term { "or" term }
//   term       = factor { "and" factor }
//   factor     = "not" factor | "(" query ")" | FIELD OPERATOR VALUE
//   operator   = == != < <= > >= ~        (~: the word belongs to a path expression, paths/automaton.h)
//
// A value is a number, a word, or a text in quotes. Each event that contributes light, or was blocked, is one
// row.
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "recording/place_index.h"

namespace lucerna::recording {

/// One event that contributes light, or a blocked light sample.
struct Row {
  const Recording& of;
  const Path& path;
  uint32_t event;  ///< its number in the path
  const Event& at() const { return of.events[path.first + event]; }
};

struct Field {
  std::string name, help;
  /// Either a text, or several of which one must fit, or a number.
  std::function<std::vector<std::string>(const Row&)> texts = {};
  std::function<double(const Row&)> number = {};
  std::vector<std::string> values = {};  ///< all possible texts; empty: any
  int axis = -1;                         ///< of a number that is a coordinate of lit_place()
};
const std::vector<Field>& fields();
/// Null if there is none.
const Field* find_field(const std::string& name);
/// Its value as text: of several texts, all of them, separated by '+'.
std::string text_of(const Field& field, const Row& row);

class Query {
 public:
  /// "": every row. Throws Error located at `where`, with the position of the mistake, from 1.
  explicit Query(const std::string& text, const std::string& where = "--where");
  bool operator()(const Row& row) const { return !test_ || test_(row); }
  /// A box that has the lit_place() of every row that passes, slightly too large; nullopt: it has no bound.
  std::optional<Box> places() const;

 private:
  std::function<bool(const Row&)> test_;
  Box places_{vec3(-k_infinity), vec3(k_infinity)};
};

/// Calls f with each row of a recording: events that contribute light, and blocked light samples.
void visit_rows(const Recording& recording, const std::function<void(const Row&)>& f);

}  // namespace lucerna::recording
