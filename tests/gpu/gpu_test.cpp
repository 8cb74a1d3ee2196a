#include "tests/gpu/gpu_test.hpp"

#include <cstdlib>

#include "core/error.hpp"
#include "gpu/device_features.hpp"

namespace brume::gpu {
namespace {

TEST_F(GpuTest, NamesItsDevice) {
  EXPECT_FALSE(context().info().name.empty());
  EXPECT_TRUE(context().info().unsupported.empty());
  EXPECT_TRUE(context().owns_device());
}

TEST_F(GpuTest, BufferRoundTrip) {
  std::vector<std::uint32_t> values(70001);
  for (std::uint32_t i = 0; i < values.size(); ++i) values[i] = i * 2654435761u;
  EXPECT_EQ(read_back<std::uint32_t>(upload(values), values.size()), values);
}

TEST_F(GpuTest, UploadLargerThanTheStagingBlock) {
  std::vector<std::uint32_t> values(5u << 20, 7u);
  values.back() = 9;
  EXPECT_EQ(read_back<std::uint32_t>(upload(values), values.size()), values);
}

TEST_F(GpuTest, ImageRoundTripOfAwkwardSize) {
  ImageInfo info;
  info.format = VK_FORMAT_R8G8_UNORM;
  info.size = {33, 17, 5};
  info.three_dimensional = true;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  const Image image(context(), info);
  std::vector<std::uint16_t> texels(33 * 17 * 5);
  for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = static_cast<std::uint16_t>(i * 977);
  runner().run([&](Recorder& recorder) {
    const Recorder::Region all{std::as_bytes(std::span(texels)), glm::ivec3(0), info.size};
    recorder.upload(image, {&all, 1});
  });
  EXPECT_EQ(read_back<std::uint16_t>(image), texels);
}

TEST_F(GpuTest, TimingsNameTheirScopes) {
  runner().run([&](Recorder& recorder) {
    const Buffer buffer(context(), 1024, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    { const Scope scope(recorder, "first"); }
    const Scope scope(recorder, "second");
  });
  const auto scopes = runner().timings();
  ASSERT_EQ(scopes.size(), 2u);
  EXPECT_EQ(scopes[0].name, "first");
  EXPECT_EQ(scopes[1].name, "second");
  EXPECT_GE(scopes[0].milliseconds, 0);
}

TEST(Devices, ChoosesByNumberByNameAndBySpeed) {
  std::vector<DeviceInfo> devices(3);
  devices[0] = {"llvmpipe", "", "cpu", 0, 0, "", nullptr};
  devices[1] = {"Some Discrete", "", "discrete", 0, 0, "", nullptr};
  devices[2] = {"Old Discrete", "", "discrete", 0, 0, "lacks synchronization2", nullptr};
  EXPECT_EQ(choose_device(devices, "").name, "Some Discrete");
  EXPECT_EQ(choose_device(devices, "0").name, "llvmpipe");
  EXPECT_EQ(choose_device(devices, "LLVM").name, "llvmpipe");
  EXPECT_THROW((void)choose_device(devices, "3"), Error);
  EXPECT_THROW((void)choose_device(devices, "old"), Error);
  EXPECT_THROW((void)choose_device({}, ""), Error);
}

/// A device created by a host application and borrowed by Brume.
TEST_F(GpuTest, WorksOnADeviceOfTheHost) {
  HostDevice host;
  host.get_instance_proc_addr = system_loader();
  const Instance instance(true);
  host.instance = instance.handle();
  const auto devices = list_devices(instance.vk(), host.instance);
  host.physical_device = choose_device(devices, "").handle;
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  const DeviceFeatures features;
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = features.chain();
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  ASSERT_EQ(instance.vk().CreateDevice(host.physical_device, &info, nullptr, &host.device), VK_SUCCESS);
  Functions vk = instance.vk();
  vk.load_device(host.device);
  VkQueue host_queue = VK_NULL_HANDLE;
  vk.GetDeviceQueue(host.device, 0, 0, &host_queue);
  {
    Context borrowed(host);
    EXPECT_FALSE(borrowed.owns_device());
    FrameSlot slot(borrowed);
    const VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, 0};
    VkCommandPool pool = VK_NULL_HANDLE;
    ASSERT_EQ(vk.CreateCommandPool(host.device, &pool_info, nullptr, &pool), VK_SUCCESS);
    const VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool,
                                               VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    VkCommandBuffer commands = VK_NULL_HANDLE;
    ASSERT_EQ(vk.AllocateCommandBuffers(host.device, &allocate, &commands), VK_SUCCESS);
    const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, 0, nullptr};
    ASSERT_EQ(vk.BeginCommandBuffer(commands, &begin), VK_SUCCESS);

    const Buffer from(borrowed, 64, VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const Buffer to(borrowed, 64, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::readback);
    Recorder recorder(borrowed, slot, commands);
    recorder.fill(from, 0x01020304u);
    recorder.read_back(from, to, 64);

    ASSERT_EQ(vk.EndCommandBuffer(commands), VK_SUCCESS);
    const VkCommandBufferSubmitInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, nullptr, commands,
                                           0};
    VkSubmitInfo2 submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &buffer;
    ASSERT_EQ(vk.QueueSubmit2(host_queue, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
    ASSERT_EQ(vk.DeviceWaitIdle(host.device), VK_SUCCESS);
    EXPECT_EQ(static_cast<std::uint8_t>(to.mapped()[63]), 1);
    vk.DestroyCommandPool(host.device, pool, nullptr);
  }
  vk.DestroyDevice(host.device, nullptr);
  for (const std::string& message : instance.take_messages()) ADD_FAILURE() << message;
}

}  // namespace
}  // namespace brume::gpu
