// Film -> picture of a number: samples, relative error or device time of each pixel, on a ramp. Pixels of which nothing is
// known are dark grey.
#include "lib/film.glsl"
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
#include "shaders/shared/ramp.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { HeatPush push; };
layout(scalar) writeonly buffer Picture { uint picture[]; };
layout(scalar) readonly buffer FilmVertices { uint film_vertices[]; };
layout(scalar) readonly buffer BlockErrors { BlockError block_errors[]; };

// The quadratic mean of its quadrants' relative errors, with the errors of lookups, as film/error.h defines a tile's;
// negative: not known.
float block_relative(uint block) {
  float squares = 0.0, quadrants = 0.0, all = 0.0;
  for (uint q = 0u; q < 4u; ++q) {
    float pixels = block_errors[block].quadrant_pixels[q];
    if (pixels > 0.0) {
      float mean = block_errors[block].relative[q] / pixels;
      squares += mean * mean;
      quadrants += 1.0;
      all += pixels;
    }
  }
  if (quadrants <= 0.0) return -1.0;
  float lookups = max(block_errors[block].lookup_noise_relative, 0.0) / all;
  return sqrt(squares / quadrants + lookups) + sqrt(max(block_errors[block].interpolation_relative, 0.0) / all);
}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  uvec2 xy = uvec2(pixel % push.width, pixel / push.width);
  uint count = film_count[pixel];
  float value = count > 0u ? float(count) : -1.0;
  if (push.layer == k_layer_cost) value = count > 0u ? float(film_vertices[pixel]) * push.unit : -1.0;
  if (push.layer == k_layer_error)
    value = block_relative(xy.y / k_block * ((push.width + k_block - 1u) / k_block) + xy.x / k_block);
  vec3 color = value < 0.0 ? vec3(0.13) : ramp_color(push.ramp, ramp_position(value, push.lo, push.hi, push.logarithmic));
  picture[pixel] = picture_packed(color);
}
