#include "session/session.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "base/log.h"
#include "base/timer.h"
#include "session/renderer.h"

namespace lucerna::session {

const std::array<const char*, k_components> k_component_names = paths::k_component_names;

namespace {
constexpr double k_publish_seconds = 0.1;  // between pictures while the image refines
constexpr double k_numbers_seconds = 0.5;  // between read-backs of the film for shares
constexpr int k_nice = 10;                 // rendering yields to the window's thread
}  // namespace

struct Session::Impl {
  Options options;
  std::thread thread;
  mutable std::mutex mutex;
  std::condition_variable wake;
  std::deque<std::function<void(Renderer&)>> queue;
  bool quit = false;
  uint64_t posted = 0;
  std::atomic<bool> cancel_load{false}, pending{false};
  std::atomic<uint32_t> caches_asked{0};  // for, and not saved yet
  std::shared_ptr<const Snapshot> snapshot;
  std::shared_ptr<const scene::Scene> scene;
  plan::Settings settings;
  std::function<void()> published;

  // Of the session thread alone.
  Snapshot next;
  AccuracyKeeper accuracy;
  Timer since_publish, since_numbers;
  bool paused = false, dirty = true, coarse_wanted = false, size_known = false;
  bool filled = false;
  uint64_t levels_shown = 0;                  // of the cache, by the coarse picture
  std::vector<std::filesystem::path> caches;  // to be saved when complete

  /// Saves what was asked for if it is complete, or cannot be.
  void save_caches(Renderer& r) {
    if (caches.empty() || (r.cache() && !r.cache()->ready())) return;
    for (const std::filesystem::path& file : caches) {
      try {
        r.save_cache(file);
        log::info("saved {}: {} records", file.string(), r.cache()->status().records);
      } catch (const std::exception& e) {
        log::error("{}", e.what());
      }
    }
    caches_asked -= uint32_t(caches.size());
    caches.clear();
  }

  void give_up_caches(const char* why) {
    for (const auto& file : caches)
      log::error("{}: not written: {} before the cache was complete", file.string(), why);
    caches_asked -= uint32_t(caches.size());
    caches.clear();
  }

  void post(std::function<void(Renderer&)> command) {
    {
      std::lock_guard lock(mutex);
      queue.push_back(std::move(command));
      ++posted;
      pending = true;
    }
    wake.notify_one();
  }

  void publish_activity(const std::string& what, float fraction) {
    next.activity = what;
    next.progress = fraction;
    publish();
  }

  void publish() {
    auto copy = std::make_shared<Snapshot>(next);
    copy->id = ++next.id;
    std::function<void()> call;
    {
      std::lock_guard lock(mutex);
      snapshot = std::move(copy);
      call = published;
    }
    if (call) call();
  }

  void restarted() {
    coarse_wanted = dirty = true;
    filled = false;
  }

  void fill_snapshot(Renderer& r, bool numbers) {
    next.width = r.film().width();
    next.height = r.film().height();
    next.rgba = r.picture(!filled);
    const film::View view = r.view();
    next.legend = {};
    if (view.layer >= shared::k_layer_samples)
      next.legend = {view.layer, view.heat.ramp, view.heat.logarithmic, view.heat.lo, view.heat.hi};
    next.tiles = view.tiles > 0;
    next.samples = r.samples();
    next.max_samples = r.max_samples();
    next.coarse = !filled;
    next.paused = paused;
    next.finished = r.done();
    next.preparing.clear();
    if (const irradiance_cache::Cache* cache = r.cache(); cache && !cache->ready()) {
      const irradiance_cache::CacheStatus& c = cache->status();
      next.preparing =
          c.waits ? fmt::format("cache waits: {}", stage_words(*c.last))
          : c.relighting > 0
              ? fmt::format("cache: relighting {} records, {:.0f} %", c.relighting, 100 * c.relit)
              : fmt::format("cache, pass {}: {} records", c.pass + 1, cache->records().size());
    }
    next.cache = r.cache_report();
    next.seconds = r.seconds();
    next.camera = r.camera();
    next.tracer = r.tracer_name();
    next.device = r.device().info().name;
    next.device_mb = double(r.device().allocated_bytes()) / (1 << 20);
    const transport::TransportStats& stats = r.stats();
    next.rays = stats.rays;
    const double tracing = r.render_seconds();
    next.mrays_per_second = tracing > 0 ? 1e-6 * double(stats.rays) / tracing : 0;
    next.dropped = stats.dropped;
    next.stages.clear();
    for (const auto& s : stats.stages) next.stages.push_back({s.name, s.ms, s.host});
    next.mean_samples = double(stats.paths) / (double(next.width) * next.height);
    accuracy.follow(r, next.scene_id);
    next.accuracy = accuracy.publish(r, numbers || dirty);
    const auto ms = r.component_ms_a_sample();
    for (int c = 0; c < k_components; ++c) {
      next.components[c].solver = r.settings().text(std::string("components.") + k_component_names[c]);
      next.components[c].ms_per_sample = ms[size_t(c)];
    }
    if (numbers) {
      next.host_mb = peak_host_mb();
      const auto means = film::Film::means(r.image());
      double total = 0;
      for (const vec3& m : means) total += luminance(m);
      for (int c = 0; c < k_components; ++c) {
        next.components[c].mean_luminance = luminance(means[c]);
        next.components[c].share = total > 0 ? luminance(means[c]) / total : 0;
      }
    }
  }

  void run();
};

void Session::Impl::run() {
  // Threads that the device starts inherit this, so that the window is served first.
  setpriority(PRIO_PROCESS, id_t(syscall(SYS_gettid)), k_nice);
  std::unique_ptr<Renderer> renderer;
  try {
    renderer = std::make_unique<Renderer>(
        RendererOptions{options.device, options.validation, options.shaders, {}, true});
    next.device = renderer->device().info().name;
    publish();
  } catch (const std::exception& e) {
    log::error("{}", e.what());
    publish_activity(std::string("no device: ") + e.what(), -1);
  }
  std::unique_lock lock(mutex);
  while (!quit) {
    while (!queue.empty() && !quit) {
      auto command = std::move(queue.front());
      queue.pop_front();
      lock.unlock();
      try {
        if (!renderer) throw Error("device", "there is none to render with");
        command(*renderer);
      } catch (const std::exception& e) {
        log::error("{}", e.what());
      }
      if (renderer) {
        lock.lock();
        settings = renderer->settings();
        scene = renderer->scene();
        pending = !queue.empty();
        lock.unlock();
      }
      next.activity.clear();
      next.progress = -1;
      ++next.commands;
      dirty = true;
      lock.lock();
    }
    pending = false;
    const bool work =
        renderer && renderer->ready() && !paused && !renderer->done() && !renderer->cache_waits();
    if (renderer && !work) renderer->rest();
    if (!work && !dirty) {
      wake.wait(lock, [&] { return quit || !queue.empty(); });
      continue;
    }
    lock.unlock();
    const auto cancelled = [&] { return pending.load() || quit; };
    try {
      if (renderer && renderer->ready()) {
        bool changed = dirty;
        if (coarse_wanted && !paused) {
          renderer->render_coarse(cancelled);
          coarse_wanted = false;
          changed = true;
        } else if (work && renderer->step(cancelled)) {
          // While the cache is built or relit the coarse picture shows what has come of it.
          if (const irradiance_cache::Cache* cache = renderer->cache();
              cache && !cache->ready() && cache->status().published != levels_shown) {
            levels_shown = cache->status().published;
            coarse_wanted = true;
          }
          accuracy.follow(*renderer, next.scene_id);
          save_caches(*renderer);
        }
        // The last line of the ledger is that of the finished image.
        if (renderer->done() && !renderer->ledger().entries().empty() &&
            renderer->ledger().entries().back().paths != renderer->stats().paths)
          renderer->finish_ledger();
        if (!filled && renderer->samples() > 0) filled = changed = true;
        if (changed || since_publish.seconds() > k_publish_seconds || renderer->done() ||
            renderer->cache_waits()) {
          const bool numbers = since_numbers.seconds() > k_numbers_seconds || renderer->done();
          if (numbers) since_numbers.restart();
          fill_snapshot(*renderer, numbers);
          publish();
          since_publish.restart();
          dirty = false;
        }
      } else {
        publish();
        dirty = false;
      }
    } catch (const std::exception& e) {
      log::error("{}", e.what());
      next.activity.clear();
      next.progress = -1;
      next.paused = paused = true;
      publish();
      dirty = false;
    }
    lock.lock();
  }
  lock.unlock();
  give_up_caches("the program ended");
}

Session::Session(const Options& options) : impl_(std::make_unique<Impl>()) {
  impl_->options = options;
  impl_->thread = std::thread([this] { impl_->run(); });
}

Session::~Session() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->quit = true;
    impl_->cancel_load = true;
    impl_->pending = true;
  }
  impl_->wake.notify_one();
  impl_->thread.join();
}

void Session::load(const std::filesystem::path& file) {
  impl_->cancel_load = false;
  impl_->post([s = impl_.get(), file](Renderer& r) {
    Timer since;
    r.load(file, [&](float fraction, const std::string& what) {
      if (since.seconds() > 0.05 || fraction == 0) {
        s->publish_activity(fmt::format("loading {}: {}", file.filename().string(), what), fraction);
        since.restart();
      }
      return !s->cancel_load.load();
    });
    ++s->next.scene_id;
    s->restarted();
    s->give_up_caches("another scene was loaded");
    const auto count = [](uint64_t n, const char* what) {
      return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
    };
    log::info("{} loaded: {}, {}, {}", file.string(), count(scene::count_triangles(*r.scene()), "triangle"),
              count(r.scene()->lights.size(), "lamp"), count(r.scene()->cameras.size(), "camera"));
  });
}

void Session::set(const std::string& key, const std::string& value) {
  impl_->post([s = impl_.get(), key, value](Renderer& r) {
    const uint64_t before = r.restarts();
    r.settings().set(key, value, "setting");
    r.apply_settings();
    if (r.restarts() != before) s->restarted();
  });
}

void Session::set_camera(const scene::Camera& camera) {
  impl_->post([s = impl_.get(), camera](Renderer& r) {
    r.set_camera(camera);
    s->restarted();
  });
}

void Session::set_size(uint32_t width, uint32_t height) {
  impl_->post([s = impl_.get(), width, height](Renderer& r) {
    r.set_size(width, height);
    s->restarted();
  });
}

void Session::set_light(uint32_t index, const scene::Light& light) {
  impl_->post([s = impl_.get(), index, light](Renderer& r) {
    r.set_light(index, light);
    s->restarted();
  });
}

void Session::set_environment(float scale, float rotation_degrees) {
  impl_->post([s = impl_.get(), scale, rotation_degrees](Renderer& r) {
    r.set_environment(scale, rotation_degrees);
    s->restarted();
  });
}

void Session::set_material(uint32_t index, const scene::Material& material) {
  impl_->post([s = impl_.get(), index, material](Renderer& r) {
    r.set_material(index, material);
    s->restarted();
  });
}

void Session::set_paused(bool paused) {
  impl_->post([s = impl_.get(), paused](Renderer&) { s->paused = paused; });
}

void Session::restart() {
  impl_->post([s = impl_.get()](Renderer& r) {
    r.restart();
    s->restarted();
  });
}

void Session::reload_shaders() {
  impl_->post([s = impl_.get()](Renderer& r) {
    const Timer timer;
    r.reload_shaders();
    s->restarted();
    log::info("shaders reloaded in {:.2f} s", timer.seconds());
  });
}

void Session::set_reference(const std::filesystem::path& file) {
  impl_->post([file](Renderer& r) {
    r.set_reference(file);
    r.finish_ledger();  // what there is is held against it at once
    log::info("{} is the reference", file.string());
  });
}

void Session::clear_reference() {
  impl_->post([](Renderer& r) { r.clear_reference(); });
}

void Session::inspect(std::optional<vec2> at) {
  impl_->post([at](Renderer& r) { r.inspect(at); });
}

void Session::save(const std::filesystem::path& file) {
  impl_->post([file](Renderer& r) {
    r.save(file);
    log::info("saved {}", file.string());
  });
}

void Session::save_cache(const std::filesystem::path& file) {
  ++impl_->caches_asked;
  impl_->post([s = impl_.get(), file](Renderer& r) {
    s->caches.push_back(file);
    s->save_caches(r);
    if (!s->caches.empty()) log::info("{}: will be written when the cache is complete", file.string());
  });
}

bool Session::saving_cache() const { return impl_->caches_asked > 0; }

void Session::load_cache(const std::filesystem::path& file) {
  impl_->post([s = impl_.get(), file](Renderer& r) {
    r.load_cache(file);
    s->restarted();
  });
}

void Session::step_cache() {
  impl_->post([s = impl_.get()](Renderer& r) {
    r.step_cache();
    s->paused = false;
  });
}

void Session::run_cache() {
  impl_->post([s = impl_.get()](Renderer& r) {
    r.run_cache();
    s->paused = false;
  });
}

uint64_t Session::commands() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->posted;
}

void Session::cancel() { impl_->cancel_load = true; }

std::shared_ptr<const Snapshot> Session::snapshot() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->snapshot;
}

std::shared_ptr<const scene::Scene> Session::scene() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->scene;
}

plan::Settings Session::settings() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->settings;
}

void Session::on_publish(std::function<void()> call) {
  std::lock_guard lock(impl_->mutex);
  impl_->published = std::move(call);
}

}  // namespace lucerna::session
