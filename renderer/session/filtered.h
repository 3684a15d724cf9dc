#pragma once
// A filtered picture (film/filter/): of a finished picture at once, or of the window's in work items between
// its samples.
#include <functional>
#include <map>
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
  uint64_t paths = 0;                            ///< of the filtered picture
  std::map<std::string, double> kernel_ms = {};  ///< device time
  double ms() const;                             ///< of all kernels
};

/// Input of the filter, and how its error is estimated.
struct FilterJob {
  const film::Film& film;
  uint32_t tile;          ///< side of a tile [pixels]
  float luminance_floor;  ///< as filter_error()
  uint64_t paths;         ///< in the film
  uint32_t looked_up;     ///< components (bits) with record lookups
};

class PictureFilter {
 public:
  PictureFilter(gpu::Device& device, gpu::ShaderCompiler& compiler) : device_(device), compiler_(compiler) {}

  /// Starts filtering. The film must not change while working().
  void begin(const FilterJob& job);
  /// Runs the next work item; working() is false after the last. Throws Error like film::Filter; the work is
  /// then cancelled. `sight` provides the visible surfaces, and traces them if needed.
  void step(Engine& engine, const PictureView& view, PixelSight& sight, const std::function<bool()>& cancel);
  bool working() const { return job_.has_value(); }
  void stop();
  /// Result, once working() is false.
  Filtered take() { return std::move(result_); }

 private:
  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  std::optional<film::Filter> filter_;  ///< kernels are compiled at the first use
  std::optional<FilterJob> job_;
  bool begun_ = false,
       filtered_ = false;  ///< progress: visible surfaces known; filtered, error not estimated yet
  Filtered result_;
};

/// "filtered; estimated error 1.2 %": for the metadata of files.
std::string filter_text(const film::FilterError& error);
/// Adds the layers filtered (the sum), filtered.COMPONENT and filtered.error (standard error of the
/// luminance).
void add_filtered_layers(film::FilmImage& out, const Filtered& filtered);

}  // namespace lucerna::session
