#pragma once
// What the records' own errors make of the picture: errors that all samples of a pixel have in common, so
// that the film's halves do not tell of them and no further sample takes them away.
//
// A picture reads records linearly. What a region R of it (a pixel, a tile, all) is off by is
//   delta_R = sum_k c_k(R) e_k,
// where e_k is what record k is off by and c_k(R) the mean over R's paths of their throughput times k's
// weight in the interpolation. Pixels that read one record err together, so that variances of pixels do not
// add up.
//
// Noise: e_k = sigma_k xi_k, with the standard error that record k keeps and xi of mean 0 and variance 1,
// independent from record to record. In each of k_record_lanes lanes every xi_k is drawn anew as a fixed
// sign; paths are sent through the picture, every lane is summed over R, and the mean over the lanes of the
// square of that is Var(delta_R) = sum_k c_k^2 sigma_k^2 (M. Hutchinson's estimator, 1989): the lanes are its
// degrees of freedom. Two independent paths a pixel, whose sums are multiplied, keep the paths' own noise out
// of the square.
//
// Records whose rays end in other records err with them. In the mean such a record's light is that of its
// rays, so that paths which pass the first lookup over and go on as the rays do read what the record has
// read: the errors are propagated over all further lookups, as often as light is.
//
// Interpolation: what the records around k say of the light at its place, less what k says, tells with its
// sign how the light bends there and so by what k is off at any distance (leave_one_out.comp); that is
// propagated along the same paths and summed the same way. The noise in it, mostly cancelled over a region
// because each record comes in once with either sign, is known by the same lanes and taken off the square.
// Where a record is alone, or all around miss the same thing, it does not tell.
#include <functional>

#include "film/film.h"
#include "gpu/kernel.h"
#include "transport/wavefront.h"

namespace lucerna::irradiance_cache {

class PictureError {
 public:
  /// Pixels of the film that have one of the pixels that are traced, at most so many; of larger pictures one
  /// stands for several.
  static constexpr uint32_t k_most_pixels = 240'000;

  /// `defines`: Cache::defines().
  PictureError(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& defines);

  /// What the pass is done with: the paths' frame of the picture, the records that are evaluated, whether
  /// they read each other; binding of what lookup.glsl reads; the cache's note of where paths read,
  /// `candidates`, and what writes the cache frame that says what they note: k_probe_*.
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
  /// Forgets how far the picture has been gone through.
  void begin() { done_ = 0, residuals_for_ = 0; }
  /// Goes through the next pixels, as many as there are slots, and through the last tells the film;
  /// afterwards the wavefront's frame is `frame` again. False when it was cancelled.
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
  uint32_t residuals_for_ = 0;  // records that have residuals
};

}  // namespace lucerna::irradiance_cache
