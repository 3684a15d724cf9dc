// Prefix sum, last step: scans every run, starting from the sum of the runs before it. One invocation reads elements before
// it writes them. If output and input are one buffer, it is read under the name that is written: under another name the
// compiler may read it again after the write.
#include "lib/scan.glsl"
#ifndef LUCERNA_SCAN_IN_PLACE
#define LUCERNA_SCAN_IN_PLACE 0
#endif
layout(local_size_x = LUCERNA_SCAN_GROUP) in;
layout(scalar) readonly buffer ScanSums { uint scan_sums[]; };
#if LUCERNA_SCAN_IN_PLACE
layout(scalar) buffer ScanOut { uint scan_out[]; };

uvec4 fetch(uint at, uint end) {
  uint left = end - at;
  return uvec4(scan_out[at], left > 1u ? scan_out[at + 1u] : 0u, left > 2u ? scan_out[at + 2u] : 0u,
               left > 3u ? scan_out[at + 3u] : 0u);
}
#else
layout(scalar) writeonly buffer ScanOut { uint scan_out[]; };

uvec4 fetch(uint at, uint end) {
  return scan_fetch(at, end);
}
#endif

void main() {
  uint index = global_index(), count = scan_count(), length = scan_run_length(count);
  Run run = run_of(index, run_count(count, length), length, count);
  if (run.first >= run.end) return;
  uint sum = scan_sums[index];
  for (uint at = run.first; at < run.end; at += 4u) {
    uvec4 v = fetch(at, run.end);
    uint y = sum + v.x, z = y + v.y, w = z + v.z;
    scan_out[at] = sum;
    if (at + 1u < run.end) scan_out[at + 1u] = y;
    if (at + 2u < run.end) scan_out[at + 2u] = z;
    if (at + 3u < run.end) scan_out[at + 3u] = w;
    sum = w + v.w;
  }
}
