#pragma once
// Measurements of the picture's brightness that set the exposure: on request, for a scene that sets none, and
// after edits that replace daylight.
#include <functional>
#include <future>
#include <optional>
#include <string>

#include "commands/navigation.h"
#include "commands/open_scene.h"

namespace lucerna::commands {

class Exposure {
 public:
  Exposure(const OpenScene& open, const Navigation& camera) : open_(open), camera_(camera) {}

  enum class Reason { request, load, daylight };
  struct Found {
    float ev = 0;
    Reason reason = Reason::request;
    uint64_t step = 0;  ///< that of daylight_replaced()
  };

  /// Requests a measurement of the whole picture, or at a point (0..1 to the right and down).
  void measure(std::optional<vec2> at);
  bool measuring() const { return measuring_.has_value(); }
  /// True if the latest request is done. Throws Error if it has failed.
  bool done() const;

  /// Call when another scene is requested: an exposure that is set from now on belongs to it.
  void begin_load() { given_ = false; }
  void note_given() { given_ = true; }
  /// A scene has been shown.
  void begin_scene();
  /// Call after an edit that replaces daylight, whose strength can be of another order of magnitude. `step`:
  /// History::position() after it. Measures the picture if film.exposure_at_load allows it; the result counts
  /// if the present exposure is more than k_tolerated_ev from it and was not changed meanwhile.
  void daylight_replaced(bool interactive, uint64_t step);
  static constexpr float k_tolerated_ev = 2;
  /// Measures a new scene's picture if it is due and the setting film.exposure_at_load allows it;
  /// `interactive`: for a user. Calls `found` with the result of a measurement that is ready, if it differs
  /// from the setting; an Error that it throws is the measurement's.
  void follow(bool interactive, const std::function<void(const Found&)>& found);

 private:
  bool allowed(bool interactive) const;
  void measure(std::optional<vec2> at, Reason reason, uint64_t step = 0);
  struct Measuring {
    std::shared_future<film::Brightness> result;
    bool at_point;
    Reason reason;
    uint64_t step, scene;
    std::string ev;  ///< the setting at the request
  };
  const OpenScene& open_;
  const Navigation& camera_;
  std::optional<Measuring> measuring_;
  std::string failure_;  ///< of the latest request
  uint64_t due_ = 0;     ///< scene whose exposure is to be measured; 0: none
  bool given_ = false;   ///< film.ev was set after a scene was requested
};

}  // namespace lucerna::commands
