#pragma once
// Comparison of the live picture with held results.
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "commands/live_difference.h"

namespace lucerna::commands {

struct Comparing {
  HeldResults results;
  LiveDifference live;
  /// A picture that is on its way.
  struct Holding {
    std::shared_future<std::shared_ptr<const session::HeldPicture>> picture;
    std::string name, camera;
  };
  std::optional<Holding> holding;

  /// Takes what has come; errors are logged.
  void refresh(const OpenScene& open);
};

}  // namespace lucerna::commands
