#include "app/verbs.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "film/io/compare.h"
#include "gpu/device.h"

namespace lucerna::app {

int devices(bool json) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const gpu::DeviceInfo& d : gpu::enumerate()) {
    const auto version = fmt::format("{}.{}.{}", d.api_version >> 22 & 0x7f, d.api_version >> 12 & 0x3ff,
                                     d.api_version & 0xfff);
    if (json) {
      list.push_back({{"index", d.index},
                      {"name", d.name},
                      {"driver", d.driver},
                      {"vulkan", version},
                      {"cpu", d.is_cpu},
                      {"discrete", d.is_discrete},
                      {"memory_mb", d.memory_bytes >> 20},
                      {"missing", d.missing}});
      continue;
    }
    std::printf(
        "%u  %s\n   %s, Vulkan %s, %s, %llu MiB\n   optional: float atomics %s, subgroups %s, external "
        "memory %s, int64 %s, float64 %s\n",
        d.index, d.name.c_str(), d.driver.c_str(), version.c_str(),
        d.is_cpu        ? "CPU"
        : d.is_discrete ? "discrete GPU"
                        : "GPU",
        (unsigned long long)(d.memory_bytes >> 20), d.optional.float_atomics ? "yes" : "no",
        d.optional.subgroups ? "yes" : "no", d.optional.external_memory ? "yes" : "no",
        d.optional.int64 ? "yes" : "no", d.optional.float64 ? "yes" : "no");
    if (!d.missing.empty()) std::printf("   cannot be used: lacks %s\n", d.missing.c_str());
  }
  if (json) std::printf("%s\n", json_text(list, 2).c_str());
  return 0;
}

namespace {
/// True for the integer formats, whose values have the curve of the display.
bool is_encoded(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  return extension != ".exr" && extension != ".hdr" && extension != ".pfm";
}
}  // namespace

int compare(const CompareArguments& a) {
  const film::FilmImage first = film::read_exr(a.a), second = film::read_exr(a.b);
  film::CompareOptions options;
  options.encoded = is_encoded(a.a) && is_encoded(a.b);
  const film::Comparison c = film::compare(first, second, a.layer, options);
  std::printf("%s\n", (a.json ? film::to_json(c) : film::to_text(c)).c_str());
  if (a.max_relmse < 0) return 0;
  // Values that are not finite have no bounded error: the figures exclude them.
  const std::string non_finite = film::non_finite_text(c);
  if (!non_finite.empty()) std::fprintf(stderr, "lucerna: compare: not finite: %s\n", non_finite.c_str());
  return non_finite.empty() && c.relmse <= a.max_relmse ? 0 : 1;
}

}  // namespace lucerna::app
