#include "gpu/stream.h"

#include <algorithm>
#include <map>

#include "gpu/vulkan.h"

namespace lucerna::gpu {

namespace {

constexpr uint32_t k_sets_a_pool = 256;
constexpr size_t k_most_sets = 4096;        ///< cached sets; beyond, all are dropped
constexpr uint32_t k_queries_a_pool = 512;  ///< two a timed dispatch

}  // namespace

struct Stream::Impl {
  struct TimedDispatch {
    uint32_t stage, query;  ///< `query` counts through all pools; the end is the next one
  };

  Handles& h;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  VkFence fence = VK_NULL_HANDLE;
  bool recording = false;

  std::vector<VkDescriptorPool> set_pools;
  size_t sets_made = 0;
  /// (kernel id, resource ids by binding) -> set. Ids are never reused, so a set cannot be found for other
  /// resources.
  std::map<std::vector<uint64_t>, VkDescriptorSet> sets;
  std::vector<uint64_t> key;  ///< scratch

  std::vector<VkQueryPool> query_pools;
  uint32_t queries = 0;
  std::vector<TimedDispatch> timed;
  std::vector<StageTime> times;

  explicit Impl(Handles& handles) : h(handles) {}
  ~Impl();
  void begin();
  void command() {
    begin();
    full_barrier(h, commands);
  }
  VkDescriptorSet set_for(const Kernel::Impl& kernel, const Resources& resources);
  VkDescriptorSet allocate_set(VkDescriptorSetLayout layout);
  void bind(const Kernel& kernel, const Resources& resources, const void* push, size_t push_bytes);
  uint32_t start_timer(const std::string& stage);
  void stop_timer(uint32_t query);
  void collect_times();
};

namespace {

constexpr uint32_t k_no_query = ~0u;

/// The Vulkan resource to bind to a kernel's slot, checked.
const Resources::Entry& resource_for(const Kernel::Impl& kernel, const Kernel::Impl::Slot& slot,
                                     const Resources& resources) {
  const Resources::Entry* entry = resources.find(slot.name);
  if (!entry) throw_error(kernel.file, "it declares '{}', and there is no resource of that name", slot.name);
  const bool image = slot.kind == Kernel::Impl::Kind::sampled_image;
  if (image != std::holds_alternative<const TextureArray*>(*entry))
    throw_error(kernel.file, "'{}' must be a {}, and the resource of that name is a {}", slot.name,
                image ? "texture array" : "buffer", image ? "buffer" : "texture array");
  if (image) {
    if (!*std::get<const TextureArray*>(*entry))
      throw_error(kernel.file, "the texture array '{}' is empty", slot.name);
    return *entry;
  }
  const Buffer& buffer = *std::get<const Buffer*>(*entry);
  if (!buffer) throw_error(kernel.file, "the buffer '{}' was never made, or was moved away", slot.name);
  const bool texels = slot.kind != Kernel::Impl::Kind::storage_buffer;
  if (texels && !buffer.impl()->view)
    throw_error(kernel.file, "'{}' is read as texels, but the buffer '{}' was made without texel = true",
                slot.name, buffer.name());
  const uint64_t limit = kernel.handles->info.limits.max_storage_buffer;
  if (slot.kind == Kernel::Impl::Kind::storage_buffer && buffer.bytes() > limit)
    throw_error(kernel.file,
                "'{}' is {}; a storage buffer reaches {} here (maxStorageBufferRange): read it as a "
                "samplerBuffer",
                slot.name, format_bytes(buffer.bytes()), format_bytes(limit));
  return *entry;
}

}  // namespace

Stream::Impl::~Impl() {
  if (recording) h.vk.vkEndCommandBuffer(commands);
  for (auto p : query_pools) h.vk.vkDestroyQueryPool(h.device, p, nullptr);
  for (auto p : set_pools) h.vk.vkDestroyDescriptorPool(h.device, p, nullptr);
  if (fence) h.vk.vkDestroyFence(h.device, fence, nullptr);
  if (pool) h.vk.vkDestroyCommandPool(h.device, pool, nullptr);
}

void Stream::Impl::begin() {
  if (recording) return;
  check(h.vk.vkResetCommandPool(h.device, pool, 0), "resetting commands");
  if (sets.size() > k_most_sets) {
    for (auto p : set_pools) h.vk.vkResetDescriptorPool(h.device, p, 0);
    sets.clear();
    sets_made = 0;
  }
  VkCommandBufferBeginInfo begin{};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(h.vk.vkBeginCommandBuffer(commands, &begin), "recording");
  recording = true;
  for (auto p : query_pools) h.vk.vkCmdResetQueryPool(commands, p, 0, k_queries_a_pool);
}

VkDescriptorSet Stream::Impl::allocate_set(VkDescriptorSetLayout layout) {
  VkDescriptorSetAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  info.descriptorSetCount = 1;
  info.pSetLayouts = &layout;
  VkDescriptorSet set = VK_NULL_HANDLE;
  size_t index = sets_made / k_sets_a_pool;
  if (index < set_pools.size()) {
    info.descriptorPool = set_pools[index];
    if (h.vk.vkAllocateDescriptorSets(h.device, &info, &set) == VK_SUCCESS) {
      ++sets_made;
      return set;
    }
    // This pool has no more descriptors of one kind: continues with the next.
    sets_made = ++index * k_sets_a_pool;
  }
  if (index >= set_pools.size()) {
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, k_sets_a_pool * 16},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, k_sets_a_pool * 8},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, k_sets_a_pool * 8},
                                          {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, k_sets_a_pool * 8}};
    VkDescriptorPoolCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    create.maxSets = k_sets_a_pool;
    create.poolSizeCount = static_cast<uint32_t>(std::size(sizes));
    create.pPoolSizes = sizes;
    VkDescriptorPool made = VK_NULL_HANDLE;
    check(h.vk.vkCreateDescriptorPool(h.device, &create, nullptr, &made), "creating a descriptor pool");
    set_pools.push_back(made);
  }
  info.descriptorPool = set_pools[index];
  check(h.vk.vkAllocateDescriptorSets(h.device, &info, &set), "binding resources");
  ++sets_made;
  return set;
}

VkDescriptorSet Stream::Impl::set_for(const Kernel::Impl& kernel, const Resources& resources) {
  key.assign(1, kernel.id);
  for (const auto& slot : kernel.slots) {
    const Resources::Entry& entry = resource_for(kernel, slot, resources);
    key.push_back(std::holds_alternative<const Buffer*>(entry)
                      ? std::get<const Buffer*>(entry)->impl()->id
                      : std::get<const TextureArray*>(entry)->impl()->id);
  }
  if (const auto found = sets.find(key); found != sets.end()) return found->second;

  const VkDescriptorSet set = allocate_set(kernel.pipeline->set_layout);
  std::vector<VkWriteDescriptorSet> writes(kernel.slots.size());
  std::vector<VkDescriptorBufferInfo> buffers(kernel.slots.size());
  std::vector<VkDescriptorImageInfo> images(kernel.slots.size());
  for (size_t i = 0; i < kernel.slots.size(); ++i) {
    const Resources::Entry& entry = *resources.find(kernel.slots[i].name);
    VkWriteDescriptorSet& write = writes[i];
    write = {};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.dstBinding = static_cast<uint32_t>(i);
    write.descriptorCount = 1;
    switch (kernel.slots[i].kind) {
      case Kernel::Impl::Kind::storage_buffer: {
        const Buffer::Impl& buffer = *std::get<const Buffer*>(entry)->impl();
        // The range has the requested size, so that length() of an array is exact.
        buffers[i] = {buffer.buffer, 0, buffer.desc.bytes ? buffer.desc.bytes : buffer.allocated};
        write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        write.pBufferInfo = &buffers[i];
        break;
      }
      case Kernel::Impl::Kind::texel_buffer:
        write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
        write.pTexelBufferView = &std::get<const Buffer*>(entry)->impl()->view;
        break;
      case Kernel::Impl::Kind::texel_buffer_words:
        write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
        write.pTexelBufferView = &std::get<const Buffer*>(entry)->impl()->word_view;
        break;
      case Kernel::Impl::Kind::texel_image:
        write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
        write.pTexelBufferView = &std::get<const Buffer*>(entry)->impl()->view;
        break;
      case Kernel::Impl::Kind::sampled_image:
        images[i] = {h.sampler, std::get<const TextureArray*>(entry)->impl()->view,
                     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        write.pImageInfo = &images[i];
        break;
    }
  }
  h.vk.vkUpdateDescriptorSets(h.device, static_cast<uint32_t>(writes.size()), writes.data(), 0, nullptr);
  sets.emplace(key, set);
  return set;
}

void Stream::Impl::bind(const Kernel& kernel, const Resources& resources, const void* push,
                        size_t push_bytes) {
  if (!kernel) throw Error("kernel", "a kernel that was never made was dispatched");
  const Kernel::Impl& k = *kernel.impl();
  if (push_bytes != k.push_bytes)
    throw_error(k.file, "its push constants are {} bytes, {} were given", k.push_bytes, push_bytes);
  begin();
  const VkDescriptorSet set = set_for(k, resources);
  full_barrier(h, commands);
  h.vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, k.pipeline->pipeline);
  h.vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, k.pipeline->layout, 0, 1, &set, 0,
                               nullptr);
  if (push_bytes)
    h.vk.vkCmdPushConstants(commands, k.pipeline->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                            static_cast<uint32_t>(push_bytes), push);
}

uint32_t Stream::Impl::start_timer(const std::string& stage) {
  if (stage.empty() || !h.timestamps) return k_no_query;
  auto found = std::find_if(times.begin(), times.end(), [&](const StageTime& t) { return t.stage == stage; });
  if (found == times.end()) found = times.insert(times.end(), {stage, 0});
  if (queries / k_queries_a_pool >= query_pools.size()) {
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = k_queries_a_pool;
    VkQueryPool made = VK_NULL_HANDLE;
    check(h.vk.vkCreateQueryPool(h.device, &info, nullptr, &made), "creating timers");
    query_pools.push_back(made);
    h.vk.vkCmdResetQueryPool(commands, made, 0, k_queries_a_pool);
  }
  timed.push_back({static_cast<uint32_t>(found - times.begin()), queries});
  // At the bottom of the pipe: when all that came before has finished.
  h.vk.vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                           query_pools[queries / k_queries_a_pool], queries % k_queries_a_pool);
  queries += 2;
  return queries - 2;
}

void Stream::Impl::stop_timer(uint32_t query) {
  if (query == k_no_query) return;
  h.vk.vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                           query_pools[query / k_queries_a_pool], query % k_queries_a_pool + 1);
}

void Stream::Impl::collect_times() {
  std::vector<uint64_t> ticks(queries);
  for (uint32_t first = 0; first < queries; first += k_queries_a_pool) {
    const uint32_t count = std::min(k_queries_a_pool, queries - first);
    check(h.vk.vkGetQueryPoolResults(h.device, query_pools[first / k_queries_a_pool], 0, count,
                                     count * sizeof(uint64_t), &ticks[first], sizeof(uint64_t),
                                     VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "reading timers");
  }
  for (const TimedDispatch& t : timed)
    times[t.stage].milliseconds +=
        1e-6 * h.info.limits.timestamp_ns *
        static_cast<double>((ticks[t.query + 1] - ticks[t.query]) & h.timestamp_mask);
  timed.clear();
  queries = 0;
}

Stream::Stream(Device& device) : impl_(std::make_unique<Impl>(device.handles())) {
  Handles& h = impl_->h;
  VkCommandPoolCreateInfo pool{};
  pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool.queueFamilyIndex = h.queue_family;
  check(h.vk.vkCreateCommandPool(h.device, &pool, nullptr, &impl_->pool), "creating a command pool");
  VkCommandBufferAllocateInfo allocate{};
  allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  allocate.commandPool = impl_->pool;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocate.commandBufferCount = 1;
  check(h.vk.vkAllocateCommandBuffers(h.device, &allocate, &impl_->commands), "creating a command buffer");
  VkFenceCreateInfo fence{};
  fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
  check(h.vk.vkCreateFence(h.device, &fence, nullptr, &impl_->fence), "creating a fence");
}

Stream::~Stream() = default;

void Stream::dispatch(const Kernel& kernel, const Resources& resources, const void* push, size_t push_bytes,
                      uint32_t groups, const std::string& stage) {
  impl_->bind(kernel, resources, push, push_bytes);
  const uint32_t timer = impl_->start_timer(stage);
  const uint32_t most = k_most_groups;
  const uint32_t y = groups <= most ? 1 : (groups - 1) / most + 1;
  const uint32_t x = groups <= most ? groups : (groups - 1) / y + 1;
  impl_->h.vk.vkCmdDispatch(impl_->commands, x, y, 1);
  impl_->stop_timer(timer);
}

void Stream::dispatch_indirect(const Kernel& kernel, const Resources& resources, const void* push,
                               size_t push_bytes, const Buffer& arguments, uint64_t offset,
                               const std::string& stage) {
  if (!arguments || offset % 4 || offset + 12 > arguments.bytes())
    throw_error("buffer '" + arguments.name() + "'",
                "three workgroup counts at {} are not within its {} bytes, or not "
                "at a multiple of 4",
                offset, arguments.bytes());
  impl_->bind(kernel, resources, push, push_bytes);
  const uint32_t timer = impl_->start_timer(stage);
  impl_->h.vk.vkCmdDispatchIndirect(impl_->commands, arguments.impl()->buffer, offset);
  impl_->stop_timer(timer);
}

void Stream::fill(const Buffer& buffer, uint32_t value, uint64_t offset, uint64_t bytes) {
  const uint64_t size = buffer.bytes();
  if (bytes == ~0ull) bytes = offset <= size ? size - offset : 0;
  if (bytes == 0 && offset <= size) return;
  if (offset % 4 || bytes % 4 || offset > size || bytes > size - offset)
    throw_error("buffer '" + buffer.name() + "'",
                "cannot fill {} bytes at {} of its {}: both must be multiples of 4 and "
                "within it",
                bytes, offset, size);
  impl_->command();
  impl_->h.vk.vkCmdFillBuffer(impl_->commands, buffer.impl()->buffer, offset, bytes, value);
}

void Stream::copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t from_offset,
                  uint64_t to_offset) {
  if (bytes == 0) return;
  const auto within = [&](const Buffer& b, uint64_t offset) {
    return offset <= b.bytes() && bytes <= b.bytes() - offset;
  };
  if (!within(from, from_offset) || !within(to, to_offset))
    throw_error("buffer '" + from.name() + "'",
                "cannot copy {} bytes at {} of its {} to {} of the {} of '{}'", bytes, from_offset,
                from.bytes(), to_offset, to.bytes(), to.name());
  impl_->command();
  const VkBufferCopy region{from_offset, to_offset, bytes};
  impl_->h.vk.vkCmdCopyBuffer(impl_->commands, from.impl()->buffer, to.impl()->buffer, 1, &region);
}

void Stream::run() {
  if (!impl_->recording) return;
  full_barrier(impl_->h, impl_->commands);
  impl_->recording = false;
  check(impl_->h.vk.vkEndCommandBuffer(impl_->commands), "recording");
  impl_->h.submit_and_wait(impl_->commands, impl_->fence);
  impl_->collect_times();
}

void Stream::discard() {
  if (!impl_->recording) return;
  impl_->recording = false;
  impl_->h.vk.vkEndCommandBuffer(impl_->commands);  // begin() resets the pool
  impl_->timed.clear();
  impl_->queries = 0;
}

std::vector<StageTime> Stream::take_times() {
  std::vector<StageTime> taken;
  // Stages of work that is recorded but has not run keep their places until it has.
  if (!impl_->timed.empty()) {
    taken = impl_->times;
    for (auto& t : impl_->times) t.milliseconds = 0;
    return taken;
  }
  taken.swap(impl_->times);
  return taken;
}

}  // namespace lucerna::gpu
