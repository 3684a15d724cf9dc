#include "session/ocio_table.h"

#include <utility>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "film/io/ocio.h"

namespace lucerna::session {

std::shared_ptr<const OcioTable> ocio_table(gpu::Device& device, const plan::Settings& settings,
                                            std::shared_ptr<const OcioTable> present) {
  const std::string& text = settings.text("film.ocio");
  if (text.empty()) return nullptr;
  const std::shared_ptr<const film::OcioConfig> config = film::ocio_config();
  if (!config)
    throw_error("film.ocio",
                "'{}': the environment variable OCIO names no configuration (export OCIO=FILE.ocio)", text);
  const std::string of = config->file() + ": " + text;
  if (present && present->of == of) return present;
  const auto [display, view] = config->split(text);
  const std::vector<vec4> nodes = config->table(display, view);
  OcioTable table{of,
                  gpu::Buffer(device, {.name = "display and view",
                                       .bytes = nodes.size() * sizeof(vec4),
                                       .memory = gpu::Memory::host}),
                  config->white(display, view)};
  table.nodes.write(nodes.data(), nodes.size() * sizeof(vec4));
  if (!config->source_is_rec709())
    log::warning("{}: names no linear Rec.709; radiance is taken as '{}'", config->file(), config->source());
  return std::make_shared<const OcioTable>(std::move(table));
}

}  // namespace lucerna::session
