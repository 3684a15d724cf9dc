#pragma once
// Highlights and reflections of lights on surfaces: whose is at a point of the picture, and where a light
// must be for its highlight to be there. Pure functions of scene and lights.
#include <vector>

#include "commands/navigation.h"

namespace lucerna::commands {

/// The light, or the emissive material, whose highlight or reflection a ray of the camera shows; none: it
/// shows none that a person could see there. A highlight is seen if the light's image in the first surface
/// (GGX lobe of surface or coat, widened by the light's size: Karis, "Real Shading in Unreal Engine 4", 2013)
/// is brighter than the diffuse light of that light there and, at `exposure` (factor), a twentieth of white.
/// Reflections in up to four polished surfaces are followed. Lights that are off or behind walls have none;
/// walls of glass let them pass.
Selection light_in_highlight(const session::Probe& probe, const std::vector<scene::Light>& lights,
                             const session::PickRay& ray, float exposure);

/// Moves a light so that the ray meets its highlight: a lamp to the reflected ray, as far from the surface as
/// it is now, or as there is room; a sun so that it comes from there (without a date then). Lights with a
/// direction are aimed at the surface. False if something is in the way of a lamp, which is nearer now.
/// Throws Error: no surface there, or the reflection goes into it.
bool place_highlight(const session::Probe& probe, const session::PickRay& ray, scene::Light& light);

}  // namespace lucerna::commands
