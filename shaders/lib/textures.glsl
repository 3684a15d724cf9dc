// Textures on the pages of a few texture arrays, one per format (renderer/upload/textures.h). A device without dynamic
// indexing of sampler arrays needs one call site per array. If the scene keeps a use's textures in one array, as nearly all
// do, the read is unconditional; otherwise each call is in a loop of at most one iteration, because lavapipe skips a loop
// whose lanes are all done, but not an `if`.
#ifndef LUCERNA_LIB_TEXTURES
#define LUCERNA_LIB_TEXTURES
#include "lib/variants.glsl"
#include "shaders/shared/scene.h"

#if LUCERNA_BUCKETS > 0
uniform sampler2DArray texture_bucket_0;
#endif
#if LUCERNA_BUCKETS > 1
uniform sampler2DArray texture_bucket_1;
#endif
#if LUCERNA_BUCKETS > 2
uniform sampler2DArray texture_bucket_2;
#endif
#if LUCERNA_BUCKETS > 3
uniform sampler2DArray texture_bucket_3;
#endif
#if LUCERNA_BUCKETS > 4
uniform sampler2DArray texture_bucket_4;
#endif
#if LUCERNA_BUCKETS > 5
uniform sampler2DArray texture_bucket_5;
#endif

// Wraps into [0, 1]; the borders on the page do the rest. fract keeps precision for large coordinates.
float wrap_coordinate(float x, uint mode) {
#if LUCERNA_TEX_WRAPS
  float mirror = abs(x - 2.0 * floor(0.5 * x + 0.5));   // triangle wave
  return mode == 0u ? fract(x) : mode == 1u ? clamp(x, 0.0, 1.0) : mirror;
#else
  return fract(x);
#endif
}

vec4 texture_fetch(sampler2DArray bucket, uint bits, vec4 rect, vec2 uv) {
#if LUCERNA_TEX_NEAREST
  vec2 size = round(rect.zw * vec2(textureSize(bucket, 0).xy));
  vec2 nearest = (min(floor(uv * size), size - 1.0) + 0.5) / size;
  uv = (bits & k_texture_nearest) != 0u ? nearest : uv;
#endif
  return textureLod(bucket, vec3(rect.xy + uv * rect.zw, float(bits & 0x7ffu)), 0.0);
}

#define LUCERNA_BUCKET_READ(number, array)                                                                      \
  if (buckets == 1u << number) {                                                                                \
    texel = texture_fetch(array, bits, rect, uv);                                                               \
  } else if ((buckets & 1u << number) != 0u) {                                                                  \
    for (uint go = bucket == number ? 1u : 0u; go > 0u; --go) texel = texture_fetch(array, bits, rect, uv); \
  }

// `buckets` is a constant: after inlining, only the reads in it remain.
vec4 texture_read(uint bits, uint buckets, vec4 rect, vec2 uv) {
  vec4 texel = vec4(1.0);
  uint bucket = (bits & k_texture_present) != 0u ? (bits >> 11) & 31u : 31u;
  uv = vec2(wrap_coordinate(uv.x, (bits >> 16) & 3u), wrap_coordinate(uv.y, (bits >> 18) & 3u));
#if LUCERNA_BUCKETS > 0
  LUCERNA_BUCKET_READ(0u, texture_bucket_0)
#endif
#if LUCERNA_BUCKETS > 1
  LUCERNA_BUCKET_READ(1u, texture_bucket_1)
#endif
#if LUCERNA_BUCKETS > 2
  LUCERNA_BUCKET_READ(2u, texture_bucket_2)
#endif
#if LUCERNA_BUCKETS > 3
  LUCERNA_BUCKET_READ(3u, texture_bucket_3)
#endif
#if LUCERNA_BUCKETS > 4
  LUCERNA_BUCKET_READ(4u, texture_bucket_4)
#endif
#if LUCERNA_BUCKETS > 5
  LUCERNA_BUCKET_READ(5u, texture_bucket_5)
#endif
  return texel;
}

#endif
