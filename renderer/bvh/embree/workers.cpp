#include "bvh/embree/workers.h"

#include <algorithm>

namespace lucerna::bvh {

Workers::Workers(int threads) {
  const int wanted =
      threads > 0 ? threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  for (int i = 1; i < wanted; ++i) threads_.emplace_back([this] { work(); });
}

Workers::~Workers() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  start_.notify_all();
  for (std::thread& t : threads_) t.join();
}

void Workers::run(uint32_t chunks, const std::function<void(uint32_t)>& job) {
  if (chunks == 0) return;
  const std::lock_guard one_caller(callers_);
  std::unique_lock lock(mutex_);
  job_ = &job, next_ = 0, chunks_ = chunks, ++round_;
  if (chunks > 1) start_.notify_all();
  while (next_ < chunks_) {
    const uint32_t chunk = next_++;
    lock.unlock();
    job(chunk);
    lock.lock();
  }
  finished_.wait(lock, [this] { return active_ == 0; });
  job_ = nullptr;
}

void Workers::work() {
  uint64_t seen = 0;
  std::unique_lock lock(mutex_);
  for (;;) {
    start_.wait(lock, [&] { return stop_ || (round_ != seen && next_ < chunks_); });
    if (stop_) return;
    seen = round_;
    ++active_;
    while (next_ < chunks_) {
      const uint32_t chunk = next_++;
      const auto& job = *job_;
      lock.unlock();
      job(chunk);
      lock.lock();
    }
    if (--active_ == 0) finished_.notify_one();
  }
}

}  // namespace lucerna::bvh
