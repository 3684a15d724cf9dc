// How much light has changed, from noisy sums of it over many places: what the window's preview asks of records and of the
// picture. Kernels have workgroups of 64, and say with LUCERNA_SUM_ROWS how many vectors they sum.
#ifndef LUCERNA_LIB_LIGHT_CHANGE
#define LUCERNA_LIB_LIGHT_CHANGE

const float k_most_light_ratio = 16.0;  // that light is taken to have grown by
const float k_dark_place = 0.1;         // no place weighs more than one with so much of the mean light

// How far sums are believed, where what is known without them is `off` from them, squared: nothing within two standard errors,
// by the square that has been found (`spread`) or by that which was to be expected; all of it far off.
vec4 light_belief(vec4 off, vec4 spread, vec4 expected) {
  vec4 found = clamp(1.0 - 4.0 * spread / max(off, vec4(1e-20)), 0.0, 1.0);
  return found * smoothstep(4.0 * expected, 9.0 * expected + 1e-20, off);
}

#ifdef LUCERNA_SUM_ROWS
shared vec4 lanes[LUCERNA_SUM_ROWS][64];

// Sums over the workgroup, in all rows: in the first lane.
void add_up(uint lane) {
  for (uint half_way = 32u; half_way > 0u; half_way >>= 1) {
    barrier();
    if (lane < half_way)
      for (int k = 0; k < LUCERNA_SUM_ROWS; ++k) lanes[k][lane] += lanes[k][lane + half_way];
  }
  barrier();
}
#endif
#endif
