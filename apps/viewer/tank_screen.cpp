#include "apps/viewer/tank_screen.hpp"

#include <cstring>

namespace brume::viewer {
namespace {

gpu::Image make_shown(gpu::Context& context, const glm::uvec3& size) {
  gpu::ImageInfo info;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.size = size;
  info.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  return gpu::Image(context, info);
}

}  // namespace

TankScreen::TankScreen(const Window& window, const ScreenOptions& options)
    : context_({options.device, options.validation, window.presentation()}) {
  runner_.emplace(context_);
  canvas_.emplace(context_, *runner_, window, options.vertical_sync);
}

TankScreen::~TankScreen() {
  // Returns an error at once on a lost device, which is fine: its resources may be destroyed.
  context_.vk().DeviceWaitIdle(context_.device());
}

void TankScreen::load(const spheres::Tank& tank, glm::uvec2 size_px) {
  renderer_.reset();  // first: there may be no room for two
  renderer_.emplace(context_, *runner_, tank, glm::max(size_px, glm::uvec2(1)));
  kind_ = scene::TankView::spheres;
  lighting_ = scene::TankLighting::maps;
}

void TankScreen::set_view(const planning::TankPlan& plan, const planning::TankDisplay& display,
                          scene::TankView kind, scene::TankLighting lighting) {
  if (lighting != lighting_) renderer_->set_lighting(lighting);
  lighting_ = lighting;
  if (kind != kind_) {
    kind_.reset();  // if it throws
    renderer_->set_kind(kind);
    kind_ = kind;
  }
  if (plan.constants.size_px != picture_px()) renderer_->resize(plan.constants.size_px);
  renderer_->set_view(plan, display);
  display_changed_ = false;
}

void TankScreen::set_display(const planning::TankDisplay& display) {
  renderer_->set_display(display);
  display_changed_ = true;
}

void TankScreen::record(gpu::Recorder& recorder, const TankSlice& slice) {
  const std::uint32_t before = samples();
  if (slice.samples > 0) renderer_->record_samples(recorder, slice.samples);
  if (slice.rows > 0) renderer_->record_rows(recorder, slice.rows);
  if (samples() == 0 || (samples() == before && !display_changed_)) return;
  if (samples() == before) renderer_->record_display(recorder);
  display_changed_ = false;
  recorder.blit(renderer_->display(), shown_, VK_FILTER_NEAREST);
}

void TankScreen::show(const TankSlice& slice, const ImDrawData& ui) {
  // A picture of another size replaces the one that shows only when it is complete.
  const bool completes =
      renderer_ && (slice.samples > 0 || (slice.rows > 0 && rows() + slice.rows == picture_px().y));
  if (completes && (!shown_ || shown_.info().size != glm::uvec3(picture_px(), 1)))
    shown_ = make_shown(context_, glm::uvec3(picture_px(), 1));
  canvas_->submit(
      [&](gpu::Recorder& recorder) {
        if (renderer_) record(recorder, slice);
      },
      shown_ ? &shown_ : nullptr, ui);
  canvas_->present();
}

void TankScreen::add(const TankSlice& slice) {
  runner_->run([&](gpu::Recorder& recorder) {
    if (slice.samples > 0) renderer_->record_samples(recorder, slice.samples);
    if (slice.rows > 0) renderer_->record_rows(recorder, slice.rows);
  });
}

image::Image8 TankScreen::picture() {
  const glm::uvec2 size = picture_px();
  const gpu::Buffer pixels(context_, std::size_t{4} * size.x * size.y, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           gpu::MemoryUse::readback);
  runner_->run([&](gpu::Recorder& recorder) {
    renderer_->record_display(recorder);
    recorder.read_back(renderer_->display(), pixels);
  });
  image::Image8 picture{size.x, size.y, std::vector<std::uint8_t>(pixels.size())};
  std::memcpy(picture.rgba.data(), pixels.mapped(), picture.rgba.size());
  return picture;
}

glm::uvec2 TankScreen::picture_px() const {
  return renderer_ ? glm::uvec2(renderer_->display().info().size) : glm::uvec2(0);
}

double TankScreen::slice_seconds() const {
  for (const auto& scope : timings())
    if (scope.name == "tank") return 1e-3 * scope.milliseconds;
  return 0;
}

}  // namespace brume::viewer
