#pragma once
// What is drawn over the picture: the views of solvers, of learned lights, of the depth of field and of
// recorded paths, with the inspected place.
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "overlay/sheet.h"
#include "session/focus_view.h"
#include "session/lights_view.h"
#include "session/paths_view.h"
#include "session/transaction.h"

namespace lucerna::session {

class Overlays {
 public:
  /// Both must outlive it.
  Overlays(const SetupContext& context, const Setup& setup)
      : context_(context), setup_(setup), mode_{.complete = !context.interactive} {}

  struct Mode {
    uint32_t scale =
        1;  ///< largest scale of the picture with overlays: window pixels per pixel, along a side
    bool complete = true;                ///< the picture waits for the surfaces of the window's pixels
    std::optional<vec2> inspected = {};  ///< place, 0..1 to the right and down
  };
  const Mode& mode() const { return mode_; }
  /// Informs the solvers of the inspected place.
  void set_mode(const Mode& mode);
  /// Session::inspect; shown in later pictures.
  void inspect(std::optional<vec2> at);
  /// Sets the pixels of the window per pixel of the picture, along a side: with overlays, pictures are larger
  /// by scale(), at most this.
  void set_window_scale(uint32_t scale);

  /// Recorded paths that are drawn.
  void show_paths(ShownPaths paths) { paths_shown_ = std::move(paths); }
  const ShownPaths& shown_paths() const { return paths_shown_; }

  /// The film's picture with the overlays, larger by scale(); in the given view, tiles are drawn too.
  std::vector<uint8_t> finish(const film::View& view, const std::function<bool()>& cancel);
  uint32_t scale() { return sheet().scale(); }
  /// True if the surfaces of the window's pixels are needed, not traced yet, and can be traced. Overlays then
  /// use the picture's samples. In the window only trace() traces them, so that a moving camera does not
  /// wait; the next picture shows them.
  bool waits();
  void trace(const std::function<bool()>& cancel);
  /// Calls f with each solver, the canvas for its overlays, and its view of the picture.
  using Visit = std::function<void(solvers::Solver&, const overlay::Canvas&, const solvers::Picture&)>;
  void visit_solvers(const Visit& f, const std::function<bool()>& cancel = {});
  /// Report of the view of learned lights; null: it is off.
  const solvers::Report* lights_report() const {
    return lights_ && lights_->report() ? &*lights_->report() : nullptr;
  }
  /// ... of the depth of field.
  const solvers::Report* focus_report() const {
    return focus_ && focus_->report() ? &*focus_->report() : nullptr;
  }
  /// ... of recorded paths.
  const solvers::Report* paths_report() const {
    return paths_ && paths_->report() ? &*paths_->report() : nullptr;
  }

  /// Call when surfaces or kernels have changed.
  void forget_surfaces();
  /// Call when there may be enough memory for the surfaces again.
  void retry() { fails_ = false; }

 private:
  /// True if a view of a solver, of the lights or of the depth of field is on.
  bool are_on() const;
  overlay::Sheet& sheet();
  /// To the picture, at most at that scale.
  void fit(uint32_t scale);
  void draw_lights(const std::function<bool()>& cancel);
  void draw_focus(const std::function<bool()>& cancel);
  void draw_paths(const std::function<bool()>& cancel);
  PictureView view() const { return setup_.view(context_.automaton); }

  const SetupContext& context_;
  const Setup& setup_;
  Mode mode_;
  bool fails_ = false;                     ///< no memory for the surfaces
  std::unique_ptr<overlay::Sheet> sheet_;  ///< null until something is drawn
  std::unique_ptr<LightsView> lights_;     ///< null until it is shown
  std::unique_ptr<FocusView> focus_;       ///< likewise
  std::unique_ptr<PathsView> paths_;       ///< likewise
  ShownPaths paths_shown_;
};

}  // namespace lucerna::session
