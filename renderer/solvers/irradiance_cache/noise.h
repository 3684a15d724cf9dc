#pragma once
// Selects records that are too noisy and get more rays. Pure; no device.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lucerna::irradiance_cache {

/// Statistics of a record from its rays so far.
struct Noise {
  float error = 0;  ///< standard error of its luminance
  float light = 0;  ///< its luminance, as `error`
  float bound = 0;  ///< bound of error over light, above which more rays are efficient
};

/// Number of records before and behind a record in the list that are judged with it.
inline constexpr size_t k_around = 4;

/// Minimum luminance in relative errors, because errors of darker records are less visible: a tenth of the
/// mean of the first `count`, without unlit records; 1 if all are unlit.
float dark_luminance(std::span<const float> light, uint32_t count);

/// Rising indices of the records that are too noisy: the root mean square error of a record's neighbours in
/// the list exceeds `bound` times their mean light, or times `darkest` if they are darker. Neighbours should
/// be similar: sorted by place, with equally many rays each.
///
/// A record is not judged alone: its error estimate comes from the same rays as its irradiance. A record that
/// missed a bright feature by chance has too small an error and too little light; one that met it too often
/// has too small a ratio; stopping by either would bias the result. Light that few rays find (a caustic) is
/// therefore searched wherever a nearby record has found it. A record without neighbours is judged alone.
///
/// At most `most` are selected: those that exceed their bound most, earlier ones first among equals.
std::vector<uint32_t> too_noisy(std::span<const Noise> list, float darkest, size_t most = SIZE_MAX);

}  // namespace lucerna::irradiance_cache
