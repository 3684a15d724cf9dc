// Division of an array into runs: contiguous pieces of equal length, each processed in order by one invocation.
#ifndef LUCERNA_LIB_RUNS
#define LUCERNA_LIB_RUNS

// Length of the array that a kernel works on, from push constants `count` and `count_at` (shaders/shared/sort.h) and the
// words of the buffer that may hold it. A macro, because the buffer has another name in every library.
#define counted(words) (push.count_at == k_sort_count_here ? push.count : min(words[push.count_at], push.count))

struct Run {
  uint first, end;  // elements; empty when the array ends before it
};

// All loops of an invocation together end after 65535 iterations on lavapipe, silently: no run is longer than this.
const uint k_longest_run = 32768u;

// Length of the runs of an array, a multiple of 4 (whole texels): about `wanted` runs of at least `least` elements, more
// of them if they would be too long.
uint run_length(uint count, uint least, uint wanted) {
  uint length = count / wanted + (count % wanted != 0u ? 1u : 0u);
  return (clamp(length, least, k_longest_run) + 3u) & ~3u;
}

// Number of runs.
uint run_count(uint count, uint length) { return count / length + (count % length != 0u ? 1u : 0u); }

Run run_of(uint index, uint runs, uint length, uint count) {
  uint first = index < runs ? index * length : count;
  return Run(first, first + min(length, count - first));
}
#endif
