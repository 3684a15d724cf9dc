// Weighted reservoir sampling of one item from a stream (M. Chao 1982), with a single random number.
#ifndef LUCERNA_LIB_RESERVOIR
#define LUCERNA_LIB_RESERVOIR

struct Reservoir {
  float u;      // in [0, 1), independent of the items drawn so far
  float total;  // sum of the weights so far
};

// True if the new item replaces the former one. The remainder of the random number is uniform again.
bool reservoir_draw(inout Reservoir r, float weight) {
  float before = r.total, at = r.u * (before + weight);
  r.total = before + weight;
  bool drawn = weight > 0.0 && at < weight;
  if (weight > 0.0) r.u = drawn ? at / weight : min((at - weight) / max(before, 1e-30), 1.0);
  return drawn;
}
#endif
