#include "commands/comparing.h"

#include "base/error.h"
#include "base/future.h"
#include "base/log.h"

namespace lucerna::commands {

void Comparing::refresh(const OpenScene& open) {
  if (holding && is_ready(holding->picture)) {
    const Holding held = *holding;
    holding.reset();
    try {
      results.add(held.name, "result", held.camera, held.picture.get());
      const HeldResult& added = results.list().back();
      log::info("held as '{}': {:.4g} samples, {:.3g} s{}", added.name, added.picture->samples,
                added.picture->seconds,
                added.picture->error ? fmt::format(", error {:.3g}", *added.picture->error) : "");
    } catch (const std::exception& error) {
      log::error("compare.hold: {}", error.what());
    }
  }
  live.follow(open, results.compared());
}

}  // namespace lucerna::commands
