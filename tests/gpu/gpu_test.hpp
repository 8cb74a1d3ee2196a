// GPU tests run on the system's default device with validation and synchronization layers: any message fails.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "gpu/read_back.hpp"

namespace brume::gpu {

class GpuTest : public testing::Test {
 protected:
  static Context& context() {
    // One device for all tests, with its pipelines: creating one takes longer than most of them.
    static Context device(ContextOptions{"", true});
    return device;
  }
  static CommandRunner& runner() {
    static CommandRunner instance(context());
    return instance;
  }
  void TearDown() override {
    for (const std::string& message : context().take_validation_messages()) ADD_FAILURE() << message;
  }

  /// How far beyond half a step devices may round 8-bit numbers: Direct3D 11 allows 0.6 steps in all.
  static constexpr double kStoreError = 0.1;
  /// The grid to which the device snaps vertices [px].
  static double snapping_px() {
    return std::exp2(-static_cast<double>(context().limits().subPixelPrecisionBits));
  }
  template <typename T>
  static Buffer upload(const std::vector<T>& values,
                       VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                                  VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT) {
    Buffer buffer(context(), std::max<std::size_t>(values.size(), 1) * sizeof(T),
                  usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    runner().run([&](Recorder& recorder) { recorder.upload(buffer, 0, std::as_bytes(std::span(values))); });
    return buffer;
  }
  template <typename T>
  static std::vector<T> read_back(const Buffer& buffer, std::size_t count) {
    return read_values<T>(context(), runner(), buffer, count);
  }
  /// The texels of an image with texels of type T.
  template <typename T>
  static std::vector<T> read_back(const Image& image) {
    return read_texels<T>(context(), runner(), image);
  }
};

}  // namespace brume::gpu
