#include "gpu/pipeline.hpp"

namespace brume::gpu {
namespace {

template <typename Info>
const Pipeline* pipeline_of(Context& context, const Info& info) {
  const Pipeline& pipeline = context.pipelines().find_or_make(info);
  if (!context.owns_device()) (void)pipeline.handle();
  return &pipeline;
}

}  // namespace

ComputePipeline::ComputePipeline(Context& context, const ShaderCode& shader,
                                 std::vector<std::uint32_t> constants)
    : pipeline_(pipeline_of(context, ComputeInfo{&shader, std::move(constants)})) {}

GraphicsPipeline::GraphicsPipeline(Context& context, const GraphicsInfo& info)
    : pipeline_(pipeline_of(context, info)) {}

}  // namespace brume::gpu
