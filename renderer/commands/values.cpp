#include "commands/values.h"

#include <cassert>

#include "base/error.h"
#include "commands/text.h"
#include "plan/settings.h"

namespace lucerna::commands {

void Values::add(Value value) {
  assert(!values_.count(value.name) && !plan::find_option(value.name) && value.read);
  values_.emplace(value.name, std::move(value));
}

ValueWords Values::take(std::vector<std::string>& words) const {
  if (words.empty()) throw Error("", "a value is missing; 'help values' lists them");
  ValueWords taken{words[0], {}};
  const auto known = values_.find(words[0]);
  if (known == values_.end() && !plan::find_option(words[0])) {
    const std::string near = suggestion(words[0], suggestions({}));
    throw_error("", "word 1: there is no value '{}'{}", words[0],
                near.empty() ? "; 'help values' lists them" : near);
  }
  const size_t count = known == values_.end() ? 0 : known->second.words.size();
  for (size_t i = 0; i < count; ++i) {
    if (i + 1 >= words.size())
      throw_error("", "{}: {} is missing; expected {} {}", words[0], known->second.words[i], words[0],
                  fmt::join(known->second.words, " "));
    taken.words.push_back(words[i + 1]);
  }
  words.erase(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(count + 1));
  return taken;
}

std::vector<std::string> Values::suggestions(const std::vector<std::string>& before) const {
  std::vector<std::string> list;
  if (before.empty()) {
    for (const auto& [name, value] : values_) list.push_back(name);
    for (const OptionInfo& o : plan::options()) list.push_back(o.key);
    return list;
  }
  const auto known = values_.find(before[0]);
  if (known == values_.end() || !known->second.names || before.size() > known->second.words.size()) return {};
  return known->second.names({before.begin() + 1, before.end()});
}

std::string Values::manual() const {
  std::string text = "Values, for 'get VALUE' and 'expect VALUE is X', besides the settings:";
  for (const auto& [name, value] : values_) {
    text += "\n  " + name;
    for (const std::string& word : value.words) text += " " + word;
    text += ": " + value.help;
  }
  return text;
}

}  // namespace lucerna::commands
