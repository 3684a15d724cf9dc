#pragma once
// The live picture as light, and its figures against the held result that it is compared with.
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "commands/held_results.h"
#include "commands/open_scene.h"
#include "film/io/light_difference.h"

namespace lucerna::commands {

class LiveDifference {
 public:
  /// Reads the live light when the picture is another one, after a quarter more samples and when it rests,
  /// and measures its figures after twice as many samples, when it rests and when it is shown by another
  /// exposure or view, on a thread. `held`: null ends it.
  void follow(const OpenScene& open, const HeldResult* held);
  /// Discards light and figures, so that both are of the present picture.
  void restart();

  /// The latest light; null: none yet, or it cannot be compared.
  std::shared_ptr<const session::HeldPicture> light() const { return comparable_ ? light_ : nullptr; }
  /// Changes with light().
  uint64_t version() const { return version_; }
  /// The latest figures of this picture against this result; nullopt: not known yet.
  const std::optional<film::LightDifference>& figures() const { return figures_; }
  /// Why there is no comparison: why_not_comparable(), or why the picture has no light. "" if there is one.
  const std::string& problem() const { return problem_; }

 private:
  void take_light();
  void take_figures();
  /// Identifies the shown light, apart from its samples.
  static std::string shown_light(const OpenScene& open);

  struct Measured {
    film::LightDifference figures;
    uint64_t held = 0, version = 0;
    film::ViewTransform view;
  };
  std::shared_future<std::shared_ptr<const session::HeldPicture>> requested_;
  std::string requested_for_;  ///< shown_light() of the request
  std::shared_ptr<const session::HeldPicture> light_;
  std::string light_of_;
  uint64_t version_ = 0, oldest_ = 0;  ///< of light_; figures of older light do not count
  std::future<Measured> measuring_;
  std::optional<film::LightDifference> figures_;
  film::ViewTransform view_;  ///< of the figures
  double figures_samples_ = 0;
  uint64_t figures_version_ = 0, held_ = 0;
  bool comparable_ = false, refused_ = false;
  std::string problem_;
};

}  // namespace lucerna::commands
