// Compute and graphics pipelines. A pipeline has one descriptor set; its layout comes from the shaders
// (reflection).
#pragma once

#include <span>
#include <vector>

#include "gpu/context.hpp"
#include "gpu/shader_code.hpp"
#include "gpu/shader_interface.hpp"

namespace brume::gpu {

/// Base of compute and graphics pipelines.
class Pipeline {
 public:
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// On a host's device it is there from the start, so that no frame waits for a compiler. On our own it is
  /// created when it is first bound: a picture takes few of all that the passes have. Throws when the driver
  /// rejects it.
  VkPipeline handle() const;
  VkPipelineLayout layout() const { return layout_; }
  VkDescriptorSetLayout set_layout() const { return set_layout_; }
  VkPipelineBindPoint bind_point() const { return bind_point_; }
  VkShaderStageFlags stages() const { return stages_; }
  /// The interface of all stages together.
  const ShaderInterface& interface() const { return interface_; }
  /// Its stages, in order.
  std::span<const ShaderCode> shaders() const { return shaders_; }

  /// Replaces the stage of the same name by a version whose interface fits (check_fit), once the device has
  /// finished previous recordings. `code.words` must outlive the pipeline. Fails when the driver rejects the
  /// shader; the pipeline is then unchanged.
  Result<void> replace_shader(const ShaderCode& code);

 protected:
  /// The shaders' interfaces must be supported and agree, see reflect.
  Pipeline(Context& context, VkPipelineBindPoint bind_point, VkShaderStageFlags stages,
           std::vector<ShaderCode> shaders);
  virtual ~Pipeline();
  /// Creates the pipeline of these stages.
  virtual VkResult make(std::span<const ShaderCode> shaders, VkPipeline* made) const = 0;
  /// Creates the first version on a host's device, at the end of a derived constructor.
  void make_first();
  Context& context_;

 private:
  mutable VkPipeline handle_ = VK_NULL_HANDLE;
  std::vector<ShaderCode> shaders_;
  VkPipelineBindPoint bind_point_;
  VkShaderStageFlags stages_;
  ShaderInterface interface_;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
};

class ComputePipeline : public Pipeline {
 public:
  /// `constants` are the values of the specialization constants 0, 1...
  ComputePipeline(Context& context, const ShaderCode& shader, std::vector<std::uint32_t> constants = {});
  /// Workgroup size.
  const std::array<std::uint32_t, 3>& group() const { return interface().group; }

 private:
  VkResult make(std::span<const ShaderCode> shaders, VkPipeline* made) const override;
  std::vector<std::uint32_t> constants_;
};

/// How a fragment joins the colour behind it.
enum class Blend {
  none,
  alpha,   ///< Alpha of the fragment: its opacity.
  medium,  ///< Premultiplied radiance and, in alpha, transmittance, in both.
  filter,  ///< Multiplies what is behind.
  add,     ///< Adds to its colour; the alpha stays.
};

struct GraphicsInfo {
  const ShaderCode* vertex = nullptr;
  const ShaderCode* fragment = nullptr;  ///< Null: depth only.
  std::vector<VkFormat> colours;
  VkFormat depth = VK_FORMAT_D32_SFLOAT;  ///< VK_FORMAT_UNDEFINED: no depth.
  float depth_bias_slope = 0;  ///< Pushes surfaces away from the eye (reverse depth) by their slope.
  float depth_bias_constant = 0;
  Blend blend = Blend::none;
  bool writes_depth = true;                   ///< Where there is a depth.
  std::vector<std::uint32_t> constants = {};  ///< Specialization constants 0, 1... of fragments.
};

/// Triangles with reverse depth (greater is nearer) and dynamic cull mode; shaders pull vertices from
/// buffers.
class GraphicsPipeline : public Pipeline {
 public:
  GraphicsPipeline(Context& context, const GraphicsInfo& info);

 private:
  VkResult make(std::span<const ShaderCode> shaders, VkPipeline* made) const override;
  GraphicsInfo info_;
};

}  // namespace brume::gpu
