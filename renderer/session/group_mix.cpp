#include "session/group_mix.h"

#include <utility>

namespace lucerna::session {

void GroupMix::change() {
  setup_.film->set_mix(setup_.relight.weights), setup_.coarse->set_mix(setup_.relight.weights);
  // Dragging a slider changes one group; dragging over presets gives a sequence of mixes.
  constexpr double k_drag_seconds = 0.5;  // maximum time between these; the first is shown meanwhile
  mixed_.resize(setup_.relight.weights.size(), vec3(1));
  size_t groups = 0;
  for (size_t g = 0; g < mixed_.size(); ++g)
    groups += std::exchange(mixed_[g], setup_.relight.weights[g]) != setup_.relight.weights[g];
  dragged_ = groups <= 1 || since_mix_.seconds() < k_drag_seconds;
  since_mix_.restart();
  pending_ = true;
}

void GroupMix::settle() {
  if (!std::exchange(pending_, false)) return;
  transport::Wavefront& wavefront = setup_.engine->wavefront();
  if (wavefront.stats().paths == 0) return;
  wavefront.uncounted([&] { wavefront.mix(*setup_.film); });
  progress_.forget_errors();
  if (sampling_.samples() == 0) return;
  if (sampling_.adaptive()) sampling_.change(progress_);
  progress_.note(true);
}

}  // namespace lucerna::session
