#pragma once
// The language of scripts (*.lucerna): one command per line, as registry.h reads them; # starts a comment.
// Besides commands there are these lines:
//
//   let NAME VALUE             a variable, for ${NAME} in later lines; VALUE is one word
//   include FILE               the lines of another script, relative to this one's folder
//   for NAME in A B C ... end  repeats the lines up to its 'end', with each value in turn
//
// A variable is replaced in the text of a line: inside quotation marks as part of the word, outside of them
// it can be several words. ${here} is the folder of the script's file. $${ stands for ${. All of this happens
// before the first line runs, so that a mistake anywhere is found at once.
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "commands/registry.h"

namespace lucerna::commands {

/// A running script.
struct Call {
  std::string file;                ///< canonical path; "" if it is no file
  std::shared_ptr<const Call> by;  ///< the calling script; null: the program's own, or the console's
  bool own = false;                ///< the program's own
  uint64_t errors = 0;             ///< logged before it began
};

/// A line to run.
struct Step {
  std::string line;    ///< with its variables replaced
  std::string where;   ///< "FILE:3" or "FILE:3 (x = a)", for messages
  std::string folder;  ///< of its script's file; "" if it is no file
  std::shared_ptr<const Call> call = {};
};

using Variables = std::map<std::string, std::string>;

/// Expands and checks the lines. `given` variables take precedence over 'let'. Throws Error "NAME:LINE: ..."
/// at the first mistake: an invalid command, an unknown variable, a loop without end, a file that includes
/// itself, more than k_most_steps lines, or a given variable that no line mentions (located at NAME).
std::vector<Step> parse_script(const Registry& registry, const std::vector<std::string>& lines,
                               const std::string& name, const Variables& given = {});
inline constexpr size_t k_most_steps = 100'000;

/// The lines of a file. Throws Error if it cannot be read, is a folder or no text.
std::vector<std::string> read_script(const std::string& file);

/// NAME=VALUE as a variable. Throws Error if NAME is none: lower-case letters, digits and _, first a letter.
std::pair<std::string, std::string> parse_variable(const std::string& text, const std::string& where);

/// Without links, '.' and '..', as far as the file exists: two names of one file are equal.
std::string canonical_path(const std::string& file);

/// A file named in a line of a script: relative to the folder of the script's file.
std::string beside_script(const std::string& folder, const std::string& file);

/// True if one of the steps needs a window on a display.
bool needs_window(const Registry& registry, const std::vector<Step>& steps);

}  // namespace lucerna::commands
