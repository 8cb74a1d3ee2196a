#include "gpu/shader_interface.hpp"

#include <algorithm>
#include <spirv_cross/spirv_cross.hpp>
#include <utility>

namespace brume::gpu {
namespace {

Failure fault(const std::string& what) {
  return {ErrorCode::bad_input, what};
}

std::string place(std::uint32_t number, VkDescriptorType type) {
  return "binding " + std::to_string(number) + ", a " + name_of(type);
}

/// Adds the resources of one kind to the interface.
Result<void> add(const spirv_cross::Compiler& compiler,
                 const spirv_cross::SmallVector<spirv_cross::Resource>& resources, VkDescriptorType type,
                 ShaderInterface& interface) {
  for (const spirv_cross::Resource& resource : resources) {
    const std::uint32_t number = compiler.get_decoration(resource.id, spv::DecorationBinding);
    if (compiler.get_decoration(resource.id, spv::DecorationDescriptorSet) != 0)
      return fault(place(number, type) + ", is not in descriptor set 0");
    if (!compiler.get_type(resource.type_id).array.empty())
      return fault(place(number, type) + ", is an array");
    if (interface.find(number)) return fault(place(number, type) + ", is declared twice");
    const auto behind = std::find_if(interface.bindings.begin(), interface.bindings.end(),
                                     [&](const ShaderInterface::Binding& b) { return b.number > number; });
    interface.bindings.insert(behind, {number, type});
  }
  return {};
}

}  // namespace

const ShaderInterface::Binding* ShaderInterface::find(std::uint32_t number) const {
  const auto found = std::find_if(bindings.begin(), bindings.end(),
                                  [&](const Binding& binding) { return binding.number == number; });
  return found == bindings.end() ? nullptr : &*found;
}

Result<ShaderInterface> reflect(const ShaderCode& shader) {
  const spirv_cross::Compiler compiler(shader.words.data(), shader.words.size());
  const spirv_cross::ShaderResources resources = compiler.get_shader_resources();
  const std::string name = std::string(shader.name) + ": ";
  if (!resources.separate_images.empty() || !resources.separate_samplers.empty() ||
      !resources.subpass_inputs.empty() || !resources.acceleration_structures.empty())
    return fault(name + "expected buffers, sampled images and storage images only");

  ShaderInterface interface;
  for (const auto& [list, type] :
       {std::pair(&resources.storage_buffers, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER),
        std::pair(&resources.uniform_buffers, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER),
        std::pair(&resources.sampled_images, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER),
        std::pair(&resources.storage_images, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE)})
    if (const auto added = add(compiler, *list, type, interface); !added)
      return fault(name + added.failure().message);
  for (const spirv_cross::Resource& block : resources.push_constant_buffers)
    interface.push_bytes =
        static_cast<std::uint32_t>(compiler.get_declared_struct_size(compiler.get_type(block.base_type_id)));
  if (compiler.get_execution_model() == spv::ExecutionModelGLCompute)
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      interface.group[axis] = compiler.get_execution_mode_argument(spv::ExecutionModeLocalSize, axis);
  return interface;
}

Result<ShaderInterface> reflect(std::span<const ShaderCode> stages) {
  ShaderInterface all;
  for (const ShaderCode& stage : stages) {
    const auto own = reflect(stage);
    if (!own) return own.failure();
    all.push_bytes = std::max(all.push_bytes, own->push_bytes);
    all.group = own->group;
    for (const ShaderInterface::Binding& binding : own->bindings) {
      const ShaderInterface::Binding* other = all.find(binding.number);
      if (!other)
        all.bindings.push_back(binding);
      else if (other->type != binding.type)
        return fault(std::string(stage.name) + ": " + place(binding.number, binding.type) + ", is a " +
                     name_of(other->type) + " in another stage");
    }
  }
  std::sort(all.bindings.begin(), all.bindings.end(),
            [](const auto& a, const auto& b) { return a.number < b.number; });
  return all;
}

Result<void> check_fit(const ShaderInterface& shader, const ShaderInterface& offered) {
  for (const ShaderInterface::Binding& binding : shader.bindings) {
    const ShaderInterface::Binding* other = offered.find(binding.number);
    if (!other || other->type != binding.type)
      return fault("the program binds no " + name_of(binding.type) + " at binding " +
                   std::to_string(binding.number));
  }
  if (shader.push_bytes > offered.push_bytes)
    return fault("the program pushes only " + std::to_string(offered.push_bytes) + " bytes");
  if (shader.group != offered.group) return fault("the program expects another workgroup size");
  return {};
}

std::string name_of(VkDescriptorType type) {
  switch (type) {
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
      return "storage buffer";
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
      return "uniform buffer";
    case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER:
      return "sampled image";
    case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
      return "storage image";
    default:
      return "resource of type " + std::to_string(type);
  }
}

}  // namespace brume::gpu
