#pragma once
// Error of the picture from the errors of records. These errors are common to all samples of a pixel, so the
// difference of the film's halves does not contain them, and more samples do not reduce them.
//
// A picture is linear in the records it reads. The error of a region R (a pixel, a tile, everything) is
//   delta_R = sum_k c_k(R) e_k,
// where e_k is the error of record k and c_k(R) the mean, over R's paths, of their throughput times k's
// interpolation weight. Pixels that read the same record have correlated errors, so variances of pixels do
// not add up.
//
// Noise: e_k = sigma_k xi_k, with the standard error stored in record k, and independent xi_k of mean 0 and
// variance 1. In each of k_lookup_lanes lanes every xi_k is a random sign. Paths are traced through the
// picture and every lane is summed over R; the mean square over the lanes is Var(delta_R) = sum_k c_k^2
// sigma_k^2 (M. Hutchinson's estimator, 1989). The number of lanes is the number of degrees of freedom. The
// sums of two independent paths per pixel are multiplied, which keeps the paths' own noise out of the square.
//
// Records whose rays end in other records inherit their errors. On average such a record's light is that of
// its rays, so paths that pass the first lookup and continue like those rays read what the record has read:
// errors propagate over all further lookups.
//
// Interpolation: the leave-one-out residual of record k, the prediction of its neighbours minus its own
// value, measures the curvature of the light and thus k's error at any distance, with its sign
// (leave_one_out.comp). It is propagated along the same paths and summed in the same way. Its noise, which
// mostly cancels over a region because each record occurs with both signs, is estimated with the same lanes
// and subtracted from the square. The residual misses errors of a record without neighbours, and errors that
// all neighbours share.
#include <functional>

#include "film/film.h"
#include "gpu/kernel.h"
#include "transport/wavefront.h"

namespace lucerna::irradiance_cache {

class PictureError {
 public:
  /// Maximum number of traced pixels; in larger pictures one represents several.
  static constexpr uint32_t k_most_pixels = 240'000;

  /// `defines`: Cache::defines().
  PictureError(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& defines);

  /// Inputs: frame of the picture's paths; number of evaluated records, and whether they read each other;
  /// bindings of lookup.glsl; `candidates` with the notes of the paths; and a function that writes the cache
  /// frame with the kind of notes: k_probe_*.
  struct Work {
    transport::Wavefront& wavefront;
    film::Film& film;
    const shared::Frame& frame;
    uint32_t enabled;
    uint32_t records;
    bool recursive;
    const gpu::Buffer& candidates;
    std::function<void(gpu::Resources&)> bind;
    std::function<void(uint32_t probing)> write_frame;
    std::function<bool()> cancel;
  };
  /// Restarts at the first pixel.
  void begin() { done_ = 0, residuals_for_ = 0; }
  /// Processes the next pixels, as many as there are slots; the last call completes the film's errors.
  /// Afterwards the wavefront's frame is `frame` again. False if cancelled.
  bool step(const Work& work);
  uint64_t bytes() const { return residuals_.bytes() + first_.bytes(); }

 private:
  void leave_one_out(const Work& work);
  bool propagate(const Work& work, uint32_t side, uint32_t end);

  gpu::Device& device_;
  gpu::Kernel leave_one_out_, propagating_;
  gpu::Buffer residuals_, first_, blocks_;
  gpu::Resources resources_;
  uint32_t done_ = 0;           // blocks
  uint32_t residuals_for_ = 0;  // number of records with residuals
};

}  // namespace lucerna::irradiance_cache
