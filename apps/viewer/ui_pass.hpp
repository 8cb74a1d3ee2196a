// Draws what Dear ImGui has laid out over a picture.
#pragma once

#include <vector>

#include "gpu/recorder.hpp"

struct ImDrawData;

namespace brume::viewer {

class UiPass {
 public:
  /// Uploads the font of the current ImGui context. `target` is the format of the picture.
  UiPass(gpu::Context& context, gpu::CommandRunner& runner, VkFormat target);

  /// Makes room. When the device is done with the frame before.
  void reserve(const ImDrawData& data);
  /// Draws over `picture`, which is as large as the display that the data is for.
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
