#include "gpu/vulkan.h"

namespace lucerna::gpu {

Handles::~Handles() {
  if (!device) return;
  pipelines.clear();
  if (staging_) vk.vkDestroyBuffer(device, staging_, nullptr);
  if (allocator) allocator->free(staging_memory_, false);
  if (now_fence_) vk.vkDestroyFence(device, now_fence_, nullptr);
  if (now_pool_) vk.vkDestroyCommandPool(device, now_pool_, nullptr);
  if (sampler) vk.vkDestroySampler(device, sampler, nullptr);
  allocator.reset();
  vk.vkDestroyDevice(device, nullptr);
}

void Handles::submit_and_wait(VkCommandBuffer commands, VkFence fence) {
  VkSubmitInfo submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  {
    std::lock_guard lock(queue_mutex);
    check(vk.vkQueueSubmit(queue, 1, &submit, fence), "submitting work");
  }
  check(vk.vkWaitForFences(device, 1, &fence, VK_TRUE, ~0ull), "waiting for work");
  check(vk.vkResetFences(device, 1, &fence), "resetting a fence");
}

void Handles::run_now(const std::function<void(VkCommandBuffer)>& record) {
  std::lock_guard lock(now_mutex_);
  if (!now_pool_) {
    VkCommandPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool.queueFamilyIndex = queue_family;
    check(vk.vkCreateCommandPool(device, &pool, nullptr, &now_pool_), "creating a command pool");
    VkCommandBufferAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocate.commandPool = now_pool_;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    check(vk.vkAllocateCommandBuffers(device, &allocate, &now_commands_), "creating a command buffer");
    VkFenceCreateInfo fence{};
    fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    check(vk.vkCreateFence(device, &fence, nullptr, &now_fence_), "creating a fence");
  }
  check(vk.vkResetCommandPool(device, now_pool_, 0), "resetting commands");
  VkCommandBufferBeginInfo begin{};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vk.vkBeginCommandBuffer(now_commands_, &begin), "recording");
  record(now_commands_);
  full_barrier(*this, now_commands_);
  check(vk.vkEndCommandBuffer(now_commands_), "recording");
  submit_and_wait(now_commands_, now_fence_);
}

void Handles::with_staging(const std::function<void(VkBuffer, void*)>& use) {
  std::lock_guard lock(staging_mutex_);
  if (!staging_) {
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = staging_bytes;
    info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    check(vk.vkCreateBuffer(device, &info, nullptr, &buffer), "creating the staging buffer");
    VkMemoryRequirements needs{};
    vk.vkGetBufferMemoryRequirements(device, buffer, &needs);
    try {
      staging_memory_ = allocator->allocate(needs, Memory::host, false, "staging", staging_bytes, false);
    } catch (...) {
      vk.vkDestroyBuffer(device, buffer, nullptr);
      throw;
    }
    staging_ = buffer;
    check(vk.vkBindBufferMemory(device, staging_, staging_memory_.memory, staging_memory_.offset),
          "binding memory");
  }
  use(staging_, staging_memory_.mapped);
}

void full_barrier(const Handles& handles, VkCommandBuffer commands) {
  VkMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
  barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                          VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT |
                          VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_HOST_READ_BIT;
  const VkPipelineStageFlags work = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
  handles.vk.vkCmdPipelineBarrier(commands, work,
                                  work | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0,
                                  1, &barrier, 0, nullptr, 0, nullptr);
}

}  // namespace lucerna::gpu
