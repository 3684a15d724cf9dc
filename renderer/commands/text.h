#pragma once
// Words: splitting of a line of text, writing that can be parsed again, and suggestions for a mistyped
// word.
#include <concepts>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"

namespace lucerna::commands {

/// A word of a line. `plain` is the part before the first quotation mark: only there can '=' separate a name
/// from its value.
struct Word {
  std::string text;
  size_t plain = 0;
};

/// Splits a line at blanks. "..." keeps blanks, and inside it \" and \\ mean " and \; # starts a comment.
/// Throws Error at `where` if a quotation mark is not closed.
std::vector<Word> split(std::string_view line, const std::string& where = "");
/// The text of a line behind its first `count` words, as written, without blanks at its ends and without a
/// comment.
std::string text_after(std::string_view line, size_t count);
/// Start of the last word of an unfinished line; its length if the next word has not begun.
size_t last_word(std::string_view line);
/// The text as a word for split(): in quotation marks if necessary.
std::string quote(std::string_view text);

/// The shortest text that parses to the same number.
std::string number_text(double value);
std::string number_text(float value);
/// "x,y,z"
std::string vector_text(const vec3& v);
/// name=value, as a word of line().
struct Named {
  std::string text;
};
inline std::string word(const std::string& text) { return quote(text); }
inline std::string word(const char* text) { return quote(text); }
inline std::string word(bool on) { return on ? "true" : "false"; }
inline std::string word(double value) { return number_text(value); }
inline std::string word(float value) { return number_text(value); }
inline std::string word(const vec3& value) { return vector_text(value); }
inline std::string word(const Named& named) { return named.text; }
template <std::integral T>
std::string word(T value) {
  return std::to_string(value);
}
template <class T>
Named named(const std::string& name, const T& value) {
  return {name + "=" + word(value)};
}
/// A command and its words as one line.
template <class... A>
std::string line(const std::string& command, const A&... words) {
  std::string text = command;
  ((text += " " + word(words)), ...);
  return text;
}

/// The whole text as a finite number; false if it is not one.
bool read_number(std::string_view text, double& value);
bool read_vector(std::string_view text, vec3& value);

/// The word of `known` that `word` most likely means: equal except for case, with the same ending
/// ("orbit" -> "camera.orbit") or beginning, or a few letters different. "" if none is similar.
std::string nearest(std::string_view word, const std::vector<std::string>& known);
/// "; did you mean 'x'?", or "" if none is similar.
std::string suggestion(std::string_view word, const std::vector<std::string>& known);

/// Names of objects of the scene, in its order; "" for unnamed ones.
template <class List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  for (const auto& item : list) names.push_back(item.name);
  return names;
}
/// Without the empty ones.
template <class List>
std::vector<std::string> given_names(const List& list) {
  std::vector<std::string> names = names_of(list);
  std::erase(names, "");
  return names;
}
/// Index of the object of a `kind` ("light") with that name, or with that number from 1. Throws Error with a
/// suggestion if there is none.
uint32_t index_of(const char* kind, const std::string& which, const std::vector<std::string>& names);

/// Files that begin with `typed` and end in one of `endings` (".gltf"; none: all), and folders with a final
/// '/', folders first. Reads only the first 5000 entries of a folder.
std::vector<std::string> paths_starting(const std::string& typed, const std::vector<std::string>& endings);

}  // namespace lucerna::commands
