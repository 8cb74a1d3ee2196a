#include "gpu/pipeline_store.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <string_view>

#include "core/error.hpp"

namespace brume::gpu {
namespace {

/// A shader module that lives while its pipeline is created.
class Module {
 public:
  Module(const Functions& vk, VkDevice device, const ShaderCode& code) : vk_(vk), device_(device) {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = code.words.size_bytes();
    info.pCode = code.words.data();
    check(vk.CreateShaderModule(device, &info, vk.allocator, &handle_), code.name);
  }
  ~Module() { vk_.DestroyShaderModule(device_, handle_, vk_.allocator); }
  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;

  VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits stage,
                                        const VkSpecializationInfo* constants) const {
    return {
        VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, stage, handle_, "main", constants};
  }

 private:
  const Functions& vk_;
  VkDevice device_;
  VkShaderModule handle_ = VK_NULL_HANDLE;
};

/// Values of the specialization constants 0, 1..., which must outlive it.
struct Specialization {
  explicit Specialization(std::span<const std::uint32_t> constants) {
    for (std::uint32_t i = 0; i < constants.size(); ++i) entries.push_back({i, i * 4, 4});
    info = {static_cast<std::uint32_t>(entries.size()), entries.data(), constants.size_bytes(),
            constants.data()};
  }
  Specialization(const Specialization&) = delete;
  Specialization& operator=(const Specialization&) = delete;

  std::vector<VkSpecializationMapEntry> entries;
  VkSpecializationInfo info{};
};

VkPipelineRasterizationStateCreateInfo raster_state(const GraphicsInfo& wanted) {
  VkPipelineRasterizationStateCreateInfo raster{};
  raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
  raster.polygonMode = VK_POLYGON_MODE_FILL;
  raster.cullMode = wanted.culls_back_faces ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
  raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  raster.lineWidth = 1;
  raster.depthBiasEnable =
      wanted.depth_bias_slope != 0 || wanted.depth_bias_constant != 0 ? VK_TRUE : VK_FALSE;
  raster.depthBiasSlopeFactor = -wanted.depth_bias_slope;
  raster.depthBiasConstantFactor = -wanted.depth_bias_constant;
  return raster;
}

VkPipelineDepthStencilStateCreateInfo depth_state(const GraphicsInfo& wanted) {
  VkPipelineDepthStencilStateCreateInfo depth{};
  depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
  depth.depthTestEnable = wanted.depth != VK_FORMAT_UNDEFINED ? VK_TRUE : VK_FALSE;
  depth.depthWriteEnable = wanted.writes_depth ? depth.depthTestEnable : VK_FALSE;
  depth.depthCompareOp = VK_COMPARE_OP_GREATER_OR_EQUAL;
  return depth;
}

VkPipelineColorBlendAttachmentState colour_state(Blend blend) {
  VkPipelineColorBlendAttachmentState colour{};
  colour.colorWriteMask = 0xf;
  colour.blendEnable = blend != Blend::none ? VK_TRUE : VK_FALSE;
  const auto set = [&](VkBlendFactor source, VkBlendFactor behind, VkBlendFactor source_alpha,
                       VkBlendFactor behind_alpha) {
    colour.srcColorBlendFactor = source;
    colour.dstColorBlendFactor = behind;
    colour.srcAlphaBlendFactor = source_alpha;
    colour.dstAlphaBlendFactor = behind_alpha;
  };
  // Factors of the fragment, and of what is behind.
  switch (blend) {
    case Blend::none:
      break;
    case Blend::alpha:
      set(VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA, VK_BLEND_FACTOR_ONE,
          VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA);
      break;
    case Blend::medium:
      set(VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ZERO, VK_BLEND_FACTOR_SRC_ALPHA);
      break;
    case Blend::filter:
      set(VK_BLEND_FACTOR_ZERO, VK_BLEND_FACTOR_SRC_COLOR, VK_BLEND_FACTOR_ZERO, VK_BLEND_FACTOR_SRC_ALPHA);
      break;
    case Blend::add:
      set(VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ZERO, VK_BLEND_FACTOR_ONE);
      break;
  }
  return colour;
}

/// One that is compatible to those that it draws in.
RenderPassInfo render_pass_of(const GraphicsInfo& info) {
  RenderPassInfo pass;
  std::ranges::copy(info.colours, pass.colours.begin());
  pass.depth = info.depth;
  return pass;
}

std::vector<ShaderCode> stages_of(const GraphicsInfo& info) {
  std::vector<ShaderCode> stages{*info.vertex};
  if (info.fragment) stages.push_back(*info.fragment);
  return stages;
}

ShaderInterface interface_of(std::span<const ShaderCode> shaders) {
  auto interface = reflect(shaders);
  BRUME_ASSERT(static_cast<bool>(interface), interface.failure().message);
  return *std::move(interface);
}

class ComputeMade : public Pipeline {
 public:
  ComputeMade(const Maker& maker, const ComputeInfo& info)
      : Pipeline(maker, VK_PIPELINE_BIND_POINT_COMPUTE, VK_SHADER_STAGE_COMPUTE_BIT, {*info.shader}),
        constants_(info.constants) {}

 private:
  VkResult make(std::span<const ShaderCode> shaders, VkPipeline* made) const override {
    const Specialization specialization(constants_);
    const Module module(maker().vk, maker().device, shaders[0]);
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage = module.stage(VK_SHADER_STAGE_COMPUTE_BIT, &specialization.info);
    info.layout = layout();
    return maker().vk.CreateComputePipelines(maker().device, maker().cache, 1, &info, maker().vk.allocator,
                                             made);
  }
  const std::vector<std::uint32_t> constants_;
};

class GraphicsMade : public Pipeline {
 public:
  GraphicsMade(const Maker& maker, const GraphicsInfo& info)
      : Pipeline(maker, VK_PIPELINE_BIND_POINT_GRAPHICS,
                 VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, stages_of(info)),
        info_(info) {}

 private:
  VkResult make(std::span<const ShaderCode> shaders, VkPipeline* made) const override;
  const GraphicsInfo info_;
};

constexpr VkDynamicState kDynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};

VkResult GraphicsMade::make(std::span<const ShaderCode> shaders, VkPipeline* made) const {
  // Shader stages.
  const Module vertex(maker().vk, maker().device, shaders[0]);
  std::vector<VkPipelineShaderStageCreateInfo> stages{vertex.stage(VK_SHADER_STAGE_VERTEX_BIT, nullptr)};
  std::optional<Module> fragment;
  const Specialization specialization(info_.constants);
  if (shaders.size() > 1) {
    fragment.emplace(maker().vk, maker().device, shaders[1]);
    stages.push_back(fragment->stage(VK_SHADER_STAGE_FRAGMENT_BIT, &specialization.info));
  }

  // Fixed-function state.
  const VkPipelineVertexInputStateCreateInfo input{
      VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO, nullptr, 0, 0, nullptr, 0, nullptr};
  const VkPipelineInputAssemblyStateCreateInfo assembly{
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO, nullptr, 0,
      VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_FALSE};
  VkPipelineViewportStateCreateInfo viewport{};
  viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
  viewport.viewportCount = viewport.scissorCount = 1;
  const VkPipelineRasterizationStateCreateInfo raster = raster_state(info_);
  VkPipelineMultisampleStateCreateInfo samples{};
  samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  const VkPipelineDepthStencilStateCreateInfo depth = depth_state(info_);
  const std::vector<VkPipelineColorBlendAttachmentState> attachments(info_.colours.size(),
                                                                     colour_state(info_.blend));
  VkPipelineColorBlendStateCreateInfo blend{};
  blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
  blend.attachmentCount = static_cast<std::uint32_t>(attachments.size());
  blend.pAttachments = attachments.data();
  const VkPipelineDynamicStateCreateInfo dynamics{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                  nullptr, 0, 2, kDynamicStates};
  VkPipelineRenderingCreateInfo rendering{};
  rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
  rendering.colorAttachmentCount = static_cast<std::uint32_t>(info_.colours.size());
  rendering.pColorAttachmentFormats = info_.colours.data();
  rendering.depthAttachmentFormat = info_.depth;

  VkGraphicsPipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  if (maker().render_passes)
    info.renderPass = maker().render_passes->find_or_make(render_pass_of(info_));
  else
    info.pNext = &rendering;
  info.stageCount = static_cast<std::uint32_t>(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamics;
  info.layout = layout();
  return maker().vk.CreateGraphicsPipelines(maker().device, maker().cache, 1, &info, maker().vk.allocator,
                                            made);
}

/// Appends a shader or a list, with its length.
void append(std::vector<std::uint64_t>& key, const ShaderCode* shader) {
  key.push_back(shader ? reinterpret_cast<std::uintptr_t>(shader->words.data()) : 0);
}
template <typename T>
void append(std::vector<std::uint64_t>& key, const std::vector<T>& list) {
  key.push_back(list.size());
  for (const T value : list) key.push_back(static_cast<std::uint64_t>(value));
}

}  // namespace

Pipeline::Pipeline(const Maker& maker, VkPipelineBindPoint bind_point, VkShaderStageFlags stages,
                   std::vector<ShaderCode> shaders)
    : maker_(maker),
      shaders_(std::move(shaders)),
      bind_point_(bind_point),
      stages_(stages),
      interface_(interface_of(shaders_)) {
  const std::uint32_t push_bytes = interface_.push_bytes;
  BRUME_ASSERT(push_bytes <= 128, std::to_string(push_bytes));

  // Layouts of the descriptor set and the push constants, as the shaders declare them.
  std::vector<VkDescriptorSetLayoutBinding> entries;
  for (const ShaderInterface::Binding& binding : interface_.bindings)
    entries.push_back({binding.number, binding.type, 1, stages, nullptr});
  VkDescriptorSetLayoutCreateInfo set{};
  set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  set.bindingCount = static_cast<std::uint32_t>(entries.size());
  set.pBindings = entries.data();
  check(maker.vk.CreateDescriptorSetLayout(maker.device, &set, maker.vk.allocator, &set_layout_),
        "vkCreateDescriptorSetLayout");

  const VkPushConstantRange push{stages, 0, push_bytes};
  VkPipelineLayoutCreateInfo layout{};
  layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &set_layout_;
  layout.pushConstantRangeCount = push_bytes > 0 ? 1 : 0;
  layout.pPushConstantRanges = &push;
  const VkResult result = maker.vk.CreatePipelineLayout(maker.device, &layout, maker.vk.allocator, &layout_);
  if (result != VK_SUCCESS)
    maker.vk.DestroyDescriptorSetLayout(maker.device, set_layout_, maker.vk.allocator);
  check(result, "vkCreatePipelineLayout");
}

Pipeline::~Pipeline() {
  maker_.vk.DestroyPipeline(maker_.device, handle_, maker_.vk.allocator);
  maker_.vk.DestroyPipelineLayout(maker_.device, layout_, maker_.vk.allocator);
  maker_.vk.DestroyDescriptorSetLayout(maker_.device, set_layout_, maker_.vk.allocator);
}

VkPipeline Pipeline::handle() const {
  const std::scoped_lock lock(mutex_);
  if (handle_ == VK_NULL_HANDLE) {
    check(make(shaders_, &handle_), shaders_.front().name);
    set_name(handle_);
  }
  return handle_;
}

/// For debuggers: the name of its last shader.
void Pipeline::set_name(VkPipeline made) const {
  if (!maker_.vk.SetDebugUtilsObjectNameEXT) return;
  const VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT, nullptr,
                                           VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(made),
                                           shaders_.back().name};
  (void)maker_.vk.SetDebugUtilsObjectNameEXT(maker_.device, &info);  // Without a name it works, too.
}

Result<void> Pipeline::replace_shader(const ShaderCode& code) {
  std::vector<ShaderCode> shaders = shaders_;
  for (ShaderCode& shader : shaders)
    if (std::string_view(shader.name) == code.name) shader = code;
  VkPipeline made = VK_NULL_HANDLE;
  const VkResult result = make(shaders, &made);
  if (result != VK_SUCCESS)
    return Failure{ErrorCode::bad_input,
                   std::string(code.name) + ": the driver rejects it with " + result_name(result)};
  const std::scoped_lock lock(mutex_);
  maker_.vk.DestroyPipeline(maker_.device, std::exchange(handle_, made), maker_.vk.allocator);
  shaders_ = std::move(shaders);
  return {};
}

PipelineStore::PipelineStore(const Functions& vk, VkDevice device, VkPipelineCache cache)
    : render_passes_(vk.CmdBeginRendering ? nullptr : std::make_unique<RenderPasses>(vk, device)),
      maker_{vk, device, cache, render_passes_.get()} {}

template <typename Made, typename Info>
Pipeline& PipelineStore::find_or_make(const Key& key, const Info& info) {
  const std::scoped_lock lock(mutex_);
  std::unique_ptr<Pipeline>& pipeline = pipelines_[key];
  if (!pipeline) pipeline = std::make_unique<Made>(maker_, info);
  return *pipeline;
}

Pipeline& PipelineStore::find_or_make(const ComputeInfo& info) {
  Key key{VK_PIPELINE_BIND_POINT_COMPUTE};
  append(key, info.shader);
  append(key, info.constants);
  return find_or_make<ComputeMade>(key, info);
}

Pipeline& PipelineStore::find_or_make(const GraphicsInfo& info) {
  Key key{VK_PIPELINE_BIND_POINT_GRAPHICS,
          static_cast<std::uint64_t>(info.depth),
          std::bit_cast<std::uint32_t>(info.depth_bias_slope),
          std::bit_cast<std::uint32_t>(info.depth_bias_constant),
          static_cast<std::uint64_t>(info.blend),
          info.writes_depth,
          info.culls_back_faces};
  append(key, info.vertex);
  append(key, info.fragment);
  append(key, info.colours);
  append(key, info.constants);
  return find_or_make<GraphicsMade>(key, info);
}

std::vector<Pipeline*> PipelineStore::all() const {
  const std::scoped_lock lock(mutex_);
  std::vector<Pipeline*> pipelines;
  for (const auto& [key, pipeline] : pipelines_)
    if (pipeline) pipelines.push_back(pipeline.get());
  return pipelines;
}

}  // namespace brume::gpu
