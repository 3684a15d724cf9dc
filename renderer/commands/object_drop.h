#pragma once
// How far an object falls when it is dropped.
#include <optional>

#include "session/pick.h"

namespace lucerna::commands {

/// Distance [m] that an object falls until it rests on another surface, measured from its vertices and from
/// its lowest points over a raster of its box. Points up to a hundredth of its height inside a surface count
/// as above it, so the distance may be slightly below 0. `to_world`: the object's matrix, which may differ
/// from that in the probe's scene. nullopt: nothing is below.
std::optional<float> way_down(const session::Probe& probe, uint32_t object, const mat4& to_world);

}  // namespace lucerna::commands
