#pragma once
// Files of measured light distributions: IES LM-63 and EULUMDAT.
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "scene/light_profile.h"

namespace lucerna::scene {

/// Reads IES LM-63 of 1986, 1991, 1995, 2002 or 2019 (the first without a line that says so), photometry of
/// type A, B or C. Candela are those of the file times its multiplier and its ballast's factor (before 1995
/// also the factor of ballast and lamp); the tilt of lamps is ignored. Angles that the file leaves out by
/// symmetry are filled in; beyond its angles there is no light.
///
/// Directions (EXT_lights_ies): angles (0, 0) are -Z. Type C: polar angle from -Z, and around from +X towards
/// +Y. Type A: horizontal angle about Y, towards +X, then vertical up. Type B: vertical angle about X, up,
/// then horizontal towards +X (IES LM-75, CIE 121).
///
/// Throws Error at "where, line N": ends early, no number, too many or unordered angles, candela negative,
/// not finite, or all 0.
LightProfile parse_ies(std::string_view text, const std::string& where);

/// Converts EULUMDAT to LM-63, type C: C planes by its symmetry, candela of all lamps together. The factor of
/// light output, 1 for measured luminaires, is not applied. Throws Error likewise.
std::string ies_of_eulumdat(std::string_view text, const std::string& where);

/// Reads a file by its ending: .ldt is EULUMDAT, others LM-63. Throws Error, also if it is missing or larger
/// than 16 MiB.
std::shared_ptr<const LightProfile> load_light_profile(const std::filesystem::path& file);
/// Likewise from its bytes; `name`: of the file.
std::shared_ptr<const LightProfile> light_profile_of(std::string_view bytes, const std::string& name,
                                                     const std::string& where);

}  // namespace lucerna::scene
