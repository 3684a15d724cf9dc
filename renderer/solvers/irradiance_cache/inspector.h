#pragma once
// Looks at an irradiance cache for a person: which records serve what a pixel shows and with which weights,
// how many serve the pixels of the picture, and what is drawn over it to show both. All by kernels that use
// the lookup's own functions (shaders/irradiance_cache/lookup.glsl), so that the answers are those of the
// picture.
//
// A pixel asks for records where a path through its centre does, on the smooth surface, as the cache itself
// has looked at the picture (Cache::look_at_picture). What is drawn, and what is asked before the cache has
// looked, is at the mean over the pixel's samples, from the film's depth and normal: where most have met
// nothing there is none. Before its first sample the coarse film stands for it. Kernels are compiled when
// they are first called for.
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "overlay/canvas.h"
#include "shaders/shared/irradiance_cache/inspect.h"
#include "solvers/irradiance_cache/cache.h"

namespace lucerna::irradiance_cache {

/// What asked for a record, by shared::k_origin_*.
inline constexpr std::array<const char*, 3> k_origins{"screen", "world", "recursive"};

/// A record that serves a point.
struct Serving {
  uint32_t record = 0;  ///< index
  float weight = 0;     ///< share of what is interpolated; all that serve add up to 1
  vec2 at{0};           ///< its centre in the picture, pixels from the upper left corner
  float depth = 0;      ///< of its centre along the view axis [m]; not above 0: behind the eye
};

/// A record in whose disc a pixel lies.
struct Covering {
  uint32_t index = 0;
  Record record;  ///< its fields
  vec2 at{0};     ///< its centre in the picture [pixels]
};

/// What there is at a pixel.
struct Inspection {
  uint32_t x = 0, y = 0;  ///< the pixel
  bool solid = false;     ///< a surface is seen there; nothing below holds where not
  uint32_t lookup = 0;    ///< shared::k_asks_*
  struct {
    vec3 position{0}, normal{0};  ///< world space [m]; where records are asked for and with which normal
    float size = 0;               ///< of the pixel there [m]
    float depth = 0;              ///< along the view axis [m]
  } surface;
  uint32_t count = 0;             ///< records that serve
  bool gathers = false;           ///< none does: paths gather there themselves, as Record::crowded
  std::vector<Serving> serving;   ///< heaviest first; no more than shared::k_inspect_most
  std::optional<Covering> under;  ///< the record in whose disc the pixel lies; of several the one whose
                                  ///< centre is nearest
};

/// How many records serve the pixels that show a diffuse surface, and so ask for them.
struct Overlap {
  uint64_t pixels = 0, served = 0;  ///< that ask; of these with a record at least
  uint64_t gathered = 0;            ///< ... and those with none where paths gather, as Record::crowded
  double mean = 0;                  ///< records, over the pixels that are served
  double listed = 0;                ///< records that a lookup goes through, over the pixels that ask
  uint32_t most = 0;
  /// Pixels that 0, 1, ... records serve; the last counts all that more do.
  std::vector<uint32_t> histogram;
};

class Inspector {
 public:
  /// Both must outlive it.
  Inspector(gpu::Device& device, gpu::ShaderCompiler& compiler);
  ~Inspector();

  /// `x`, `y` are inside the picture. Throws Error when a kernel does not compile; so do the others.
  Inspection inspect(const overlay::Canvas& canvas, const Cache& cache, uint32_t x, uint32_t y);
  /// Over the film's pixels.
  Overlap overlap(const overlay::Canvas& canvas, const Cache& cache);
  /// A lookup at every pixel of the film that asks, of which nothing is kept: to be timed.
  /// `defines`: Cache::defines(); those of the first call count.
  void look_up(const overlay::Canvas& canvas, const Cache& cache, const gpu::Defines& defines);

  /// Draws over the film's picture, from the pixel to each record that serves it, a line as wide and opaque
  /// as its weight says, and the border of the record in whose disc the pixel lies.
  void draw_lines(const overlay::Canvas& canvas, const Cache& cache, const Inspection& inspection);
  /// Draws the records' normals over the film's picture, as short lines from their centres, coloured by one
  /// of shared::k_record_by_*.
  void draw_normals(const overlay::Canvas& canvas, const Cache& cache, uint32_t color);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::irradiance_cache
