#include "base/options.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace lucerna {
namespace {

bool parse_number(const std::string& text, double& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end && std::isfinite(value);
}

}  // namespace

OptionInfo integer_option(const char* key, int64_t fallback, double lo, double hi, const char* unit,
                          const char* help, const char* label) {
  return {.key = key,
          .type = OptionType::integer,
          .fallback = std::to_string(fallback),
          .lo = lo,
          .hi = hi,
          .unit = unit,
          .choices = {},
          .help = help,
          .label = label};
}

OptionInfo real_option(const char* key, const char* fallback, double lo, double hi, const char* unit,
                       const char* help, const char* label) {
  return {.key = key,
          .type = OptionType::real,
          .fallback = fallback,
          .lo = lo,
          .hi = hi,
          .unit = unit,
          .choices = {},
          .help = help,
          .label = label};
}

OptionInfo boolean_option(const char* key, const char* fallback, const char* help, const char* label) {
  return {.key = key,
          .type = OptionType::boolean,
          .fallback = fallback,
          .choices = {},
          .help = help,
          .label = label};
}

OptionInfo choice_option(const char* key, const char* fallback, std::vector<std::string> choices,
                         const char* unit, const char* help, const char* label) {
  return {.key = key,
          .type = OptionType::choice,
          .fallback = fallback,
          .unit = unit,
          .choices = std::move(choices),
          .help = help,
          .label = label};
}

OptionInfo text_option(const char* key, const char* help) {
  return {.key = key, .type = OptionType::text, .fallback = "", .choices = {}, .help = help, .label = ""};
}

OptionInfo without_restart(OptionInfo option) {
  option.restarts = false;
  return option;
}

OptionInfo of_same_light(OptionInfo option) {
  option.same_light = true;
  return option;
}

OptionInfo with_zero(OptionInfo option, const char* meaning) {
  option.at_zero = meaning;
  return option;
}

std::string describe_values(const OptionInfo& o) {
  switch (o.type) {
    case OptionType::choice:
      return fmt::format("{}", fmt::join(o.choices, "|"));
    case OptionType::boolean:
      return "true|false";
    case OptionType::text:
      return "";
    default:
      return fmt::format("{} to {}{}{}", o.lo, o.hi, o.unit.empty() ? "" : " ", o.unit);
  }
}

std::string option_label(const OptionInfo& option) {
  if (!option.label.empty()) return option.label;
  const size_t dot = option.key.find('.');
  std::string name = dot == std::string::npos ? option.key : option.key.substr(dot + 1);
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '.' || c == '_'; }, ' ');
  if (!name.empty()) name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

std::pair<std::string, std::string> split_change(const std::string& change, const std::string& where) {
  const size_t at = change.find('=');
  if (at == std::string::npos) throw_error(where, "'{}': expected key=value", change);
  return {change.substr(0, at), change.substr(at + 1)};
}

const OptionInfo* find_option(std::span<const OptionInfo> table, const std::string& key) {
  for (const OptionInfo& option : table)
    if (option.key == key) return &option;
  return nullptr;
}

OptionValues::OptionValues(std::span<const OptionInfo> table) : table_(table) {
  for (const OptionInfo& option : table) values_[option.key] = option.fallback;
}

void OptionValues::set(const std::string& key, const std::string& value, const std::string& where) {
  const OptionInfo* option = find_option(table_, key);
  if (!option) {
    std::vector<std::string> keys;
    for (const OptionInfo& known : table_) keys.push_back(known.key);
    throw_error(where, "unknown setting '{}'; known are {}", key, fmt::join(keys, ", "));
  }
  double number = 0;
  switch (option->type) {
    case OptionType::choice:
      if (!option->other_names &&
          std::find(option->choices.begin(), option->choices.end(), value) == option->choices.end())
        throw_error(where, "{} = '{}': expected one of {}", key, value, fmt::join(option->choices, ", "));
      break;
    case OptionType::boolean:
      if (value != "true" && value != "false")
        throw_error(where, "{} = '{}': expected true or false", key, value);
      break;
    case OptionType::integer:
    case OptionType::real:
      if (!parse_number(value, number) || number < option->lo || number > option->hi ||
          (option->type == OptionType::integer && number != std::floor(number)))
        throw_error(where, "{} = '{}': expected {} from {} to {}{}{}", key, value,
                    option->type == OptionType::integer ? "a whole number" : "a number", option->lo,
                    option->hi, option->unit.empty() ? "" : " ", option->unit);
      break;
    case OptionType::text:
      break;
  }
  values_[key] = value;
}

double OptionValues::real(const std::string& key) const {
  double number = 0;
  parse_number(values_.at(key), number);
  return number;
}

int OptionValues::choice(const std::string& key) const {
  const auto& choices = find_option(table_, key)->choices;
  return static_cast<int>(std::find(choices.begin(), choices.end(), values_.at(key)) - choices.begin());
}

}  // namespace lucerna
