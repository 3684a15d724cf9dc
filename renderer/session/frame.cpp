#include "session/frame.h"

namespace lucerna::session {

shared::Frame frame_of(const PathRoutes& routes, const PictureView& picture, uint32_t width,
                       uint32_t height) {
  const auto frame = [&](const solvers::Routing& routing) {
    return solvers::path_frame(
        {picture.automaton, picture.settings, picture.world.flat, picture.camera, width, height}, routing,
        routing.lookups.traced);
  };
  shared::Frame result = frame(routes.here);
  if (routes.delegated) transport::set_delegated_tables(result, frame(*routes.delegated));
  return result;
}

}  // namespace lucerna::session
