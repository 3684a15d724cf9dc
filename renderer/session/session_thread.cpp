#include "session/session_thread.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "session/kept_device.h"

namespace lucerna::session {

namespace {
constexpr double k_draft_seconds = 0.5;  // maximum time without a preview sample during consecutive edits
// Time without another mix after which the last one is applied in full.
constexpr double k_mix_pause_seconds = 0.2;
constexpr double k_viewer_seconds = 0.05;  // between looks at a viewer that is still reading
constexpr int k_nice = 10;                 // rendering yields to the window's thread

}  // namespace

SessionThread::SessionThread(const Options& o) : options(o) {
  if (!options.idle) thread = std::thread([this] { run(); });
}

SessionThread::~SessionThread() {
  {
    std::lock_guard lock(mutex);
    quit = true;
    given_up = loads.load();
    pending = true;
  }
  wake.notify_one();
  if (thread.joinable()) thread.join();
}

std::unique_ptr<Renderer> SessionThread::make_renderer() {
  try {
    RendererOptions made{options.device, options.validation, options.shaders, {}, true, options.scenes};
    made.patience = options.patience;
    if (!options.validation) made.on = kept_device(options.device);
    auto renderer = std::make_unique<Renderer>(made);
    next.device = renderer->device().info().name;
    publish();
    return renderer;
  } catch (const std::exception& e) {
    log::error("{}", e.what());
    publish_activity(std::string("no device: ") + e.what(), -1);
    return nullptr;
  }
}

void SessionThread::carry_out_next(Renderer* renderer, std::unique_lock<std::mutex>& lock) {
  Command command = queue.pop();
  const uint64_t number = command.number;
  lock.unlock();
  try {
    if (!renderer) throw Error("device", "there is none to render with");
    if (command.scene == k_any_scene || command.scene == scene_id) {
      command.run(*renderer);
    } else {
      log::warning("a command for {} was left out: another scene was loaded before its turn",
                   command.subject);
      refuse(command);
    }
  } catch (const Abandoned&) {
    refuse(command);
  } catch (const std::exception& e) {
    log::error("{}", e.what());
    refuse(command);
  }
  command = {};
  if (renderer) {
    try {
      serve_due(*renderer);
    } catch (const std::exception& e) {
      log::error("{}", e.what());
    }
    lock.lock();
    state = {scene_id, renderer->scene(), renderer->loaded(), renderer->settings()};
    pending = !queue.empty();
    lock.unlock();
  }
  next.activity.clear();
  next.progress = -1;
  next.commands = number;
  dirty = true;
  lock.lock();
  done = next.commands;
}

void SessionThread::advance(Renderer& renderer, bool work) {
  // The former picture in the new view does not wait for new light.
  if (std::exchange(recall_wanted, false) && renderer.output().remembers()) publish_picture(renderer, false);
  bool changed = dirty;
  // During edits faster than preview samples, some of them are still shown.
  const auto draft_cancelled = [&] {
    return quit || (pending && (!draft_given_up || since_given_up.seconds() < k_draft_seconds));
  };
  if (!paused && !draft_cancelled() && renderer.previews().draw(draft_cancelled)) {
    renderer.choose_by_previews();
    draft_given_up = false;
    changed = changed || renderer.previews().news();
    // The first one, and the first of improved light, are shown at once; more of them at the usual rate.
    if (renderer.previews().begun())
      changed = changed || std::exchange(coarse_wanted, false);
    else
      coarse_wanted = coarse_wanted || std::exchange(better_wanted, false);
  } else if (pending && coarse_wanted) {
    if (!std::exchange(draft_given_up, true)) since_given_up.restart();
  } else if (work && renderer.step([&] { return pending.load() || quit; })) {
    accuracy.follow(renderer, scene_id);
  }
  // The last entry of the ledger is that of the finished image.
  if (renderer.done() && !renderer.progress().ledger().entries().empty() &&
      renderer.progress().ledger().entries().back().paths != renderer.stats().paths)
    renderer.finish_ledger();
  if (!filled && renderer.samples() > 0) filled = changed = true;
  changed = renderer.output().filter_news() || changed;
  const bool over = (renderer.done() && !renderer.output().filter_due()) || renderer.waits();
  if (changed || since_publish.seconds() > publish_seconds || over)
    publish_picture(renderer, renderer.samples() > 0 && !renderer.mix().pending() &&
                                  (since_numbers.seconds() > numbers_seconds || renderer.done() || paused));
  if (!dirty && renderer.overlays().waits()) {
    renderer.overlays().trace([&] { return pending.load() || quit; });
    dirty = true;
  }
}

void SessionThread::measure_effects() {
  effects->step([&] { return pending.load() || quit; });
  if (!effects->done()) {
    if (since_publish.seconds() < k_publish_seconds) return;
    since_publish.restart();
    publish_activity(effects->activity(), float(effects->progress()));
    return;
  }
  auto result = std::make_shared<const EffectCosts>(effects->take());
  log::info("{}", costs_line(*result));
  end_effects(std::move(result));
}

void SessionThread::end_effects(std::shared_ptr<const EffectCosts> result) {
  effects.reset();
  next.effect_costs = std::move(result);
  next.measures_effects = false;
  next.activity.clear(), next.progress = -1;
  dirty = true;
}

/// `numbers`: including values read back from the film.
void SessionThread::publish_picture(Renderer& renderer, bool numbers) {
  if (numbers) since_numbers.restart();
  fill_snapshot(renderer, numbers);
  publish();
  since_publish.restart();
  dirty = false;
}

void SessionThread::end(Renderer* renderer, std::unique_lock<std::mutex>& lock) {
  while (!queue.empty())
    if (const Command command = queue.pop();
        command.saves && renderer && (command.scene == k_any_scene || command.scene == scene_id))
      command.run(*renderer);
  lock.unlock();
  std::erase_if(saves, [&](const Save& save) {
    if (save.solver.empty()) write(*renderer, save);
    return save.solver.empty();
  });
  give_up_saves("the program ended");
}

void SessionThread::run() {
  // Threads of the device inherit this, so the window has priority.
  setpriority(PRIO_PROCESS, id_t(syscall(SYS_gettid)), k_nice);
  const std::unique_ptr<Renderer> renderer = make_renderer();
  std::unique_lock lock(mutex);
  while (!quit) {
    while (!queue.empty() && !quit) carry_out_next(renderer.get(), lock);
    pending = false;
    // During a drag at a group's slider display comes first; the film's sums and more samples follow when it
    // pauses.
    const bool mixing = renderer && renderer->mix().pending();
    if (mixing && !dirty && wake.wait_for(lock, std::chrono::duration<double>(k_mix_pause_seconds), [&] {
          return quit || !queue.empty();
        }))
      continue;
    const bool work = renderer && (effects || works(*renderer)) && !(mixing && dirty);
    if (renderer && !work) renderer->progress().rest();
    if (!work && !dirty && !mixing) {
      const auto woken = [&] { return quit || !queue.empty(); };
      if (!renderer || !tev || !tev->waits(*renderer)) {
        wake.wait(lock, woken);
      } else if (!wake.wait_for(lock, std::chrono::duration<double>(k_viewer_seconds), woken)) {
        lock.unlock();
        follow_tev(*renderer);
        lock.lock();
      }
      continue;
    }
    lock.unlock();
    try {
      if (renderer && renderer->ready()) {
        if (mixing && !dirty) {
          // A drag has shown unfiltered samples, which may be few: filter before taking more.
          renderer->mix().settle();
          publish_picture(*renderer, false);
        }
        if (effects) measure_effects();
        // Edits are shown meanwhile, by preview samples.
        if (!effects || dirty || coarse_wanted) advance(*renderer, work && !effects);
      } else {
        publish();
        dirty = false;
      }
    } catch (const std::exception& e) {
      log::error("{}", e.what());
      next.activity.clear();
      next.progress = -1;
      if (effects) {
        end_effects(next.effect_costs);
        lock.lock();
        continue;
      }
      next.paused = paused = true;
      // A picture of the former scene must not be shown for this one.
      if (next.scene_id != scene_id && renderer)
        next.scene_id = scene_id, next.camera = renderer->camera(), next.rgba.clear();
      publish();
      dirty = false;
    }
    if (renderer) {
      serve_due(*renderer);
      follow_tev(*renderer);
    }
    lock.lock();
  }
  end(renderer.get(), lock);
}

}  // namespace lucerna::session
