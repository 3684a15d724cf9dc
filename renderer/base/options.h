#pragma once
// Options as data: name, type, range, unit, default, help in one row. Tables of rows feed window, command
// line, settings.json, scripts and documentation (plan/settings.h joins them into one); an unknown key or a
// wrong value is a located Error that says what is valid.
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace lucerna {

enum class OptionType { choice, integer, real, boolean, text };

struct OptionInfo {
  std::string key;  ///< dotted: "components.primary"
  OptionType type = OptionType::real;
  std::string fallback;              ///< the default, as text
  double lo = 0, hi = 0;             ///< integer and real, inclusive
  std::string unit;                  ///< "EV", "samples", "" ...
  std::vector<std::string> choices;  ///< choice
  std::string help;                  ///< one sentence
  std::string label;                 ///< beside its control in the window; "": made from the key
  bool restarts = true;  ///< a change makes the image start afresh (false: its display, or it goes on)
  /// The light stays the same, another way or amount of computing it: until the new picture is better the old
  /// one may be shown.
  bool same_light = false;
  /// integer and real: what the least value means, where that is 0 and no amount like the others
  /// ("automatic", "all lamps"); "": it is one.
  std::string at_zero{};
};

// Rows, in short.
OptionInfo integer_option(const char* key, int64_t fallback, double lo, double hi, const char* unit,
                          const char* help, const char* label = "");
OptionInfo real_option(const char* key, const char* fallback, double lo, double hi, const char* unit,
                       const char* help, const char* label = "");
OptionInfo boolean_option(const char* key, const char* fallback, const char* help, const char* label = "");
OptionInfo choice_option(const char* key, const char* fallback, std::vector<std::string> choices,
                         const char* unit, const char* help, const char* label = "");
OptionInfo text_option(const char* key, const char* help);
/// The same option, a change of which lets the image go on.
OptionInfo without_restart(OptionInfo option);
/// The same option, of how light is computed (same_light).
OptionInfo of_same_light(OptionInfo option);

/// The same option, with that for its value 0 (at_zero).
OptionInfo with_zero(OptionInfo option, const char* meaning);

/// What values an option takes, for people: "path|off", "true|false", "1 to 64 vertices"; "" for a text.
std::string describe_values(const OptionInfo& option);
/// Name of its control: its label, or else its key without the first word.
std::string option_label(const OptionInfo& option);
/// Key and value of "KEY=VALUE", unchecked. Without a '=': an Error located at `where`.
std::pair<std::string, std::string> split_change(const std::string& change, const std::string& where);
/// Null when there is no such key.
const OptionInfo* find_option(std::span<const OptionInfo> table, const std::string& key);

/// A value for every option of a table; starts with the defaults.
class OptionValues {
 public:
  /// The table must outlive it.
  explicit OptionValues(std::span<const OptionInfo> table);
  /// Checks and stores. `where` locates the source in the message ("--set", "settings.json", ...).
  void set(const std::string& key, const std::string& value, const std::string& where = "setting");
  // A key that the table does not have throws std::out_of_range.
  const std::string& text(const std::string& key) const { return values_.at(key); }
  double real(const std::string& key) const;
  int64_t integer(const std::string& key) const { return static_cast<int64_t>(real(key)); }
  bool boolean(const std::string& key) const { return values_.at(key) == "true"; }
  /// Index into OptionInfo::choices.
  int choice(const std::string& key) const;
  const std::map<std::string, std::string>& all() const { return values_; }

 private:
  std::span<const OptionInfo> table_;
  std::map<std::string, std::string> values_;
};

}  // namespace lucerna
