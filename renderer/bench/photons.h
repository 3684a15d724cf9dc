#pragma once
// Cost and convergence of photons (`lucerna bench --photons`): slopes of noise and bias over rounds and
// radii, rates and memory, the cost of a round over its light paths and over lamps, and the cost of enabled
// photons in scenes without casters.
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/runner.h"

namespace lucerna::bench {

inline constexpr std::array<const char*, 4> k_photon_parts = {"slopes", "rounds", "lamps", "free"};

struct PhotonBenchOptions {
  std::vector<std::string> parts{k_photon_parts.begin(), k_photon_parts.end()};
  uint32_t side = 64;               ///< pixels of the square pictures of which slopes are measured
  uint32_t seeds = 6;               ///< renders of each, 3 or more
  uint32_t rounds = 256;            ///< of each, a power of two from 8 on
  uint32_t reference_samples = 64;  ///< a pixel, of each of the independent truths
  std::vector<uint32_t> paths = {10000, 31623, 100000, 316228, 1000000, 3162278, 10000000};  ///< of a round
  std::vector<uint32_t> lamps = {1, 10, 100, 1000};
  uint32_t repeats = 3;          ///< rounds that are timed for each of these
  uint32_t pairs = 41;           ///< of renders with and without photons
  std::filesystem::path scenes;  ///< the folder of the program's own scenes: cornell and glass
  std::string device;
};

/// Description of the measurement, for the report folder.
nlohmann::ordered_json to_json(const PhotonBenchOptions& options);

/// Measures what the folder ("units" is its part) does not contain yet: a unit is one render of the slopes,
/// one number of paths or lamps, or all pairs. Throws Error like loading and rendering; nullopt if
/// interrupted: finished units are kept. The result, by requested part:
///   slopes [{series, scene, what, radius, floor, alpha, points [{rounds, noise, bias, error}], slopes [{of,
///     over, value, low, high, expected, why}], pixels, seeds, mean}]: "over" rounds or radius;
///   rounds [{paths, photons, wall_s, cpu_s, trace_s, build_s, build_share, emitted_per_s, stored_per_s,
///     sorted_per_s, gathered_per_s, bytes,
///     cpu_us_a_path, of light paths and sorting alone}];
///   lamps [the same with lamps];
///   free {scene, samples, pairs, extra, low, high, path_cpu_s, rays, rays_with_photons, light_paths}.
std::optional<nlohmann::ordered_json> measure_photons(const PhotonBenchOptions& options,
                                                      const ReportFolder& folder, const Hooks& hooks);

/// One line a figure, what was expected beside it.
std::string photons_text(const nlohmann::ordered_json& report);
/// The page, as make_page() makes one.
std::string photons_page(const nlohmann::ordered_json& report);

/// True if a measured slope is within a tenth of the expected one.
bool slope_kept(double measured, double expected);

}  // namespace lucerna::bench
