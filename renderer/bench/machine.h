#pragma once
// Description of the measuring machine.
#include <string>

namespace lucerna::bench {

struct Machine {
  std::string cpu, system;  ///< "unknown" if not available
  unsigned cores = 0;       ///< logical, that this process may use
  double memory_gib = 0;
};
Machine this_machine();

/// Programs that wanted to run in the last minute, on average, this one included; < 0: not known.
double load_average();

/// "2026-11-21 14:30 UTC".
std::string now_utc();

}  // namespace lucerna::bench
