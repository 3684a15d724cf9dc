#pragma once
// Options as data: name, type, range, unit, default and help in one row. Window, command line, settings.json,
// scripts and documentation use these tables (joined by plan/settings.h); an unknown key or a wrong value is
// a located Error that states what is valid.
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
  bool other_names = false;          ///< choice: names defined by another setting are valid too
  std::string help;                  ///< one sentence
  std::string label;                 ///< beside its control in the window; "": made from the key
  bool restarts = true;              ///< a change restarts the picture (false: display only, or it continues)
  /// A change affects how the light is computed, not the light: the old picture may stay until the new one is
  /// better.
  bool same_light = false;
  /// integer and real: meaning of 0 where it is no amount ("automatic", "all lamps"); "": 0 is an amount.
  std::string at_zero{};
};

// Factories for rows of a table.
OptionInfo integer_option(const char* key, int64_t fallback, double lo, double hi, const char* unit,
                          const char* help, const char* label = "");
OptionInfo real_option(const char* key, const char* fallback, double lo, double hi, const char* unit,
                       const char* help, const char* label = "");
OptionInfo boolean_option(const char* key, const char* fallback, const char* help, const char* label = "");
OptionInfo choice_option(const char* key, const char* fallback, std::vector<std::string> choices,
                         const char* unit, const char* help, const char* label = "");
OptionInfo text_option(const char* key, const char* help);
/// Likewise, but a change does not restart the picture.
OptionInfo without_restart(OptionInfo option);
/// Likewise, with same_light set.
OptionInfo of_same_light(OptionInfo option);

/// Likewise, with `meaning` as at_zero.
OptionInfo with_zero(OptionInfo option, const char* meaning);

/// The valid values, for display: "path|off", "true|false", "1 to 64 vertices"; "" for a text.
std::string describe_values(const OptionInfo& option);
/// Label of the control: OptionInfo::label, else the key without its first word.
std::string option_label(const OptionInfo& option);
/// Splits "KEY=VALUE" without checking. Throws Error located at `where` if there is no '='.
std::pair<std::string, std::string> split_change(const std::string& change, const std::string& where);
/// Null if the table has no such key.
const OptionInfo* find_option(std::span<const OptionInfo> table, const std::string& key);

/// Values of all options of a table; initially the defaults.
class OptionValues {
 public:
  /// The table must outlive it.
  explicit OptionValues(std::span<const OptionInfo> table);
  /// Checks and stores a value. `where` names its source for the message ("--set", "settings.json").
  void set(const std::string& key, const std::string& value, const std::string& where = "setting");
  // A key that the table does not have throws std::out_of_range.
  const std::string& text(const std::string& key) const { return values_.at(key); }
  double real(const std::string& key) const;
  int64_t integer(const std::string& key) const { return static_cast<int64_t>(real(key)); }
  bool boolean(const std::string& key) const { return values_.at(key) == "true"; }
  /// Index into OptionInfo::choices; their number for another name (OptionInfo::other_names).
  int choice(const std::string& key) const;
  const std::map<std::string, std::string>& all() const { return values_; }

 private:
  std::span<const OptionInfo> table_;
  std::map<std::string, std::string> values_;
};

}  // namespace lucerna
