// Hooks for paths without lookups. If solvers are looked up, the host replaces this file's text
// (renderer/transport/vertex_hooks.cpp).
#define LUCERNA_VERTEX_HOOKS 0
#include "transport/vertex_hook.glsl"

struct VertexHooks { uint none; };
VertexHooks hooks_read(VertexIn v, inout VertexOut o) { return VertexHooks(0u); }
vec3 hooks_cosine(VertexIn v, inout VertexHooks h, vec2 u, vec3 cosine) { return cosine; }
void hooks_weigh(VertexIn v, VertexHooks h, vec3 direction, inout BsdfSample b) {}
uint hooks_state(VertexIn v, VertexHooks h, BsdfSample b, uint state) { return state; }
void hooks_leave(VertexIn v, inout VertexHooks h, Leaving l, inout vec3 throughput, inout bool go_on) {}
void hooks_end(VertexIn v, VertexHooks h) {}
