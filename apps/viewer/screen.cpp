#include "apps/viewer/screen.hpp"

#include <chrono>
#include <cstring>

#include "render/exposure.hpp"
#include "render/volume_room.hpp"

namespace brume::viewer {
namespace {

render::RendererOptions renderer_options(const scenario::Scenario& scenario, glm::uvec2 size_px) {
  render::RendererOptions options{size_px};
  options.antialias = true;
  options.smoke.temporal = true;
  options.smoke.prepare_all = true;
  options.smoke.masks = &scenario.masks;
  return options;
}

glm::uvec2 scaled(glm::uvec2 size_px, float scale) {
  return glm::max(glm::uvec2(glm::round(glm::vec2(size_px) * scale)), glm::uvec2(1));
}

}  // namespace

Screen::Screen(const Window& window, const ScreenOptions& options)
    : context_({options.device, options.validation, window.presentation()}) {
  runner_.emplace(context_);
  canvas_.emplace(context_, *runner_, window, options.vertical_sync);
}

void Screen::load(const scenario::Scenario& scenario, glm::uvec2 size_px, std::uint64_t volume_bytes) {
  if (scenario.volumes) {
    volumes::VolumeRoom room = render::volume_room(context_, volume_bytes);
    const std::uint64_t previews = 2 * volumes::kPreviewBricks * scenario.timeline.volumes.size();
    room.bricks -= std::min(room.bricks / 4, previews);
    scenario.volumes->limit(room).value_or_throw();
    scenario.volumes->make_previews();
  }
  const glm::uvec2 size = glm::max(size_px, glm::uvec2(1));
  renderer_.emplace(context_, *runner_, scenario.scene, renderer_options(scenario, size));
}

Screen::~Screen() {
  // Returns an error at once on a lost device, which is fine: its resources may be destroyed.
  context_.vk().DeviceWaitIdle(context_.device());
}

void Screen::wait() {
  context_.wait();
}

void Screen::set_resolution(glm::uvec2 picture_px, std::uint32_t march_scale) {
  if (picture_px != renderer_->targets().size_px) {
    renderer_->resize(picture_px);
    history_lost_ = true;
  }
  if (march_scale != march_scale_) renderer_->set_march_scale(march_scale);
  march_scale_ = march_scale;
}

bool Screen::show(const render::FrameInput* input, const Quality& quality, const ImDrawData& ui) {
  const auto size_px = canvas_->begin();
  if (!size_px) return false;
  const auto begin = std::chrono::steady_clock::now();
  std::optional<render::FramePlan> plan;
  if (input) {
    set_resolution(scaled(*size_px, quality.picture_scale), quality.march_scale);
    render::FrameInput frame = *input;
    frame.view.continues = input->view.continues && !history_lost_;
    history_lost_ = false;
    plan.emplace(renderer_->plan(frame));
  }
  const auto record = [&](gpu::Recorder& recorder) {
    if (plan) renderer_->record_frame(recorder, *plan);
  };
  canvas_->submit(record, renderer_ ? &renderer_->targets().display : nullptr, ui);
  record_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  canvas_->present();
  return true;
}

/// Prepares for the image that `brume render` renders of `input`.
void Screen::begin_still(render::FrameInput& input, glm::uvec2 size_px) {
  set_resolution(size_px, 1);
  history_lost_ = true;
  input.view.continues = false;
  input.quality = {};
}

bool Screen::refine(render::FrameInput input, const std::function<bool()>& stops) {
  begin_still(input, canvas_->size_px());
  const render::FramePlan plan = renderer_->plan(input);
  for (int part = 0; part < render::Renderer::kParts; ++part) {
    if (part > 0 && stops()) return false;
    runner_->run([&](gpu::Recorder& recorder) { renderer_->record_part(recorder, plan, part); });
  }
  return true;
}

float Screen::measure_exposure(const render::FrameInput& input) {
  return render::measure_exposure(context_, *renderer_, input);
}

image::Image8 Screen::picture(const StillFrame& frame, glm::uvec2 size_px) {
  const gpu::Buffer pixels(context_, std::size_t{4} * size_px.x * size_px.y, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           gpu::MemoryUse::readback);
  for (std::uint32_t i = 0; i < frame.samples(); ++i) {
    render::FrameInput input = frame.sample(i);
    begin_still(input, size_px);
    renderer_->draw(input, [&](gpu::Recorder& recorder) {
      if (i + 1 == frame.samples()) recorder.read_back(renderer_->targets().display, pixels);
    });
  }
  image::Image8 picture;
  picture.width = size_px.x;
  picture.height = size_px.y;
  picture.rgba.resize(pixels.size());
  std::memcpy(picture.rgba.data(), pixels.mapped(), picture.rgba.size());
  return picture;
}

}  // namespace brume::viewer
