#pragma once
// Report of photon mapping.
#include "overlay/light_paths.h"
#include "solvers/photons/inspector.h"
#include "solvers/photons/photon_map.h"
#include "solvers/photons/radius.h"
#include "solvers/report.h"

namespace lucerna::photons {

struct PhotonReport {
  double lights_power = 0;   ///< luminance of all lights' flux [W]
  bool sends_rounds = true;  ///< traces rounds or maps; false: all components are delegated to paths
  bool sends = true;         ///< traces photons; false: there are only caustics, and nothing focuses light
  uint64_t rounds = 0, paths = 0, photons = 0, escaped = 0, dark = 0,
           spared = 0;  ///< totals of the picture
  RoundFigures last;
  bool maps = false;    ///< rounds are irradiance maps, each used for several samples
  uint32_t pieces = 0;  ///< cells of the latest map
  double radius_pixels = 0;
  RadiusLaw radius_law;
  bool at_floor = false;
  bool limited = false;                   ///< fewer paths than requested, for lack of memory
  uint32_t casters = 0, entrances = 0;    ///< boxes that paths are aimed at
  double unaimed = 1;                     ///< unaimed share of the paths
  bool weighs = false;                    ///< caustics may be delegated to paths
  double by_photons = 1;                  ///< share of the picture whose caustics photons compute
  double efficiency_gain = 1;             ///< estimated efficiency gain of this choice
  uint32_t tried = 0;                     ///< components tried with photons and with paths
  uint32_t delegated = 0;                 ///< of these, delegated to paths in the whole picture
  double delegation_gain = 1;             ///< estimated efficiency gain of this choice
  bool ready = true;                      ///< the pilot is complete
  std::vector<overlay::AimedPair> aimed;  ///< largest share first
  bool paths_shown = false, aim_shown = false;
  uint64_t bytes = 0;
  double trace_s = 0, build_s = 0;                               ///< of the picture's rounds
  double emitted_per_s = 0, stored_per_s = 0, sorted_per_s = 0;  ///< 0: not measured yet
  uint32_t view = 0;                                             ///< overlay.photons
  DensityScale density;
  std::optional<vec2> looked_at;
  std::optional<Inspected> inspected;
};

solvers::Report make_report(const PhotonReport& r);

}  // namespace lucerna::photons
