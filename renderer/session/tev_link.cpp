#include "session/tev_link.h"

#include "base/log.h"
#include "session/renderer.h"

namespace lucerna::session {

namespace {
constexpr double k_seconds = 1;  // between pictures
}

TevLink::TevLink(const film::TevAddress& address, const std::string& scene)
    : address_(address.text()), sender_(address, "Lucerna: " + scene) {}

bool TevLink::report() {
  if (const std::string problem = sender_.take_problem(); !problem.empty()) log::warning("{}", problem);
  return !sender_.ended();
}

bool TevLink::follow(Renderer& r) {
  if (!report()) return false;
  if (!r.ready() || r.samples() == 0 || sender_.busy()) return true;
  const bool other = !begun_ || restart_ != r.restarts();
  const uint64_t paths = r.stats().paths;
  if (!other && paths == paths_) return true;
  const bool due = other || paths >= 2 * paths_;
  if (!r.done() && (!due || (begun_ && since_.seconds() < k_seconds))) return true;
  sender_.send(r.output().film_image());
  begun_ = true, restart_ = r.restarts(), paths_ = paths;
  since_.restart();
  return true;
}

bool TevLink::has(const Renderer& r) const {
  return begun_ && restart_ == r.restarts() && paths_ == r.stats().paths;
}

bool TevLink::waits(const Renderer& r) const {
  return sender_.busy() || sender_.ended() || (r.ready() && r.done() && r.samples() > 0 && !has(r));
}

void TevLink::finish(Renderer& r) {
  if (!report() || !r.ready() || r.stats().paths == 0) return;
  if (!has(r)) sender_.send(r.output().film_image());
  sender_.finish();
  report();
}

}  // namespace lucerna::session
