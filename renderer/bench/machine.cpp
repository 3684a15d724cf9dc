#include "bench/machine.h"

#include <sched.h>
#include <sys/utsname.h>

#include <cstdlib>
#include <ctime>
#include <fstream>

namespace lucerna::bench {
namespace {

/// Text after the separator in the first line that begins with `key`.
std::string find_line(const char* file, const std::string& key, char separator) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(key)) continue;
    const size_t at = line.find(separator);
    if (at == std::string::npos) continue;
    const size_t begin = line.find_first_not_of(" \t\"", at + 1);
    const size_t end = line.find_last_not_of(" \t\"");
    if (begin != std::string::npos) return line.substr(begin, end + 1 - begin);
  }
  return "";
}

}  // namespace

Machine this_machine() {
  Machine m;
  m.cpu = find_line("/proc/cpuinfo", "model name", ':');
  if (m.cpu.empty()) m.cpu = "unknown";
  m.system = find_line("/etc/os-release", "PRETTY_NAME", '=');
  if (utsname name{}; uname(&name) == 0)
    m.system += (m.system.empty() ? "" : ", ") + std::string(name.sysname) + " " + name.release;
  if (m.system.empty()) m.system = "unknown";
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) m.cores = unsigned(CPU_COUNT(&set));
  m.memory_gib = std::strtod(find_line("/proc/meminfo", "MemTotal", ':').c_str(), nullptr) / (1 << 20);
  return m;
}

double load_average() {
  double load = -1;
  return getloadavg(&load, 1) == 1 ? load : -1;
}

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &utc);
  return text;
}

}  // namespace lucerna::bench
