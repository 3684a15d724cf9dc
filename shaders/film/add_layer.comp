// Adds a batch's finished paths to a layer of the film (shared/layers.h), before film/add.comp counts its samples: one
// invocation a pixel, samples in their order, as there.
#define LUCERNA_FILM_LAYER 1
#include "lib/variants.glsl"
#include "lib/film.glsl"
#include "lib/blocks.glsl"
#include "lib/invocation.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FilmPush push; };
uniform samplerBuffer layer_texels;

void main() {
  uint index = global_index();
  if (index >= push.pixel_count) return;
  WorkBlock block = blocks[index / 64u];
  uvec2 xy = block_pixel(block.index, index % 64u, push.width);
  if (xy.x >= push.width || xy.y >= push.height) return;
  uint pixel = xy.y * push.width + xy.x;
  FilmPixel sums = LUCERNA_FILM_LOAD(film_layer, pixel);
  for (uint i = 0u; i < push.sample_count; ++i) {
    uint slot = index + i * push.pixel_count;
    vec3 light = texelFetch(layer_texels, int(slot * LUCERNA_WORD_LAYERS + push.group)).rgb;
    if (((block.first_sample + i) & 1u) == 0u)
      film_half_add(sums.even, light);
    else
      film_half_add(sums.odd, light);
  }
  LUCERNA_FILM_STORE(film_layer_out, pixel, sums)
}
