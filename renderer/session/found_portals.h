#pragma once
// Portals of a scene by the setting lights.portals.
#include <memory>
#include <string>
#include <vector>

#include "scene/openings.h"

namespace lucerna::session {

/// Openings of the rooms in which the scene's cameras are: by a fixed set of rays from points that diffuse
/// paths from the cameras reach. Alpha and thin glass do not stop rays, as they do not stop light samples.
/// Points and cameras from which most rays leave the scene are outdoors and do not count. Takes about as
/// long as loading the scene's geometry. Throws Error: memory.
std::vector<scene::Opening> search_openings(std::shared_ptr<const scene::Scene> scene);

/// The scene with the marked portals or, if there are none, `how` is "found" and the scene has a sky, with
/// the openings found, each of which is logged.
std::shared_ptr<const scene::Scene> with_portals(std::shared_ptr<const scene::Scene> scene,
                                                 const std::vector<scene::Portal>& marked,
                                                 const std::string& how);

}  // namespace lucerna::session
