// Padded Owen-scrambled Sobol points: B. Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020.
// Each pad is a two-dimensional (0,2)-sequence (Sobol dimensions 0 and 1) with its own index shuffle and scrambles, derived
// by hashing (pixel, seed, half, pad). Even and odd samples of a pixel are two independently scrambled sequences: the two
// halves for the error estimate.
#ifndef LUCERNA_LIB_SAMPLER
#define LUCERNA_LIB_SAMPLER
#include "lib/variants.glsl"
#include "lib/hash.glsl"

// Pads: 0 pixel, 1 lens, then k_pads_per_vertex for every scattering event.
const uint k_pad_pixel = 0u;
const uint k_pad_lens = 1u;
const uint k_pad_first_vertex = 2u;
const uint k_pads_per_vertex = 5u;
const uint k_pad_light_choice = 0u;  // x: which light, y: roulette
const uint k_pad_light_uv = 1u;
const uint k_pad_lobe = 2u;          // x: lobe, y: label; of a null event's stream: x by alpha, y through a pane
const uint k_pad_direction = 3u;
const uint k_pad_light_detail = 4u;  // which texel of the environment
// From here on one for each vertex: selects the record of an irradiance cache.
const uint k_pad_record = 0x8000u;
// From here on no pads but the streams of null events.
const uint k_pad_null = 0x10000u;
// Of the whole path: its wavelength (lib/dispersion.glsl).
const uint k_pad_wavelength = 0x20000u;

//
// Coherent sampling (LUCERNA_COHERENT: log2 of the side of a tile in pixels): all pixels of a tile share the sequences, so
// that neighbouring paths are nearly parallel; each pixel has a separate digital shift below the first k_shared_bits binary
// digits, so that they do not repeat each other. A pixel's points are still uniform and its halves independent; the pixels
// of a tile are correlated, so the noise of a tile's mean is not the sum of theirs.

struct Sampler {
  uint key;    // of pixel (or tile), seed and half
  uint index;  // in the half's sequence
#if LUCERNA_COHERENT
  uint pixel_key;
#endif
};
const uint k_shared_bits = 4u;

uint hash_combine(uint seed, uint v) { return hash_mix(seed ^ (v * 0x9e3779b9u + 0x7f4a7c15u + (seed << 6) + (seed >> 2))); }

// `pixel`: y * width + x.
Sampler make_sampler(uint pixel, uint width, uint sample_index, uint seed) {
  Sampler s;
  uint seeded = hash_mix(seed + 0x51633e2du);
#if LUCERNA_COHERENT
  uint tile = ((pixel / width) >> LUCERNA_COHERENT << 16) + (pixel % width >> LUCERNA_COHERENT);
  s.key = hash_combine(hash_combine(seeded, tile), sample_index & 1u);
  s.pixel_key = hash_combine(seeded + 1u, pixel);
#else
  s.key = hash_combine(hash_combine(seeded, pixel), sample_index & 1u);
#endif
  s.index = sample_index >> 1;
  return s;
}

// Sample number of a branch: in the same half; the branches of all samples form one sequence.
uint branch_sample(uint sample_index, uint branches, uint branch) {
  return ((sample_index >> 1) * branches + branch) << 1 | (sample_index & 1u);
}

// Laine-Karras style permutation of reversed bits: an Owen scramble (Burley's improved constants are his; these are
// the ones of N. Vegdahl, "Building a Better LK Hash", 2021).
uint owen_scramble_reversed(uint x, uint seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}
uint owen_scramble(uint x, uint seed) { return bitfieldReverse(owen_scramble_reversed(bitfieldReverse(x), seed)); }

// Second Sobol dimension: Pascal's matrix mod 2 applied to the index by xor-shifts; result is bit-reversed.
uint sobol_1_reversed(uint i) {
  i ^= (i & 0xaaaaaaaau) >> 1;  // each step is one factor of the matrix
  i ^= (i & 0xccccccccu) >> 2;
  i ^= (i & 0xf0f0f0f0u) >> 4;
  i ^= (i & 0xff00ff00u) >> 8;
  i ^= i >> 16;
  return i;
}

uvec2 sample_2d_bits(Sampler s, uint pad) {
  uint key = hash_combine(s.key, pad);
  uint index = owen_scramble(s.index, key);           // nested uniform shuffle of the order
  uint rx = owen_scramble_reversed(index, hash_mix(key ^ 0xa511e9b3u));  // dimension 0 reversed is the index itself
  uint ry = owen_scramble_reversed(sobol_1_reversed(index), hash_mix(key ^ 0x63d83595u));
  uvec2 bits = uvec2(bitfieldReverse(rx), bitfieldReverse(ry));
#if LUCERNA_COHERENT
  uint shift = hash_combine(s.pixel_key, pad);
  bits ^= uvec2(shift, hash_mix(shift)) >> k_shared_bits;
#endif
  return bits;
}

// True with probability p: from 32 random bits, exact to 2^-32 for p below 1/2 and to 2^-24 above, where floats are that far
// apart. Tables use such p (upload/alias_table.cpp).
bool coin_below(uint bits, float p) {
  return p < 0.5 ? float(bits) * (1.0 / 4294967296.0) < p : float(bits >> 8) * (1.0 / 16777216.0) < p;
}
// 24 bits keep the value strictly below 1.
vec2 to_unit(uvec2 bits) { return vec2(bits >> 8) * (1.0 / 16777216.0); }
vec2 sample_2d(Sampler s, uint pad) { return to_unit(sample_2d_bits(s, pad)); }

// Random numbers of the next null event (alpha, undeflected through a pane), after `nulls` of them since the last scattering
// event. Separate from those of other null events and of the scattering vertex behind, whose dimensions do not depend on
// null events.
Sampler null_sampler(Sampler s, uint nulls) {
  s.key = hash_combine(s.key, k_pad_null + nulls);
#if LUCERNA_COHERENT
  s.pixel_key = hash_combine(s.pixel_key, k_pad_null + nulls);
#endif
  return s;
}

uvec2 sample_vertex_bits(Sampler s, uint depth, uint what) {
  return sample_2d_bits(s, k_pad_first_vertex + depth * k_pads_per_vertex + what);
}
vec2 sample_vertex(Sampler s, uint depth, uint what) { return to_unit(sample_vertex_bits(s, depth, what)); }

#endif
