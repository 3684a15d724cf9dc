// Lays the marks of records' normals over the picture (ticks.comp).
#include "lib/invocation.glsl"
#include "lib/math.glsl"
layout(local_size_x = 64) in;
#include "shaders/shared/cache_inspect.h"
layout(push_constant, scalar) uniform Push { CacheTicksPush push; };
uniform samplerBuffer record_texels;
#include "irradiance_cache/ink.glsl"
layout(scalar) readonly buffer Ticks { uint marks[]; };
layout(scalar) buffer Picture { uint picture[]; };

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  uint mark = marks[pixel];
  if (mark == 0u) return;
  float cover = float(mark >> k_tick_cover_shift & 0x7fu) / 127.0;
  // Lighter than the discs' ink, so that it parts from their rims.
  bool core = (mark & k_tick_core) != 0u;
  vec3 ink = core ? mix(record_ink(k_tick_record - (mark & k_tick_record), push.color, push.lo, push.hi), vec3(1.0), 0.4)
                  : vec3(0.0);
  uint packed = picture[pixel];
  vec3 color = vec3(packed & 0xffu, packed >> 8 & 0xffu, packed >> 16 & 0xffu) / 255.0;
  color = mix(color, ink, cover * (core ? 0.95 : 0.4));
  uvec3 bytes = uvec3(clamp(color, vec3(0.0), vec3(1.0)) * 255.0 + 0.5);
  picture[pixel] = bytes.x | bytes.y << 8 | bytes.z << 16 | 0xff000000u;
}
