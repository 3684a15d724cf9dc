#pragma once
// Words: how a line of text is cut into them, how they are written so that they can be read again, and which
// known word a mistyped one is meant to be.
#include <concepts>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"

namespace lucerna::commands {

/// A word of a line. `plain` is the part before the first quotation mark: only there can a '=' part a name
/// from its value.
struct Word {
  std::string text;
  size_t plain = 0;
};

/// Splits a line at blanks. "..." keeps blanks, and inside it \" and \\ mean " and \; # starts a comment.
/// Throws Error at `where` if a quotation mark is not closed.
std::vector<Word> split(std::string_view line, const std::string& where = "");
/// Where the last word of an unfinished line begins; its length when the next word has not been begun.
size_t last_word(std::string_view line);
/// The text as a word that split() gives back: in quotation marks where it needs them.
std::string quote(std::string_view text);

/// The shortest text that is read back as the same number.
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

/// Whole text as a finite number; false when it is none.
bool read_number(std::string_view text, double& value);
bool read_vector(std::string_view text, vec3& value);

/// The word of `known` that `word` is most likely meant to be: equal but for case, ending like it
/// ("orbit" -> "camera.orbit"), beginning like it, or a few letters off. "" when none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& known);
/// "; did you mean 'x'?", or "" when nothing is near.
std::string suggestion(std::string_view word, const std::vector<std::string>& known);

/// Files that begin with `typed` and end in one of `endings` (".gltf"; none: all), and folders with a final
/// '/', folders first. Looks at the first 5000 entries of a folder only.
std::vector<std::string> paths_starting(const std::string& typed, const std::vector<std::string>& endings);

}  // namespace lucerna::commands
