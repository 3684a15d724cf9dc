#include "session/path_study.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "pilot/findings.h"
#include "plan/choose.h"
#include "shaders/shared/seen_error.h"

namespace lucerna::session {
namespace {

constexpr uint32_t k_trial_pixels = 640, k_trial_paths = 10240, k_most_samples = 256;

/// Pixels of a rectangle: all, or one in each of at most k_trial_pixels cells, at a place that depends on the
/// cell.
std::vector<uint32_t> trial_pixels(const uvec2& lo, const uvec2& hi, uint32_t width) {
  const uvec2 size = hi - lo;
  const double cell = std::max(1.0, std::sqrt(double(size.x) * size.y / k_trial_pixels));
  std::vector<uint32_t> pixels;
  uint32_t number = 0;
  for (double y = 0; y + 0.5 < size.y; y += cell)
    for (double x = 0; x + 0.5 < size.x; x += cell) {
      const uint32_t bits = ++number * 0x9e3779b9u;
      const auto at = [&](double from, uint32_t random, uint32_t most) {
        return std::min(uint32_t(from + std::floor(cell * (random & 0xffffu) / 65536.0)), most - 1);
      };
      pixels.push_back((lo.y + at(y, bits >> 16, size.y)) * width + lo.x + at(x, bits, size.x));
    }
  return pixels;
}

/// Luminance to which a pixel's noise is compared (shared/seen_error.h); 0: it is not seen, or the pixel has
/// no sample.
double around(const film::Image& image, uint32_t pixel, const film::SeenRange& range) {
  const auto shown = [&](uint32_t at) {
    float y = 0;
    for (const auto& component : image.components) y += luminance(component[at]);
    return shared::seen_shown(y, range.white);
  };
  if (image.samples[pixel] == 0 || shown(pixel) >= range.white) return 0;
  const uint32_t x = pixel % image.width, y = pixel / image.width, reach = shared::k_seen_reach;
  float sum = 0, count = 0;
  for (uint32_t v = y - std::min(y, reach); v <= std::min(y + reach, image.height - 1); ++v)
    for (uint32_t u = x - std::min(x, reach); u <= std::min(x + reach, image.width - 1); ++u)
      if (const uint32_t at = v * image.width + u; image.samples[at] > 0) sum += shown(at), ++count;
  return double(shared::seen_scale(shown(pixel), count > 0 ? sum / count : 0, range.floor));
}

std::string component_key(size_t component) {
  return std::string("components.") + paths::k_component_names[component];
}

std::string capital(std::string text) {
  text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/// Shadow stages by the rays to lights, all others by the other rays.
recording::RayTimes ray_times(const transport::TransportStats& stats) {
  double shadow = 0, other = 0;
  for (const transport::StageSum& stage : stats.stages)
    (stage.name.starts_with("shadow") ? shadow : other) += stage.ms;
  if (stats.rays <= stats.shadow_rays) return {};
  return {.surface = 1e3 * other / double(stats.rays - stats.shadow_rays),
          .light = stats.shadow_rays > 0 ? 1e3 * shadow / double(stats.shadow_rays) : 0};
}

}  // namespace

PictureView PathStudy::view() const {
  if (!setup_.engine) throw Error("", "there is no scene whose paths could be recorded");
  return setup_.view(context_.automaton);
}

recording::Recording PathStudy::begin() const {
  recording::Recording all = recorder_->begin(view());
  all.times = ray_times(setup_.engine->wavefront().stats());
  return all;
}

bool PathStudy::record(std::span<const shared::PathChoice> choices, recording::Recording& into,
                       const std::function<bool()>& cancel, uint32_t events_per_path) {
  const PictureView picture = view();
  return recorder_->record(*setup_.engine, picture, choices, into, cancel, events_per_path);
}

recording::NoiseReport PathStudy::explain_noise(const vec2& lo, const vec2& hi) {
  recording::Recording all = begin();
  const uvec2 first = pixel_at(lo, all.width, all.height);
  const uvec2 end = glm::min(pixel_at(hi, all.width, all.height) + 1u, uvec2(all.width, all.height));
  const std::vector<uint32_t> pixels = trial_pixels(first, end, all.width);
  const uint32_t each =
      std::clamp(k_trial_paths / uint32_t(std::max<size_t>(pixels.size(), 1)), 2u, k_most_samples);
  std::vector<shared::PathChoice> choices;
  for (const uint32_t pixel : pixels)
    for (uint32_t s = 0; s < each; ++s) choices.push_back({pixel, s});
  record(choices, all);
  const film::Image image = sampling_.samples() > 0 ? setup_.film->read() : setup_.coarse->read();
  const bool same_size = image.width == all.width && image.height == all.height;
  if (!same_size) throw Error("", "the picture has no sample yet");
  std::vector<double> near(all.paths.size());
  for (size_t i = 0; i < near.size(); ++i)
    near[i] = i > 0 && all.paths[i].pixel == all.paths[i - 1].pixel
                  ? near[i - 1]
                  : around(image, all.paths[i].pixel, setup_.seen_range());
  recording::NoiseReport report = recording::analyse_noise(all, near, pilot::k_most_variance);
  report.sentence =
      recording::noise_sentence(report, first == uvec2(0) && end == uvec2(all.width, all.height));
  report.cure = cure_of(report);
  return report;
}

recording::NoiseCure PathStudy::cure_of(const recording::NoiseReport& report) const {
  if (report.sentence.empty()) return {};
  const plan::Settings& settings = setup_.settings;
  const auto worst = size_t(
      std::find(paths::k_component_names.begin(), paths::k_component_names.end(), report.components[0].name) -
      paths::k_component_names.begin());
  // What `auto` would choose, had the picture the light and the noise of this part of it.
  const ByComponent<plan::Choice>& now = setup_.engine->plan().choices;
  plan::Settings open = settings;
  solvers::Findings findings;
  findings.pixels = double(setup_.width) * setup_.height;
  for (size_t c = 0; c < now.size(); ++c) {
    findings.components[c] = {report.light[c], report.variance[c]};
    open.set(component_key(c), now[c].solver == "path" ? plan::k_auto : now[c].solver);
  }
  plan::Goal goal = plan::goal_of(open, nullptr);
  const auto chosen = plan::choose(facts_, open, &findings, goal);
  recording::NoiseCure cure;
  if (now[worst].solver == "path" && chosen[worst].solver != "path") {
    std::string what;
    for (size_t c = 0; c < now.size(); ++c) {
      if (now[c].solver != "path" || chosen[c].solver != chosen[worst].solver) continue;
      cure.settings.emplace_back(component_key(c), chosen[c].solver);
      what += (what.empty() ? "" : " and ") + std::string(paths::k_component_names[c]);
    }
    cure.label = fmt::format("{} light by {}", capital(what), chosen[worst].solver);
    cure.reason = chosen[worst].reason;
    return cure;
  }
  if (worst == paths::k_primary && settings.text("lights.sampling") == "power" &&
      facts_.effect("primary").called_for()) {
    cure.settings = {{"lights.sampling", "learned"}};
    cure.label = "Learn the lights";
    cure.reason = "light samples would learn which lights arrive here";
    return cure;
  }
  if (worst == paths::k_caustic && now[worst].solver == "path") {
    cure.settings = {{component_key(worst), "photons"}};
    cure.label = "Caustic light by photons";
    cure.reason = "eye paths find this light only by chance; photons start at the light";
    return cure;
  }
  if (settings.text("sampling.mode") == "uniform") {
    cure.settings = {{"sampling.mode", "adaptive"}};
    cure.label = "Adaptive sampling";
    cure.reason =
        fmt::format("no other solver is clearly ahead for {} light: more samples go where the noise is",
                    paths::k_component_names[worst]);
    return cure;
  }
  cure.reason = fmt::format("no setting is known that would reduce this noise: {} light needs more samples",
                            paths::k_component_names[worst]);
  return cure;
}

}  // namespace lucerna::session
