// Interface of solver hooks, which shade.comp calls at every scattering vertex. A hook is a file with a structure X_Vertex,
// the solver's state at one vertex, and functions, where X is the solver's name. One is required:
//
//   X_Vertex X_read(VertexIn v, inout VertexOut o)
//       looks up light and adds it to o
//
// The others are optional. A file that has one defines the macro beside it:
//
//   X_HAS_COSINE  vec3 X_cosine(VertexIn v, inout X_Vertex x, vec2 u, vec3 cosine)
//       direction of the diffuse lobe, replaces the cosine-distributed `cosine`; local to v.to_world
//   X_HAS_WEIGH   void X_weigh(VertexIn v, X_Vertex x, vec3 direction, inout BsdfSample b)
//       updates the weight of the sampled direction where X_cosine has changed its density
//   X_HAS_STATE   uint X_state(VertexIn v, X_Vertex x, BsdfSample b, uint state)
//       automaton state behind the vertex, replaces `state`
//   X_HAS_LEAVE   void X_leave(VertexIn v, inout X_Vertex x, Leaving l, inout vec3 throughput, inout bool go_on)
//       may end the path or change its throughput; runs after everything except Russian roulette
//   X_HAS_END     void X_end(VertexIn v, X_Vertex x)
//       writes notes about the vertex
//
// transport/vertex_hooks.glsl calls the hooks of all solvers in turn; renderer/transport/vertex_hooks.h generates it.
#ifndef LUCERNA_TRANSPORT_VERTEX_HOOK
#define LUCERNA_TRANSPORT_VERTEX_HOOK
#include "lib/surface.glsl"
#include "lib/sampler.glsl"
#include "lib/path_events.glsl"

struct VertexIn {
  uint slot;
  PathState path;   // on arrival
  uint state;       // automaton state
  uint depth;       // number of scattering events before this vertex
  Hit hit;
  Surface surface;
  Bsdf bsdf;
  mat3 to_world;    // shading frame
  vec3 side;        // geometric normal on the side of the arriving path
  Sampler random;   // random numbers of this vertex
  bool again;       // a further branch: the vertex's light has been computed, and what X_read adds is ignored
};

struct VertexOut {
  // Light found here times the path's throughput: by lane; with compact groups by component and, once more, by group.
#if LUCERNA_GROUP_SUMS
  vec3 radiance[k_component_count];
  vec3 by_group[k_group_count];
#else
  vec3 radiance[k_lane_count];
#endif
  float bias;       // estimated mean excess of that luminance (LUCERNA_LOOKUP_BIAS; otherwise ignored)
  bool sky_known;   // includes direct sky light on the diffuse lobe
  bool samples_lights;
  uint branches;    // number of branches of the diffuse lobe
#if LUCERNA_PATH_EVENTS
  uvec4 served;     // by component: records or photons that were read
  uvec4 reader;     // ... k_path_records, k_path_photons or k_path_looked_up
  uint record;      // drawn record; k_path_no_event: none
#endif
};

struct Leaving {
  BsdfSample b;
  bool finite;      // the throughput behind the vertex is finite
};
#endif
