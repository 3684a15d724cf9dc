#include "session/filtered.h"

#include "film/io/planes.h"
#include "paths/automaton.h"

namespace lucerna::session {

double Filtered::ms() const {
  double sum = 0;
  for (const auto& [kernel, ms] : kernel_ms) sum += ms;
  return sum;
}

void PictureFilter::begin(const FilterJob& job) {
  stop();
  job_.emplace(job);
}

void PictureFilter::stop() {
  if (filter_) filter_->release();
  job_.reset();
  result_ = {};
  begun_ = filtered_ = false;
}

void PictureFilter::step(Engine& engine, const PictureView& view, PixelSight& sight,
                         const std::function<bool()>& cancel) {
  if (!job_) return;
  try {
    const film::Film& film = job_->film;
    gpu::Stream& stream = engine.wavefront().stream();
    if (!filter_) {
      filter_.emplace(device_, compiler_);
    } else if (!begun_ && sight.wanted(engine, view)) {
      sight.see(engine, view, cancel);
    } else if (!begun_) {
      result_ = {std::make_unique<film::Film>(device_, film.width(), film.height()), {}, job_->paths};
      filter_->begin(film, *result_.film, sight.surfaces(engine, view), job_->looked_up);
      begun_ = true;
    } else if (!filtered_) {
      engine.wavefront().uncounted([&] {
        stream.run();
        stream.take_times();
        filtered_ = !filter_->step(stream);
        for (const gpu::StageTime& t : stream.take_times()) result_.kernel_ms[t.stage] += t.milliseconds;
      });
    } else {
      filter_->release();
      result_.error =
          film::filter_error(film.read(), result_.film->read(), job_->tile, double{job_->luminance_floor});
      job_.reset();
      begun_ = filtered_ = false;
    }
  } catch (...) {
    stop();
    throw;
  }
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
