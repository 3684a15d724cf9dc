#include "session/effect_measurement.h"

#include <algorithm>
#include <cmath>

#include "base/timer.h"
#include "plan/facts.h"

namespace lucerna::session {
namespace {

/// Samples at which both pictures change turns. The first round warms the kernels up and is not timed.
constexpr uint32_t k_turns[] = {4, 6, 8, 10, 12, 14, EffectMeasurement::k_samples};

/// Component of that name, or the number of components.
size_t component_of(const std::string& key) {
  const auto& names = paths::k_component_names;
  return size_t(std::find(names.begin(), names.end(), key) - names.begin());
}

/// The fastest round, and by how much the next one is slower. Other programs only ever slow a round down.
struct Fastest {
  double ms = 0, spread = 0;
};
Fastest fastest_of(std::vector<double> rounds) {
  if (rounds.empty()) return {};
  std::sort(rounds.begin(), rounds.end());
  return {rounds[0], rounds.size() > 1 ? rounds[1] - rounds[0] : 0};
}

}  // namespace

EffectMeasurement::EffectMeasurement(Renderer& picture, const RendererOptions& options)
    : settings_(picture.settings()), pixels_(double(picture.film().width()) * picture.film().height()) {
  const uint32_t width = picture.film().width(), height = picture.film().height();
  const double scale = std::min(1.0, std::sqrt(k_pixels / pixels_));
  RendererOptions small = options;
  small.interactive = false;
  small.patience.reset();
  small.on = picture.shared_device();
  for (const auto& [key, value] :
       std::initializer_list<std::pair<const char*, std::string>>{{"sampling.mode", "uniform"},
                                                                  {"samples", std::to_string(k_turns[0])},
                                                                  {"lights.sampling", "power"},
                                                                  {"relight.enabled", "off"}})
    settings_.set(key, value, "effects");
  for (const char* name : paths::k_component_names)
    if (const std::string key = std::string("components.") + name; settings_.text(key) != "off")
      settings_.set(key, "path", "effects");
  for (std::unique_ptr<Renderer>* renderer : {&with_, &without_}) {
    *renderer = std::make_unique<Renderer>(small);
    (*renderer)->set_size(std::max(1u, uint32_t(width * scale + 0.5)),
                          std::max(1u, uint32_t(height * scale + 0.5)));
    (*renderer)->set_scene(picture.scene());
    (*renderer)->set_camera(picture.camera());
    leave_out(**renderer, "");
  }
  result_.width = width, result_.height = height;
  for (const plan::Effect& effect : with_->facts().effects) {
    const size_t component = component_of(std::string(effect.key));
    const bool computed = shared::is_component(component) &&
                          settings_.text(std::string("components.") + std::string(effect.key)) != "off";
    if (effect.called_for() && (effect.can_be_off || computed))
      result_.effects.push_back({.key = std::string(effect.key), .label = std::string(effect.label)});
  }
}

EffectMeasurement::~EffectMeasurement() = default;

void EffectMeasurement::leave_out(Renderer& renderer, const std::string& key) const {
  renderer.settings() = settings_;
  if (shared::is_component(component_of(key))) {
    renderer.settings().set("components." + key, "off", "effects");
  } else if (!key.empty()) {
    const std::string& off = settings_.text("effects.off");
    renderer.settings().set("effects.off", off.empty() ? key : off + "," + key, "effects");
  }
  renderer.apply_settings();
}

bool EffectMeasurement::render(Renderer& renderer, uint32_t samples, Rounds* rounds,
                               const std::function<bool()>& cancel) const {
  renderer.settings().set("samples", std::to_string(samples), "effects");
  renderer.apply_settings();
  const uint64_t before = renderer.stats().paths;
  const Timer timer;
  while (!renderer.done())
    if (!renderer.step(cancel)) return false;
  const uint64_t paths = renderer.stats().paths - before;
  if (rounds && paths > 0) rounds->push_back(1e3 * timer.seconds() / double(paths) * pixels_);
  return true;
}

bool EffectMeasurement::step(const std::function<bool()>& cancel) {
  if (done()) return true;
  if (!prepared_) {
    leave_out(*without_, result_.effects[at_].key);
    with_->restart();
    samples_ = 0, with_rounds_.clear(), without_rounds_.clear();
    prepared_ = true;
    return true;
  }
  const uint32_t next = *std::upper_bound(std::begin(k_turns), std::end(k_turns) - 1, samples_);
  const bool timed = samples_ > 0;
  // A cancelled round has lost its duration.
  if (!render(*with_, next, timed ? &with_rounds_ : nullptr, cancel)) return false;
  if (!render(*without_, next, timed ? &without_rounds_ : nullptr, cancel)) return false;
  samples_ = next;
  if (samples_ == k_samples) finish_effect();
  return true;
}

void EffectMeasurement::finish_effect() {
  EffectCost& cost = result_.effects[at_];
  const Fastest with = fastest_of(with_rounds_), without = fastest_of(without_rounds_);
  cost.ms = with.ms - without.ms;
  cost.ms_error = std::hypot(with.spread, without.spread);
  all_rounds_.insert(all_rounds_.end(), with_rounds_.begin(), with_rounds_.end());
  cost.part = pilot::difference(with_->image(), without_->image(), k_samples);
  prepared_ = false;
  ++at_;
}

double EffectMeasurement::progress() const {
  const double effects = double(std::max<size_t>(result_.effects.size(), 1));
  return done() ? 1 : (double(at_) + double(samples_) / k_samples * (prepared_ ? 1 : 0)) / effects;
}

std::string EffectMeasurement::activity() const {
  return done() ? "measuring effects" : "measuring effects: " + result_.effects[at_].label;
}

EffectCosts EffectMeasurement::take() {
  result_.sample_ms = fastest_of(all_rounds_).ms;
  std::stable_sort(result_.effects.begin(), result_.effects.end(),
                   [](const EffectCost& a, const EffectCost& b) { return a.ms > b.ms; });
  return result_;
}

}  // namespace lucerna::session
