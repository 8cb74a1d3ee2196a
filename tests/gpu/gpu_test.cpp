#include "tests/gpu/gpu_test.hpp"

#include <cstdlib>

#include "core/error.hpp"
#include "tests/gpu/host_application.hpp"

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
  devices[0] = {"llvmpipe", "", DeviceKind::cpu, 0, 0, "", nullptr};
  devices[1] = {"Some Discrete", "", DeviceKind::discrete, 0, 0, "", nullptr};
  devices[2] = {"Old Discrete", "", DeviceKind::discrete, 0, 0, "lacks synchronization2", nullptr};
  EXPECT_EQ(choose_device(devices, "").name, "Some Discrete");
  EXPECT_EQ(choose_device(devices, "0").name, "llvmpipe");
  EXPECT_EQ(choose_device(devices, "LLVM").name, "llvmpipe");
  EXPECT_THROW((void)choose_device(devices, "3"), Error);
  EXPECT_THROW((void)choose_device(devices, "old"), Error);
  EXPECT_THROW((void)choose_device({}, ""), Error);
}

/// A device created by a host application and borrowed by Brume.
TEST(HostedContext, RecordsIntoCommandsOfTheHost) {
  HostApplication host(1);
  {
    Context borrowed(host.device());
    EXPECT_FALSE(borrowed.owns_device());
    HostRecording recording(borrowed);
    const Buffer from(borrowed, 64, VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const Buffer to = readback_buffer(borrowed, 64);
    host.frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
      recording.begin(commands, frame, completed);
      recording.recorder().fill(from, 0x01020304u);
      recording.recorder().read_back(from, to, 64);
      recording.end();
    });
    host.wait();
    EXPECT_EQ(static_cast<std::uint8_t>(to.mapped()[63]), 1);
  }
  for (const std::string& message : host.take_messages()) ADD_FAILURE() << message;
}

// A frame that fails after its preparations: those come with the next one, even where what they wrote to is
// gone by then, and all that the frame's own commands would have changed is as before.
TEST(HostedContext, ADiscardedFrameLeavesOnlyItsPreparations) {
  HostApplication host(2);
  {
    Context borrowed(host.device());
    HostRecording recording(borrowed);
    constexpr VkBufferUsageFlags kBoth = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const Buffer own(borrowed, 64, kBoth), prepared(borrowed, 64, kBoth);
    const Buffer to(borrowed, 128, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::readback);
    Recorded<int> value(1);
    const auto frame = [&](const std::function<void()>& record, bool fails) {
      host.frame([&](VkCommandBuffer commands, std::uint64_t number, std::uint64_t completed) {
        recording.begin(commands, number, completed);
        record();
        if (fails)
          recording.discard();
        else
          recording.end();
      });
    };
    frame([&] { recording.recorder().fill(own, 0x05050505u); }, false);
    for (int again = 0; again < 2; ++again)
      frame(
          [&] {
            const Buffer gone(borrowed, 64, kBoth);
            recording.run([&](Recorder& recorder) {
              recorder.fill(gone, 7);
              recorder.fill(prepared, 0x06060606u);
            });
            EXPECT_ANY_THROW(recording.run([&](Recorder& recorder) {
              recorder.fill(prepared, 9);
              throw Error(ErrorCode::resource_limit, "refused");
            }));
            recording.recorder().fill(own, 8);
            recording.recorder().change(value) = 2;
            EXPECT_EQ(value.get(borrowed), 2);
          },
          true);
    EXPECT_EQ(value.get(borrowed), 1);
    frame(
        [&] {
          recording.recorder().read_back(own, to, 64);
          recording.recorder().change(value) = 3;
        },
        false);
    host.wait();
    EXPECT_EQ(static_cast<std::uint8_t>(to.mapped()[63]), 5);
    frame([&] { recording.recorder().read_back(prepared, to, 64); }, false);
    host.wait();
    EXPECT_EQ(static_cast<std::uint8_t>(to.mapped()[63]), 6);
    EXPECT_EQ(value.get(borrowed), 3);
  }
  for (const std::string& message : host.take_messages()) ADD_FAILURE() << message;
}

// What commands in flight use is destroyed when the device has completed them, and not before.
TEST(HostedContext, DestroysNothingThatIsInFlight) {
  HostApplication host(3);
  {
    Context borrowed(host.device());
    HostRecording recording(borrowed);
    const Buffer to = readback_buffer(borrowed, 1 << 20);
    const VkDeviceSize before = borrowed.memory().bytes_in_use();
    for (std::uint32_t i = 0; i < 8; ++i) {
      host.frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
        recording.begin(commands, frame, completed);
        const Buffer of_frame(borrowed, 1 << 20,
                              VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        recording.recorder().fill(of_frame, i);
        recording.recorder().read_back(of_frame, to, 1 << 20);
        recording.end();
      });
      EXPECT_GT(borrowed.memory().bytes_in_use(), before);
      EXPECT_LE(borrowed.memory().bytes_in_use(), before + (4u << 20));
    }
    host.wait();
    host.frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
      recording.begin(commands, frame, completed);
      recording.end();
    });
    EXPECT_EQ(borrowed.memory().bytes_in_use(), before);
    host.wait();
  }
  for (const std::string& message : host.take_messages()) ADD_FAILURE() << message;
}

}  // namespace
}  // namespace brume::gpu
