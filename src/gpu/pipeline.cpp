#include "gpu/pipeline.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

#include "core/error.hpp"

namespace brume::gpu {
namespace {

/// A shader module that lives while its pipeline is created.
class Module {
 public:
  Module(Context& context, const ShaderCode& code) : context_(context) {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = code.words.size_bytes();
    info.pCode = code.words.data();
    check(context.vk().CreateShaderModule(context.device(), &info, nullptr, &handle_), code.name);
  }
  ~Module() { context_.vk().DestroyShaderModule(context_.device(), handle_, nullptr); }
  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;

  VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits stage,
                                        const VkSpecializationInfo* constants) const {
    return {
        VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, stage, handle_, "main", constants};
  }

 private:
  Context& context_;
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

}  // namespace

Pipeline::Pipeline(Context& context, VkPipelineBindPoint bind_point, VkShaderStageFlags stages,
                   std::vector<ShaderCode> shaders)
    : context_(context),
      shaders_(std::move(shaders)),
      bind_point_(bind_point),
      stages_(stages),
      interface_(interface_of(shaders_)) {
  // What could fail later, when something is made already.
  context.expect_retirement();
  context.pipelines().reserve(context.pipelines().size() + 1);
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
  const Functions& vk = context.vk();
  check(vk.CreateDescriptorSetLayout(context.device(), &set, nullptr, &set_layout_),
        "vkCreateDescriptorSetLayout");

  const VkPushConstantRange push{stages, 0, push_bytes};
  VkPipelineLayoutCreateInfo layout{};
  layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &set_layout_;
  layout.pushConstantRangeCount = push_bytes > 0 ? 1 : 0;
  layout.pPushConstantRanges = &push;
  const VkResult result = vk.CreatePipelineLayout(context.device(), &layout, nullptr, &layout_);
  if (result != VK_SUCCESS) vk.DestroyDescriptorSetLayout(context.device(), set_layout_, nullptr);
  check(result, "vkCreatePipelineLayout");
  context.pipelines().push_back(this);
}

Pipeline::~Pipeline() {
  std::erase(context_.pipelines(), this);
  context_.retire({.pipeline = handle_, .layout = layout_, .set_layout = set_layout_});
}

void Pipeline::make_first() {
  if (!context_.owns_device()) (void)handle();
}

VkPipeline Pipeline::handle() const {
  if (handle_ == VK_NULL_HANDLE) check(make(shaders_, &handle_), shaders_.front().name);
  return handle_;
}

Result<void> Pipeline::replace_shader(const ShaderCode& code) {
  std::vector<ShaderCode> shaders = shaders_;
  for (ShaderCode& shader : shaders)
    if (std::string_view(shader.name) == code.name) shader = code;
  VkPipeline made = VK_NULL_HANDLE;
  context_.expect_retirement();
  const VkResult result = make(shaders, &made);
  if (result != VK_SUCCESS)
    return Failure{ErrorCode::bad_input,
                   std::string(code.name) + ": the driver rejects it with " + result_name(result)};
  context_.retire({.pipeline = handle_});
  handle_ = made;
  shaders_ = std::move(shaders);
  return {};
}

ComputePipeline::ComputePipeline(Context& context, const ShaderCode& shader,
                                 std::vector<std::uint32_t> constants)
    : Pipeline(context, VK_PIPELINE_BIND_POINT_COMPUTE, VK_SHADER_STAGE_COMPUTE_BIT, {shader}),
      constants_(std::move(constants)) {
  make_first();
}

VkResult ComputePipeline::make(std::span<const ShaderCode> shaders, VkPipeline* made) const {
  const Specialization specialization(constants_);
  const Module module(context_, shaders[0]);
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage = module.stage(VK_SHADER_STAGE_COMPUTE_BIT, &specialization.info);
  info.layout = layout();
  return context_.vk().CreateComputePipelines(context_.device(), VK_NULL_HANDLE, 1, &info, nullptr, made);
}

GraphicsPipeline::GraphicsPipeline(Context& context, const GraphicsInfo& wanted)
    : Pipeline(context, VK_PIPELINE_BIND_POINT_GRAPHICS,
               VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, stages_of(wanted)),
      info_(wanted) {
  make_first();
}

VkResult GraphicsPipeline::make(std::span<const ShaderCode> shaders, VkPipeline* made) const {
  // Shader stages.
  const Module vertex(context_, shaders[0]);
  std::vector<VkPipelineShaderStageCreateInfo> stages{vertex.stage(VK_SHADER_STAGE_VERTEX_BIT, nullptr)};
  std::optional<Module> fragment;
  const Specialization specialization(info_.constants);
  if (shaders.size() > 1) {
    fragment.emplace(context_, shaders[1]);
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
  const VkDynamicState dynamic[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                    VK_DYNAMIC_STATE_CULL_MODE};
  const VkPipelineDynamicStateCreateInfo dynamics{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                  nullptr, 0, 3, dynamic};
  VkPipelineRenderingCreateInfo rendering{};
  rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
  rendering.colorAttachmentCount = static_cast<std::uint32_t>(info_.colours.size());
  rendering.pColorAttachmentFormats = info_.colours.data();
  rendering.depthAttachmentFormat = info_.depth;

  VkGraphicsPipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
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
  return context_.vk().CreateGraphicsPipelines(context_.device(), VK_NULL_HANDLE, 1, &info, nullptr, made);
}

}  // namespace brume::gpu
