#pragma once
// The screen-space stage of placement: where in the picture geometry changes, or the irradiance
// that the present records give; a pyramid of it, so that detail counts at every scale; and which points of
// the picture, by dithering it, become candidates. All on the device. What exactly is measured and drawn
// stands in shaders/irradiance_cache/detail.comp and dither.comp.
//
// It looks at the points of overlay/sight.h.
#include <array>
#include <functional>
#include <vector>

#include "overlay/canvas.h"
#include "overlay/sight.h"
#include "shaders/shared/irradiance_cache/discontinuity.h"
#include "solvers/irradiance_cache/placement.h"
#include "transport/wavefront.h"

namespace lucerna::irradiance_cache {

struct DiscontinuityOptions {
  /// Candidates a cell of the finest level where detail is full; 0: the stage is left out, and every path
  /// asks.
  float density = 1;
  /// Of a point's probability, from each level to the next coarser one, 0..1. 1/4: as many candidates a cell
  /// at every scale.
  float falloff = 0.25f;
  float depth_weight = 3;   ///< of a step out of a surface's plane, in the width of a cell
  float normal_weight = 3;  ///< of a turn of the normal, in radians; 3: full at 20 degrees
  /// Of the relative difference of irradiance; 0: later passes do not look at it.
  float irradiance_weight = 1;
  /// A relative difference of irradiance up to it does not count: records have noise.
  float irradiance_noise = 0;
  bool operator==(const DiscontinuityOptions&) const = default;
};

class Discontinuity {
 public:
  enum class Of { geometry, irradiance };

  /// `defines`: Cache::defines. Kernels are compiled when the stage is first called for.
  Discontinuity(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& defines);
  ~Discontinuity();
  Discontinuity(const Discontinuity&) = delete;
  Discontinuity& operator=(const Discontinuity&) = delete;

  /// Forgets what was seen: the picture is to be that of `frame`. Throws Error when there is no memory.
  void begin(const shared::Frame& frame);
  /// Forgets what was seen; see() wants begin() again.
  void forget();
  bool begun() const;
  /// Whether all points of the picture have been looked at.
  bool seen() const;
  /// Sends the next rays, as many as there are slots. The wavefront's frame is the picture's, the cache
  /// frame says k_probe_screen, and kernels note what they meet in `candidates`. False when it was cancelled.
  bool see(transport::Wavefront& wavefront, const gpu::Buffer& candidates,
           const std::function<bool()>& cancel = {});
  /// What has been seen of the points.
  const overlay::Sight& sight() const;
  /// What the records give at the points; `bind` as Cache::bind.
  void look_up(gpu::Stream& stream, const std::function<void(gpu::Resources&)>& bind);
  /// The pyramid. Irradiance darker than `least` is held against that (luminance, above 0).
  void measure(gpu::Stream& stream, Of of, const DiscontinuityOptions& options, float least = 1e-6f);
  /// Draws candidates from the pyramid that was measured last: of geometry where no record serves, of
  /// irradiance where no record that serves is nearer than half a cell. The same for the same seed.
  struct Scale {
    float least_width = 0;  ///< cells narrower than that do not draw [pixels]
    float finest = 0;       ///< ... nor those narrower than that [m]
    /// Side of a square in which as many candidates are drawn as in a cell of full detail, whatever the
    /// detail [m]; 0: none where there is none.
    float flat_side = 0;
  };
  void dither(gpu::Stream& stream, Of of, const DiscontinuityOptions& options, const Scale& scale,
              uint32_t seed);
  /// For Placement::collect, after dither().
  Placement::Screen screen() const;
  /// Lays a level of the pyramid that was measured last over a picture of the frame's size, as colours
  /// (k_ramp_magma, 0 to 1); levels beyond the last count as that. The stream is not run.
  void draw(const overlay::Canvas& canvas, uint32_t level);

  uint32_t levels() const;  ///< of which the last has one cell
  uint64_t bytes() const;
  /// Cells of a level in raster order; of each 0..1.
  std::vector<float> level(uint32_t k) const;
  /// For tests: the level of each point that was taken, levels() where none was; and surfaces
  /// (shared::k_surface_texels a point) and irradiance as if they had been seen and looked up.
  std::vector<uint32_t> taken() const;
  void set(const std::vector<vec4>& surfaces, const std::vector<vec3>& lit);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::irradiance_cache
