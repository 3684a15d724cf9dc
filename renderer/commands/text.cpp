#include "commands/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "base/error.h"

namespace lucerna::commands {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// Letters to insert, remove or replace, or neighbours to swap, to turn a into b.
size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  std::iota(d[0].begin(), d[0].end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i)
    for (size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

bool blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

}  // namespace

std::vector<Word> split(std::string_view line, const std::string& where) {
  std::vector<Word> words;
  for (size_t i = 0; i < line.size();) {
    if (blank(line[i])) {
      ++i;
      continue;
    }
    if (line[i] == '#') break;
    Word word;
    bool quotes = false, any = false;
    for (; i < line.size() && (quotes || !blank(line[i])); ++i) {
      if (line[i] == '"') {
        quotes = !quotes, any = true;
      } else {
        if (quotes && line[i] == '\\' && i + 1 < line.size() && (line[i + 1] == '"' || line[i + 1] == '\\'))
          ++i;
        word.text += line[i];
        if (!any) ++word.plain;
      }
    }
    if (quotes) throw Error(where, "a quotation mark is not closed");
    words.push_back(std::move(word));
  }
  return words;
}

std::string text_after(std::string_view line, size_t count) {
  size_t begin = std::string_view::npos, end = 0, words = 0;
  bool quotes = false, between = true;
  for (size_t i = 0; i < line.size(); ++i) {
    if (!quotes && blank(line[i])) {
      between = true;
      continue;
    }
    if (between && line[i] == '#') break;
    if (between && words++ == count) begin = i;
    between = false, end = i + 1;
    if (quotes && line[i] == '\\' && i + 1 < line.size())
      ++i, end = i + 1;
    else if (line[i] == '"')
      quotes = !quotes;
  }
  return begin == std::string_view::npos ? "" : std::string(line.substr(begin, end - begin));
}

size_t last_word(std::string_view line) {
  size_t begin = 0;
  bool quotes = false, between = true;
  for (size_t i = 0; i < line.size(); ++i) {
    if (between && !blank(line[i])) begin = i, between = false;
    if (line[i] == '"') quotes = !quotes;
    if (!quotes && blank(line[i])) between = true;
  }
  return between ? line.size() : begin;
}

std::string quote(std::string_view text) {
  const bool plain = !text.empty() && text.find_first_of(" \t\r\n\"#=\\") == std::string_view::npos;
  if (plain) return std::string(text);
  std::string result = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

std::string number_text(double value) { return fmt::format("{}", value + 0.0); }
std::string number_text(float value) { return fmt::format("{}", value + 0.0f); }
std::string vector_text(const vec3& v) {
  return number_text(v.x) + "," + number_text(v.y) + "," + number_text(v.z);
}

bool read_number(std::string_view text, double& value) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end && std::isfinite(value);
}

bool read_vector(std::string_view text, vec3& value) {
  for (int i = 0; i < 3; ++i) {
    const size_t comma = text.find(',');
    if ((comma == std::string_view::npos) != (i == 2)) return false;
    double number = 0;
    if (!read_number(text.substr(0, comma), number)) return false;
    value[i] = static_cast<float>(number);
    if (!std::isfinite(value[i])) return false;
    if (i < 2) text.remove_prefix(comma + 1);
  }
  return true;
}

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
  const std::string wanted = lower(word);
  if (wanted.empty()) return "";
  std::string best;
  size_t least = std::max<size_t>(1, wanted.size() / 3) + 1;  // the distance at which nothing is near
  for (const std::string& name : known) {
    if (name.empty()) continue;
    const std::string candidate = lower(name);
    const size_t dot = candidate.rfind('.');
    const std::string tail = dot == std::string::npos ? candidate : candidate.substr(dot + 1);
    size_t far = std::min(distance(wanted, candidate), distance(wanted, tail));
    // The typed text is the beginning of the name or of its part behind the dot: a near match.
    if (far > 0 && wanted.size() >= 3 && (candidate.starts_with(wanted) || tail.starts_with(wanted))) far = 1;
    if (far < least) least = far, best = name;
  }
  return best;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
  const std::string near = nearest(word, known);
  return near.empty() ? "" : fmt::format("; did you mean '{}'?", near);
}

uint32_t index_of(const char* kind, const std::string& which, const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), which);
  if (found != names.end()) return static_cast<uint32_t>(found - names.begin());
  double number = 0;
  if (read_number(which, number)) {
    if (number >= 1 && number <= static_cast<double>(names.size()) && number == std::floor(number))
      return static_cast<uint32_t>(number) - 1;
    throw Error("", fmt::format("there is no {} {}; the scene has {}", kind, which, names.size()));
  }
  throw Error("", fmt::format("the scene has no {} '{}'{}", kind, which, suggestion(which, names)));
}

std::vector<std::string> paths_starting(const std::string& typed, const std::vector<std::string>& endings) {
  namespace fs = std::filesystem;
  const size_t slash = typed.rfind('/');
  const std::string head = slash == std::string::npos ? "" : typed.substr(0, slash + 1);
  const std::string start = slash == std::string::npos ? typed : typed.substr(slash + 1);
  std::vector<std::string> folders, files;
  std::error_code error;
  auto entry =
      fs::directory_iterator(head.empty() ? "." : head, fs::directory_options::skip_permission_denied, error);
  // A folder of many thousands is looked at in part: the window must not stall.
  for (int n = 0; !error && entry != fs::directory_iterator() && n < 5000; entry.increment(error), ++n) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(start) || (name[0] == '.' && start.empty())) continue;
    std::error_code ignored;
    if (entry->is_directory(ignored)) {
      folders.push_back(head + name + "/");
      continue;
    }
    const std::string ending = lower(entry->path().extension().string());
    if (endings.empty() || std::find(endings.begin(), endings.end(), ending) != endings.end())
      files.push_back(head + name);
  }
  std::sort(folders.begin(), folders.end());
  std::sort(files.begin(), files.end());
  folders.insert(folders.end(), files.begin(), files.end());
  return folders;
}

}  // namespace lucerna::commands
