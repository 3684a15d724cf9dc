// Prefix sum, last step: within every run, from what the runs before it sum up to. Elements are read before they are
// written, by one invocation, so that output and input may be one buffer.
#include "lib/scan.glsl"
layout(local_size_x = LUCERNA_SCAN_GROUP) in;
layout(scalar) readonly buffer ScanSums { uint scan_sums[]; };
layout(scalar) writeonly buffer ScanOut { uint scan_out[]; };

void main() {
  uint index = global_index(), count = scan_count(), length = scan_run_length(count);
  Run run = run_of(index, run_count(count, length), length, count);
  if (run.first >= run.end) return;
  uint sum = scan_sums[index];
  for (uint at = run.first; at < run.end; at += 4u) {
    uvec4 v = scan_fetch(at, run.end);
    uint y = sum + v.x, z = y + v.y, w = z + v.z;
    scan_out[at] = sum;
    if (at + 1u < run.end) scan_out[at + 1u] = y;
    if (at + 2u < run.end) scan_out[at + 2u] = z;
    if (at + 3u < run.end) scan_out[at + 3u] = w;
    sum = w + v.w;
  }
}
