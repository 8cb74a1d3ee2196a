#include "gpu/recorder.hpp"

#include <algorithm>
#include <cstring>

#include "core/error.hpp"

namespace brume::gpu {
namespace {

constexpr VkDeviceSize kStagingBytes = 8ull << 20;
constexpr std::uint32_t kSetsPerFrame = 4096;
constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT |
                                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                   VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;

struct Dependency {
  bool needed = false;
  VkPipelineStageFlags2 src_stages = 0;
  VkAccessFlags2 src_access = 0;
};

/// Records a use and returns its dependency.
Dependency advance(LastUse& last, VkPipelineStageFlags2 stages, VkAccessFlags2 access, bool new_layout) {
  // A read waits for the last write, unless that is visible already.
  if (!(access & kWrites) && !new_layout) {
    const bool visible = (last.visible_stages & stages) == stages && (last.visible_access & access) == access;
    const Dependency after_write{!visible && last.write_stages != 0, last.write_stages, last.write_access};
    last.read_stages |= stages;
    last.visible_stages |= stages;
    last.visible_access |= access;
    return after_write;
  }

  // A write or layout change waits for all earlier uses.
  const Dependency after_all{new_layout || last.write_stages != 0 || last.read_stages != 0,
                             last.write_stages | last.read_stages, last.write_access};
  last.write_stages = stages;
  last.write_access = access & kWrites;
  const bool reads_only = last.write_access == 0;
  last.read_stages = reads_only ? stages : 0;
  last.visible_stages = reads_only ? stages : 0;
  last.visible_access = reads_only ? access : 0;
  return after_all;
}

}  // namespace

FrameSlot::FrameSlot(Context& context) : context_(context), timings_(context) {
  const VkDescriptorPoolSize sizes[] = {{kBuffer, 4 * kSetsPerFrame},
                                        {kUniform, kSetsPerFrame},
                                        {kSampled, 4 * kSetsPerFrame},
                                        {kStored, kSetsPerFrame}};
  VkDescriptorPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = kSetsPerFrame;
  info.poolSizeCount = 4;
  info.pPoolSizes = sizes;
  check(context.vk().CreateDescriptorPool(context.device(), &info, nullptr, &descriptors_),
        "vkCreateDescriptorPool");
}

FrameSlot::~FrameSlot() {
  context_.vk().DestroyDescriptorPool(context_.device(), descriptors_, nullptr);
}

Recorder::Recorder(Context& context, FrameSlot& slot, VkCommandBuffer commands)
    : context_(context), slot_(slot), commands_(commands) {
  check(context.vk().ResetDescriptorPool(context.device(), slot.descriptors_, 0), "vkResetDescriptorPool");
  slot.staging_index_ = 0;
  slot.staging_used_ = 0;
  slot.timings_.reset(commands);
}

void Recorder::use(const Buffer& buffer, VkPipelineStageFlags2 stages, VkAccessFlags2 access) {
  const Dependency wait = advance(buffer.last_use, stages, access, false);
  if (!wait.needed) return;
  buffer_barriers_.push_back({VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2, nullptr, wait.src_stages,
                              wait.src_access, stages, access, VK_QUEUE_FAMILY_IGNORED,
                              VK_QUEUE_FAMILY_IGNORED, buffer.handle(), 0, VK_WHOLE_SIZE});
}

void Recorder::use(const Image& image, VkPipelineStageFlags2 stages, VkAccessFlags2 access,
                   VkImageLayout layout) {
  const VkImageLayout old_layout = image.last_use.layout;
  const Dependency wait = advance(image.last_use, stages, access, old_layout != layout);
  image.last_use.layout = layout;
  if (!wait.needed) return;
  image_barriers_.push_back({VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                             nullptr,
                             wait.src_stages,
                             wait.src_access,
                             stages,
                             access,
                             old_layout,
                             layout,
                             VK_QUEUE_FAMILY_IGNORED,
                             VK_QUEUE_FAMILY_IGNORED,
                             image.handle(),
                             {image.aspect(), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS}});
}

void Recorder::use(const Binding& binding, VkPipelineStageFlags2 stages) {
  VkAccessFlags2 access = 0;
  if (binding.type == kUniform) access = VK_ACCESS_2_UNIFORM_READ_BIT;
  if (binding.type == kSampled) access = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
  if (binding.type == kBuffer || binding.type == kStored) {
    if (binding.reads) access |= VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
    if (binding.writes) access |= VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  }
  if (binding.buffer) use(*binding.buffer, stages, access);
  if (binding.image) {
    use(*binding.image, stages, access,
        binding.type == kStored ? VK_IMAGE_LAYOUT_GENERAL : binding.image->sampled_layout());
  }
}

void Recorder::flush_barriers() {
  if (buffer_barriers_.empty() && image_barriers_.empty()) return;
  VkDependencyInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  info.bufferMemoryBarrierCount = static_cast<std::uint32_t>(buffer_barriers_.size());
  info.pBufferMemoryBarriers = buffer_barriers_.data();
  info.imageMemoryBarrierCount = static_cast<std::uint32_t>(image_barriers_.size());
  info.pImageMemoryBarriers = image_barriers_.data();
  context_.vk().CmdPipelineBarrier2(commands_, &info);
  buffer_barriers_.clear();
  image_barriers_.clear();
}

VkDescriptorSet Recorder::write_set(const Pipeline& pipeline, std::span<const BoundResource> resources) {
  const std::string fault = binding_fault(pipeline.interface(), resources);
  BRUME_ASSERT(fault.empty(), std::string(pipeline.shaders().front().name) + ": " + fault);
  VkDescriptorSetAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  info.descriptorPool = slot_.descriptors_;
  info.descriptorSetCount = 1;
  const VkDescriptorSetLayout layout = pipeline.set_layout();
  info.pSetLayouts = &layout;
  VkDescriptorSet set = VK_NULL_HANDLE;
  check(context_.vk().AllocateDescriptorSets(context_.device(), &info, &set), "vkAllocateDescriptorSets");

  std::vector<VkDescriptorBufferInfo> buffers(resources.size());
  std::vector<VkDescriptorImageInfo> images(resources.size());
  std::vector<VkWriteDescriptorSet> writes;
  std::uint32_t i = 0;
  for (const auto& [at, binding] : resources) {
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.dstBinding = at.number;
    write.descriptorCount = 1;
    write.descriptorType = binding.type;
    if (binding.buffer) {
      buffers[i] = {binding.buffer->handle(), 0, VK_WHOLE_SIZE};
      write.pBufferInfo = &buffers[i];
    } else {
      images[i] = {binding.sampler ? binding.sampler->handle() : VK_NULL_HANDLE, binding.image->view(),
                   binding.type == kStored ? VK_IMAGE_LAYOUT_GENERAL : binding.image->sampled_layout()};
      write.pImageInfo = &images[i];
    }
    writes.push_back(write);
    ++i;
  }
  context_.vk().UpdateDescriptorSets(context_.device(), i, writes.data(), 0, nullptr);
  return set;
}

void Recorder::bind(const Pipeline& pipeline, BoundResources resources, std::span<const std::byte> bytes) {
  for (const BoundResource& bound : resources) use(bound.resource, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
  flush_barriers();
  bind_set(pipeline, resources);
  if (!bytes.empty()) push(pipeline, bytes);
}

void Recorder::bind_for_draws(const Pipeline& pipeline, BoundResources resources) {
  bind_set(pipeline, resources);
}

void Recorder::bind_set(const Pipeline& pipeline, std::span<const BoundResource> resources) {
  const VkDescriptorSet set = write_set(pipeline, resources);
  context_.vk().CmdBindPipeline(commands_, pipeline.bind_point(), pipeline.handle());
  context_.vk().CmdBindDescriptorSets(commands_, pipeline.bind_point(), pipeline.layout(), 0, 1, &set, 0,
                                      nullptr);
}

void Recorder::prepare_for_draws(std::initializer_list<Binding> bindings) {
  for (const Binding& binding : bindings) {
    use(binding, VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
  }
}

void Recorder::prepare_indices(const Buffer& indices) {
  use(indices, VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT);
}

void Recorder::push(const Pipeline& pipeline, std::span<const std::byte> bytes) {
  BRUME_ASSERT(bytes.size() == pipeline.interface().push_bytes, std::to_string(bytes.size()));
  context_.vk().CmdPushConstants(commands_, pipeline.layout(), pipeline.stages(), 0,
                                 static_cast<std::uint32_t>(bytes.size()), bytes.data());
}

void Recorder::dispatch_threads(const ComputePipeline& pipeline, std::uint32_t x, std::uint32_t y,
                                std::uint32_t z) {
  const auto& group = pipeline.group();
  context_.vk().CmdDispatch(commands_, (x + group[0] - 1) / group[0], (y + group[1] - 1) / group[1],
                            (z + group[2] - 1) / group[2]);
}

void Recorder::dispatch_together(std::initializer_list<Dispatch> dispatches) {
  for (const Dispatch& dispatch : dispatches)
    for (const BoundResource& bound : dispatch.resources)
      use(bound.resource, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
  flush_barriers();
  for (const Dispatch& dispatch : dispatches) {
    bind_set(dispatch.pipeline, dispatch.resources);
    if (!dispatch.push.empty()) push(dispatch.pipeline, dispatch.push);
    dispatch_threads(dispatch.pipeline, dispatch.threads.x, dispatch.threads.y, dispatch.threads.z);
  }
}

void Recorder::dispatch_indirect(const Buffer& groups) {
  use(groups, VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
  flush_barriers();
  context_.vk().CmdDispatchIndirect(commands_, groups.handle(), 0);
}

Recorder::Staged Recorder::stage_bytes(std::span<const std::byte> bytes) {
  // Offsets of image copies must be multiples of the texel size; 16 covers every format in use.
  constexpr VkDeviceSize kAlignment = 16;
  auto& buffers = slot_.staging_;
  while (slot_.staging_index_ < buffers.size() &&
         slot_.staging_used_ + bytes.size() > buffers[slot_.staging_index_].size()) {
    ++slot_.staging_index_;
    slot_.staging_used_ = 0;
  }
  if (slot_.staging_index_ == buffers.size()) {
    buffers.emplace_back(context_, std::max<VkDeviceSize>(kStagingBytes, bytes.size()),
                         VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::upload);
    slot_.staging_used_ = 0;
  }
  const Staged staged{&buffers[slot_.staging_index_], slot_.staging_used_};
  std::memcpy(staged.buffer->mapped() + staged.offset, bytes.data(), bytes.size());
  slot_.staging_used_ += (bytes.size() + kAlignment - 1) / kAlignment * kAlignment;
  return staged;
}

void Recorder::upload(const Buffer& buffer, VkDeviceSize offset, std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
  BRUME_ASSERT(offset + bytes.size() <= buffer.size(), std::to_string(offset + bytes.size()));
  const Staged staged = stage_bytes(bytes);
  use(buffer, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  flush_barriers();
  const VkBufferCopy copy{staged.offset, offset, bytes.size()};
  context_.vk().CmdCopyBuffer(commands_, staged.buffer->handle(), buffer.handle(), 1, &copy);
}

void Recorder::upload(const Image& image, std::span<const Region> regions) {
  if (regions.empty()) return;
  use(image, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
      VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  flush_barriers();

  // One copy command per staging buffer.
  std::vector<VkBufferImageCopy> copies;
  const Buffer* source = nullptr;
  const auto flush_copies = [&] {
    if (!source || copies.empty()) return;
    context_.vk().CmdCopyBufferToImage(commands_, source->handle(), image.handle(),
                                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                       static_cast<std::uint32_t>(copies.size()), copies.data());
    copies.clear();
  };
  for (const Region& region : regions) {
    const Staged staged = stage_bytes(region.texels);
    if (staged.buffer != source) flush_copies();
    source = staged.buffer;
    VkBufferImageCopy copy{};
    copy.bufferOffset = staged.offset;
    copy.imageSubresource = {image.aspect(), 0, 0, 1};
    copy.imageOffset = {region.offset.x, region.offset.y, region.offset.z};
    copy.imageExtent = {region.size.x, region.size.y, region.size.z};
    copies.push_back(copy);
  }
  flush_copies();
}

void Recorder::fill(const Buffer& buffer, std::uint32_t value) {
  use(buffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  flush_barriers();
  context_.vk().CmdFillBuffer(commands_, buffer.handle(), 0, VK_WHOLE_SIZE, value);
}

void Recorder::clear(const Image& image, VkClearColorValue value) {
  use(image, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL);
  flush_barriers();
  const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0,
                                    VK_REMAINING_ARRAY_LAYERS};
  context_.vk().CmdClearColorImage(commands_, image.handle(), VK_IMAGE_LAYOUT_GENERAL, &value, 1, &all);
}

void Recorder::read_back(const Image& image, const Buffer& buffer) {
  const bool general = image.sampled_layout() == VK_IMAGE_LAYOUT_GENERAL;
  const VkImageLayout layout = general ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  use(image, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, layout);
  use(buffer, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  flush_barriers();
  VkBufferImageCopy copy{};
  copy.imageSubresource = {image.aspect(), 0, 0, 1};
  copy.imageExtent = {image.info().size.x, image.info().size.y, image.info().size.z};
  context_.vk().CmdCopyImageToBuffer(commands_, image.handle(), layout, buffer.handle(), 1, &copy);
  use(buffer, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
  flush_barriers();
}

void Recorder::read_back(const Buffer& from, const Buffer& to, VkDeviceSize bytes) {
  use(from, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
  use(to, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  flush_barriers();
  const VkBufferCopy copy{0, 0, bytes};
  context_.vk().CmdCopyBuffer(commands_, from.handle(), to.handle(), 1, &copy);
  use(to, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
  flush_barriers();
}

namespace {

VkImageBlit whole_blit(glm::uvec2 from, glm::uvec2 to) {
  VkImageBlit blit{};
  blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  blit.srcOffsets[1] = {static_cast<std::int32_t>(from.x), static_cast<std::int32_t>(from.y), 1};
  blit.dstOffsets[1] = {static_cast<std::int32_t>(to.x), static_cast<std::int32_t>(to.y), 1};
  return blit;
}

}  // namespace

void Recorder::blit(const Image& from, const Image& to, VkFilter filter) {
  use(from, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_GENERAL);
  use(to, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL);
  flush_barriers();
  const VkImageBlit blit = whole_blit(glm::uvec2(from.info().size), glm::uvec2(to.info().size));
  context_.vk().CmdBlitImage(commands_, from.handle(), VK_IMAGE_LAYOUT_GENERAL, to.handle(),
                             VK_IMAGE_LAYOUT_GENERAL, 1, &blit, filter);
}

void Recorder::blit(const Image& from, const WindowImage& to) {
  use(from, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_GENERAL);
  const auto change = [&](VkAccessFlags2 before, VkAccessFlags2 after, VkImageLayout old_layout,
                          VkImageLayout new_layout) {
    image_barriers_.push_back({VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                               nullptr,
                               VK_PIPELINE_STAGE_2_BLIT_BIT,
                               before,
                               VK_PIPELINE_STAGE_2_BLIT_BIT,
                               after,
                               old_layout,
                               new_layout,
                               VK_QUEUE_FAMILY_IGNORED,
                               VK_QUEUE_FAMILY_IGNORED,
                               to.handle,
                               {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}});
    flush_barriers();
  };
  change(0, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  const VkImageBlit blit = whole_blit(glm::uvec2(from.info().size), to.size_px);
  context_.vk().CmdBlitImage(commands_, from.handle(), VK_IMAGE_LAYOUT_GENERAL, to.handle,
                             VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_NEAREST);
  change(VK_ACCESS_2_TRANSFER_WRITE_BIT, 0, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
         VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
}

void Recorder::make_mip_levels(const Image& image) {
  use(image, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT,
      VK_IMAGE_LAYOUT_GENERAL);
  flush_barriers();
  auto half = [](std::uint32_t size, std::uint32_t level) {
    return static_cast<std::int32_t>(std::max(1u, size >> level));
  };
  const glm::uvec3 size = image.info().size;
  for (std::uint32_t level = 1; level < image.info().mip_levels; ++level) {
    VkImageBlit blit{};
    blit.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level - 1, 0, 1};
    blit.srcOffsets[1] = {half(size.x, level - 1), half(size.y, level - 1), 1};
    blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
    blit.dstOffsets[1] = {half(size.x, level), half(size.y, level), 1};
    context_.vk().CmdBlitImage(commands_, image.handle(), VK_IMAGE_LAYOUT_GENERAL, image.handle(),
                               VK_IMAGE_LAYOUT_GENERAL, 1, &blit, VK_FILTER_LINEAR);
    use(image, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT,
        VK_IMAGE_LAYOUT_GENERAL);
    flush_barriers();
  }
}

void Recorder::begin_rendering(const Attachments& attachments, glm::uvec2 size_px) {
  const auto attachment = [&](VkImageView view, VkImageLayout layout) {
    VkRenderingAttachmentInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    info.imageView = view;
    info.imageLayout = layout;
    info.loadOp = attachments.keep ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    return info;
  };

  // Attachments and their barriers.
  std::vector<VkRenderingAttachmentInfo> colours;
  for (const Image* image : attachments.colours) {
    use(*image, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
        VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
            (attachments.keep ? VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT : 0),
        VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    colours.push_back(attachment(image->view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL));
  }
  VkRenderingAttachmentInfo depth{};
  if (attachments.depth) {
    use(*attachments.depth,
        VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
        VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
        VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    depth = attachment(attachments.depth_view ? attachments.depth_view : attachments.depth->view(),
                       VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
  }
  flush_barriers();

  // Rendering, with the whole area as viewport and scissor.
  VkRenderingInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  info.renderArea.extent = {size_px.x, size_px.y};
  info.layerCount = 1;
  info.colorAttachmentCount = static_cast<std::uint32_t>(colours.size());
  info.pColorAttachments = colours.data();
  info.pDepthAttachment = attachments.depth ? &depth : nullptr;
  const Functions& vk = context_.vk();
  vk.CmdBeginRendering(commands_, &info);
  const VkViewport viewport{0, 0, static_cast<float>(size_px.x), static_cast<float>(size_px.y), 0, 1};
  vk.CmdSetViewport(commands_, 0, 1, &viewport);
  vk.CmdSetScissor(commands_, 0, 1, &info.renderArea);
  set_culling(false);
}

void Recorder::end_rendering() {
  context_.vk().CmdEndRendering(commands_);
}

void Recorder::draw_indexed(const Buffer& indices, std::uint32_t count, std::uint32_t first,
                            std::int32_t first_vertex) {
  context_.vk().CmdBindIndexBuffer(commands_, indices.handle(), 0, VK_INDEX_TYPE_UINT32);
  context_.vk().CmdDrawIndexed(commands_, count, 1, first, first_vertex, 0);
}

void Recorder::draw(std::uint32_t vertex_count) {
  context_.vk().CmdDraw(commands_, vertex_count, 1, 0, 0);
}

void Recorder::set_culling(bool back_faces) {
  context_.vk().CmdSetCullMode(commands_, back_faces ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE);
}

void Recorder::set_scissor(glm::ivec2 offset_px, glm::uvec2 size_px) {
  const VkRect2D rectangle{{offset_px.x, offset_px.y}, {size_px.x, size_px.y}};
  context_.vk().CmdSetScissor(commands_, 0, 1, &rectangle);
}

}  // namespace brume::gpu
