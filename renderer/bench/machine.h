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

/// Mean number of runnable programs in the last minute, including this one; < 0: unknown.
double load_average();

/// "2026-11-21 14:30 UTC".
std::string now_utc();

}  // namespace lucerna::bench
