#include "gpu/recorder.hpp"

namespace brume::gpu {

CommandRunner::CommandRunner(Context& context) : context_(context), slot_(context, true) {
  VkCommandPoolCreateInfo pool{};
  pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool.queueFamilyIndex = context.queue_family();
  check(context.vk().CreateCommandPool(context.device(), &pool, context.vk().allocator, &pool_),
        "vkCreateCommandPool");
  VkCommandBufferAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  info.commandPool = pool_;
  info.commandBufferCount = 1;
  const VkResult result = context.vk().AllocateCommandBuffers(context.device(), &info, &commands_);
  if (result != VK_SUCCESS) context.vk().DestroyCommandPool(context.device(), pool_, context.vk().allocator);
  check(result, "vkAllocateCommandBuffers");
}

CommandRunner::~CommandRunner() {
  context_.vk().DestroyCommandPool(context_.device(), pool_, context_.vk().allocator);
}

void CommandRunner::run(const std::function<void(Recorder&)>& record) {
  start(record, {});
  context_.wait();
}

void CommandRunner::start(const std::function<void(Recorder&)>& record, const WindowSemaphores& window) {
  const Functions& vk = context_.vk();
  check(vk.ResetCommandPool(context_.device(), pool_, 0), "vkResetCommandPool");
  const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                       VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
  check(vk.BeginCommandBuffer(commands_, &begin), "vkBeginCommandBuffer");
  Recorder recorder(context_, slot_);
  record(recorder);
  recorder.record(commands_);
  check(vk.EndCommandBuffer(commands_), "vkEndCommandBuffer");
  context_.submit(commands_, window);
  recorder.keep();
}

}  // namespace brume::gpu
