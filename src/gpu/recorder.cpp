#include "gpu/recorder.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "gpu/barriers.hpp"
#include "gpu/rendering.hpp"

namespace brume::gpu {
namespace {

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

Recorder::Recorder(Context& context, FrameSlot& slot)
    : context_(context),
      slot_(slot),
      list_(slot.memory_),
      buffer_barriers_(&slot.memory_),
      image_barriers_(&slot.memory_),
      transfers_(&slot.memory_),
      dispatches_(&slot.memory_),
      id_(context.begin_recording()) {
  slot.memory_.reset();
  for (const VkDescriptorPool pool : slot.descriptors_)
    check(context.vk().ResetDescriptorPool(context.device(), pool, 0), "vkResetDescriptorPool");
  slot.descriptors_index_ = 0;
  // A burst of uploads does not keep its memory.
  constexpr std::uint32_t kSpareFrames = 64;
  slot.spare_frames_ = slot.staging_.size() > slot.staging_index_ + 1 ? slot.spare_frames_ + 1 : 0;
  if (slot.spare_frames_ >= kSpareFrames) {
    slot.staging_.pop_back();
    slot.spare_frames_ = 0;
  }
  slot.staging_index_ = 0;
  slot.staging_used_ = 0;
  slot.timings_.reset(list_);
}

Recorder::~Recorder() {
  if (!is_kept_) context_.drop_recording(id_);
}

void Recorder::collect(const std::function<void(Recorder&)>& record) {
  flush_transfers();
  flush_barriers();
  const CommandList::End end = list_.end();
  const RecordingId before = id_;
  id_ = context_.begin_recording();
  try {
    record(*this);
    flush_transfers();
    flush_barriers();
  } catch (...) {
    list_.cut(end);
    transfers_.clear();
    buffer_barriers_.clear();
    image_barriers_.clear();
    dispatches_.clear();
    concurrently_ = false;
    context_.drop_recording(id_);
    id_ = before;
    throw;
  }
  id_ = before;
}

void Recorder::use(const Buffer& buffer, VkPipelineStageFlags2 stages, VkAccessFlags2 access) {
  flush_transfers();
  add_barrier(buffer, stages, access);
}

void Recorder::add_barrier(const Buffer& buffer, VkPipelineStageFlags2 stages, VkAccessFlags2 access) {
  const Dependency wait = advance(change(buffer.last_use), stages, access, false);
  if (!wait.needed) return;
  buffer_barriers_.push_back({VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2, nullptr, wait.src_stages,
                              wait.src_access, stages, access, VK_QUEUE_FAMILY_IGNORED,
                              VK_QUEUE_FAMILY_IGNORED, buffer.handle(), 0, VK_WHOLE_SIZE});
}

void Recorder::use(const Image& image, VkPipelineStageFlags2 stages, VkAccessFlags2 access,
                   VkImageLayout layout) {
  flush_transfers();
  LastUse& last_use = change(image.last_use);
  const VkImageLayout old_layout = last_use.layout;
  const Dependency wait = advance(last_use, stages, access, old_layout != layout);
  last_use.layout = layout;
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
  add_barriers(context_.vk(), list_, buffer_barriers_, image_barriers_);
  buffer_barriers_.clear();
  image_barriers_.clear();
}

VkDescriptorSet Recorder::allocate_set(VkDescriptorSetLayout layout) {
  VkDescriptorSetAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  info.descriptorSetCount = 1;
  info.pSetLayouts = &layout;
  for (;; ++slot_.descriptors_index_) {
    const std::vector<VkDescriptorPool>& pools = slot_.descriptors_;
    const bool is_new = slot_.descriptors_index_ == pools.size();
    info.descriptorPool = is_new ? slot_.add_descriptors() : pools[slot_.descriptors_index_];
    VkDescriptorSet set = VK_NULL_HANDLE;
    const VkResult result = context_.vk().AllocateDescriptorSets(context_.device(), &info, &set);
    const bool is_full = result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL;
    if (is_full && !is_new) continue;
    check(result, "vkAllocateDescriptorSets");
    return set;
  }
}

VkDescriptorSet Recorder::write_set(const Pipeline& pipeline, std::span<const BoundResource> resources) {
  const std::string fault = binding_fault(pipeline.interface(), resources);
  BRUME_ASSERT(fault.empty(), std::string(pipeline.shaders().front().name) + ": " + fault);
  const VkDescriptorSet set = allocate_set(pipeline.set_layout());
  // The writes point into these lists, which must not grow.
  FrameVector<VkDescriptorBufferInfo> buffers(resources.size(), &memory());
  FrameVector<VkDescriptorImageInfo> images(resources.size(), &memory());
  FrameVector<VkWriteDescriptorSet> writes(&memory());
  writes.reserve(resources.size());
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
  bind_all(pipeline, resources, bytes);
}

void Recorder::bind(const Pipeline& pipeline, Bundles bundles, BoundResources resources,
                    std::span<const std::byte> bytes) {
  bind_all(pipeline, with_bundles(pipeline.interface(), bundles, resources, &memory()), bytes);
}

void Recorder::bind_all(const Pipeline& pipeline, std::span<const BoundResource> resources,
                        std::span<const std::byte> bytes) {
  for (const BoundResource& bound : resources) use(bound.resource, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
  const VkDescriptorSet set = write_set(pipeline, resources);
  if (concurrently_) {
    dispatches_.push_back({&pipeline, set, list_.kept(bytes), {}});
    return;
  }
  flush_barriers();
  bind_set(pipeline, set);
  if (!bytes.empty()) push(pipeline, bytes);
}

void Recorder::bind_for_draws(const Pipeline& pipeline, BoundResources resources) {
  bind_set(pipeline, write_set(pipeline, resources));
}

void Recorder::bind_for_draws(const Pipeline& pipeline, Bundles bundles, BoundResources resources) {
  bind_set(pipeline, write_set(pipeline, with_bundles(pipeline.interface(), bundles, resources, &memory())));
}

void Recorder::bind_set(const Pipeline& pipeline, VkDescriptorSet set) {
  const VkPipelineBindPoint point = pipeline.bind_point();
  const VkPipeline handle = pipeline.handle();
  const VkPipelineLayout layout = pipeline.layout();
  list_.add([=](const Functions& vk, VkCommandBuffer commands) {
    vk.CmdBindPipeline(commands, point, handle);
    vk.CmdBindDescriptorSets(commands, point, layout, 0, 1, &set, 0, nullptr);
  });
}

void Recorder::prepare_for_draws(std::initializer_list<Binding> bindings) {
  for (const Binding& binding : bindings) {
    use(binding, VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
  }
}

void Recorder::prepare_for_draws(const Pipeline& pipeline, Bundles bundles, BoundResources resources) {
  for (const BoundResource& bound : with_bundles(pipeline.interface(), bundles, resources, &memory()))
    prepare_for_draws({bound.resource});
}

void Recorder::prepare_indices(const Buffer& indices) {
  use(indices, VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT);
}

void Recorder::push(const Pipeline& pipeline, std::span<const std::byte> bytes) {
  BRUME_ASSERT(bytes.size() == pipeline.interface().push_bytes, std::to_string(bytes.size()));
  const VkPipelineLayout layout = pipeline.layout();
  const VkShaderStageFlags stages = pipeline.stages();
  const std::span<const std::byte> kept = list_.kept(bytes);
  list_.add([=](const Functions& vk, VkCommandBuffer commands) {
    vk.CmdPushConstants(commands, layout, stages, 0, static_cast<std::uint32_t>(kept.size()), kept.data());
  });
}

void Recorder::dispatch_threads(const ComputePipeline& pipeline, std::uint32_t x, std::uint32_t y,
                                std::uint32_t z) {
  const auto& group = pipeline.group();
  const std::array groups{(x + group[0] - 1) / group[0], (y + group[1] - 1) / group[1],
                          (z + group[2] - 1) / group[2]};
  if (concurrently_)
    dispatches_.back().groups = groups;
  else
    add_dispatch(groups);
}

void Recorder::add_dispatch(const std::array<std::uint32_t, 3>& groups) {
  list_.add([=](const Functions& vk, VkCommandBuffer commands) {
    vk.CmdDispatch(commands, groups[0], groups[1], groups[2]);
  });
}

void Recorder::begin_concurrent() {
  BRUME_ASSERT(!concurrently_, "dispatches inside of others");
  concurrently_ = true;
}

void Recorder::end_concurrent() {
  concurrently_ = false;
  flush_barriers();
  for (const Dispatch& dispatch : dispatches_) {
    bind_set(*dispatch.pipeline, dispatch.set);
    if (!dispatch.push.empty()) push(*dispatch.pipeline, dispatch.push);
    add_dispatch(dispatch.groups);
  }
  dispatches_.clear();
}

void Recorder::dispatch_indirect(const Buffer& groups) {
  use(groups, VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
  flush_barriers();
  const VkBuffer buffer = groups.handle();
  list_.add(
      [=](const Functions& vk, VkCommandBuffer commands) { vk.CmdDispatchIndirect(commands, buffer, 0); });
}

void Recorder::begin_rendering(const Attachments& attachments, glm::uvec2 size_px, glm::uvec2 origin_px) {
  // Attachments and their barriers.
  RenderingInfo rendering;
  for (const Image* image : attachments.colours) {
    if (!image) break;
    const std::uint32_t i = rendering.colour_count++;
    const bool keep = (attachments.keep >> i & 1u) != 0;
    use(*image, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
        VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | (keep ? VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT : 0),
        VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    rendering.views[i] = image->view();
    rendering.pass.colours[i] = image->info().format;
    rendering.pass.loads[i] = keep                    ? VK_ATTACHMENT_LOAD_OP_LOAD
                              : attachments.overwrite ? VK_ATTACHMENT_LOAD_OP_DONT_CARE
                                                      : VK_ATTACHMENT_LOAD_OP_CLEAR;
  }
  if (attachments.depth) {
    use(*attachments.depth,
        VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
        VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
        VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    rendering.views[rendering.colour_count] =
        attachments.depth_view ? attachments.depth_view : attachments.depth->view();
    rendering.pass.depth = attachments.depth->info().format;
    rendering.pass.depth_load =
        attachments.keep_depth ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR;
  }
  flush_barriers();

  // Rendering, with the part as viewport and scissor.
  rendering.area = {{static_cast<std::int32_t>(origin_px.x), static_cast<std::int32_t>(origin_px.y)},
                    {size_px.x, size_px.y}};
  add_begin_rendering(context_, list_, rendering);
  list_.add([area = rendering.area](const Functions& vk, VkCommandBuffer commands) {
    const glm::vec2 low(area.offset.x, area.offset.y), size(area.extent.width, area.extent.height);
    const VkViewport viewport{low.x, low.y, size.x, size.y, 0, 1};
    vk.CmdSetViewport(commands, 0, 1, &viewport);
    vk.CmdSetScissor(commands, 0, 1, &area);
  });
}

void Recorder::end_rendering() {
  add_end_rendering(list_);
}

void Recorder::begin_scope(const char* name) {
  flush_transfers();
  if (context_.vk().CmdBeginDebugUtilsLabelEXT)
    list_.add([name](const Functions& vk, VkCommandBuffer commands) {
      const VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, nullptr, name, {}};
      vk.CmdBeginDebugUtilsLabelEXT(commands, &label);
    });
  slot_.timings_.begin(list_, name);
}

void Recorder::end_scope() {
  flush_transfers();
  slot_.timings_.end(list_);
  if (context_.vk().CmdEndDebugUtilsLabelEXT)
    list_.add([](const Functions& vk, VkCommandBuffer commands) { vk.CmdEndDebugUtilsLabelEXT(commands); });
}

void Recorder::record(VkCommandBuffer commands) {
  flush_transfers();
  flush_barriers();
  list_.record(context_.vk(), commands);
  slot_.timings_.set_recorded();
}

void Recorder::draw_indexed(const Buffer& indices, std::uint32_t count, std::uint32_t first,
                            std::int32_t first_vertex) {
  const VkBuffer buffer = indices.handle();
  list_.add([=](const Functions& vk, VkCommandBuffer commands) {
    vk.CmdBindIndexBuffer(commands, buffer, 0, VK_INDEX_TYPE_UINT32);
    vk.CmdDrawIndexed(commands, count, 1, first, first_vertex, 0);
  });
}

void Recorder::draw(std::uint32_t vertex_count) {
  list_.add(
      [=](const Functions& vk, VkCommandBuffer commands) { vk.CmdDraw(commands, vertex_count, 1, 0, 0); });
}

void Recorder::set_scissor(glm::ivec2 offset_px, glm::uvec2 size_px) {
  const VkRect2D rectangle{{offset_px.x, offset_px.y}, {size_px.x, size_px.y}};
  list_.add(
      [=](const Functions& vk, VkCommandBuffer commands) { vk.CmdSetScissor(commands, 0, 1, &rectangle); });
}

}  // namespace brume::gpu
