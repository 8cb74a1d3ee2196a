#include "gpu/pipeline.hpp"

#include "core/error.hpp"

namespace brume::gpu {
namespace {

/// A shader module that lives as long as its pipeline is being made.
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

}  // namespace

Pipeline::Pipeline(Context& context, VkPipelineBindPoint bind_point, VkShaderStageFlags stages,
                   std::initializer_list<VkDescriptorType> bindings, std::uint32_t push_bytes)
    : context_(context),
      bind_point_(bind_point),
      stages_(stages),
      bindings_(bindings),
      push_bytes_(push_bytes) {
  BRUME_ASSERT(push_bytes <= 128, std::to_string(push_bytes));
  std::vector<VkDescriptorSetLayoutBinding> entries;
  for (std::uint32_t i = 0; i < bindings_.size(); ++i)
    entries.push_back({i, bindings_[i], 1, stages, nullptr});
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
}

Pipeline::~Pipeline() {
  const Functions& vk = context_.vk();
  vk.DestroyPipeline(context_.device(), handle_, nullptr);
  vk.DestroyPipelineLayout(context_.device(), layout_, nullptr);
  vk.DestroyDescriptorSetLayout(context_.device(), set_layout_, nullptr);
}

ComputePipeline::ComputePipeline(Context& context, const ShaderCode& shader,
                                 std::initializer_list<VkDescriptorType> bindings, std::uint32_t push_bytes,
                                 std::array<std::uint32_t, 3> group,
                                 const std::vector<std::uint32_t>& constants)
    : Pipeline(context, VK_PIPELINE_BIND_POINT_COMPUTE, VK_SHADER_STAGE_COMPUTE_BIT, bindings, push_bytes),
      group_(group) {
  std::vector<VkSpecializationMapEntry> entries;
  for (std::uint32_t i = 0; i < constants.size(); ++i) entries.push_back({i, i * 4, 4});
  const VkSpecializationInfo specialization{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                            constants.size() * 4, constants.data()};
  const Module module(context, shader);
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage = module.stage(VK_SHADER_STAGE_COMPUTE_BIT, &specialization);
  info.layout = layout();
  check(context.vk().CreateComputePipelines(context.device(), VK_NULL_HANDLE, 1, &info, nullptr, &handle_),
        shader.name);
}

GraphicsPipeline::GraphicsPipeline(Context& context, const GraphicsInfo& wanted,
                                   std::initializer_list<VkDescriptorType> bindings, std::uint32_t push_bytes)
    : Pipeline(context, VK_PIPELINE_BIND_POINT_GRAPHICS,
               VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, bindings, push_bytes) {
  const Module vertex(context, *wanted.vertex);
  std::vector<VkPipelineShaderStageCreateInfo> stages{vertex.stage(VK_SHADER_STAGE_VERTEX_BIT, nullptr)};
  std::unique_ptr<Module> fragment;
  if (wanted.fragment) {
    fragment = std::make_unique<Module>(context, *wanted.fragment);
    stages.push_back(fragment->stage(VK_SHADER_STAGE_FRAGMENT_BIT, nullptr));
  }

  const VkPipelineVertexInputStateCreateInfo input{
      VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO, nullptr, 0, 0, nullptr, 0, nullptr};
  const VkPipelineInputAssemblyStateCreateInfo assembly{
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO, nullptr, 0,
      VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_FALSE};
  VkPipelineViewportStateCreateInfo viewport{};
  viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{};
  raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
  raster.polygonMode = VK_POLYGON_MODE_FILL;
  raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  raster.lineWidth = 1;
  raster.depthBiasEnable =
      wanted.depth_bias_slope != 0 || wanted.depth_bias_constant != 0 ? VK_TRUE : VK_FALSE;
  raster.depthBiasSlopeFactor = -wanted.depth_bias_slope;
  raster.depthBiasConstantFactor = -wanted.depth_bias_constant;
  VkPipelineMultisampleStateCreateInfo samples{};
  samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineDepthStencilStateCreateInfo depth{};
  depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
  depth.depthTestEnable = depth.depthWriteEnable = wanted.depth != VK_FORMAT_UNDEFINED ? VK_TRUE : VK_FALSE;
  depth.depthCompareOp = VK_COMPARE_OP_GREATER_OR_EQUAL;
  VkPipelineColorBlendAttachmentState colour{};
  colour.colorWriteMask = 0xf;
  colour.blendEnable = wanted.blend ? VK_TRUE : VK_FALSE;
  colour.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
  colour.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  colour.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  colour.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  const std::vector<VkPipelineColorBlendAttachmentState> attachments(wanted.colours.size(), colour);
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
  rendering.colorAttachmentCount = static_cast<std::uint32_t>(wanted.colours.size());
  rendering.pColorAttachmentFormats = wanted.colours.data();
  rendering.depthAttachmentFormat = wanted.depth;

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
  check(context.vk().CreateGraphicsPipelines(context.device(), VK_NULL_HANDLE, 1, &info, nullptr, &handle_),
        wanted.vertex->name);
}

}  // namespace brume::gpu
