#include "apps/viewer/window_canvas.hpp"

#include <imgui.h>

namespace brume::viewer {
namespace {

gpu::Image make_canvas(gpu::Context& context, glm::uvec2 size_px) {
  gpu::ImageInfo info;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;  // as Renderer::display: already sRGB-encoded
  info.size = {size_px, 1};
  info.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
               VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
  return gpu::Image(context, info);
}

}  // namespace

WindowCanvas::WindowCanvas(gpu::Context& context, gpu::CommandRunner& runner, const Window& window,
                           bool vertical_sync)
    : context_(context),
      runner_(runner),
      swapchain_(context, window.surface(), vertical_sync),
      ui_(context, runner, VK_FORMAT_R8G8B8A8_UNORM),
      upscale_(context),
      canvas_(make_canvas(context, glm::max(window.size_px(), glm::uvec2(1)))) {}

std::optional<glm::uvec2> WindowCanvas::begin() {
  const auto image = swapchain_.acquire();
  if (!image) return std::nullopt;
  image_ = *image;
  if (image_.size_px != size_px()) canvas_ = make_canvas(context_, image_.size_px);
  return image_.size_px;
}

void WindowCanvas::submit(const std::function<void(gpu::Recorder&)>& record, const gpu::Image* picture,
                          const ImDrawData& ui) {
  ui_.reserve(ui);
  const auto record_all = [&](gpu::Recorder& recorder) {
    record(recorder);
    const gpu::Scope scope(recorder, "window");
    if (!picture) {
      recorder.clear(canvas_, VkClearColorValue{});
    } else if (picture->info().size == canvas_.info().size) {
      recorder.blit(*picture, canvas_, VK_FILTER_NEAREST);
    } else {
      upscale_.record(recorder, *picture, canvas_);
    }
    ui_.record(recorder, ui, canvas_);
    recorder.blit(canvas_, image_);
  };
  runner_.start(record_all, swapchain_.semaphores());
}

}  // namespace brume::viewer
