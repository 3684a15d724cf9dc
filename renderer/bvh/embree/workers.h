#pragma once
// A few threads that execute one loop at a time together.
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace lucerna::bvh {

/// Threads persist between calls (starting one costs more than tracing a small queue). They are started by
/// the thread that creates the object and so inherit its priority.
class Workers {
 public:
  /// `threads` in all, the caller of run() included; 0: one a core.
  explicit Workers(int threads = 0);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int threads() const { return static_cast<int>(threads_.size()) + 1; }
  /// Calls job(0) ... job(chunks - 1), each once, on any thread, and returns when all have returned. `job`
  /// must not throw. One run() at a time: a second caller waits.
  void run(uint32_t chunks, const std::function<void(uint32_t)>& job);

 private:
  void work();

  std::vector<std::thread> threads_;
  std::mutex callers_, mutex_;
  std::condition_variable start_, finished_;
  const std::function<void(uint32_t)>* job_ = nullptr;
  uint32_t next_ = 0, chunks_ = 0, active_ = 0;
  uint64_t round_ = 0;
  bool stop_ = false;
};

}  // namespace lucerna::bvh
