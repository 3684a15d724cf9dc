#include "commands/document.h"

namespace lucerna::commands {

Document::Material Document::Material::in_scene() const {
  Material m = *this;
  if (!m.emits) m.emission = vec3(0);
  m.emits = true;
  return m;
}

}  // namespace lucerna::commands
