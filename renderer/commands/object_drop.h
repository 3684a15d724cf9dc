#pragma once
// How far an object can fall.
#include <optional>

#include "session/pick.h"

namespace lucerna::commands {

/// The way down [m] until an object rests on another surface, from the lowest points of its mesh: of a raster
/// over its box and of its vertices. Points up to a hundredth of its height inside a surface count as above
/// it, so the way may be a little below 0. `to_world`: where the object is, which may differ from the
/// probe's scene. nullopt: nothing is below.
std::optional<float> way_down(const session::Probe& probe, uint32_t object, const mat4& to_world);

}  // namespace lucerna::commands
