#include "gpu/frame_slot.hpp"

#include "gpu/pipeline.hpp"

namespace brume::gpu {
namespace {

constexpr std::uint32_t kSetsPerFrame = 4096;

VkDescriptorPool make_descriptor_pool(Context& context) {
  const VkDescriptorPoolSize sizes[] = {{kBuffer, 4 * kSetsPerFrame},
                                        {kUniform, kSetsPerFrame},
                                        {kSampled, 4 * kSetsPerFrame},
                                        {kStored, kSetsPerFrame}};
  VkDescriptorPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = kSetsPerFrame;
  info.poolSizeCount = 4;
  info.pPoolSizes = sizes;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(context.vk().CreateDescriptorPool(context.device(), &info, context.vk().allocator, &pool),
        "vkCreateDescriptorPool");
  return pool;
}

}  // namespace

FrameSlot::FrameSlot(Context& context, bool timed) : context_(context), timings_(context, timed) {
  add_descriptors();
}

VkDescriptorPool FrameSlot::add_descriptors() {
  context_.expect_retirement();
  descriptors_.reserve(descriptors_.size() + 1);
  descriptors_.push_back(make_descriptor_pool(context_));
  return descriptors_.back();
}

FrameSlot::~FrameSlot() {
  for (const VkDescriptorPool pool : descriptors_) context_.retire({.descriptors = pool});
}

}  // namespace brume::gpu
