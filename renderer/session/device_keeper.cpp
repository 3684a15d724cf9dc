#include "session/device_keeper.h"

#include <mutex>

#include "session/kept_device.h"

namespace lucerna::session {
namespace {

struct Kept {
  std::mutex mutex;
  bool keeps = false;
  std::string selector;
  std::shared_ptr<gpu::Device> device;
};

Kept& kept() {
  static Kept kept;
  return kept;
}

}  // namespace

DeviceKeeper::DeviceKeeper() {
  std::lock_guard lock(kept().mutex);
  kept().keeps = true;
}

DeviceKeeper::~DeviceKeeper() {
  std::lock_guard lock(kept().mutex);
  kept().keeps = false, kept().device.reset();
}

std::shared_ptr<gpu::Device> kept_device(const std::string& selector) {
  Kept& k = kept();
  std::lock_guard lock(k.mutex);
  if (!k.keeps) return nullptr;
  if (k.selector == selector && k.device.use_count() == 1) return k.device;
  auto made = std::make_shared<gpu::Device>(gpu::DeviceOptions{.selector = selector});
  k.selector = selector, k.device = made;
  return made;
}

}  // namespace lucerna::session
