#pragma once
// A finished picture, filtered (film/filter/).
#include <memory>
#include <string>

#include "film/filter/filter.h"
#include "film/filter/filter_error.h"
#include "film/io/image_file.h"

namespace lucerna::session {

struct Filtered {
  std::unique_ptr<film::Film> film;
  film::FilterError error;
  double ms = 0;       ///< device time that it took
  uint64_t paths = 0;  ///< of the picture that was filtered
};

/// Runs the stream. `side`: of a tile [pixels]. Throws Error as film::Filter::apply.
Filtered filter(gpu::Device& device, gpu::ShaderCompiler& compiler, gpu::Stream& stream,
                const film::Film& film, uint32_t side, float luminance_floor);
/// "filtered; estimated error 1.2 %": for the metadata of files.
std::string filter_text(const film::FilterError& error);
/// Adds the layers filtered (the sum), filtered.COMPONENT and filtered.error (standard error of the
/// luminance).
void add_filtered_layers(film::FilmImage& out, const Filtered& filtered);

}  // namespace lucerna::session
