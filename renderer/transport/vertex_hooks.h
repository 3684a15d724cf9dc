#pragma once
// Solvers' hooks at the vertices of paths: which GLSL files shade.comp calls
// (shaders/transport/vertex_hook.glsl says with what), for a plan.
#include <string>
#include <vector>

#include "gpu/kernel.h"

namespace lucerna::transport {

struct VertexHook {
  std::string prefix;  ///< of its functions and of the structure of its state
  std::string file;    ///< relative to shaders/, or absolute
};

/// Defines by which the wavefront's kernels are compiled with these hooks, called in this order.
gpu::Defines hook_defines(const std::vector<VertexHook>& hooks);

}  // namespace lucerna::transport
