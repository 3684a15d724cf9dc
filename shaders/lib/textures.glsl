// Textures in at most k_max_buckets arrays. A device without dynamic indexing of sampler arrays needs one call site a
// bucket; each stands in a loop that runs once or not at all, because on lavapipe a loop whose lanes are all done is
// skipped and an `if` is not.
#ifndef LUCERNA_LIB_TEXTURES
#define LUCERNA_LIB_TEXTURES
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
#if LUCERNA_BUCKETS > 6
uniform sampler2DArray texture_bucket_6;
#endif
#if LUCERNA_BUCKETS > 7
uniform sampler2DArray texture_bucket_7;
#endif
#if LUCERNA_BUCKETS > 8
uniform sampler2DArray texture_bucket_8;
#endif
#if LUCERNA_BUCKETS > 9
uniform sampler2DArray texture_bucket_9;
#endif
#if LUCERNA_BUCKETS > 10
uniform sampler2DArray texture_bucket_10;
#endif
#if LUCERNA_BUCKETS > 11
uniform sampler2DArray texture_bucket_11;
#endif

float wrap_coordinate(float x, uint mode, float size) {
  // Repeat is the sampler's; fract keeps precision for large coordinates.
  float repeat = fract(x);
  float clamped = clamp(x, 0.5 / size, 1.0 - 0.5 / size);
  float m = abs(x - 2.0 * floor(0.5 * x + 0.5));   // triangle wave
  float mirror = clamp(m, 0.5 / size, 1.0 - 0.5 / size);
  return mode == 0u ? repeat : mode == 1u ? clamped : mirror;
}

vec4 texture_fetch(sampler2DArray bucket, uint bits, vec2 uv) {
  vec2 size = vec2(textureSize(bucket, 0).xy);
  uv.x = wrap_coordinate(uv.x, (bits >> 16) & 3u, size.x);
  uv.y = wrap_coordinate(uv.y, (bits >> 18) & 3u, size.y);
  vec2 nearest = (floor(uv * size) + 0.5) / size;
  uv = (bits & k_texture_nearest) != 0u ? nearest : uv;
  return textureLod(bucket, vec3(uv, float(bits & 0x7ffu)), 0.0);
}

#define LUCERNA_BUCKET_READ(number, array) \
  for (uint go = bucket == number ? 1u : 0u; go > 0u; go -= min(frame.width, 1u)) texel = texture_fetch(array, bits, uv);

vec4 texture_read(uint bits, vec2 uv) {
  vec4 texel = vec4(1.0);
  uint bucket = (bits & k_texture_present) != 0u ? (bits >> 11) & 31u : 31u;
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
#if LUCERNA_BUCKETS > 6
  LUCERNA_BUCKET_READ(6u, texture_bucket_6)
#endif
#if LUCERNA_BUCKETS > 7
  LUCERNA_BUCKET_READ(7u, texture_bucket_7)
#endif
#if LUCERNA_BUCKETS > 8
  LUCERNA_BUCKET_READ(8u, texture_bucket_8)
#endif
#if LUCERNA_BUCKETS > 9
  LUCERNA_BUCKET_READ(9u, texture_bucket_9)
#endif
#if LUCERNA_BUCKETS > 10
  LUCERNA_BUCKET_READ(10u, texture_bucket_10)
#endif
#if LUCERNA_BUCKETS > 11
  LUCERNA_BUCKET_READ(11u, texture_bucket_11)
#endif
  return texel;
}

#endif
