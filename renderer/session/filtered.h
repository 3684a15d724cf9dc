#pragma once
// A picture, filtered (film/filter/): a finished one at once, or the window's in pieces between its samples.
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "film/filter/filter.h"
#include "film/filter/filter_error.h"
#include "film/io/image_file.h"
#include "session/pixel_sight.h"

namespace lucerna::session {

struct Filtered {
  std::unique_ptr<film::Film> film;
  film::FilterError error;
  double ms = 0;       ///< device time that it took
  uint64_t paths = 0;  ///< of the picture that was filtered
};

/// What is to be filtered, and how it is judged.
struct FilterJob {
  const film::Film& film;
  uint32_t tile;          ///< side of a tile [pixels]
  float luminance_floor;  ///< as filter_error()
  uint64_t paths;         ///< that the film holds
  uint32_t looked_up;     ///< components (bits) that look records up
};

class PictureFilter {
 public:
  PictureFilter(gpu::Device& device, gpu::ShaderCompiler& compiler) : device_(device), compiler_(compiler) {}

  /// Begins to filter the picture. The film stays as it is while working().
  void begin(const FilterJob& job);
  /// The next piece; working() is false after the last. Throws Error as film::Filter; the work is stopped
  /// then. `sight` is asked what the pixels show, and looks where it is not known yet.
  void step(Engine& engine, const PictureView& view, PixelSight& sight, const std::function<bool()>& cancel);
  bool working() const { return job_.has_value(); }
  void stop();
  /// Of the picture begun last, once working() is false.
  Filtered take() { return std::move(result_); }

 private:
  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  std::optional<film::Filter> filter_;  ///< its kernels are compiled when they are first called for
  std::optional<FilterJob> job_;
  bool begun_ = false, filtered_ = false;  ///< of the job: after its sight, and before its error is known
  Filtered result_;
};

/// "filtered; estimated error 1.2 %": for the metadata of files.
std::string filter_text(const film::FilterError& error);
/// Adds the layers filtered (the sum), filtered.COMPONENT and filtered.error (standard error of the
/// luminance).
void add_filtered_layers(film::FilmImage& out, const Filtered& filtered);

}  // namespace lucerna::session
