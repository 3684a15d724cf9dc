// Radix sort, last step of a pass: moves the entries of every run, in order, to the place of their digit.
#include "lib/variants.glsl"
#include "lib/sort.glsl"
uniform usamplerBuffer sort_places;   // the prefix sum of the table
#if LUCERNA_SORT_WIDE
layout(scalar) writeonly buffer SortOut { SortEntry64 sort_out[]; };
#else
layout(scalar) writeonly buffer SortOut { SortPair sort_out[]; };
#endif

void main() {
  uint index = global_index(), count = sort_count(), length = sort_run_length(count), runs = run_count(count, length);
  if (index >= runs) return;
  Run run = run_of(index, runs, length, count);
  for (uint bin = 0u; bin < push.bins; ++bin) {
    uint at = bin * runs + index;
    uvec4 four = texelFetch(sort_places, int(at >> 2));
    uvec2 two = (at & 2u) != 0u ? four.zw : four.xy;
    counters[bin] = (at & 1u) != 0u ? two.y : two.x;
  }
#if LUCERNA_SORT_WIDE
  for (uint at = run.first; at < run.end; ++at) {
    uvec4 entry = texelFetch(sort_in, int(at));
    uint place = take(digit(push.high_word != 0u ? entry.y : entry.x));
    sort_out[place].low = entry.x;
    sort_out[place].high = entry.y;
    sort_out[place].value = entry.z;
  }
#else
  for (uint at = run.first; at < run.end; at += 2u) {
    uvec4 entries = texelFetch(sort_in, int(at >> 1));
    uint place = take(digit(entries.x));
    sort_out[place] = SortPair(entries.x, entries.y);
    if (at + 1u < run.end) {
      place = take(digit(entries.z));
      sort_out[place] = SortPair(entries.z, entries.w);
    }
  }
#endif
}
