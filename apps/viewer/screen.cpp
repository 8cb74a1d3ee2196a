#include "apps/viewer/screen.hpp"

#include <imgui.h>

#include <chrono>
#include <cstring>

namespace brume::viewer {
namespace {

gpu::Image make_canvas(gpu::Context& context, glm::uvec2 size_px) {
  gpu::ImageInfo info;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;  // as the pictures: already sRGB-encoded
  info.size = {size_px, 1};
  info.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
               VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
  return gpu::Image(context, info);
}

}  // namespace

Screen::Screen(const Window& window, const ScreenOptions& options)
    : context_({options.device, options.validation, window.presentation()}),
      runner_(context_),
      swapchain_(context_, window.surface(), options.vertical_sync),
      ui_(context_, runner_, VK_FORMAT_R8G8B8A8_UNORM),
      upscale_(context_),
      canvas_(make_canvas(context_, glm::max(window.size_px(), glm::uvec2(1)))) {}

std::optional<glm::uvec2> Screen::begin() {
  const auto image = swapchain_.acquire();
  if (!image) return std::nullopt;
  image_ = *image;
  if (image_.size_px != size_px()) canvas_ = make_canvas(context_, image_.size_px);
  return image_.size_px;
}

void Screen::show(const std::function<void(gpu::Recorder&)>& record, const gpu::Image* picture,
                  const ImDrawData& ui) {
  const auto begin = std::chrono::steady_clock::now();
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
  record_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  swapchain_.present();
}

image::Image8 Screen::read(const gpu::Image& image) {
  const glm::uvec2 size(image.info().size);
  const gpu::Buffer pixels(context_, std::size_t{4} * size.x * size.y, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           gpu::MemoryUse::readback);
  runner_.run([&](gpu::Recorder& recorder) { recorder.read_back(image, pixels); });
  image::Image8 picture{size.x, size.y, std::vector<std::uint8_t>(pixels.size())};
  std::memcpy(picture.rgba.data(), pixels.mapped(), picture.rgba.size());
  return picture;
}

}  // namespace brume::viewer
