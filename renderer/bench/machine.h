#pragma once
// The machine that measured, as far as it tells.
#include <string>

namespace lucerna::bench {

struct Machine {
  std::string cpu, system;  ///< "unknown" where it cannot be told
  unsigned cores = 0;       ///< logical, that this process may use
  double memory_gib = 0;
};
Machine this_machine();

/// Programs that wanted to run in the last minute, on average, this one included; < 0: not known.
double load_average();

/// "2026-11-21 14:30 UTC".
std::string now_utc();

}  // namespace lucerna::bench
