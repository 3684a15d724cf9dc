// Sums of several vectors over a workgroup of 64. The including kernel defines their number, LUCERNA_SUM_ROWS.
#ifndef LUCERNA_LIB_SUM_ROWS
#define LUCERNA_LIB_SUM_ROWS

shared vec4 lanes[LUCERNA_SUM_ROWS][64];

// Sums all rows over the workgroup; valid in the first lane.
void add_up(uint lane) {
  for (uint half_way = 32u; half_way > 0u; half_way >>= 1) {
    barrier();
    if (lane < half_way)
      for (int k = 0; k < LUCERNA_SUM_ROWS; ++k) lanes[k][lane] += lanes[k][lane + half_way];
  }
  barrier();
}
#endif
