// The pixel at the centre of a window, and its surface. Needs push and filter_surfaces.
#ifndef LUCERNA_FILM_FILTER_WINDOW
#define LUCERNA_FILM_FILTER_WINDOW
struct Window {
  ivec2 xy;
  FilterSurface surface;
  vec2 slope;  // of depth [m a pixel]
};

// A window is a disk: rows -reach to reach, each from -window_row(reach, y) to window_row(reach, y). Both bound loops, because a
// loop is left early where a condition within it would not save its work. A reach of 2 has 21 pixels, one of 3 has 37.
int window_row(int reach, int y) { return min(reach, reach + 1 - abs(y)); }

bool window_has(ivec2 at) { return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(push.width, push.height))); }

float window_depth(ivec2 at) {
  ivec2 last = ivec2(push.width, push.height) - 1;
  ivec2 there = clamp(at, ivec2(0), last);
  return there == at ? filter_depth(texelFetch(filter_surfaces, at.y * int(push.width) + at.x)) : 0.0;
}

Window window_at(uint pixel) {
  Window w;
  w.xy = ivec2(pixel % push.width, pixel / push.width);
  w.surface = filter_surface(texelFetch(filter_surfaces, int(pixel)));
  float z = w.surface.depth;
  w.slope = vec2(filter_slope(window_depth(w.xy - ivec2(1, 0)), z, window_depth(w.xy + ivec2(1, 0))),
                 filter_slope(window_depth(w.xy - ivec2(0, 1)), z, window_depth(w.xy + ivec2(0, 1))));
  return w;
}
#endif
