#pragma once
// Every option of the renderer, in one table: name, type, range, unit, default, help. The same table feeds
// window, command line, settings.json and the documentation; an unknown key or a wrong value is a located
// Error that says what is valid.
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace lucerna::plan {

enum class OptionType { choice, integer, real, boolean, text };

struct OptionInfo {
  std::string key;  ///< dotted: "components.primary"
  OptionType type = OptionType::real;
  std::string fallback;              ///< the default, as text
  double lo = 0, hi = 0;             ///< integer and real, inclusive
  std::string unit;                  ///< "EV", "samples", "" ...
  std::vector<std::string> choices;  ///< choice
  std::string help;                  ///< one sentence
  bool restarts = true;  ///< a change makes the image start afresh (false: its display, or it goes on)
};

/// The table, in display order.
const std::vector<OptionInfo>& options();
/// What values an option takes, for people: "path|off", "true|false", "1 to 64 vertices"; "" for a text.
std::string describe_values(const OptionInfo& option);
/// Key and value of "KEY=VALUE", unchecked. Without a '=': an Error located at `where`.
std::pair<std::string, std::string> split_change(const std::string& change, const std::string& where);
/// Null when there is no such key.
const OptionInfo* find_option(const std::string& key);

/// Values of all options; starts with the defaults.
class Settings {
 public:
  Settings();
  /// Checks and stores. `where` locates the source in the message ("--set", "settings.json", ...).
  void set(const std::string& key, const std::string& value, const std::string& where = "setting");
  const std::string& text(const std::string& key) const;
  double real(const std::string& key) const;
  int64_t integer(const std::string& key) const;
  bool boolean(const std::string& key) const;
  /// Index into OptionInfo::choices.
  int choice(const std::string& key) const;
  /// All values that differ from the default, as {"key": value} JSON text.
  std::string changed_json() const;
  const std::map<std::string, std::string>& all() const { return values_; }

 private:
  std::map<std::string, std::string> values_;
};

}  // namespace lucerna::plan
