// Temporal anti-aliasing of the host's picture, which may follow the smoke.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "gpu.hpp"
#include "smoke.hpp"

using Matrix = std::array<float, 16>;  // column by column

/// From world space to clip space.
inline Matrix matrix_of(const Camera& camera, float aspect) {
  const Vec3 right = unit(cross(camera.forward, camera.up)), up = cross(right, camera.forward),
             f = camera.forward;
  const float y = 1 / std::tan(0.5f * kFieldOfView), x = y / aspect;
  const Vec3 p = camera.position;
  return {x * right.x, -y * up.x, 0, f.x, x * right.y,        -y * up.y,      0,     f.y,
          x * right.z, -y * up.z, 0, f.z, -x * dot(right, p), y * dot(up, p), kNear, -dot(f, p)};
}
/// From clip space to world space, both homogeneous.
inline Matrix inverse_of(const Camera& camera, float aspect) {
  const Vec3 right = unit(cross(camera.forward, camera.up)), up = cross(right, camera.forward),
             f = camera.forward;
  const float y = 1 / std::tan(0.5f * kFieldOfView), x = y / aspect;
  const Vec3 p = camera.position;
  return {right.x / x, right.y / x, right.z / x, 0,         -up.x / y, -up.y / y, -up.z / y, 0,
          p.x / kNear, p.y / kNear, p.z / kNear, 1 / kNear, f.x,       f.y,       f.z,       0};
}
inline Matrix product(const Matrix& a, const Matrix& b) {
  Matrix out{};
  for (std::size_t i = 0; i < 16; ++i)
    for (std::size_t k = 0; k < 4; ++k) out[i] += a[i % 4 + 4 * k] * b[i / 4 * 4 + k];
  return out;
}

/// Eight places, by the sequences of van der Corput of base 2 and 3.
inline Jitter jitter_of(std::uint64_t frame) {
  const auto radical = [](std::uint64_t i, std::uint64_t base) {
    double value = 0, digit = 1;
    for (; i > 0; i /= base) value += static_cast<double>(i % base) * (digit /= static_cast<double>(base));
    return static_cast<float>(value - 0.5);
  };
  return {radical(frame % 8 + 1, 2), radical(frame % 8 + 1, 3)};
}

/// The matrix that moves what a pixel shows by its jitter.
inline Matrix jittered(Matrix clip_from_world, Jitter jitter, float width, float height) {
  for (std::size_t column = 0; column < 4; ++column) {
    float* const c = &clip_from_world[4 * column];
    c[0] -= 2 * jitter.x / width * c[3];
    c[1] -= 2 * jitter.y / height * c[3];
  }
  return clip_from_world;
}

class Taa {
 public:
  /// What a frame is made of. All images are for compute shaders to read, Brume's in the layout GENERAL.
  struct Inputs {
    VkImageView picture, depth, smoke, motion;
    Camera camera;
    Jitter jitter;
  };

  Taa(const Gpu& gpu, VkExtent2D size, std::size_t in_flight, bool follows_smoke)
      : gpu_(gpu), size_(size), follows_smoke_(follows_smoke), sets_(in_flight) {
    for (Image& image : images_)
      image = gpu.make_image(
          VK_FORMAT_R16G16B16A16_SFLOAT, size, VK_IMAGE_ASPECT_COLOR_BIT,
          VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    VkSamplerCreateInfo sampler{};
    sampler.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    sampler.minFilter = sampler.magFilter = VK_FILTER_LINEAR;
    sampler.addressModeU = sampler.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    check(vkCreateSampler(gpu.device, &sampler, nullptr, &linear_), "vkCreateSampler");
    sampler.minFilter = sampler.magFilter = VK_FILTER_NEAREST;  // not every device filters a depth
    check(vkCreateSampler(gpu.device, &sampler, nullptr, &nearest_), "vkCreateSampler");
    make_pipeline();
    make_sets();
  }

  /// The image that it returns has the picture, written by a compute shader in the layout GENERAL. The next
  /// frame reads it in that layout.
  const Image& record(VkCommandBuffer commands, std::uint64_t frame, const Inputs& in) {
    const Image &shown = images_[frame % 2], &history = images_[1 - frame % 2];
    // The frame before has read it, and shown the one before that.
    gpu_.transition(commands, shown, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL,
                    {kBlitReads.stages | kComputeReads.stages, 0}, kComputeWrites);
    if (!has_history_)
      gpu_.transition(commands, history, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL, {},
                      kComputeReads);
    const VkDescriptorSet set = sets_[frame % sets_.size()];
    write_set(set, in, history, shown);
    const float aspect = static_cast<float>(size_.width) / static_cast<float>(size_.height);
    const Push push{
        product(matrix_of(has_history_ ? before_ : in.camera, aspect), inverse_of(in.camera, aspect)),
        in.jitter, follows_smoke_ ? 1u : 0u, has_history_ ? 1u : 0u};
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set, 0, nullptr);
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, &push);
    vkCmdDispatch(commands, (size_.width + 7) / 8, (size_.height + 7) / 8, 1);
    before_ = in.camera;
    has_history_ = true;
    return shown;
  }

 private:
  struct Push {
    Matrix before_from_now;
    Jitter jitter;
    std::uint32_t follows_smoke, has_history;
  };  // as in taa.comp
  static constexpr std::uint32_t kSampled = 5;

  void make_pipeline() {
    std::array<VkDescriptorSetLayoutBinding, kSampled + 1> bindings{};
    for (std::uint32_t i = 0; i <= kSampled; ++i)
      bindings[i] = {
          i, i < kSampled ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1,
          VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    const VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, nullptr, 0,
                                              kSampled + 1, bindings.data()};
    check(vkCreateDescriptorSetLayout(gpu_.device, &set, nullptr, &set_layout_),
          "vkCreateDescriptorSetLayout");
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(Push)};
    const VkPipelineLayoutCreateInfo layout{
        VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, nullptr, 0, 1, &set_layout_, 1, &range};
    check(vkCreatePipelineLayout(gpu_.device, &layout, nullptr, &layout_), "vkCreatePipelineLayout");
    static constexpr std::uint32_t kShader[] =
#include "taa.comp.inc"
        ;
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = gpu_.make_module(kShader);
    info.stage.pName = "main";
    info.layout = layout_;
    check(vkCreateComputePipelines(gpu_.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_),
          "vkCreateComputePipelines");
  }
  void make_sets() {
    const auto count = static_cast<std::uint32_t>(sets_.size());
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kSampled * count},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, count}};
    const VkDescriptorPoolCreateInfo info{
        VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, 0, count, 2, sizes};
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(gpu_.device, &info, nullptr, &pool), "vkCreateDescriptorPool");
    const std::vector<VkDescriptorSetLayout> layouts(sets_.size(), set_layout_);
    const VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool,
                                               count, layouts.data()};
    check(vkAllocateDescriptorSets(gpu_.device, &allocate, sets_.data()), "vkAllocateDescriptorSets");
  }
  void write_set(VkDescriptorSet set, const Inputs& in, const Image& history, const Image& shown) const {
    const VkDescriptorImageInfo images[] = {{nearest_, in.picture, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
                                            {nearest_, in.depth, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
                                            {nearest_, in.smoke, VK_IMAGE_LAYOUT_GENERAL},
                                            {nearest_, in.motion, VK_IMAGE_LAYOUT_GENERAL},
                                            {linear_, history.view, VK_IMAGE_LAYOUT_GENERAL},
                                            {VK_NULL_HANDLE, shown.view, VK_IMAGE_LAYOUT_GENERAL}};
    std::array<VkWriteDescriptorSet, kSampled + 1> writes{};
    for (std::uint32_t i = 0; i <= kSampled; ++i) {
      writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
      writes[i].dstSet = set;
      writes[i].dstBinding = i;
      writes[i].descriptorCount = 1;
      writes[i].descriptorType =
          i < kSampled ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
      writes[i].pImageInfo = &images[i];
    }
    vkUpdateDescriptorSets(gpu_.device, kSampled + 1, writes.data(), 0, nullptr);
  }

  const Gpu& gpu_;
  VkExtent2D size_;
  bool follows_smoke_, has_history_ = false;
  std::array<Image, 2> images_;
  Camera before_{};
  VkSampler linear_ = VK_NULL_HANDLE, nearest_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  std::vector<VkDescriptorSet> sets_;
};
