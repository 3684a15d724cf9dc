#include "gpu/kernel.h"

#include "base/hash.h"
#include "gpu/spirv.h"
#include "gpu/vulkan.h"

namespace lucerna::gpu {

namespace {

VkDescriptorType descriptor_type(Kernel::Impl::Kind kind) {
  switch (kind) {
    case Kernel::Impl::Kind::storage_buffer:
      return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    case Kernel::Impl::Kind::texel_buffer:
    case Kernel::Impl::Kind::texel_buffer_words:
      return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    case Kernel::Impl::Kind::texel_image:
      return VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
    case Kernel::Impl::Kind::sampled_image:
      return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  }
  return VK_DESCRIPTOR_TYPE_MAX_ENUM;
}

Kernel::Impl::Kind slot_kind(const std::string& file, const spirv::Resource& resource) {
  switch (resource.kind) {
    case spirv::ResourceKind::storage_buffer:
      return Kernel::Impl::Kind::storage_buffer;
    case spirv::ResourceKind::texel_buffer:
      return Kernel::Impl::Kind::texel_buffer;
    case spirv::ResourceKind::texel_buffer_words:
      return Kernel::Impl::Kind::texel_buffer_words;
    case spirv::ResourceKind::texel_image:
      return Kernel::Impl::Kind::texel_image;
    case spirv::ResourceKind::sampled_image:
      return Kernel::Impl::Kind::sampled_image;
    default:
      throw_error(file,
                  "'{}' is neither a storage buffer, a samplerBuffer, a usamplerBuffer, an imageBuffer nor a "
                  "sampler2DArray; "
                  "nothing else can be "
                  "bound to a kernel",
                  resource.name);
  }
}

void make_layouts(const Handles& h, const Kernel::Impl& kernel, const std::vector<spirv::Resource>& resources,
                  Pipeline& out) {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (size_t i = 0; i < resources.size(); ++i) {
    VkDescriptorSetLayoutBinding binding{};
    binding.binding = resources[i].binding;
    binding.descriptorType = descriptor_type(kernel.slots[i].kind);
    binding.descriptorCount = 1;
    binding.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    bindings.push_back(binding);
  }
  VkDescriptorSetLayoutCreateInfo set{};
  set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  set.bindingCount = static_cast<uint32_t>(bindings.size());
  set.pBindings = bindings.data();
  check(h.vk.vkCreateDescriptorSetLayout(h.device, &set, nullptr, &out.set_layout), "creating a kernel");
  const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, (kernel.push_bytes + 3) / 4 * 4};
  VkPipelineLayoutCreateInfo layout{};
  layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &out.set_layout;
  layout.pushConstantRangeCount = kernel.push_bytes ? 1 : 0;
  layout.pPushConstantRanges = &push;
  check(h.vk.vkCreatePipelineLayout(h.device, &layout, nullptr, &out.layout), "creating a kernel");
}

/// Depends on `words` and `constants` alone: slots and push constants are what the words declare.
std::shared_ptr<const Pipeline> make_pipeline(const Handles& h, const Kernel::Impl& kernel,
                                              const std::vector<uint32_t>& words,
                                              const std::vector<spirv::Resource>& resources,
                                              const std::vector<SpecConstant>& constants) {
  auto made = std::make_shared<Pipeline>(h);
  make_layouts(h, kernel, resources, *made);
  VkShaderModuleCreateInfo code{};
  code.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  code.codeSize = words.size() * sizeof(uint32_t);
  code.pCode = words.data();
  VkShaderModule shader = VK_NULL_HANDLE;
  check(h.vk.vkCreateShaderModule(h.device, &code, nullptr, &shader), "creating a kernel");
  std::vector<VkSpecializationMapEntry> entries;
  for (size_t i = 0; i < constants.size(); ++i)
    entries.push_back({constants[i].id,
                       static_cast<uint32_t>(i * sizeof(SpecConstant) + offsetof(SpecConstant, value)),
                       sizeof(uint32_t)});
  const VkSpecializationInfo special{static_cast<uint32_t>(entries.size()), entries.data(),
                                     constants.size() * sizeof(SpecConstant), constants.data()};
  VkComputePipelineCreateInfo pipeline{};
  pipeline.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  pipeline.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  pipeline.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  pipeline.stage.module = shader;
  pipeline.stage.pName = "main";
  pipeline.stage.pSpecializationInfo = constants.empty() ? nullptr : &special;
  pipeline.layout = made->layout;
  const VkResult result =
      h.vk.vkCreateComputePipelines(h.device, VK_NULL_HANDLE, 1, &pipeline, nullptr, &made->pipeline);
  h.vk.vkDestroyShaderModule(h.device, shader, nullptr);
  check(result, ("building the kernel " + kernel.file).c_str());
  return made;
}

}  // namespace

void Resources::set(const std::string& name, const Buffer& buffer) { entries_[name] = &buffer, ++version_; }
void Resources::set(const std::string& name, const TextureArray& array) {
  entries_[name] = &array, ++version_;
}

void Resources::remove(const std::string& name) { version_ += entries_.erase(name); }

const Resources::Entry* Resources::find(const std::string& name) const {
  const auto found = entries_.find(name);
  return found == entries_.end() ? nullptr : &found->second;
}

Kernel::Kernel() = default;
Kernel::~Kernel() = default;
Kernel::Kernel(Kernel&&) noexcept = default;
Kernel& Kernel::operator=(Kernel&&) noexcept = default;

Kernel::Kernel(Device& device, ShaderCompiler& compiler, const std::string& file, const Defines& defines,
               std::vector<SpecConstant> constants) {
  Handles& h = device.handles();
  Defines all = defines;
  all["LUCERNA_SUBGROUPS"] = h.info.optional.subgroups ? "1" : "0";
  const std::vector<uint32_t> words = compiler.compile(file, all);
  const spirv::Module module = spirv::reflect(words);
  auto impl = std::make_unique<Impl>();
  impl->handles = &h;
  impl->id = h.next_id();
  impl->file = file;
  for (int axis = 0; axis < 3; ++axis) {
    impl->workgroup[axis] = module.workgroup[axis];
    for (const SpecConstant& c : constants)
      if (module.workgroup_constant[axis] == static_cast<int32_t>(c.id)) impl->workgroup[axis] = c.value;
  }
  impl->push_bytes = module.push_constant_bytes;
  if (impl->push_bytes > h.max_push_constants)
    throw_error(file, "its push constants are {} bytes; {} takes {}", impl->push_bytes, h.info.name,
                h.max_push_constants);

  for (const spirv::Resource& resource : module.resources)
    impl->slots.push_back({resource.name, slot_kind(file, resource)});
  Hash key;
  key.add_values(words), key.add_values(constants);
  impl->pipeline = h.pipelines.find_or_make(
      key.hex(), [&] { return make_pipeline(h, *impl, words, module.resources, constants); });
  impl_ = std::move(impl);
}

const std::string& Kernel::file() const { return impl_->file; }
uint32_t Kernel::workgroup_size() const { return impl_->workgroup[0]; }
uint32_t Kernel::push_constant_bytes() const { return impl_->push_bytes; }

std::vector<std::string> Kernel::resource_names() const {
  std::vector<std::string> names;
  for (const auto& slot : impl_->slots) names.push_back(slot.name);
  return names;
}

}  // namespace lucerna::gpu
