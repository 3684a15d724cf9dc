#include "commands/registry.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/error.h"
#include "base/log.h"

namespace lucerna::commands {
namespace {

std::string range_text(const Parameter& p) {
  // Limits that only keep numbers sane are not mentioned.
  const bool low = p.lo > -1e9, high = p.hi < 1e9;
  const std::string unit = p.unit.empty() ? "" : " " + p.unit;
  if (low && high) return fmt::format(" from {} to {}{}", p.lo, p.hi, unit);
  if (low) return fmt::format(" of at least {}{}", p.lo, unit);
  if (high) return fmt::format(" of at most {}{}", p.hi, unit);
  return unit.empty() ? "" : " in" + unit;
}

std::string kind_text(const Parameter& p) {
  switch (p.type) {
    case Type::boolean:
      return "true or false";
    case Type::integer:
      return "a whole number" + range_text(p);
    case Type::real:
      return "a number" + range_text(p);
    case Type::vector:
      return "three numbers x,y,z" + (range_text(p).empty() ? "" : ", each" + range_text(p));
    case Type::choice:
      return fmt::format("one of {}", fmt::join(p.choices, ", "));
    case Type::text:
      return "a text on one line";
    case Type::rest:
      return "the rest of the line";
    case Type::file:
      return p.choices.empty() ? "a file"
             : p.writes        ? fmt::format("a file name that ends in {}", fmt::join(p.choices, " or "))
                               : fmt::format("a file ({})", fmt::join(p.choices, ", "));
  }
  return "";
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

bool in_range(double v, const Parameter& p) { return v >= p.lo && v <= p.hi; }

/// The value in its one form. Throws Error when it is not of the parameter's type.
std::string canonical(const Command& c, const Parameter& p, const std::string& text,
                      const std::string& where) {
  const auto refuse = [&](const std::string& more = "") {
    throw_error(where, "{}: {} = '{}': expected {}{}", c.name, p.name, text, kind_text(p), more);
  };
  double number = 0;
  vec3 vector{0};
  switch (p.type) {
    case Type::boolean:
      if (text == "true" || text == "on") return "true";
      if (text == "false" || text == "off") return "false";
      refuse();
      break;
    case Type::integer:
      if (!read_number(text, number) || number != std::floor(number) || std::abs(number) > 9e15 ||
          !in_range(number, p))
        refuse();
      return fmt::format("{}", static_cast<int64_t>(number));
    case Type::real:
      if (!read_number(text, number) || !in_range(number, p)) refuse();
      return number_text(number);
    case Type::vector:
      if (!read_vector(text, vector) || !in_range(vector.x, p) || !in_range(vector.y, p) ||
          !in_range(vector.z, p))
        refuse();
      return vector_text(vector);
    case Type::choice:
      if (std::find(p.choices.begin(), p.choices.end(), text) == p.choices.end())
        refuse(suggestion(text, p.choices));
      return text;
    case Type::file:
      if (text.empty() ||
          (p.writes && std::none_of(p.choices.begin(), p.choices.end(), [&](const std::string& ending) {
             return text.ends_with(ending) && text.size() > ending.size();
           })))
        refuse();
      [[fallthrough]];
    case Type::rest:
    case Type::text:
      if (text.find_first_of("\r\n") != std::string::npos) refuse();
      return text;
  }
  return text;
}

const Parameter* find_parameter(const Command& c, const std::string& name) {
  for (const Parameter& p : c.parameters)
    if (p.name == name) return &p;
  return nullptr;
}

/// End of a word's name: "intensity=12" -> 9; npos for a word that is only a value.
size_t name_end(const Word& word) {
  const size_t at = word.text.find('=');
  if (at == std::string::npos || at == 0 || at >= word.plain) return std::string::npos;
  for (size_t i = 0; i < at; ++i)
    if (!std::islower(static_cast<unsigned char>(word.text[i])) && word.text[i] != '_')
      return std::string::npos;
  return at;
}

}  // namespace

bool Parameter::names_file(const std::string& value) const {
  return type == Type::file && std::find(words.begin(), words.end(), value) == words.end();
}

Parameter time_limit() {
  return {.name = "limit",
          .type = Type::real,
          .help = "maximum time; default 300",
          .lo = 1,
          .hi = 86400,
          .unit = "seconds",
          .optional = true};
}

Parameter file_named(std::vector<std::string> endings) {
  return {.name = "file", .type = Type::file, .choices = std::move(endings)};
}

Parameter file_to_write(std::vector<std::string> endings) {
  return {.name = "file", .type = Type::file, .choices = std::move(endings), .writes = true};
}

double Arguments::real(const std::string& name) const {
  double value = 0;
  read_number(values_.at(name), value);
  return value;
}

vec3 Arguments::vector(const std::string& name) const {
  vec3 value{0};
  read_vector(values_.at(name), value);
  return value;
}

void Registry::add(Command command) {
  assert(!commands_.count(command.name) && (command.run || command.answer));
  if (!command.run)
    command.run = [answer = command.answer](const Arguments& a) { log::info("{}", answer(a)); };
  commands_.emplace(command.name, std::move(command));
}

void Registry::add_prefix(const std::string& word, const std::string& line_head) {
  prefixes_[word] = line_head;
}

const Command* Registry::find(const std::string& name) const {
  const auto found = commands_.find(name);
  return found == commands_.end() ? nullptr : &found->second;
}

std::vector<std::string> Registry::names() const {
  std::vector<std::string> list;
  for (const auto& [name, command] : commands_) list.push_back(name);
  for (const auto& [word, head] : prefixes_) list.push_back(word);
  return list;
}

Arguments Registry::bind(const Command& c, const std::string& line, std::vector<Word> words,
                         const std::string& where) const {
  Arguments result;
  std::vector<const Parameter*> places;
  for (const Parameter& p : c.parameters)
    if (!p.optional) places.push_back(&p);
  const bool options = places.size() < c.parameters.size();
  for (const Parameter& p : c.parameters)
    if (p.optional) places.push_back(&p);
  const auto give = [&](const Parameter& p, const std::string& text) {
    if (!result.values_.emplace(p.name, canonical(c, p, text, where)).second)
      throw_error(where, "{}: {} is given twice", c.name, p.name);
  };
  size_t place = 0;
  for (size_t i = 1; i < words.size(); ++i) {
    const Word& word = words[i];
    if (place < places.size() && places[place]->type == Type::rest) {
      give(*places[place], text_after(line, i));
      break;
    }
    if (const size_t end = name_end(word); end != std::string::npos) {
      const std::string name = word.text.substr(0, end);
      if (const Parameter* p = find_parameter(c, name)) {
        give(*p, word.text.substr(end + 1));
        continue;
      }
      if (options) {
        std::vector<std::string> known;
        for (const Parameter& p : c.parameters) known.push_back(p.name);
        throw_error(where, "{}: there is no parameter '{}'{}", c.name, name, suggestion(name, known));
      }
    }
    while (place < places.size() && result.has(places[place]->name)) ++place;
    if (place == places.size())
      throw_error(where, "{}: '{}' is one word too many; expected {}", c.name, word.text, usage(c));
    give(*places[place++], word.text);
  }
  for (const Parameter* p : places)
    if (!p->optional && !result.has(p->name))
      throw_error(where, "{}: {} is missing; expected {}", c.name, p->name, usage(c));
  return result;
}

Line Registry::parse(const std::string& line, const std::string& where) const {
  std::vector<Word> words = split(line, where);
  if (words.empty()) return {};
  // KEY=VALUE means KEY VALUE if KEY is a prefix, or follows the command of a prefix.
  const auto part = [&](size_t i) {
    if (i >= words.size()) return;
    const size_t at = words[i].text.find('=');
    if (at == std::string::npos || at >= words[i].plain) return;
    const std::string head = words[i].text.substr(0, at);
    const auto prefix = prefixes_.find(head);
    if (prefix == prefixes_.end()) return;
    if (i > 0 && !prefix->second.starts_with(words[0].text + " ")) return;
    const std::string value = words[i].text.substr(at + 1);
    words[i] = {head, head.size()};
    words.insert(words.begin() + static_cast<std::ptrdiff_t>(i) + 1, Word{value, 0});
  };
  part(0);
  if (const auto prefix = prefixes_.find(words[0].text);
      prefix != prefixes_.end() && !commands_.count(words[0].text)) {
    const std::vector<Word> head = split(prefix->second);
    words.erase(words.begin());
    words.insert(words.begin(), head.begin(), head.end());
  } else {
    part(1);
  }
  const Command* command = find(words[0].text);
  if (!command) {
    std::string near = suggestion(words[0].text, names());
    if (near.empty()) near = "; 'help' lists the commands";
    throw_error(where, "unknown command '{}'{}", words[0].text, near);
  }
  Line result{command, bind(*command, line, std::move(words), where)};
  if (command->check) {
    try {
      command->check(result.arguments);
    } catch (const Error& error) {
      throw Error(where, command->name + ": " + error.what());
    }
  }
  return result;
}

std::string Registry::print(const Line& line) const {
  if (!line.command) return "";
  std::string text = line.command->name;
  for (const Parameter& p : line.command->parameters) {
    if (!line.arguments.has(p.name)) continue;
    text += ' ';
    if (p.type == Type::rest) {
      text += line.arguments.text(p.name);
      continue;
    }
    if (p.optional) text += p.name + '=';
    text += quote(line.arguments.text(p.name));
  }
  return text;
}

std::string Registry::target(const Line& line) const {
  if (!line.command) return "";
  std::string text = line.command->name;
  for (const Parameter& p : line.command->parameters) {
    if (!line.arguments.has(p.name)) continue;
    if (p.which) text += ' ' + quote(line.arguments.text(p.name));
    if (p.optional) text += ' ' + p.name;
  }
  return text;
}

std::string Registry::usage(const Command& c) const {
  std::string text = c.name;
  for (const Parameter& p : c.parameters) {
    if (!p.optional) {
      text += ' ' + upper(p.name);
      continue;
    }
    std::string form = p.unit.empty() ? upper(p.name) : p.unit;
    if (p.type == Type::boolean) form = "true|false";
    if (p.type == Type::choice) form = fmt::format("{}", fmt::join(p.choices, "|"));
    if (p.type == Type::vector) form = "x,y,z";
    text += fmt::format(" [{}={}]", p.name, form);
  }
  return text;
}

std::string Registry::manual(const Command& c) const {
  std::string text = usage(c) + "\n  " + c.help;
  for (const Parameter& p : c.parameters)
    text += fmt::format("\n  {}: {}{}", p.optional ? p.name : upper(p.name),
                        p.help.empty() ? "" : p.help + "; ", kind_text(p));
  return text;
}

std::vector<std::string> Registry::complete(const std::string& line) const {
  std::vector<Word> words;
  try {
    words = split(line);
  } catch (const Error&) {
    return {};
  }
  const bool fresh = line.empty() || line.back() == ' ';
  if (fresh) words.push_back({});
  const std::string typed = words.empty() ? "" : words.back().text;
  std::vector<std::string> list;
  const auto offer = [&](const std::vector<std::string>& names, const std::string& start,
                         const std::string& head = "") {
    for (const std::string& name : names)
      if (name.starts_with(start)) list.push_back(head + quote(name));
  };
  if (words.size() <= 1) {
    offer(names(), typed);
    return list;
  }
  if (const auto prefix = prefixes_.find(words[0].text); prefix != prefixes_.end() && !find(words[0].text)) {
    const std::vector<Word> head = split(prefix->second);
    words.erase(words.begin());
    words.insert(words.begin(), head.begin(), head.end());
  }
  const Command* c = find(words[0].text);
  if (!c) return {};
  const auto values = [&](const Parameter& p, const std::string& start, const std::string& head,
                          const std::vector<std::string>& before) {
    if (p.type == Type::boolean) offer({"true", "false"}, start, head);
    if (p.type == Type::choice) offer(p.choices, start, head);
    if (p.type == Type::file)
      offer(p.words, start, head), offer(paths_starting(start, p.choices), start, head);
    if (p.names) offer(p.names(before), start, head);
  };
  if (const size_t end = name_end(words.back()); end != std::string::npos) {
    const std::string name = typed.substr(0, end);
    if (const Parameter* p = find_parameter(*c, name)) values(*p, typed.substr(end + 1), name + "=", {});
    return list;
  }
  // Position of the last word among the unnamed ones.
  std::vector<std::string> before;
  for (size_t i = 1; i + 1 < words.size(); ++i)
    if (name_end(words[i]) == std::string::npos) before.push_back(words[i].text);
  size_t place = 0;
  for (const bool optional : {false, true})
    for (const Parameter& p : c->parameters)
      if (p.optional == optional &&
          (place == before.size() || (place < before.size() && p.type == Type::rest)))
        values(p, typed, "", before), ++place;
      else if (p.optional == optional)
        ++place;
  if (list.empty())
    for (const Parameter& p : c->parameters) {
      const bool given = std::any_of(words.begin() + 1, words.end() - 1,
                                     [&](const Word& w) { return w.text.starts_with(p.name + "="); });
      if (p.optional && !given && p.name.starts_with(typed)) list.push_back(p.name + "=");
    }
  return list;
}

}  // namespace lucerna::commands
