#pragma once
// Every option of the renderer, in one table: common ones (settings.cpp) and those of the solvers
// (solvers/registry.h). Window, command line, settings.json and documentation use the same table.
#include <string>
#include <vector>

#include "base/options.h"

namespace lucerna::plan {

/// The table, in display order.
const std::vector<OptionInfo>& options();
/// Null if there is no such key.
const OptionInfo* find_option(const std::string& key);

/// Values of all options; starts with the defaults.
class Settings : public OptionValues {
 public:
  Settings();
  /// All values that differ from the default, as {"key": value} JSON text.
  std::string changed_json() const;
};

}  // namespace lucerna::plan
