#include <fmt/format.h>

#include "solvers/irradiance_cache/options.h"

namespace lucerna::irradiance_cache {
namespace {

/// `set` of a setting: secondary and tertiary light from the cache, and `more` (", "KEY": VALUE ...").
std::string cached(const std::string& more = "") {
  return R"("set": {"components.secondary": "cache", "components.tertiary": "cache")" + more + "}";
}

/// A setting of a matrix.
std::string setting(const std::string& name, const std::string& about, const std::string& rest) {
  return fmt::format(R"({{"name": "{}", "about": "{}", {}}})", name, about, rest);
}

/// One curve: records of a metric, by error bounds in hundredths.
std::vector<std::string> curve(const char* name, const char* about, const char* title, const char* metric) {
  std::vector<std::string> settings;
  for (const int error : {60, 40, 30, 20, 15})
    settings.push_back(setting(
        fmt::format("{}-{}", name, error), about,
        fmt::format(R"("curve": "{}", )", title) +
            cached(fmt::format(R"(, "cache.metric": "{}", "cache.error": {})", metric, error / 100.0))));
  return settings;
}

/// Compares cached light alone with the reference. Records have little noise, so interpolation is the main
/// error. Only the metric sets the radii: in a small picture the default bounds would give most records one
/// size.
std::string cache_matrix() {
  const char* const k_head = R"({
  "name": "cache",
  "repeats": 3,
  "warmup": 1,
  "reference": {"samples": 16384},
  "set": {"components.primary": "off", "components.caustic": "off", "cache.noise": 0.03,
          "cache.max_rays": 16384, "cache.min_radius": 0, "cache.max_radius": 1},
  "budgets": {"samples": [256]},
  "scenes": [
    {"file": "cornell/cornell.gltf", "size": "128x128"},
    {"file": "teapot/teapot.gltf", "size": "128x128"},
    {"file": "hall/hall.gltf", "size": "160x90"}
  ],
  "settings": [
    {"name": "plain", "about": "path tracing, no cache"},
    )";
  const auto split = curve("split", "cache, radii by distances", "split sphere", "split-sphere");
  const auto hessian =
      curve("hessian", "cache, ellipses by the curvature of the light", "hessian", "hessian");
  return k_head + fmt::format("{},\n{}]}}", fmt::join(split, ",\n"), fmt::join(hessian, ",\n"));
}

/// Cached light alone, to a barely visible error: settings of each scene found by experiment.
std::string indirect_matrix() {
  const char* const k_head = R"({
  "name": "indirect",
  "repeats": 3,
  "warmup": 1,
  "reference": {"samples": 512},
  "set": {"components.primary": "off", "components.caustic": "off", "cache.metric": "hessian"},
  "budgets": {"seconds": [60]},
  "scenes": [
    {"file": "teapot/teapot.gltf", "size": "512x512", "budgets": {"samples": [12], "seconds": [40]},
     "set": {"cache.noise": 0.2, "cache.min_radius": 6}},
    {"file": "hall/hall.gltf", "size": "512x512", "budgets": {"samples": [144], "seconds": [60]},
     "set": {"cache.noise": 0.008, "cache.max_rays": 65536, "cache.error": 0.15, "cache.min_radius": 1,
             "cache.max_records": 300000, "cache.stop": 0.0003}},
    {"file": "sun-patch/sun-patch.gltf", "size": "512x512", "budgets": {"samples": [160], "seconds": [60]},
     "set": {"cache.noise": 0.01, "cache.max_rays": 65536, "cache.error": 0.2, "cache.min_radius": 1,
             "cache.max_records": 300000, "cache.stop": 0.0005}},
    {"file": "atrium/atrium.gltf", "size": "512x512", "budgets": {"samples": [448], "seconds": [60]},
     "set": {"cache.noise": 0.0025, "cache.max_rays": 65536, "cache.error": 0.17, "cache.min_radius": 1.5,
             "cache.max_records": 400000, "cache.passes": 11}},
    {"file": "classroom/classroom.gltf", "size": "512x512", "budgets": {"samples": [384], "seconds": [60]},
     "set": {"cache.noise": 0.0025, "cache.max_rays": 65536, "cache.error": 0.13, "cache.nearest": 0.6,
             "cache.min_radius": 0.8, "cache.max_records": 400000, "cache.stop": 0.0005, "cache.passes": 18}}
  ],
  "settings": [
    {"name": "plain", "about": "path tracing", "budget": "seconds"},
    )";
  return k_head + setting("cache", "secondary and tertiary light from a new irradiance cache", cached()) +
         "]}";
}

}  // namespace

std::vector<solvers::BenchInfo> bench_rows() {
  return {
      {"cache", "error of cached light over the number of records, by both metrics; an hour and a quarter",
       cache_matrix()},
      {"indirect",
       "speedup of cached light over path tracing to an error of 2 % in five interiors; two and a half hours",
       indirect_matrix()}};
}

std::vector<std::string> bench_settings() {
  return {
      setting("cache", "as plain, secondary and tertiary light from an irradiance cache", cached()),
      setting("cache-hessian", "as cache, radii by the curvature of the light",
              cached(R"(, "cache.metric": "hessian")")),
      setting("cache-sky", "as cache, with direct sky light on diffuse surfaces",
              cached(R"(, "components.primary": "cache")")),
  };
}

}  // namespace lucerna::irradiance_cache
