#include "bench/matrix.h"

namespace lucerna::bench {
namespace {

const char* const k_quick = R"({
  "name": "quick",
  "repeats": 3,
  "scenes": [
    {"file": "cornell/cornell.gltf", "size": "128x128", "reference_samples": 2560,
     "budgets": {"samples": [512], "errors": [0.1, 0.06]}},
    {"file": "glass/glass.gltf", "size": "128x128", "reference_samples": 2048,
     "budgets": {"samples": [256], "errors": [0.2, 0.1]}},
    {"file": "studio/studio.gltf", "size": "160x120", "reference_samples": 2560,
     "budgets": {"samples": [512], "errors": [0.05, 0.03]}}
  ],
  "settings": [
    {"name": "plain", "about": "path tracing, samples for all pixels alike"},
    {"name": "adaptive", "about": "path tracing, samples for the tiles that are still noisy",
     "set": {"sampling.mode": "adaptive"}},
    {"name": "compute-bvh", "about": "as plain, rays traced by the compute shaders instead of Embree",
     "set": {"tracer": "compute-bvh"}}
  ]
})";

const char* const k_full = R"({
  "name": "full",
  "repeats": 5,
  "reference": {"samples": 16384},
  "budgets": {"samples": [16, 64, 256, 1024], "errors": [0.2, 0.1, 0.05]},
  "scenes": [
    {"file": "cornell/cornell.gltf", "size": "256x256"},
    {"file": "glass/glass.gltf", "size": "256x256"},
    {"file": "studio/studio.gltf", "size": "320x240"},
    {"file": "atrium/atrium.gltf", "size": "320x180", "reference_samples": 8192,
     "budgets": {"samples": [16, 64, 256]}},
    {"file": "hall/hall.gltf", "size": "256x144", "budgets": {"samples": [16, 64, 256]}},
    {"file": "teapot/teapot.gltf", "size": "256x144", "budgets": {"samples": [16, 64, 256]}},
    {"file": "sun-patch/sun-patch.gltf", "size": "256x144", "budgets": {"samples": [16, 64, 256]}},
    {"file": "classroom/classroom.gltf", "size": "256x144", "budgets": {"samples": [16, 64, 256]}},
    {"file": "window/window.gltf", "size": "256x144", "budgets": {"samples": [16, 64, 256]}}
  ],
  "settings": [
    {"name": "plain", "about": "path tracing, samples for all pixels alike"},
    {"name": "adaptive", "about": "path tracing, samples for the tiles of 16x16 pixels that are still noisy",
     "set": {"sampling.mode": "adaptive", "sampling.max_samples": 4096}},
    {"name": "adaptive-8", "about": "the same with tiles of 8x8 pixels",
     "set": {"sampling.mode": "adaptive", "sampling.max_samples": 4096, "sampling.tile": 8}},
    {"name": "cache", "about": "as plain, secondary and tertiary light from an irradiance cache",
     "set": {"components.secondary": "cache", "components.tertiary": "cache"}},
    {"name": "cache-split", "about": "as cache, records reach as far as things are away",
     "set": {"components.secondary": "cache", "components.tertiary": "cache", "cache.metric": "split-sphere"}},
    {"name": "cache-sky", "about": "as cache, the sky's light on diffuse surfaces too",
     "set": {"components.secondary": "cache", "components.tertiary": "cache", "cache.environment": true}},
    {"name": "coherent", "about": "as plain, the pixels of a tile share their sequences",
     "set": {"sampling.coherent": true}},
    {"name": "compute-bvh", "about": "as plain, rays traced by the compute shaders instead of Embree",
     "set": {"tracer": "compute-bvh"}}
  ]
})";

/// Cached light alone is held against the reference, of records so little noisy that it is the interpolation
/// that errs. Nothing but the metric decides their radii: in a small picture the bounds that they have
/// otherwise leave most records one size, whatever the metric says.
const char* const k_cache = R"({
  "name": "cache",
  "repeats": 3,
  "warmup": 1,
  "reference": {"samples": 16384},
  "set": {"components.primary": "off", "components.caustic": "off", "cache.noise": 0.03,
          "cache.max_rays": 16384, "cache.min_radius": 0, "cache.max_radius": 1, "cache.neighbours": false},
  "budgets": {"samples": [256]},
  "scenes": [
    {"file": "cornell/cornell.gltf", "size": "128x128"},
    {"file": "teapot/teapot.gltf", "size": "128x128"},
    {"file": "hall/hall.gltf", "size": "160x90"}
  ],
  "settings": [
    {"name": "plain", "about": "path tracing, no cache"},
    {"name": "split-60", "about": "cache, records reach as far as things are away", "curve": "split sphere",
     "set": {"components.secondary": "cache", "components.tertiary": "cache", "cache.metric": "split-sphere",
             "cache.error": 0.6}},
    {"name": "split-40", "about": "cache, records reach as far as things are away", "curve": "split sphere",
     "set": {"components.secondary": "cache", "components.tertiary": "cache", "cache.metric": "split-sphere",
             "cache.error": 0.4}},
    {"name": "split-30", "about": "cache, records reach as far as things are away", "curve": "split sphere",
     "set": {"components.secondary": "cache", "components.tertiary": "cache", "cache.metric": "split-sphere",
             "cache.error": 0.3}},
    {"name": "split-20", "about": "cache, records reach as far as things are away", "curve": "split sphere",
     "set": {"components.secondary": "cache", "components.tertiary": "cache", "cache.metric": "split-sphere",
             "cache.error": 0.2}},
    {"name": "split-15", "about": "cache, records reach as far as things are away", "curve": "split sphere",
     "set": {"components.secondary": "cache", "components.tertiary": "cache", "cache.metric": "split-sphere",
             "cache.error": 0.15}},
    {"name": "hessian-60", "about": "cache, records reach in ellipses, by how their light bends", "curve": "hessian",
     "set": {"components.secondary": "cache", "components.tertiary": "cache", "cache.metric": "hessian",
             "cache.error": 0.6}},
    {"name": "hessian-40", "about": "cache, records reach in ellipses, by how their light bends", "curve": "hessian",
     "set": {"components.secondary": "cache", "components.tertiary": "cache", "cache.metric": "hessian",
             "cache.error": 0.4}},
    {"name": "hessian-30", "about": "cache, records reach in ellipses, by how their light bends", "curve": "hessian",
     "set": {"components.secondary": "cache", "components.tertiary": "cache", "cache.metric": "hessian",
             "cache.error": 0.3}},
    {"name": "hessian-20", "about": "cache, records reach in ellipses, by how their light bends", "curve": "hessian",
     "set": {"components.secondary": "cache", "components.tertiary": "cache", "cache.metric": "hessian",
             "cache.error": 0.2}},
    {"name": "hessian-15", "about": "cache, records reach in ellipses, by how their light bends", "curve": "hessian",
     "set": {"components.secondary": "cache", "components.tertiary": "cache", "cache.metric": "hessian",
             "cache.error": 0.15}}
  ]
})";

/// Cached light alone, to an error that is hard to see: each scene with what leads there, found by trying,
/// with the metric that it was tried with.
const char* const k_indirect = R"({
  "name": "indirect",
  "repeats": 3,
  "warmup": 1,
  "reference": {"samples": 512},
  "set": {"components.primary": "off", "components.caustic": "off", "cache.metric": "split-sphere"},
  "budgets": {"seconds": [60]},
  "scenes": [
    {"file": "teapot/teapot.gltf", "size": "512x512", "budgets": {"samples": [16], "seconds": [40]},
     "set": {"cache.noise": 0.2}},
    {"file": "hall/hall.gltf", "size": "512x512", "budgets": {"samples": [256], "seconds": [60]},
     "set": {"cache.noise": 0.008, "cache.max_rays": 65536, "cache.error": 0.15, "cache.min_radius": 1,
             "cache.max_records": 300000, "cache.stop": 0.0003}},
    {"file": "sun-patch/sun-patch.gltf", "size": "512x512", "budgets": {"samples": [256], "seconds": [60]},
     "set": {"cache.noise": 0.01, "cache.max_rays": 65536, "cache.error": 0.2, "cache.min_radius": 1,
             "cache.max_records": 300000, "cache.stop": 0.0005}},
    {"file": "atrium/atrium.gltf", "size": "512x512", "budgets": {"samples": [1152], "seconds": [60]},
     "set": {"cache.noise": 0.0025, "cache.max_rays": 65536, "cache.error": 0.17, "cache.min_radius": 1.5,
             "cache.max_records": 400000, "cache.passes": 11}},
    {"file": "classroom/classroom.gltf", "size": "512x512", "budgets": {"samples": [192], "seconds": [60]},
     "set": {"cache.noise": 0.0025, "cache.max_rays": 65536, "cache.error": 0.13, "cache.nearest": 0.6,
             "cache.min_radius": 0.8, "cache.max_records": 400000, "cache.stop": 0.0005, "cache.passes": 18}}
  ],
  "settings": [
    {"name": "plain", "about": "path tracing", "budget": "seconds"},
    {"name": "cache", "about": "secondary and tertiary light from an irradiance cache, built anew",
     "set": {"components.secondary": "cache", "components.tertiary": "cache"}}
  ]
})";

}  // namespace

Matrix builtin_matrix(const std::string& name, const std::filesystem::path& scenes) {
  for (const auto& [known, text] : {std::pair("quick", k_quick), std::pair("full", k_full),
                                    std::pair("cache", k_cache), std::pair("indirect", k_indirect)})
    if (name == known) return parse_matrix(text, name, scenes);
  throw_error("bench", "there is no matrix '{}'; there are quick, full, cache and indirect", name);
}

const char* const k_matrix_help = R"(
A matrix file is a JSON object; an unknown key is an error:
  name       of the matrix [the file's]
  about      a text, for people
  repeats    renders of each cell, 1 to 100 [3]; with 1 it stays unknown what of a factor is noise
  warmup     samples a pixel rendered before the clock runs, in every cell (of a cache that is long in building only
             its first passes) [8]
  seed       of the first repeat; every further one has the next [1]
  reference  {"samples": N, "seed": N}: of the long plain path-traced renders taken for the truth [4096, 900001]
  set        {"KEY": VALUE}: settings for all cells and references (keys: lucerna render --help)
  budgets    what ends a render; lists of {"samples": [..], "errors": [..], "seconds": [..]}
  scenes     [{"file": F.gltf (relative to the matrix file), "size": "WxH", "name", "camera", "set", "budgets",
              "reference_samples"}]
  settings   [{"name", "about", "set": {..}, "curve", "budget": "samples" | "errors" | "seconds"}]; the first is
              what the others are held against. Without "budget", adaptive settings take errors, the others
              samples. Settings of one "curve" (a text) differ in how many records the irradiance cache comes to;
              the page joins them by a line, error against records.
The smallest one:
  {"budgets": {"samples": [64], "errors": [0.1]},
   "scenes": [{"file": "cornell.gltf", "size": "128x128"}],
   "settings": [{"name": "plain"}, {"name": "adaptive", "set": {"sampling.mode": "adaptive"}}]}
)";

}  // namespace lucerna::bench
