// Copies of buffers and images for the CPU.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "gpu/recorder.hpp"

namespace brume::gpu {

/// Memory that the device copies to and the CPU reads. Throws resource_limit.
Buffer readback_buffer(Context& context, VkDeviceSize bytes);
/// Texels of the first level of an image.
std::size_t texel_count(const Image& image);

/// The values in a readback buffer, once the device is done.
template <typename T>
std::span<const T> values_of(const Buffer& buffer) {
  return {reinterpret_cast<const T*>(buffer.mapped()), buffer.size() / sizeof(T)};
}

/// A copy of the first bytes of a buffer.
Buffer read_back(Context& context, CommandRunner& runner, const Buffer& buffer, VkDeviceSize bytes);
/// A copy of the texels of an image. `record` comes first in the same submission.
Buffer read_back(Context& context, CommandRunner& runner, const Image& image, std::size_t texel_bytes,
                 const std::function<void(Recorder&)>& record = {});

/// The first values of a buffer.
template <typename T>
std::vector<T> read_values(Context& context, CommandRunner& runner, const Buffer& buffer, std::size_t count) {
  const Buffer copy = read_back(context, runner, buffer, count * sizeof(T));
  const std::span<const T> values = values_of<T>(copy);
  return {values.begin(), values.end()};
}
/// The texels of an image, each as a T.
template <typename T>
std::vector<T> read_texels(Context& context, CommandRunner& runner, const Image& image) {
  const Buffer copy = read_back(context, runner, image, sizeof(T));
  const std::span<const T> texels = values_of<T>(copy);
  return {texels.begin(), texels.end()};
}

}  // namespace brume::gpu
