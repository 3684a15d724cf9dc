// Lines over the picture in their order, each with a dark edge, so that it is visible on any background.
#ifndef LUCERNA_OVERLAY_LINES
#define LUCERNA_OVERLAY_LINES
#include "overlay/seen.glsl"
#include "shaders/shared/overlay.h"

layout(scalar) readonly buffer OverlayLines { OverlayLine lines[]; };

const float k_line_edge = 1.0;     // pixels
const float k_line_hidden = 0.25;  // factor on alpha behind a surface

// Blends the first `count` lines over the colour of the pixel at `here` (pixels), which shows the surface `seen`.
vec3 lay_lines(vec3 color, vec2 here, Seen seen, uint count) {
  for (uint i = 0u; i < count; ++i) {
    OverlayLine line = lines[i];
    vec2 along = line.to - line.from;
    float t = clamp(dot(here - line.from, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
    float away = distance(here, line.from + t * along);
    float depth = depth_between(line.from_depth, line.to_depth, t);
    // A line between two points of a curved surface runs slightly below it and is not hidden.
    bool hidden = seen.solid && depth > 1.02 * seen.depth + 4.0 * seen.size;
    float alpha = line.alpha * (hidden ? k_line_hidden : 1.0);
    color = mix(color, vec3(0.0), 0.6 * alpha * clamp(line.half_width + k_line_edge + 0.5 - away, 0.0, 1.0));
    color = mix(color, line.color, alpha * clamp(line.half_width + 0.5 - away, 0.0, 1.0));
  }
  return color;
}
#endif
