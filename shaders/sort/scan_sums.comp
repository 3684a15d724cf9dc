// Prefix sum, first step: the sum of every run.
#include "lib/scan.glsl"
layout(local_size_x = LUCERNA_SCAN_GROUP) in;
layout(scalar) writeonly buffer ScanSums { uint scan_sums[]; };

void main() {
  uint index = global_index(), count = scan_count(), length = scan_run_length(count);
  Run run = run_of(index, run_count(count, length), length, count);
  if (run.first >= run.end) return;
  uvec4 sum = uvec4(0u);
  for (uint at = run.first; at < run.end; at += 4u) sum += scan_fetch(at, run.end);
  scan_sums[index] = sum.x + sum.y + sum.z + sum.w;
}
