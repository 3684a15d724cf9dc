#include "overlay/canvas.h"

namespace lucerna::overlay {

void Canvas::bind(gpu::Resources& resources) const {
  wavefront.bind_paths(resources);
  film.bind(resources);
  coarse.bind_coarse(resources);
  sheet.bind(resources, of_film);
  resources.set("Picture", picture());
}

void Canvas::finish() const {
  stream().run();
  stream().take_times();
}

}  // namespace lucerna::overlay
