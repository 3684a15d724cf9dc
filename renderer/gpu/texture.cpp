#include <algorithm>

#include "gpu/vulkan.h"

namespace lucerna::gpu {

namespace {

struct Format {
  VkFormat format;
  uint32_t bytes;
};

Format format_of(TexelFormat format) {
  switch (format) {
    case TexelFormat::rgba8_unorm:
      return {VK_FORMAT_R8G8B8A8_UNORM, 4};
    case TexelFormat::rgba8_srgb:
      return {VK_FORMAT_R8G8B8A8_SRGB, 4};
    case TexelFormat::rgba16f:
      return {VK_FORMAT_R16G16B16A16_SFLOAT, 8};
    case TexelFormat::rgba32f:
      return {VK_FORMAT_R32G32B32A32_SFLOAT, 16};
  }
  return {VK_FORMAT_UNDEFINED, 0};
}

void transition(const Handles& h, VkCommandBuffer commands, VkImage image, VkImageLayout from,
                VkImageLayout to, uint32_t first_layer, uint32_t layers) {
  VkImageMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.dstAccessMask =
      to == VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL ? VK_ACCESS_TRANSFER_WRITE_BIT : VK_ACCESS_SHADER_READ_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, first_layer, layers};
  const VkPipelineStageFlags stages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
  h.vk.vkCmdPipelineBarrier(commands, stages, stages, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

}  // namespace

TextureArray::Impl::~Impl() {
  const auto& vk = handles->vk;
  if (view) vk.vkDestroyImageView(handles->device, view, nullptr);
  if (image) vk.vkDestroyImage(handles->device, image, nullptr);
  handles->allocator->free(memory);
}

TextureArray::TextureArray() = default;
TextureArray::~TextureArray() = default;
TextureArray::TextureArray(TextureArray&&) noexcept = default;
TextureArray& TextureArray::operator=(TextureArray&&) noexcept = default;

TextureArray::TextureArray(Device& device, const TextureArrayDesc& desc) {
  Handles& h = device.handles();
  const std::string where = "texture '" + desc.name + "'";
  const Limits& limits = h.info.limits;
  if (!desc.width || !desc.height || !desc.layers)
    throw_error(where, "{} × {} texels in {} layers is empty", desc.width, desc.height, desc.layers);
  if (std::max(desc.width, desc.height) > limits.max_image_size)
    throw_error(where, "{} × {} texels exceed this device's limit of {} a side (maxImageDimension2D)",
                desc.width, desc.height, limits.max_image_size);
  if (desc.layers > limits.max_image_layers)
    throw_error(where, "{} layers exceed this device's limit of {} (maxImageArrayLayers)", desc.layers,
                limits.max_image_layers);

  auto impl = std::make_unique<Impl>();
  impl->handles = &h;
  impl->desc = desc;
  impl->id = h.next_id();
  const Format format = format_of(desc.format);
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format.format;
  info.extent = {desc.width, desc.height, 1};
  info.mipLevels = 1;
  info.arrayLayers = desc.layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  VkImageFormatProperties most{};
  check(h.instance.image_format_properties(h.physical, info.format, info.imageType, info.tiling, info.usage,
                                           0, &most),
        "asking about textures");
  const uint64_t bytes = uint64_t(desc.width) * desc.height * desc.layers * format.bytes;
  if (bytes > most.maxResourceSize)
    throw_error(where, "{} exceed the {} that {} gives to one texture array (maxResourceSize)",
                format_bytes(bytes), format_bytes(most.maxResourceSize), h.info.name);
  check(h.vk.vkCreateImage(h.device, &info, nullptr, &impl->image), "creating a texture");
  VkMemoryRequirements needs{};
  h.vk.vkGetImageMemoryRequirements(h.device, impl->image, &needs);
  impl->memory = h.allocator->allocate(needs, Memory::device, true, desc.name, bytes);
  check(h.vk.vkBindImageMemory(h.device, impl->image, impl->memory.memory, impl->memory.offset),
        "binding memory");

  VkImageViewCreateInfo view{};
  view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  view.image = impl->image;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  view.format = format.format;
  view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, desc.layers};
  check(h.vk.vkCreateImageView(h.device, &view, nullptr, &impl->view), "creating a texture");

  // Layers that are never written read as black.
  h.run_now([&](VkCommandBuffer commands) {
    transition(h, commands, impl->image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 0,
               desc.layers);
    const VkClearColorValue black{};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, desc.layers};
    h.vk.vkCmdClearColorImage(commands, impl->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black, 1, &all);
    transition(h, commands, impl->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, 0, desc.layers);
  });
  impl_ = std::move(impl);
}

const TextureArrayDesc& TextureArray::desc() const {
  static const TextureArrayDesc empty{};
  return impl_ ? impl_->desc : empty;
}

void TextureArray::write_layer(uint32_t layer, const void* texels) {
  if (!impl_) throw Error("texture", "cannot write to an empty texture");
  const TextureArrayDesc& desc = impl_->desc;
  if (layer >= desc.layers)
    throw_error("texture '" + desc.name + "'", "there is no layer {}: it has {}", layer, desc.layers);
  Handles& h = *impl_->handles;
  const uint64_t row_bytes = uint64_t(desc.width) * format_of(desc.format).bytes;
  const auto rows_at_once = static_cast<uint32_t>(std::max<uint64_t>(1, Handles::staging_bytes / row_bytes));
  for (uint32_t row = 0; row < desc.height; row += rows_at_once) {
    const uint32_t rows = std::min(rows_at_once, desc.height - row);
    h.with_staging([&](VkBuffer staging, void* mapped) {
      std::memcpy(mapped, static_cast<const std::byte*>(texels) + row * row_bytes, rows * row_bytes);
      h.run_now([&](VkCommandBuffer commands) {
        transition(h, commands, impl_->image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layer, 1);
        VkBufferImageCopy copy{};
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1};
        copy.imageOffset = {0, static_cast<int32_t>(row), 0};
        copy.imageExtent = {desc.width, rows, 1};
        h.vk.vkCmdCopyBufferToImage(commands, staging, impl_->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                                    &copy);
        transition(h, commands, impl_->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                   VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, layer, 1);
      });
    });
  }
}

}  // namespace lucerna::gpu
