#pragma once
// Screen-space stage of placement: finds where geometry, or the irradiance of the present records, changes in
// the picture; builds a pyramid of it, so that detail counts at every scale; selects candidates by dithering.
// All on the device. Details: shaders/irradiance_cache/detail.comp and dither.comp.
//
// Works on the points of overlay/sight.h.
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
  /// Candidates per cell of the finest level at full detail.
  float density = 1;
  /// Ratio of probabilities between a level and the next coarser one, 0..1. 1/4: equally many candidates per
  /// cell at every scale.
  float falloff = 0.25f;
  float depth_weight = 3;   ///< of a step out of the surface's plane, in cell widths
  float normal_weight = 3;  ///< of a turn of the normal [rad]; 3: full at 20 degrees
  /// Weight of the relative difference of irradiance; 0: later passes ignore it.
  float irradiance_weight = 1;
  /// Relative differences of irradiance up to this are ignored as noise.
  float irradiance_noise = 0;
  bool operator==(const DiscontinuityOptions&) const = default;
};

class Discontinuity {
 public:
  enum class Of { geometry, irradiance };

  /// `defines`: Cache::defines. Kernels are compiled at the first use.
  Discontinuity(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& defines);
  ~Discontinuity();
  Discontinuity(const Discontinuity&) = delete;
  Discontinuity& operator=(const Discontinuity&) = delete;

  /// Starts a picture with that frame. Throws Error: memory.
  void begin(const shared::Frame& frame);
  /// Drops everything; begin() must be called before see().
  void forget();
  bool begun() const;
  /// True once all points have been traced.
  bool seen() const;
  /// Traces the next points, as many as there are slots. The wavefront must have the picture's frame, and the
  /// cache frame k_probe_screen; kernels write hits to `candidates`. False if cancelled.
  bool see(transport::Wavefront& wavefront, const gpu::Buffer& candidates,
           const std::function<bool()>& cancel = {});
  /// The traced points.
  const overlay::Sight& sight() const;
  /// Looks up the irradiance of the records at the points; `bind` as Cache::bind.
  void look_up(gpu::Stream& stream, const std::function<void(gpu::Resources&)>& bind);
  /// Builds the pyramid. `least`: minimum luminance in relative differences, above 0.
  void measure(gpu::Stream& stream, Of of, const DiscontinuityOptions& options, float least = 1e-6f);
  /// Draws candidates from the latest pyramid: for geometry where no record serves, for irradiance where no
  /// serving record is nearer than half a cell. Deterministic for a seed.
  struct Scale {
    float least_width = 0;  ///< minimum width of cells that draw [pixels]
    float finest = 0;       ///< minimum width of cells that draw [m]
    /// Base density without detail: a square of this side gets as many candidates as a cell of full detail
    /// [m]; 0: no candidates without detail.
    float flat_side = 0;
  };
  void dither(gpu::Stream& stream, Of of, const DiscontinuityOptions& options, const Scale& scale,
              uint32_t seed);
  /// Input of Placement::collect, after dither().
  Placement::Screen screen() const;
  /// Lays a level of the pyramid that was measured last over a picture of the frame's size, as colours
  /// (k_ramp_magma, 0 to 1); levels beyond the last count as that. The stream is not run.
  void draw(const overlay::Canvas& canvas, uint32_t level);

  uint32_t levels() const;  ///< the last one has one cell
  uint64_t bytes() const;
  /// Cells of a level in raster order, 0..1.
  std::vector<float> level(uint32_t k) const;
  /// For tests: level of each taken point, levels() if not taken; and sets surfaces (shared::k_surface_texels
  /// a point) and irradiance as if traced and looked up.
  std::vector<uint32_t> taken() const;
  void set(const std::vector<vec4>& surfaces, const std::vector<vec3>& lit);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::irradiance_cache
