#include "scene/view_text.h"

#include <fmt/format.h>

namespace lucerna::scene {

std::string view_text(const Camera& camera) {
  std::string text = camera.orthographic ? fmt::format("orthographic {:.5g} {:.5g}", camera.xmag, camera.ymag)
                     : camera.perspective() ? fmt::format("perspective {:.5g}", camera.yfov)
                                            : k_projection_names[size_t(camera.wide)];
  text += fmt::format(" aspect {:.5g} at", camera.aspect);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) text += fmt::format(" {:.5g}", camera.to_world[column][row] + 0.0f);
  if (camera.shift != vec2(0)) text += fmt::format(" shift {:.5g} {:.5g}", camera.shift.x, camera.shift.y);
  if (const Section& cut = camera.section; cut.cuts())
    text += fmt::format(" section {:.5g} {:.5g} {:.5g} at {:.5g}", cut.normal.x, cut.normal.y, cut.normal.z,
                        cut.offset);
  if (const Lens& lens = camera.lens; camera.perspective() && lens.f_number != 0)
    text += fmt::format(" lens f/{:.5g} focus {:.5g} blades {} rotation {:.5g}", lens.f_number,
                        lens.focus_distance, lens.blades, lens.blades == 0 ? 0 : lens.rotation);
  return text;
}

}  // namespace lucerna::scene
