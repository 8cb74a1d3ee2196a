#include "gpu/read_back.hpp"

namespace brume::gpu {

Buffer readback_buffer(Context& context, VkDeviceSize bytes) {
  return {context, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::readback};
}

std::size_t texel_count(const Image& image) {
  const glm::uvec3 size = image.info().size;
  return std::size_t{size.x} * size.y * size.z;
}

Buffer read_back(Context& context, CommandRunner& runner, const Buffer& buffer, VkDeviceSize bytes) {
  Buffer copy = readback_buffer(context, bytes);
  runner.run([&](Recorder& recorder) { recorder.read_back(buffer, copy, bytes); });
  return copy;
}

Buffer read_back(Context& context, CommandRunner& runner, const Image& image, std::size_t texel_bytes,
                 const std::function<void(Recorder&)>& record) {
  Buffer copy = readback_buffer(context, texel_count(image) * texel_bytes);
  runner.run([&](Recorder& recorder) {
    if (record) record(recorder);
    recorder.read_back(image, copy);
  });
  return copy;
}

}  // namespace brume::gpu
