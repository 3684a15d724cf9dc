// Radix sort, first step of a pass: counts each digit in every run. The table is ordered by digit, so its prefix sum is the
// destination of each run's entries.
#include "lib/variants.glsl"
#include "lib/sort.glsl"
layout(scalar) writeonly buffer SortTable { uint sort_table[]; };
layout(scalar) writeonly buffer SortTableCount { uint sort_table_count; };

void main() {
  uint index = global_index(), count = sort_count(), length = sort_run_length(count), runs = run_count(count, length);
  if (index == 0u) sort_table_count = runs * push.bins;
  if (index >= runs) return;
  Run run = run_of(index, runs, length, count);
  for (uint bin = 0u; bin < push.bins; ++bin) counters[bin] = 0u;
#if LUCERNA_SORT_WIDE
  for (uint at = run.first; at < run.end; ++at) {
    uvec4 entry = texelFetch(sort_in, int(at));
    take(digit(push.high_word != 0u ? entry.y : entry.x));
  }
#else
  for (uint at = run.first; at < run.end; at += 2u) {
    uvec4 entries = texelFetch(sort_in, int(at >> 1));
    take(digit(entries.x));
    if (at + 1u < run.end) take(digit(entries.z));
  }
#endif
  for (uint bin = 0u; bin < push.bins; ++bin) sort_table[bin * runs + index] = counters[bin];
}
