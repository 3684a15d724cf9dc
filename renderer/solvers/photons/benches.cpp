#include "solvers/photons/benches.h"

namespace lucerna::photons {
namespace {

/// Caustics alone, against a path-traced reference, in equal times for path tracing and photons. Where path
/// tracing does not reach an error, the report extrapolates the time by 1/t.
constexpr const char* k_caustics_matrix = R"({
  "name": "caustics",
  "repeats": 3,
  "warmup": 1,
  "reference": {"samples": 16384},
  "set": {"components.primary": "off", "components.secondary": "off", "components.tertiary": "off",
          "components.caustic": "path"},
  "budgets": {"seconds": [4, 16, 60]},
  "scenes": [
    {"file": "glass/glass.gltf", "size": "160x160"},
    {"file": "ring/ring.gltf", "size": "192x108"}
  ],
  "settings": [
    {"name": "plain", "about": "path tracing", "budget": "seconds"},
    {"name": "photons", "about": "photons, aimed", "set": {"components.caustic": "photons"}, "budget": "seconds"},
    {"name": "unaimed", "about": "photons, not aimed", "budget": "seconds",
     "set": {"components.caustic": "photons", "photons.aim": false}},
    {"name": "light", "about": "light tracing", "set": {"components.caustic": "light"}, "budget": "seconds"},
    {"name": "both", "about": "light tracing, photons for mirror images", "budget": "seconds",
     "set": {"components.caustic": "light+photons"}}
  ]
})";

/// Whole pictures with difficult caustics; other light by paths or by records.
constexpr const char* k_caustic_pictures_matrix = R"({
  "name": "caustic-pictures",
  "repeats": 3,
  "warmup": 1,
  "reference": {"samples": 16384},
  "budgets": {"seconds": [3, 5, 10, 60]},
  "scenes": [
    {"file": "glass/glass.gltf", "size": "256x256"},
    {"file": "ring/ring.gltf", "size": "256x144"}
  ],
  "settings": [
    {"name": "plain", "about": "path tracing", "budget": "seconds"},
    {"name": "photons", "about": "caustics by photons, else path tracing", "budget": "seconds",
     "set": {"components.caustic": "photons"}},
    {"name": "photons-cache", "about": "caustics by photons, secondary and tertiary light by records",
     "budget": "seconds",
     "set": {"components.caustic": "photons", "components.secondary": "cache", "components.tertiary": "cache"}},
    {"name": "both-cache", "about": "caustics by light tracing and photons, secondary and tertiary light by records",
     "budget": "seconds",
     "set": {"components.caustic": "light+photons", "components.secondary": "cache",
             "components.tertiary": "cache"}}
  ]
})";

/// Secondary and tertiary light alone, by each choice of solvers.
constexpr const char* k_deep_matrix = R"({
  "name": "deep",
  "repeats": 3,
  "warmup": 1,
  "reference": {"samples": 2048},
  "set": {"components.primary": "off", "components.caustic": "off"},
  "budgets": {"seconds": [15, 60]},
  "scenes": [
    {"file": "hall/hall.gltf", "size": "256x256"},
    {"file": "sun-patch/sun-patch.gltf", "size": "256x256"},
    {"file": "atrium/atrium.gltf", "size": "256x256"}
  ],
  "settings": [
    {"name": "plain", "about": "path tracing", "budget": "seconds"},
    {"name": "cache", "about": "secondary and tertiary light from records", "budget": "seconds",
     "set": {"components.secondary": "cache", "components.tertiary": "cache"}},
    {"name": "cache-photons", "about": "records whose rays end in photons", "budget": "seconds",
     "set": {"components.secondary": "cache", "components.tertiary": "photons"}},
    {"name": "path-photons", "about": "final gathering: paths that end in irradiance of photons", "budget": "seconds",
     "set": {"components.tertiary": "photons"}},
    {"name": "path-rounds", "about": "... that add up the photons of rounds instead", "budget": "seconds",
     "set": {"components.tertiary": "photons", "photons.irradiance_map": "off"}}
  ]
})";

}  // namespace

std::vector<solvers::BenchInfo> bench_rows() {
  return {{"caustics",
           "caustics alone: path tracing against photons and light tracing, on glass and ring; two hours",
           k_caustics_matrix},
          {"caustic-pictures",
           "whole pictures of glass and ring: path tracing against caustics by photons and light tracing, "
           "with other light by paths or records; two hours",
           k_caustic_pictures_matrix},
          {"deep",
           "secondary and tertiary light in three interiors: by records, by photons, and by records or "
           "paths that end in photons; an hour and a half",
           k_deep_matrix}};
}

}  // namespace lucerna::photons
