#pragma once
#include <chrono>
#include <future>

namespace lucerna {

/// True if get() returns, or throws, at once. False if there is nothing to wait for.
template <class Future>
bool is_ready(const Future& future) {
  return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace lucerna
