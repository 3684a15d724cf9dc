#include "commands/expectation.h"

#include <algorithm>
#include <cassert>

#include "base/error.h"

namespace lucerna::commands {

WordReader::WordReader(const std::string& text) {
  for (Word& word : split(text)) words_.push_back(std::move(word.text));
}

bool WordReader::take(const std::string& word) {
  if (done() || words_[at_] != word) return false;
  ++at_;
  return true;
}

std::string WordReader::text(const std::string& what) {
  if (done()) refuse(what);
  return words_[at_++];
}

double WordReader::number(const std::string& what, double lo, double hi) {
  double value = 0;
  if (done() || !read_number(words_[at_], value) || value < lo || value > hi) refuse(what);
  ++at_;
  return value;
}

void WordReader::end(const std::string& expected) {
  if (!done()) refuse(expected);
}

void WordReader::refuse(const std::string& expected) const {
  if (done()) throw Error("", fmt::format("word {} is missing: expected {}", at_ + 1, expected));
  throw Error("", fmt::format("word {} ('{}'): expected {}", at_ + 1, words_[at_], expected));
}

void Expectations::add(ExpectKind kind) {
  assert(!kinds_.count(kind.name) && kind.read);
  kinds_.emplace(kind.name, std::move(kind));
}

const ExpectKind& Expectations::kind_of(const std::string& word) const {
  const auto named = kinds_.find(word);
  return named != kinds_.end() ? named->second : kinds_.at("");
}

Check Expectations::read(const std::string& text, const ExpectContext& context) const {
  WordReader words(text);
  if (words.done()) words.refuse("a value or one of the kinds of 'help expect'");
  const ExpectKind& kind = kind_of(words.remaining()[0]);
  if (!kind.name.empty()) words.skip(1);
  return kind.read(words, context);
}

bool Expectations::needs_window(const std::string& text) const {
  const std::vector<Word> words = split(text);
  return !words.empty() && kind_of(words[0].text).needs_window;
}

std::vector<std::string> Expectations::suggestions(const std::vector<std::string>& before) const {
  if (before.empty()) {
    std::vector<std::string> list = kinds_.at("").names({});
    for (const auto& [name, kind] : kinds_)
      if (!name.empty()) list.push_back(name);
    return list;
  }
  const ExpectKind& kind = kind_of(before[0]);
  if (!kind.names) return {};
  return kind.names({before.begin() + (kind.name.empty() ? 0 : 1), before.end()});
}

std::string Expectations::manual() const {
  std::string text;
  for (const auto& [name, kind] : kinds_) text += fmt::format("\n  expect {}\n    {}", kind.usage, kind.help);
  return text;
}

}  // namespace lucerna::commands
