#pragma once
// Units of a light's strength. A scene has those of glTF: an intensity of 1 is 1 cd of a lamp and 1 lx of a
// directional light, an emitted radiance of 1 is 1 cd/m2. Strengths in units are those of luminance, so a
// colour takes its part off: 1 cd of white light, filtered to blue, is 0.07 cd. One table has all
// conversions.
#include <array>
#include <optional>
#include <string>

#include "scene/scene.h"

namespace lucerna::scene {

/// candela: in front of a lamp, of a measured distribution where it is strongest. lumen: all its light. lux:
/// on a small plane that faces it, in front of it at a distance from its middle. watt: lumens over
/// k_lumens_per_watt, of a directional light per m2. nit: cd/m2 of its surface.
enum class LightUnit : uint32_t { candela, lumen, lux, watt, nit };
inline constexpr size_t k_light_units = 5;

/// Light of a watt. Exporters of glTF convert with this value (that of 555 nm, the largest), whatever the
/// spectrum: Blender writes a point lamp of 10 W as 6830 lm. So a watt is no watt of electricity: a LED lamp
/// makes about 100 lm of one.
inline constexpr double k_lumens_per_watt = 683;

struct LightUnitInfo {
  LightUnit unit;
  const char* word;      ///< in commands
  const char* symbol;    ///< for people
  const char* quantity;  ///< sentence case
};
/// In the order of LightUnit.
inline constexpr std::array<LightUnitInfo, k_light_units> k_unit_table{{
    {LightUnit::candela, "cd", "cd", "Intensity"},
    {LightUnit::lumen, "lm", "lm", "Luminous flux"},
    {LightUnit::lux, "lx", "lx", "Illuminance"},
    {LightUnit::watt, "watts", "W", "Power"},
    {LightUnit::nit, "nits", "cd/m\xC2\xB2", "Luminance"},
}};
inline const LightUnitInfo& info_of(LightUnit unit) { return k_unit_table[static_cast<size_t>(unit)]; }
/// By LightUnitInfo::word.
std::optional<LightUnit> unit_named(const std::string& word);

/// The value of a light of luminance 1 (Light::intensity) in a unit. Nothing if lights of its kind have none:
/// candela, lumens and nits of directional lights, nits of lamps without a shape. `distance` [m] counts for
/// lux of a lamp; nothing inside its shape. Of a lamp without a shape or with a distribution it is 1 /
/// distance^2; of a sphere, disk and rectangle a closed form; of a tube an integral.
std::optional<double> unit_factor(const Light& light, LightUnit unit, double distance);
/// The same of a surface that emits luminance 1 from that area [m2]: lumens, watts and nits.
std::optional<double> unit_factor(double area, LightUnit unit);

/// Luminance of linear Rec.709.
double exact_luminance(const vec3& color);
/// The strength in a unit; nothing if it has none.
std::optional<double> strength_in(const Light& light, LightUnit unit, double distance);
/// `intensity` with that strength. The colour stays; black becomes white. Bit for bit the same if it has it
/// already, to the precision of a float.
vec3 with_strength(const vec3& intensity, double factor, double strength);

/// The first of these that lights of its kind have: `wished`, then cd, lx.
LightUnit shown_unit(const Light& light, LightUnit wished, double distance);
/// The symbol for a light: W/m2 for watts of a directional one.
const char* unit_symbol(const Light& light, LightUnit unit);

/// Emitting area of the shown surfaces with that material [m2]; both sides if it is double-sided.
double emitting_area(const Scene& scene, Id material);

}  // namespace lucerna::scene
