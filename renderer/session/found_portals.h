#pragma once
// Portals of a scene by the setting lights.portals.
#include <memory>
#include <string>
#include <vector>

#include "scene/openings.h"
#include "session/world.h"

namespace lucerna::session {

/// Openings of the rooms in which the scene's cameras are: by a fixed set of rays from points that diffuse
/// paths from the cameras reach. Alpha and thin glass do not stop rays, as they do not stop light samples.
/// Points and cameras from which most rays leave the scene are outdoors and do not count. Takes about as
/// long as loading the scene's geometry. Throws Error: memory.
std::vector<scene::Opening> search_openings(std::shared_ptr<const scene::Scene> scene);

/// Those of the portals through which some of a fixed set of rays from the room leaves the scene; the others
/// are warnings. Throws Error: memory.
std::vector<scene::Portal> open_portals(std::shared_ptr<const scene::Scene> scene,
                                        const std::vector<scene::Portal>& marked);

/// The scene with the marked portals that are open or, if none is marked, `how` is "found" and the scene has
/// a sky, with the openings found, each of which is logged. Throws Error: memory, or `progress` cancels.
std::shared_ptr<const scene::Scene> with_portals(std::shared_ptr<const scene::Scene> scene,
                                                 const std::vector<scene::Portal>& marked,
                                                 const std::string& how, const Progress& progress = {});

}  // namespace lucerna::session
