#include "session/filtered.h"

#include "base/log.h"
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
  const auto add = [&](const std::string& layer, const std::vector<vec3>& plane) {
    for (int k = 0; k < 3; ++k) {
      std::vector<float> channel(n);
      for (size_t i = 0; i < n; ++i) channel[i] = plane[i][k];
      out.channels.emplace_back(fmt::format("{}.{}", layer, "RGB"[k]), std::move(channel));
    }
  };
  for (size_t c = 0; c < image.components.size(); ++c) {
    add(std::string("filtered.") + paths::k_component_names[c], image.components[c]);
    for (size_t i = 0; i < n; ++i) sum[i] += image.components[c][i];
  }
  add("filtered", sum);
  out.channels.emplace_back("filtered.error", filtered.error.pixels);
  out.metadata["filter"] = filter_text(filtered.error);
}

}  // namespace lucerna::session
