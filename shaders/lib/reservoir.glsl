// One of many that come one after the other, each as likely as its weight among all (M. Chao 1982), by a single number.
#ifndef LUCERNA_LIB_RESERVOIR
#define LUCERNA_LIB_RESERVOIR

struct Reservoir {
  float u;      // in [0, 1), independent of what has been drawn
  float total;  // of the weights that have come
};

// Whether the one that comes takes the place of the one drawn before. What is left of the number within its part is even again.
bool reservoir_draw(inout Reservoir r, float weight) {
  float before = r.total, at = r.u * (before + weight);
  r.total = before + weight;
  bool drawn = weight > 0.0 && at < weight;
  if (weight > 0.0) r.u = drawn ? at / weight : min((at - weight) / max(before, 1e-30), 1.0);
  return drawn;
}
#endif
