// Index of an invocation's item, in kernels with one-dimensional workgroups.
#ifndef LUCERNA_INVOCATION_GLSL
#define LUCERNA_INVOCATION_GLSL

// Number of this invocation over the whole dispatch. Large dispatches are laid out over x and y, and may hold more
// invocations than items: compare it with the count before anything else.
// A macro, because a function would read gl_WorkGroupSize before the kernel has declared its local_size.
#define global_index() \
  ((gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x)

// Workgroup counts for an indirect dispatch of `groups` workgroups, within what every device takes along one axis.
uvec3 indirect_groups(uint groups) {
  const uint most = 65535u;
  uint y = groups <= most ? 1u : (groups - 1u) / most + 1u;
  return uvec3(groups <= most ? groups : (groups - 1u) / y + 1u, y, 1u);
}

#endif
