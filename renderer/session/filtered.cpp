#include "session/filtered.h"

#include "base/log.h"
#include "film/io/planes.h"
#include "paths/automaton.h"

namespace lucerna::session {

Filtered filter(gpu::Device& device, gpu::ShaderCompiler& compiler, gpu::Stream& stream,
                const film::Film& film, uint32_t side, float luminance_floor) {
  film::Filter filter(device, compiler);
  Filtered f{std::make_unique<film::Film>(device, film.width(), film.height()), {}, 0, 0};
  stream.run();
  stream.take_times();
  filter.apply(stream, film, *f.film);
  for (const gpu::StageTime& t : stream.take_times()) f.ms += t.milliseconds;
  f.error = film::filter_error(film.read(), f.film->read(), side, double{luminance_floor});
  return f;
}

std::string filter_text(const film::FilterError& error) {
  return fmt::format("filtered; estimated error {:.2g} %", 100 * error.relative());
}

void add_filtered_layers(film::FilmImage& out, const Filtered& filtered) {
  const film::Image image = filtered.film->read();
  const size_t n = image.samples.size();
  std::vector<vec3> sum(n, vec3(0));
  for (size_t c = 0; c < image.components.size(); ++c) {
    film::add_plane(out, fmt::format("filtered.{}.", paths::k_component_names[c]), "RGB",
                    image.components[c]);
    for (size_t i = 0; i < n; ++i) sum[i] += image.components[c][i];
  }
  film::add_plane(out, "filtered.", "RGB", sum);
  out.channels.emplace_back("filtered.error", filtered.error.pixels);
  out.metadata["filter"] = filter_text(filtered.error);
}

}  // namespace lucerna::session
