#pragma once
// What photons tell a person.
#include "overlay/light_paths.h"
#include "solvers/photons/inspector.h"
#include "solvers/photons/photon_map.h"
#include "solvers/photons/radius.h"
#include "solvers/report.h"

namespace lucerna::photons {

struct PhotonReport {
  double lights_power = 0;   ///< luminance of all lights' flux [W]
  bool sends_rounds = true;  ///< or maps: else paths from the eye bring all that is asked for
  bool sends = true;         ///< photons: else there are only caustics to bring, and nothing focuses light
  uint64_t rounds = 0, paths = 0, photons = 0, escaped = 0, dark = 0,
           spared = 0;  ///< of the picture
  RoundFigures last;
  bool maps = false;    ///< rounds are maps of irradiance, each for some samples
  uint32_t pieces = 0;  ///< of the last one
  double radius_pixels = 0;
  RadiusLaw radius_law;
  bool at_floor = false;
  bool limited = false;                   ///< held to less than what was asked for
  uint32_t casters = 0, entrances = 0;    ///< boxes that paths are aimed at
  double unaimed = 1;                     ///< share of the paths
  bool weighs = false;                    ///< caustics may be left to paths from the eye
  double by_photons = 1;                  ///< share of the picture where they are not
  double efficiency_gain = 1;             ///< of efficiency by that, as the pilot sees it
  uint32_t tried = 0;                     ///< components that were tried by photons and by paths
  uint32_t delegated = 0;                 ///< of these, that paths bring in the whole picture
  double delegation_gain = 1;             ///< of efficiency by that, as the pilot sees it
  bool ready = true;                      ///< the pilot is done
  std::vector<overlay::AimedPair> aimed;  ///< greatest share first
  bool paths_shown = false, aim_shown = false;
  uint64_t bytes = 0;
  double trace_s = 0, build_s = 0;                               ///< of the picture's rounds
  double emitted_per_s = 0, stored_per_s = 0, sorted_per_s = 0;  ///< 0: not yet known
  uint32_t view = 0;                                             ///< overlay.photons
  DensityScale density;
  std::optional<vec2> looked_at;
  std::optional<Inspected> inspected;
};

solvers::Report make_report(const PhotonReport& r);

}  // namespace lucerna::photons
