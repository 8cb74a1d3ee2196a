// The pipelines of a device. What is made of the same shaders and settings is one pipeline, however many
// passes and renderers use it, and lives as long as the device.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "gpu/functions.hpp"
#include "gpu/render_passes.hpp"
#include "gpu/shader_code.hpp"
#include "gpu/shader_interface.hpp"

namespace brume::gpu {

// What pipelines are made of. Shaders must outlive the device: they are constants of the program.

struct ComputeInfo {
  const ShaderCode* shader = nullptr;
  std::vector<std::uint32_t> constants = {};  ///< Specialization constants 0, 1...
};

/// How a fragment joins the colour behind it.
enum class Blend {
  none,
  alpha,   ///< Alpha of the fragment: its opacity.
  medium,  ///< Premultiplied radiance and, in alpha, transmittance, in both.
  filter,  ///< Multiplies what is behind.
  add,     ///< Adds to its colour; the alpha stays.
};

/// Triangles with reverse depth (greater is nearer); shaders pull vertices from buffers.
struct GraphicsInfo {
  const ShaderCode* vertex = nullptr;
  const ShaderCode* fragment = nullptr;  ///< Null: depth only.
  std::vector<VkFormat> colours;
  VkFormat depth = VK_FORMAT_D32_SFLOAT;  ///< VK_FORMAT_UNDEFINED: no depth.
  float depth_bias_slope = 0;  ///< Pushes surfaces away from the eye (reverse depth) by their slope.
  float depth_bias_constant = 0;
  Blend blend = Blend::none;
  bool writes_depth = true;  ///< Where there is a depth.
  bool culls_back_faces = false;
  std::vector<std::uint32_t> constants = {};  ///< Specialization constants 0, 1... of fragments.
};

/// A pipeline with one descriptor set, whose layout comes from the shaders (reflection).
class Pipeline {
 public:
  virtual ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// Compiles it in the first call; any thread may call it. Throws when the driver rejects it.
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
  /// finished previous recordings. The code must outlive the device. Fails when the driver rejects the
  /// shader; the pipeline is then unchanged.
  Result<void> replace_shader(const ShaderCode& code);

 protected:
  /// The device that pipelines are made on.
  struct Maker {
    const Functions& vk;
    VkDevice device;
    VkPipelineCache cache;
    RenderPasses* render_passes;  ///< Null where the device has dynamic rendering.
  };
  /// The shaders' interfaces must be supported and agree, see reflect.
  Pipeline(const Maker& maker, VkPipelineBindPoint bind_point, VkShaderStageFlags stages,
           std::vector<ShaderCode> shaders);
  /// Compiles these stages.
  virtual VkResult make(std::span<const ShaderCode> shaders, VkPipeline* made) const = 0;
  const Maker& maker() const { return maker_; }

 private:
  friend class PipelineStore;
  void set_name(VkPipeline made) const;

  Maker maker_;
  mutable std::mutex mutex_;  // held while it is compiled
  mutable VkPipeline handle_ = VK_NULL_HANDLE;
  std::vector<ShaderCode> shaders_;
  VkPipelineBindPoint bind_point_;
  VkShaderStageFlags stages_;
  ShaderInterface interface_;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
};

/// Any thread may call any function.
class PipelineStore {
 public:
  /// `vk` and the handles must outlive the store. `cache`: of the driver's compilations; may be null.
  PipelineStore(const Functions& vk, VkDevice device, VkPipelineCache cache);
  /// The device has completed all that uses the pipelines.
  ~PipelineStore() = default;
  PipelineStore(const PipelineStore&) = delete;
  PipelineStore& operator=(const PipelineStore&) = delete;

  /// The pipeline of these settings, which is compiled by Pipeline::handle.
  Pipeline& find_or_make(const ComputeInfo& info);
  Pipeline& find_or_make(const GraphicsInfo& info);
  std::vector<Pipeline*> all() const;
  /// The render passes of a device without dynamic rendering.
  RenderPasses& render_passes() { return *render_passes_; }

 private:
  /// All that a pipeline is made of.
  using Key = std::vector<std::uint64_t>;
  template <typename Made, typename Info>
  Pipeline& find_or_make(const Key& key, const Info& info);

  const std::unique_ptr<RenderPasses> render_passes_;
  const Pipeline::Maker maker_;
  mutable std::mutex mutex_;
  std::map<Key, std::unique_ptr<Pipeline>> pipelines_;
};

}  // namespace brume::gpu
