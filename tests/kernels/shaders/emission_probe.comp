// shaders/lib/emission.glsl: the beginnings of light paths, one an invocation.
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
  uint light;
};
layout(scalar) writeonly buffer Beginnings { Beginning beginnings[]; };

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  Sampler random = make_light_sampler(i, push.round, frame.seed);
  Emission e = sample_emission(sample_vertex_bits(random, 0u, k_pad_light_choice), sample_vertex(random, 0u, k_pad_light_uv),
                               sample_vertex(random, 0u, k_pad_direction), sample_vertex_bits(random, 0u, k_pad_light_detail));
  beginnings[i] = Beginning(e.origin, e.pmf, e.direction, e.pdf_place, e.flux, e.pdf_direction, e.light);
}
