#pragma once
// Inspects an irradiance cache: which records serve a pixel and with which weights, how many serve each
// pixel, and overlays for both. Kernels use the lookup functions of the picture
// (shaders/irradiance_cache/lookup.glsl), so results are exact.
//
// The lookup place of a pixel is on the smooth surface at its centre, as traced by Cache::look_at_picture.
// Overlays, and lookup places before that, use means over the pixel's samples: the film's depth and normal;
// none where most samples hit nothing. Before the first sample the coarse film is used. Kernels are compiled
// at the first use.
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "overlay/canvas.h"
#include "shaders/shared/irradiance_cache/inspect.h"
#include "solvers/irradiance_cache/cache.h"

namespace lucerna::irradiance_cache {

/// Names of the origins of records, by shared::k_origin_*.
inline constexpr std::array<const char*, 3> k_origins{"screen", "world", "recursive"};

/// A record that serves a point.
struct Serving {
  uint32_t record = 0;  ///< index
  float weight = 0;     ///< share in the interpolation; the sum over all that serve is 1
  vec2 at{0};           ///< its centre in the picture [pixels], from the upper left corner
  float depth = 0;      ///< of its centre along the view axis [m]; 0 or less: behind the camera
};

/// A record whose disc covers a pixel.
struct Covering {
  uint32_t index = 0;
  Record record;   ///< its fields
  float read = 0;  ///< Records::published_luminance()
  vec2 at{0};      ///< its centre in the picture [pixels]
};

/// Result for a pixel.
struct Inspection {
  uint32_t x = 0, y = 0;  ///< the pixel
  bool solid = false;     ///< a surface is visible; otherwise nothing below is valid
  uint32_t lookup = 0;    ///< shared::k_lookup_*
  struct {
    vec3 position{0}, normal{0};  ///< world space [m]; place and normal of the lookup
    float size = 0;               ///< width of the pixel there [m]
    float depth = 0;              ///< along the view axis [m]
  } surface;
  uint32_t count = 0;             ///< number of records that serve
  bool gathers = false;           ///< no record serves and paths gather (Record::crowded)
  std::vector<Serving> serving;   ///< by falling weight; at most shared::k_inspect_most
  std::optional<Covering> under;  ///< record whose disc covers the pixel; the one with the nearest centre
};

/// Number of records that serve each pixel with a diffuse surface.
struct Overlap {
  uint64_t pixels = 0, served = 0;  ///< pixels with a diffuse surface; of these, with at least one record
  uint64_t gathered = 0;            ///< ... without a record because paths gather (Record::crowded)
  double mean = 0;                  ///< records that serve, over the served pixels
  double listed = 0;                ///< records that a lookup visits, over `pixels`
  uint32_t most = 0;
  /// Pixels by number of records: 0, 1, ...; the last bin includes all larger numbers.
  std::vector<uint32_t> histogram;
};

class Inspector {
 public:
  /// Both must outlive it.
  Inspector(gpu::Device& device, gpu::ShaderCompiler& compiler);
  ~Inspector();

  /// `x`, `y` are inside the picture. Throws Error if a kernel does not compile; so do the others.
  Inspection inspect(const overlay::Canvas& canvas, const Cache& cache, uint32_t x, uint32_t y);
  /// Statistics over the film's pixels.
  Overlap overlap(const overlay::Canvas& canvas, const Cache& cache);
  /// One lookup at every pixel with a diffuse surface, for timing; the results are discarded. `defines`:
  /// Cache::defines(); those of the first call are used.
  void look_up(const overlay::Canvas& canvas, const Cache& cache, const gpu::Defines& defines);

  /// Draws lines from the pixel to each record that serves it, with width and opacity by weight, and the
  /// border of the record whose disc covers the pixel.
  void draw_lines(const overlay::Canvas& canvas, const Cache& cache, const Inspection& inspection);
  /// Draws the normals of records as short lines from their centres, coloured by shared::k_record_by_*.
  void draw_normals(const overlay::Canvas& canvas, const Cache& cache, uint32_t color);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::irradiance_cache
