#include <algorithm>
#include <cassert>

#include "gpu/vulkan.h"

namespace lucerna::gpu {

namespace {

void check_range(const Buffer::Impl& b, const char* verb, uint64_t size, uint64_t offset) {
  if (offset <= b.desc.bytes && size <= b.desc.bytes - offset) return;
  throw_error("buffer '" + b.desc.name + "'", "cannot {} {} bytes at {}: it holds {} bytes", verb, size,
              offset, b.desc.bytes);
}

void check_limits(const DeviceInfo& info, const BufferDesc& desc) {
  const std::string where = "buffer '" + desc.name + "'";
  if (desc.texel) {
    if (desc.bytes % 16)
      throw_error(where, "a texel buffer must be whole texels of 16 bytes, not {} bytes", desc.bytes);
    if (desc.bytes / 16 > info.limits.max_texel_elements)
      throw_error(where,
                  "{} are {} texels; {} reads at most {} from one texel buffer (maxTexelBufferElements)",
                  format_bytes(desc.bytes), desc.bytes / 16, info.name, info.limits.max_texel_elements);
  } else if (desc.bytes > info.limits.max_storage_buffer) {
    throw_error(where,
                "{} are more than the {} that {} reads from one storage buffer (maxStorageBufferRange); "
                "try a smaller --size",
                format_bytes(desc.bytes), format_bytes(info.limits.max_storage_buffer), info.name);
  }
}

}  // namespace

Buffer::Impl::~Impl() {
  const auto& vk = handles->vk;
  if (view) vk.vkDestroyBufferView(handles->device, view, nullptr);
  if (word_view) vk.vkDestroyBufferView(handles->device, word_view, nullptr);
  if (buffer) vk.vkDestroyBuffer(handles->device, buffer, nullptr);
  handles->allocator->free(memory);
}

Buffer::Buffer() = default;
Buffer::~Buffer() = default;
Buffer::Buffer(Buffer&&) noexcept = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;

Buffer::Buffer(Device& device, const BufferDesc& desc) {
  Handles& h = device.handles();
  check_limits(h.info, desc);
  auto impl = std::make_unique<Impl>();
  impl->handles = &h;
  impl->desc = desc;
  impl->id = h.next_id();
  impl->allocated = std::max<uint64_t>(16, (desc.bytes + 15) / 16 * 16);

  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = impl->allocated;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
               VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
  if (desc.texel)
    info.usage |= VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
  check(h.vk.vkCreateBuffer(h.device, &info, nullptr, &impl->buffer), "creating a buffer");
  VkMemoryRequirements needs{};
  h.vk.vkGetBufferMemoryRequirements(h.device, impl->buffer, &needs);
  impl->memory = h.allocator->allocate(needs, desc.memory, false, desc.name, desc.bytes);
  check(h.vk.vkBindBufferMemory(h.device, impl->buffer, impl->memory.memory, impl->memory.offset),
        "binding memory");
  if (desc.texel) {
    VkBufferViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO;
    view.buffer = impl->buffer;
    view.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    view.range = impl->allocated;
    check(h.vk.vkCreateBufferView(h.device, &view, nullptr, &impl->view), "creating a texel buffer");
    view.format = VK_FORMAT_R32G32B32A32_UINT;
    check(h.vk.vkCreateBufferView(h.device, &view, nullptr, &impl->word_view), "creating a texel buffer");
  }
  impl_ = std::move(impl);
}

uint64_t Buffer::bytes() const { return impl_ ? impl_->desc.bytes : 0; }

const std::string& Buffer::name() const {
  static const std::string empty;
  return impl_ ? impl_->desc.name : empty;
}

void* Buffer::mapped() const { return impl_ ? impl_->memory.mapped : nullptr; }

void Buffer::write(const void* data, uint64_t size, uint64_t offset) {
  if (size == 0) return;
  if (!impl_) throw Error("buffer", "cannot write to an empty buffer");
  check_range(*impl_, "write", size, offset);
  if (impl_->memory.mapped) {
    std::memcpy(static_cast<std::byte*>(impl_->memory.mapped) + offset, data, size);
    return;
  }
  Handles& h = *impl_->handles;
  for (uint64_t done = 0; done < size;) {
    const uint64_t part = std::min(size - done, Handles::staging_bytes);
    h.with_staging([&](VkBuffer staging, void* mapped) {
      std::memcpy(mapped, static_cast<const std::byte*>(data) + done, part);
      h.run_now([&](VkCommandBuffer commands) {
        const VkBufferCopy copy{0, offset + done, part};
        h.vk.vkCmdCopyBuffer(commands, staging, impl_->buffer, 1, &copy);
      });
    });
    done += part;
  }
}

void Buffer::read(void* data, uint64_t size, uint64_t offset) const {
  if (size == 0) return;
  if (!impl_) throw Error("buffer", "cannot read from an empty buffer");
  check_range(*impl_, "read", size, offset);
  if (impl_->memory.mapped) {
    std::memcpy(data, static_cast<const std::byte*>(impl_->memory.mapped) + offset, size);
    return;
  }
  Handles& h = *impl_->handles;
  for (uint64_t done = 0; done < size;) {
    const uint64_t part = std::min(size - done, Handles::staging_bytes);
    h.with_staging([&](VkBuffer staging, void* mapped) {
      h.run_now([&](VkCommandBuffer commands) {
        const VkBufferCopy copy{offset + done, 0, part};
        h.vk.vkCmdCopyBuffer(commands, impl_->buffer, staging, 1, &copy);
      });
      std::memcpy(static_cast<std::byte*>(data) + done, mapped, part);
    });
    done += part;
  }
}

void make_room(Device& device, Buffer& buffer, BufferDesc desc) {
  desc.bytes = (desc.bytes + 15) / 16 * 16;
  if (buffer && buffer.bytes() >= desc.bytes) return;
  buffer = {};  // its memory first
  buffer = Buffer(device, desc);
}

void make_texel_room(Device& device, Buffer& buffer, const char* name, uint64_t bytes) {
  make_room(device, buffer, {.name = name, .bytes = bytes, .texel = true});
}

}  // namespace lucerna::gpu
