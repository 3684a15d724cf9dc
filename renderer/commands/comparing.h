#pragma once
// Comparison of the live picture with held results.
#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "commands/live_difference.h"

namespace lucerna::commands {

struct Comparing {
  HeldResults results;
  LiveDifference live;
  /// A file that is read on a thread.
  struct Reading {
    std::string file;
    std::atomic<double> done{0};  ///< share of it, 0..1
    std::atomic<bool> cancelled{false};
  };
  /// A picture that is on its way.
  struct Holding {
    std::shared_future<std::shared_ptr<const session::HeldPicture>> picture;
    std::string name, camera;
    std::shared_ptr<Reading> reading;  ///< null: it is the live picture
  };
  std::optional<Holding> holding;

  Comparing() = default;
  ~Comparing() { cancel(); }
  Comparing(const Comparing&) = delete;
  Comparing& operator=(const Comparing&) = delete;

  /// Starts to read a file, to hold its picture.
  void read(const std::string& file, const std::string& name);
  /// Ends the reading of a file after its present part; false: none is read.
  bool cancel();
  /// Takes what has come; errors are logged.
  void refresh(const OpenScene& open);

 private:
  void take_held(const OpenScene& open);
};

}  // namespace lucerna::commands
