// What shade.comp asks solvers at every vertex that scatters. A solver's hook is a file with a structure X_Vertex, which is
// what it knows of one vertex while that is worked on, and five functions, where X is the solver's name:
//
//   X_Vertex X_read(VertexIn v, inout VertexOut o)   looks up; what it brings, it adds to o
//   vec3 X_cosine(VertexIn v, inout X_Vertex x, vec2 u, vec3 cosine)
//       direction of the diffuse lobe in place of `cosine`, which is distributed by the cosine; local to v.to_world
//   void X_weigh(VertexIn v, X_Vertex x, vec3 direction, inout BsdfSample b)
//       the weight of the sampled direction, where X_cosine has changed its density
//   uint X_state(VertexIn v, X_Vertex x, BsdfSample b, uint state)
//       state of the automaton behind the vertex, in place of `state`
//   void X_leave(VertexIn v, inout X_Vertex x, Leaving l, inout vec3 throughput, inout bool go_on)
//       may end the path, or change what it carries, after everything else has been decided but roulette
//   void X_end(VertexIn v, X_Vertex x)               writes what it notes of the vertex
//
// transport/vertex_hooks.glsl calls those of the plan's solvers in turn (renderer/transport/vertex_hooks.h makes it).
#ifndef LUCERNA_TRANSPORT_VERTEX_HOOK
#define LUCERNA_TRANSPORT_VERTEX_HOOK
#include "lib/surface.glsl"
#include "lib/sampler.glsl"

struct VertexIn {
  uint slot;
  PathState path;   // as it arrives
  uint state;       // of the automaton
  uint depth;       // scattering events before this one
  Hit hit;
  Surface surface;
  Bsdf bsdf;
  mat3 to_world;    // shading frame
  vec3 side;        // geometric normal on the side that the path comes from
  Sampler random;   // of this vertex
  bool again;       // another branch leaves it: all that the vertex itself brings has been brought, what X_read adds is not heeded
};

struct VertexOut {
  // What is brought here, times the path's throughput: by lane, or where groups of lights are kept in short by component,
  // and once more by group.
#if LUCERNA_GROUP_SUMS
  vec3 radiance[k_component_count];
  vec3 by_group[k_group_count];
#else
  vec3 radiance[k_lane_count];
#endif
  float bias;       // by what the luminance of that is told to be too large, in the mean (LUCERNA_LOOKUP_BIAS; else not heeded)
  bool sky_known;   // in it is what the sky sends straight to the diffuse lobe
  bool samples_lights;
  uint branches;    // by how many the diffuse lobe is followed on
};

struct Leaving {
  BsdfSample b;
  bool finite;      // the throughput behind the vertex is
};
#endif
