// Prefix sum, second step: scans the sums of all runs in place, in one workgroup.
#include "lib/scan.glsl"
layout(local_size_x = 64) in;
layout(scalar) buffer ScanSums { uint scan_sums[]; };
layout(scalar) writeonly buffer ScanTotal { uint scan_total[]; };
shared uint part[64];

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint count = scan_count(), runs = run_count(count, scan_run_length(count)), each = (runs + 63u) / 64u;
  uint first = lane * each, end = min(first + each, runs), sum = 0u;
  for (uint i = first; i < end; ++i) sum += scan_sums[i];
  part[lane] = sum;
  barrier();
  uint before = 0u;
  for (uint i = 0u; i < lane; ++i) before += part[i];
  if (lane == 63u) scan_total[push.total_at] = before + sum;
  for (uint i = first; i < end; ++i) {
    uint value = scan_sums[i];
    scan_sums[i] = before;
    before += value;
  }
}
