// Compute and graphics pipelines of passes, which belong to the device (PipelineStore).
#pragma once

#include <array>
#include <vector>

#include "gpu/context.hpp"
#include "gpu/pipeline_store.hpp"

namespace brume::gpu {

/// On a host's device the pipeline is compiled in the constructor, so that no frame waits for a compiler. On
/// our own it is compiled when it is first bound: a picture takes few of all that the passes have. Throws
/// when the driver rejects it.
class ComputePipeline {
 public:
  /// `constants` are the values of the specialization constants 0, 1...
  ComputePipeline(Context& context, const ShaderCode& shader, std::vector<std::uint32_t> constants = {});
  operator const Pipeline&() const { return *pipeline_; }  // NOLINT: implicit by design
  /// Workgroup size.
  const std::array<std::uint32_t, 3>& group() const { return pipeline_->interface().group; }

 private:
  const Pipeline* pipeline_;
};

/// The same for triangles.
class GraphicsPipeline {
 public:
  GraphicsPipeline(Context& context, const GraphicsInfo& info);
  operator const Pipeline&() const { return *pipeline_; }  // NOLINT: implicit by design

 private:
  const Pipeline* pipeline_;
};

}  // namespace brume::gpu
