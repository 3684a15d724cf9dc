// A hash of 32 bits.
#ifndef LUCERNA_LIB_HASH
#define LUCERNA_LIB_HASH

uint hash_mix(uint x) {  // lowbias32 (C. Wellons, "Prospecting for hash functions", 2018)
  x ^= x >> 16; x *= 0x7feb352du;
  x ^= x >> 15; x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}
#endif
