#pragma once
// Which records are too noisy and get more rays. No device: pure.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lucerna::irradiance_cache {

/// Of a record, by the rays that it has had so far.
struct Noise {
  float error = 0;  ///< standard error of its luminance
  float light = 0;  ///< its luminance, as `error`
  float bound = 0;  ///< of error over light: above it more rays are worth their while
};

/// Records before a record and behind it, of the list, by which it is judged.
inline constexpr size_t k_around = 4;

/// Irradiance, luminance: what records of less are held against, because what they miss is seen less. A tenth
/// of the mean of the first `count`, those without light left out; 1 where none has any.
float dark_luminance(std::span<const float> light, uint32_t count);

/// Indices, rising, of those that are too noisy: whose neighbours in the list have a root mean square error
/// of more than `bound` times their mean light, or times `darkest` where they are darker. Neighbours should
/// be alike: in the order of their places, with as many rays each.
///
/// A record is not judged by itself, because its error and light come of the same rays as the irradiance that
/// it stops with: one that by chance has missed what is bright has too little of both, one that has met too
/// much light has too small a ratio, and stopping at either would bias what is left. So light that few rays
/// find (a caustic) is looked for wherever a record near by has found it. A record that is alone is judged by
/// itself.
std::vector<uint32_t> too_noisy(std::span<const Noise> list, float darkest);

}  // namespace lucerna::irradiance_cache
