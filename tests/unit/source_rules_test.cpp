// links: base
// Rules for the sources that no type can state: JSON is written in one place, std::filesystem never throws,
// pages have short paragraphs, and no private words.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "support/paths.h"

namespace source_rules_tests {

namespace fs = std::filesystem;

namespace {

std::string read(const fs::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The text without its comments; line ends stay.
std::string code_of(const std::string& text) { return std::regex_replace(text, std::regex("//[^\n]*"), ""); }

int line_of(const std::string& text, size_t at) {
  return 1 + int(std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n'));
}

/// The number of arguments of a call, from behind its opening parenthesis.
size_t arguments(const std::string& text, size_t at) {
  int depth = 1;
  size_t commas = 0;
  bool any = false;
  for (; at < text.size() && depth > 0; ++at) {
    const char c = text[at];
    if (c == '(' || c == '{' || c == '[') ++depth;
    if (c == ')' || c == '}' || c == ']') --depth;
    if (c == ',' && depth == 1) ++commas;
    if (depth > 0 && !std::isspace(static_cast<unsigned char>(c))) any = true;
  }
  return any ? commas + 1 : 0;
}

/// Calls that throw std::filesystem::filesystem_error on a failure of the disk, which would end the window.
std::vector<std::string> throwing_calls(const std::string& text) {
  // Number of arguments of the form that takes a std::error_code.
  static const std::map<std::string, size_t> k_quiet = {{"absolute", 2},
                                                        {"canonical", 2},
                                                        {"weakly_canonical", 2},
                                                        {"copy_file", 3},
                                                        {"copy", 3},
                                                        {"create_directory", 2},
                                                        {"create_directories", 2},
                                                        {"current_path", 1},
                                                        {"directory_iterator", 2},
                                                        {"exists", 2},
                                                        {"equivalent", 3},
                                                        {"file_size", 2},
                                                        {"is_directory", 2},
                                                        {"is_empty", 2},
                                                        {"is_regular_file", 2},
                                                        {"is_symlink", 2},
                                                        {"is_fifo", 2},
                                                        {"is_other", 2},
                                                        {"last_write_time", 2},
                                                        {"permissions", 3},
                                                        {"read_symlink", 2},
                                                        {"recursive_directory_iterator", 2},
                                                        {"relative", 3},
                                                        {"remove", 2},
                                                        {"remove_all", 2},
                                                        {"rename", 3},
                                                        {"space", 2},
                                                        {"status", 2},
                                                        {"symlink_status", 2},
                                                        {"temp_directory_path", 1}};
  static const std::regex k_call(R"((?:\bfs|std::filesystem)::(\w+)(?: \w+)?[({])");
  std::vector<std::string> found;
  for (std::sregex_iterator call(text.begin(), text.end(), k_call), end; call != end; ++call) {
    const auto quiet = k_quiet.find((*call)[1]);
    if (quiet == k_quiet.end()) continue;
    const size_t count = arguments(text, size_t(call->position() + call->length()));
    // An iterator without arguments is the end iterator.
    if (count == 0 && quiet->first.ends_with("iterator")) continue;
    if (count < quiet->second)
      found.push_back(std::to_string(line_of(text, size_t(call->position()))) + ": " + quiet->first);
  }
  static const std::regex k_entry(R"((?:->|\.)(is_regular_file|is_directory|is_symlink|file_size)\(\))");
  for (std::sregex_iterator call(text.begin(), text.end(), k_entry), end; call != end; ++call)
    found.push_back(std::to_string(line_of(text, size_t(call->position()))) + ": " + (*call)[1].str());
  static const std::regex k_loop(
      R"(for \([^;)]*: *(?:fs|std::filesystem)::(?:recursive_)?directory_iterator)");
  for (std::sregex_iterator loop(text.begin(), text.end(), k_loop), end; loop != end; ++loop)
    found.push_back(std::to_string(line_of(text, size_t(loop->position()))) + ": a loop over a folder");
  return found;
}

/// The program's files that violate `rule`, with the violations.
std::string violations(const std::function<std::vector<std::string>(const std::string&)>& rule) {
  const fs::path root = LUCERNA_SOURCE_DIR;
  std::string all;
  size_t files = 0;
  for (const char* folder : {"app", "ui", "renderer"})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string ending = entry.path().extension().string();
      if (ending != ".h" && ending != ".cpp") continue;
      ++files;
      if (entry.path().filename() == "json_text.h") continue;
      for (const std::string& found : rule(code_of(read(entry.path()))))
        all += entry.path().lexically_relative(root).string() + ":" + found + "\n";
    }
  REQUIRE(files > 300);
  return all;
}

/// Files of the repository with one of these endings.
std::vector<fs::path> files_ending_in(const std::vector<std::string>& endings) {
  const fs::path root = LUCERNA_SOURCE_DIR;
  std::vector<fs::path> files{root / "README.md"};
  for (const char* folder : {"app", "assets", "renderer", "scenes", "shaders", "tests", "ui"})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.is_regular_file() && std::count(endings.begin(), endings.end(), entry.path().extension()))
        files.push_back(entry.path());
  return files;
}

size_t words_of(const std::string& text) {
  std::istringstream in(text);
  return size_t(std::distance(std::istream_iterator<std::string>(in), {}));
}

/// Lines with paragraphs or items of lists of a page that have more words, without code, tables and headings.
std::vector<std::string> long_paragraphs(const std::string& page, size_t most) {
  std::vector<std::string> found;
  std::istringstream in(page);
  std::string paragraph;
  int line = 0, first = 1;
  bool code = false;
  const auto end = [&] {
    if (const size_t words = words_of(paragraph); words > most)
      found.push_back(std::to_string(first) + ": " + std::to_string(words) + " words");
    paragraph.clear();
  };
  for (std::string text; std::getline(in, text);) {
    ++line;
    const size_t begin = std::min(text.find_first_not_of(' '), text.size());
    const std::string words = text.substr(begin);
    const size_t number = words.find_first_not_of("0123456789");
    const bool item = words.starts_with("- ") || words.starts_with("* ") ||
                      (number > 0 && number < words.size() && words.compare(number, 2, ". ") == 0);
    const bool fence = words.starts_with("```"), other = words.empty() || words[0] == '#' || words[0] == '|';
    if (fence || code || other || item) end();
    if (fence) code = !code;
    if (fence || code || other) continue;
    if (paragraph.empty()) first = line;
    paragraph += text + "\n";
  }
  end();
  return found;
}

}  // namespace

TEST_CASE("JSON is written by json_text only, which no name from a file can make throw") {
  const auto dumps = [](const std::string& text) {
    std::vector<std::string> found;
    for (size_t at = text.find("dump("); at != std::string::npos; at = text.find("dump(", at + 1))
      if (at > 0 && (text[at - 1] == '.' || text[at - 1] == '>'))
        found.push_back(std::to_string(line_of(text, at)) + ": dump");
    return found;
  };
  CHECK(dumps("a;\nx.dump(2)") == std::vector<std::string>{"2: dump"});
  CHECK(dumps("json_text(x, 2)").empty());
  CHECK(violations(dumps) == "");
}

TEST_CASE("std::filesystem is called in the forms that do not throw") {
  using Found = std::vector<std::string>;
  CHECK(throwing_calls("if (fs::exists(f)) x();") == Found{"1: exists"});
  CHECK(throwing_calls("std::filesystem::absolute(a.text(\"file\", 2))") == Found{"1: absolute"});
  CHECK(throwing_calls("\nfs::file_size(f, error); fs::rename(a, b);") == Found{"2: rename"});
  CHECK(throwing_calls("fs::current_path(error) != fs::directory_iterator()").empty());
  CHECK(throwing_calls("for (const auto& e : fs::directory_iterator(f, error)) e.is_directory();").size() ==
        2);
  CHECK(violations(throwing_calls) == "");
}

TEST_CASE("no page has a paragraph of more than 90 words; the first page is short") {
  CHECK(long_paragraphs("a b c\nd\n\n| a b c d e |\n# a b c d e\n- a b c d e\n- f\n", 3) ==
        std::vector<std::string>{"1: 4 words", "6: 6 words"});
  CHECK(long_paragraphs("```\na b c d\n```\n1. a b\n2. c d", 3).empty());
  size_t pages = 0;
  for (const fs::path& file : files_ending_in({".md"})) {
    INFO(file);
    CHECK(long_paragraphs(read(file), 90) == std::vector<std::string>{});
    ++pages;
  }
  CHECK(pages >= 15);
  const std::string first = read(fs::path(LUCERNA_SOURCE_DIR) / "README.md");
  CHECK(words_of(first) <= 700);
  size_t pictures = 0;
  for (size_t at = first.find("!["); at != std::string::npos; at = first.find("![", at + 1)) ++pictures;
  CHECK(pictures <= 4);
}

TEST_CASE("sources have none of the words that readers had to learn") {
  // In two parts, so that a search for them does not find this file.
  std::set<std::string> words;
  for (const auto& [a, b] : std::initializer_list<std::pair<const char*, const char*>>{{"to", "ld"},
                                                                                       {"hee", "d"},
                                                                                       {"hee", "ds"},
                                                                                       {"spo", "il"},
                                                                                       {"spo", "ils"},
                                                                                       {"spo", "iled"},
                                                                                       {"some", "body"},
                                                                                       {"no", "body"},
                                                                                       {"make", "_do"},
                                                                                       {"a", "new"}})
    words.insert(std::string(a) + b);
  const auto found_in = [&](const std::string& text) {
    std::string found, word;
    for (const char c : text + "\n")
      if (std::isalpha(static_cast<unsigned char>(c)) || c == '_') {
        word += char(std::tolower(static_cast<unsigned char>(c)));
      } else if (!word.empty()) {
        if (words.contains(word)) found += " " + word;
        word.clear();
      }
    return found;
  };
  for (const std::string& word : words) CHECK(found_in("(" + word + "), re" + word) == " " + word);
  std::string all;
  for (const fs::path& file : files_ending_in({".h", ".cpp", ".glsl", ".comp", ".py", ".md"}))
    if (const std::string found = found_in(read(file)); !found.empty())
      all += file.string() + ":" + found + "\n";
  CHECK(all == "");
}

}  // namespace source_rules_tests
