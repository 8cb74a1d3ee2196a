// Draws Dear ImGui's draw data over an image.
#pragma once

#include <vector>

#include "gpu/recorder.hpp"

struct ImDrawData;

namespace brume::viewer {

class UiPass {
 public:
  /// Uploads the font of the current ImGui context. `target` is the format of the image to draw on.
  UiPass(gpu::Context& context, gpu::CommandRunner& runner, VkFormat target);

  /// Grows the buffers to hold `data`. Call it when the device has finished the previous frame.
  void reserve(const ImDrawData& data);
  /// Draws over `picture`, which must have the display size of `data`.
  void record(gpu::Recorder& recorder, const ImDrawData& data, const gpu::Image& picture) const;

 private:
  void record_upload(gpu::Recorder& recorder, const ImDrawData& data) const;

  gpu::Context& context_;
  gpu::GraphicsPipeline pipeline_;
  gpu::Sampler linear_;
  gpu::Image font_;
  gpu::Buffer vertices_, indices_;
};

}  // namespace brume::viewer
