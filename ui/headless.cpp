// Scripts without a window: the state of the window over a session, and no drawing.
#include <chrono>
#include <condition_variable>
#include <mutex>

#include "base/error.h"
#include "runner.h"
#include "setting_lines.h"
#include "state.h"
#include "viewer.h"

namespace lucerna::ui {
namespace {

class Headless {
 public:
  Headless(session::Session& session, const ViewerOptions& options)
      : options_(options),
        ui_(session),
        runner_(ui_.viewport, ui_.areas, ui_.log, ui_.requests, options.report ? *options.report : report_) {
    ui_.scripted = true;
    settings_ = setting_lines(ui_.work.registry, options.set);
    runner_.scripts.start(options.script, options.script_name, false, options.variables);
  }

  bool needs_window() const { return runner_.scripts.needs_window(); }
  commands::ScriptResult result() const { return runner_.scripts.result(); }

  int run() {
    session::Session& session = ui_.work.session;
    session.on_publish([this] {
      {
        std::lock_guard lock(mutex_);
        published_ = true;
      }
      wake_.notify_one();
    });
    ui_.work.refresh(ui_.time());
    if (!options_.scene.empty()) ui_.work.run(commands::line("scene.open", options_.scene.string()));
    for (const std::string& line : settings_) ui_.work.run(line);
    while (!ui_.requests.status && !(options_.interrupted && options_.interrupted())) {
      for (const LogLine& line : inbox_.take()) ui_.work.note_log(line.level, line.text);
      ui_.work.refresh(ui_.time());
      ui_.frames_to_settle = 0, ui_.camera.resizing = false;
      follow_size();
      runner_.advance();
      follow_size();
      if (!ui_.requests.status && runner_.running()) pause();
    }
    session.on_publish({});
    return ui_.requests.status.value_or(1);
  }

 private:
  /// Until there is a new picture, or for a moment: conditions may depend on the time.
  void pause() {
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, std::chrono::milliseconds(10), [this] { return published_; });
    published_ = false;
  }

  void follow_size() {
    const auto divided = [this](uint32_t size) {
      return std::max(1u, size / static_cast<uint32_t>(ui_.viewport.divisor));
    };
    const std::pair<uint32_t, uint32_t> size =
        ui_.picture_size.value_or(std::pair(divided(k_headless_size.first), divided(k_headless_size.second)));
    if (size == size_) return;
    size_ = size;
    ui_.camera.set_size(size.first, size.second);
  }

  ViewerOptions options_;
  LogInbox inbox_;
  Ui ui_;
  commands::ReportFolder report_;
  Runner runner_;
  std::vector<std::string> settings_;
  std::pair<uint32_t, uint32_t> size_{0, 0};
  std::mutex mutex_;
  std::condition_variable wake_;
  bool published_ = false;
};

}  // namespace

int run_headless(session::Session& session, const ViewerOptions& options, commands::ScriptResult* result) {
  Headless headless(session, options);
  if (headless.needs_window())
    throw Error(options.script_name, "needs a window: it uses the pointer, keys, panels or screenshots");
  const int status = headless.run();
  if (result) *result = headless.result();
  return status;
}

bool needs_window(session::Session& session, const ViewerOptions& options) {
  return Headless(session, options).needs_window();
}

}  // namespace lucerna::ui
