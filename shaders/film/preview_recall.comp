// Shows the previous picture from the present camera until there is new light. Newly visible surfaces take the light next to
// them, preferably of surfaces behind, found for cells of k_preview_first_step pixels. The picture may have more pixels than
// those recalled.
#include "lib/display.glsl"
#include "lib/invocation.glsl"
#include "lib/picture.glsl"
#include "film/preview.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PreviewRecallPush push; };
uniform samplerBuffer history_texels, history_surfaces;
uniform samplerBuffer cell_texels;  // per cell: light over the surface's colour; cell_word()
uniform samplerBuffer shown_texels;  // of pass 2, for pass 3: tone-mapped
layout(scalar) writeonly buffer Cells { vec4 cells[]; };
layout(scalar) writeonly buffer Picture { uint picture[]; };

const int k_reach = 64;    // cells
const float k_sky = 10.0;  // depth assumed for the background [m], so that it does not outweigh an adjacent wall

PreviewSurface surface_at(int pixel) { return preview_surface(texelFetch(history_surfaces, pixel)); }
// Divisor of the light of cells.
vec3 modulation_at(int pixel) { return push.seen != 0u ? preview_modulation(surface_at(pixel)) : vec3(1.0); }

// Approximate depth of the previous picture's surface; 0: surface and light are unknown.
float depth_at(int pixel) {
  float depth = texelFetch(history_surfaces, pixel).x;
  if (depth < 0.0 && depth > k_preview_about) return 0.0;
  if (push.seen != 0u && preview_light(history_texels, pixel).of[0].w < 0.0) return 0.0;
  depth = depth < 0.0 ? k_preview_about - depth : depth;
  return depth > 0.0 ? depth : k_sky;
}
vec3 shown_at(int pixel) {
  PreviewLight l = preview_light(history_texels, pixel);
  vec3 sum = vec3(0.0);
  for (uint c = 0u; c < k_component_count; ++c) sum += l.of[c].rgb * float(push.show >> c & 1u);
  return sum;
}

// Weight of light that was divided by this colour: light of dark or strongly coloured surfaces says little of that on others,
// above all where they mirror it, so that it has not their colour.
float trust(vec3 modulation) { return min(modulation.r, min(modulation.g, modulation.b)); }
const float k_of_emitter = 0.02;  // ... of an emitter's light, relative to that

// Depth and mean trust as one number; 0: unknown.
float cell_word(float depth, float trust) { return uintBitsToFloat(packHalf2x16(vec2(min(depth, 60000.0), trust))); }
vec2 depth_and_trust(vec4 cell) { return unpackHalf2x16(floatBitsToUint(cell.w)); }

// Mean over the cell's known pixels.
vec4 cell_mean(ivec2 cell) {
  vec4 sum = vec4(0.0);
  float known = 0.0, trusts = 0.0;
  for (int k = 0; k < 4; ++k) {
    ivec2 at = min(int(k_preview_first_step) * cell + int(k_preview_first_step / 2u) * ivec2(k & 1, k >> 1),
                   ivec2(push.width, push.height) - 1);
    int pixel = at.y * int(push.width) + at.x;
    float depth = depth_at(pixel);
    if (depth <= 0.0) continue;
    vec3 modulation = modulation_at(pixel);
    float trusted = trust(modulation) * (push.seen != 0u && surface_at(pixel).emits ? k_of_emitter : 1.0);
    sum += trusted * vec4(shown_at(pixel) / modulation, depth);
    trusts += trusted;
    known += 1.0;
  }
  return known > 0.0 ? vec4(sum.rgb / trusts, cell_word(sum.w / trusts, trusts / known)) : vec4(0.0);
}

// Weighted mean of the first known cells in eight directions. Steps double, so that the search may span the whole picture.
vec4 cell_around(ivec2 cell, ivec2 size) {
  vec4 sum = vec4(0.0);
  float weights = 0.0, trusts = 0.0;
  for (int k = 0; k < 9; ++k) {
    ivec2 way = ivec2(k % 3, k / 3) - 1;
    for (int far = k == 4 ? 2 * k_reach : 1; far <= k_reach; far *= 2) {
      ivec2 at = cell + far * way;
      if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) break;
      vec4 there = texelFetch(cell_texels, at.y * size.x + at.x);
      if (there.w <= 0.0) continue;
      vec2 surface = depth_and_trust(there);
      float weight = square(square(surface.x)) / float(far), trusted = weight * surface.y;
      sum += trusted * vec4(there.rgb, surface.x);
      weights += weight;
      trusts += trusted;
      break;
    }
  }
  return weights > 0.0 ? vec4(sum.rgb / trusts, cell_word(sum.w / trusts, trusts / weights)) : vec4(0.0);
}

void main() {
  uint index = global_index();
  ivec2 size = (ivec2(push.width, push.height) + int(k_preview_first_step) - 1) / int(k_preview_first_step);
  if (push.pass < 2u) {
    if (index >= uint(size.x * size.y)) return;
    ivec2 cell = ivec2(int(index) % size.x, int(index) / size.x);
    vec4 here = push.pass == 0u ? cell_mean(cell) : texelFetch(cell_texels, int(index));
    if (push.pass == 1u && here.w <= 0.0) here = cell_around(cell, size);
    cells[index] = here;
    return;
  }
  if (push.pass == 3u) {
    if (index >= push.across * push.down) return;
    vec2 p = (vec2(index % push.across, index / push.across) + 0.5) * vec2(push.width, push.height) / vec2(push.across, push.down) - 0.5;
    ivec2 base = ivec2(floor(p)), last = ivec2(push.width, push.height) - 1;
    vec2 f = p - vec2(base);
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 4; ++k) {
      ivec2 corner = ivec2(k & 1, k >> 1), at = clamp(base + corner, ivec2(0), last);
      vec2 g = mix(1.0 - f, f, vec2(corner));
      sum += g.x * g.y * texelFetch(shown_texels, at.y * int(push.width) + at.x).rgb;
    }
    picture[index] = picture_packed(sum);
    return;
  }
  if (index >= push.width * push.height) return;
  vec3 here;
  if (depth_at(int(index)) > 0.0) {
    here = shown_at(int(index));
  } else {
    vec2 p = (vec2(index % push.width, index / push.width) + 0.5) / float(k_preview_first_step) - 0.5;
    ivec2 base = ivec2(floor(p));
    vec2 f = p - vec2(base);
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 4; ++k) {
      ivec2 corner = ivec2(k & 1, k >> 1), at = clamp(base + corner, ivec2(0), size - 1);
      vec4 there = texelFetch(cell_texels, at.y * size.x + at.x);
      vec2 g = mix(1.0 - f, f, vec2(corner));
      sum += (there.w > 0.0 ? (g.x * g.y + 1e-4) * depth_and_trust(there).y : 0.0) * vec4(there.rgb, 1.0);
    }
    here = sum.rgb / max(sum.w, 1e-20) * modulation_at(int(index));
  }
  vec3 shown = display_color(here * push.history_scale, push.curve);
  if (push.tint != 0u) shown = preview_tinted(shown, 1.0);
  if (push.seen != 0u)
    cells[index] = vec4(shown, 1.0);
  else
    picture[index] = picture_packed(shown);
}
