#include "overlay/look_through.h"

#include "transport/aim.h"

namespace lucerna::overlay {

using namespace shared;

LookThrough::LookThrough(gpu::Device& device, gpu::ShaderCompiler& compiler, gpu::Defines scene_defines)
    : device_(device),
      compiler_(compiler),
      scene_defines_(std::move(scene_defines)),
      sight_(device, compiler, scene_defines_) {
  gpu::make_texel_room(device_, none_, "nothing seen", k_surface_texels * sizeof(vec4));
}

bool LookThrough::look(const Canvas& canvas, const Frame& frame) {
  if (known_ && transport::same_view(frame, of_)) return true;
  known_ = false;
  if (!look_) {
    look_ = gpu::Kernel(device_, compiler_, "overlay/look.comp", scene_defines_);
    keep_ = gpu::Kernel(device_, compiler_, "overlay/look_keep.comp");
  }
  transport::Wavefront& wavefront = canvas.wavefront;
  sight_.begin(frame);
  wavefront.bind_paths(resources_);
  resources_.set("Surfaces", sight_.surfaces());
  const auto keep = [&](const SeePush& push) {
    canvas.stream().dispatch(keep_, resources_, push, gpu::groups_for(push.count, 64));
  };
  bool complete = true;
  wavefront.uncounted([&] {
    while (complete && !sight_.seen())
      complete = sight_.see(wavefront, "what is shown through glass", keep, canvas.cancel, &look_);
  });
  known_ = complete, of_ = frame;
  return complete;
}

void LookThrough::bind(gpu::Resources& resources) const {
  resources.set("surface_texels", known_ ? sight_.surfaces() : none_);
}

}  // namespace lucerna::overlay
