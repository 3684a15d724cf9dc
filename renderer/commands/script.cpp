#include "commands/script.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>

#include "base/error.h"
#include "base/file.h"
#include "commands/text.h"

namespace lucerna::commands {
namespace {

constexpr size_t k_most_includes = 32;  // depth

bool is_name(const std::string& text) {
  const auto inner = [](unsigned char c) { return std::islower(c) || std::isdigit(c) || c == '_'; };
  return !text.empty() && std::islower(static_cast<unsigned char>(text[0])) &&
         std::all_of(text.begin(), text.end(), inner);
}

constexpr const char* k_name_form = "lower-case letters, digits and _, first a letter";

/// The first word of a line, as written.
std::string first_word(const std::string& line) {
  const size_t begin = line.find_first_not_of(" \t\r");
  if (begin == std::string::npos || line[begin] == '#') return "";
  return line.substr(begin, std::min(line.find_first_of(" \t\r", begin), line.size()) - begin);
}

/// Turns the lines of scripts into steps.
class Expander {
 public:
  Expander(const Registry& registry, const Variables& given)
      : registry_(registry), given_(given), variables_(given) {}

  void file(const std::vector<std::string>& lines, const std::string& name) {
    const std::string before = name_, folder = folder_;
    const std::vector<std::string>* outer = lines_;
    name_ = name, lines_ = &lines;
    const bool is_file = file_exists(name);
    folder_ = is_file ? absolute_path(name).parent_path().string() : "";
    if (is_file) open_.push_back(canonical_path(name));
    block(0, lines.size());
    if (is_file) open_.pop_back();
    name_ = before, folder_ = folder, lines_ = outer;
  }

  void check_given() const {
    for (const auto& [name, value] : given_)
      if (!mentioned_.count(name)) {
        const std::vector<std::string> known(mentioned_.begin(), mentioned_.end());
        throw_error(name_, "no line uses the variable '{}'{}", name, suggestion(name, known));
      }
  }
  std::vector<Step> steps() { return std::move(steps_); }
  void name(const std::string& name) { name_ = name; }

 private:
  std::string where(size_t line) const {
    std::string text = name_ + ":" + std::to_string(line + 1);
    for (size_t i = 0; i < loops_.size(); ++i)
      text += (i ? ", " : " (") + loops_[i] + " = " + variables_.at(loops_[i]);
    return loops_.empty() ? text : text + ")";
  }

  /// The line with its variables replaced.
  std::string replaced(const std::string& line, const std::string& where) {
    std::string text;
    bool quotes = false, between = true;
    for (size_t i = 0; i < line.size(); ++i) {
      const char c = line[i];
      if (!quotes && between && c == '#') break;
      if (line.compare(i, 3, "$${") == 0) {
        text += "${", i += 2, between = false;
      } else if (line.compare(i, 2, "${") == 0) {
        const size_t end = line.find('}', i);
        if (end == std::string::npos)
          throw_error(where, "column {}: '${{' without '}}'; $${{ stands for it", i + 1);
        for (const char v : value_of(line.substr(i + 2, end - i - 2), where, i + 1)) {
          if (quotes && (v == '"' || v == '\\')) text += '\\';
          text += v;
        }
        i = end, between = false;
      } else {
        if (c == '"') quotes = !quotes;
        between = !quotes && (c == ' ' || c == '\t');
        text += c;
        if (quotes && c == '\\' && i + 1 < line.size()) text += line[++i];
      }
    }
    return text;
  }

  const std::string& value_of(const std::string& name, const std::string& where, size_t column) {
    if (name == "here") {
      if (folder_.empty()) throw_error(where, "column {}: ${{here}}: this script is no file", column);
      return folder_;
    }
    mentioned_.insert(name);
    const auto found = variables_.find(name);
    if (found == variables_.end()) {
      std::vector<std::string> known{"here"};
      for (const auto& [known_name, value] : variables_) known.push_back(known_name);
      throw_error(where, "column {}: there is no variable '{}'{}", column, name, suggestion(name, known));
    }
    return found->second;
  }

  /// Lines [begin, end) of the current file.
  void block(size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const std::string head = first_word((*lines_)[i]);
      if (head.empty()) continue;
      const std::string at = where(i);
      if (head == "end") throw Error(at, "'end' without 'for'");
      const std::string line = replaced((*lines_)[i], at);
      if (head == "let") {
        define(line, at);
      } else if (head == "include") {
        include(line, at);
      } else if (head == "for") {
        i = loop(line, i, end);
      } else if (registry_.parse(line, at).command) {
        if (steps_.size() == k_most_steps) throw_error(at, "the script has more than {} lines", k_most_steps);
        steps_.push_back({line, at, folder_});
      }
    }
  }

  void define(const std::string& line, const std::string& at) {
    const std::vector<Word> words = split(line, at);
    if (words.size() != 3) throw Error(at, "let: expected let NAME VALUE; a value with blanks needs quotes");
    if (!is_name(words[1].text) || words[1].text == "here")
      throw_error(at, "let: '{}': expected a name of {}", words[1].text, k_name_form);
    mentioned_.insert(words[1].text);
    if (std::find(loops_.begin(), loops_.end(), words[1].text) != loops_.end())
      throw_error(at, "let: '{}' is the variable of a loop around this line", words[1].text);
    if (!given_.count(words[1].text)) variables_[words[1].text] = words[2].text;
  }

  void include(const std::string& line, const std::string& at) {
    const std::vector<Word> words = split(line, at);
    if (words.size() != 2) throw Error(at, "include: expected include FILE");
    const std::string file = beside_script(folder_, words[1].text);
    if (std::find(open_.begin(), open_.end(), canonical_path(file)) != open_.end())
      throw_error(at, "include: {} is already being read: a script cannot include itself", file);
    if (open_.size() > k_most_includes)
      throw_error(at, "include: more than {} scripts within each other", k_most_includes);
    std::vector<std::string> lines;
    try {
      lines = read_script(file);
    } catch (const Error& failure) {
      throw Error(at, std::string("include: ") + failure.what());
    }
    this->file(lines, file);
  }

  /// Repeats the block behind line `begin`. Returns the line of its 'end'.
  size_t loop(const std::string& line, size_t begin, size_t end) {
    const std::string at = where(begin);
    const std::vector<Word> words = split(line, at);
    if (words.size() < 4 || words[2].text != "in")
      throw Error(at, "for: expected for NAME in A B C, with at least one value");
    const std::string name = words[1].text;
    if (!is_name(name) || name == "here")
      throw_error(at, "for: '{}': expected a name of {}", name, k_name_form);
    if (std::find(loops_.begin(), loops_.end(), name) != loops_.end())
      throw_error(at, "for: '{}' is the variable of a loop around this one", name);
    size_t depth = 1, last = begin + 1;
    for (; last < end; ++last) {
      const std::string head = first_word((*lines_)[last]);
      if (head == "for") ++depth;
      if (head == "end" && --depth == 0) break;
    }
    if (last >= end) throw Error(at, "for: its 'end' is missing");
    if (split((*lines_)[last], where(last)).size() > 1)
      throw Error(where(last), "end: expected nothing behind it");
    const auto before = variables_.find(name);
    const std::optional<std::string> outer =
        before == variables_.end() ? std::nullopt : std::optional(before->second);
    loops_.push_back(name);
    for (size_t i = 3; i < words.size(); ++i) {
      variables_[name] = words[i].text;
      block(begin + 1, last);
    }
    loops_.pop_back();
    if (outer)
      variables_[name] = *outer;
    else
      variables_.erase(name);
    return last;
  }

  const Registry& registry_;
  const Variables& given_;
  Variables variables_;
  std::set<std::string> mentioned_;
  std::vector<std::string> loops_;
  std::vector<std::string> open_;  ///< files being read, by canonical_path()
  const std::vector<std::string>* lines_ = nullptr;
  std::string name_, folder_;
  std::vector<Step> steps_;
};

}  // namespace

std::vector<Step> parse_script(const Registry& registry, const std::vector<std::string>& lines,
                               const std::string& name, const Variables& given) {
  Expander expander(registry, given);
  expander.file(lines, name);
  expander.name(name);
  expander.check_given();
  return expander.steps();
}

std::vector<std::string> read_script(const std::string& file) {
  if (file.empty()) throw Error("script", "expected a file name, found ''");
  const std::string text = read_file(file);
  if (text.find('\0') != std::string::npos)
    throw Error(file, "is not a text file; expected a script, one command per line");
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::pair<std::string, std::string> parse_variable(const std::string& text, const std::string& where) {
  const size_t at = text.find('=');
  const std::string name = text.substr(0, at);
  if (at == std::string::npos || !is_name(name) || name == "here")
    throw_error(where, "'{}': expected NAME=VALUE, with a name of {}", text, k_name_form);
  return {name, text.substr(at + 1)};
}

std::string canonical_path(const std::string& file) {
  std::error_code error;
  return std::filesystem::weakly_canonical(file, error).string();
}

std::string beside_script(const std::string& folder, const std::string& file) {
  const std::filesystem::path path(file);
  return folder.empty() || path.is_absolute()
             ? file
             : (std::filesystem::path(folder) / path).lexically_normal().string();
}

bool needs_window(const Registry& registry, const std::vector<Step>& steps) {
  return std::any_of(steps.begin(), steps.end(), [&](const Step& step) {
    const Line line = registry.parse(step.line, step.where);
    return line.command && line.command->needs_window && line.command->needs_window(line.arguments);
  });
}

}  // namespace lucerna::commands
