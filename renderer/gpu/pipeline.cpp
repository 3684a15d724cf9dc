#include "gpu/pipeline.h"

#include <algorithm>

#include "gpu/vulkan.h"

namespace lucerna::gpu {

Pipeline::~Pipeline() {
  const auto& vk = handles.vk;
  if (pipeline) vk.vkDestroyPipeline(handles.device, pipeline, nullptr);
  if (layout) vk.vkDestroyPipelineLayout(handles.device, layout, nullptr);
  if (set_layout) vk.vkDestroyDescriptorSetLayout(handles.device, set_layout, nullptr);
}

std::shared_ptr<const Pipeline> Pipelines::find_or_make(const std::string& key, const Make& make) {
  std::lock_guard lock(mutex_);
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.key == key; });
  if (found != entries_.end()) {
    std::rotate(found, found + 1, entries_.end());
    return entries_.back().pipeline;
  }
  std::shared_ptr<const Pipeline> pipeline = make();
  entries_.push_back({key, pipeline});
  ++made_;
  drop_spare();
  return pipeline;
}

void Pipelines::drop_spare() {
  const auto spare = [](const Entry& e) { return e.pipeline.use_count() == 1; };
  size_t too_many = static_cast<size_t>(std::count_if(entries_.begin(), entries_.end(), spare));
  too_many -= std::min(too_many, k_spare);
  std::erase_if(entries_, [&](const Entry& e) { return too_many > 0 && spare(e) && too_many-- > 0; });
}

void Pipelines::clear() {
  std::lock_guard lock(mutex_);
  entries_.clear();
}

uint64_t Pipelines::made() const {
  std::lock_guard lock(mutex_);
  return made_;
}

}  // namespace lucerna::gpu
