// shaders/lib/emission.glsl: starts of light paths, one per invocation.
#include "shaders/lib/invocation.glsl"
#include "shaders/lib/frame.glsl"
#include "shaders/lib/emission.glsl"

layout(local_size_x = 64) in;
layout(scalar, push_constant) uniform Push {
  uint count;
  uint round;
} push;

struct Beginning {
  vec3 origin;
  float pmf;
  vec3 direction;
  float pdf_place;
  vec3 flux;
  float pdf_direction;
  uint light, stratum;
};
layout(scalar) writeonly buffer Beginnings { Beginning beginnings[]; };

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  Sampler random = make_light_sampler(i, push.round, frame.seed);
  Emission e = sample_emission(random, uint(4294967296.0 / float(push.count)));
  beginnings[i] = Beginning(e.origin, e.pmf, e.direction, e.pdf_place, e.flux, e.pdf_direction, e.light, e.stratum);
}
