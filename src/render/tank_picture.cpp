#include "render/tank_picture.hpp"

#include "passes/blue_noise.hpp"

namespace brume::render {
namespace {

bool same_display(const planning::TankDisplay& a, const planning::TankDisplay& b) {
  return a.frame.exposure == b.frame.exposure && a.frame.tone == b.frame.tone && a.dither == b.dither;
}

}  // namespace

TankPicture::TankPicture(gpu::Context& context, gpu::CommandStream& stream, const spheres::Tank& tank,
                         bool with_ids)
    : context_(context),
      sampler_(context, stream, tank, spheres::list_bricks(tank), with_ids),
      display_pass_(context),
      frame_(context, sizeof(shared::FrameConstants),
             VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  stream.run([&](gpu::Recorder& recorder) { blue_noise_ = passes::make_blue_noise(context, recorder); });
}

void TankPicture::reserve(glm::uvec2 size_px) {
  if (size_px == this->size_px()) return;
  sampler_.resize(size_px);
  shown_ = gpu::Image(context_, gpu::storage_image(size_px, VK_FORMAT_R8G8B8A8_UNORM));
}

bool TankPicture::show(const planning::TankPlan& plan, const planning::TankDisplay& display) {
  if (!same_display(display, display_)) is_displayed_.change(context_) = false;
  display_ = display;
  const bool has_begun = samples() > 0 || rows() > 0;
  if (has_begun && planning::same_samples(plan, sampler_.plan())) return false;
  reserve(plan.constants.size_px);
  sampler_.set_view(plan);
  sampler_.reserve(false);
  return true;
}

bool TankPicture::record(gpu::Recorder& recorder, const TankSlice& slice) {
  const std::uint32_t before = samples();
  if (slice.samples > 0) sampler_.record_samples(recorder, blue_noise_, slice.samples);
  if (slice.rows > 0) sampler_.record_rows(recorder, blue_noise_, slice.rows);
  if (samples() == 0 || (samples() == before && is_displayed_.get(context_))) return false;

  recorder.change(is_displayed_) = true;
  recorder.upload(frame_, 0, std::as_bytes(std::span(&display_.frame, 1)));
  const gpu::Scope scope(recorder, "display");
  display_pass_.record(recorder, frame_, blue_noise_, sampler_.radiance(), shown_, display_.dither);
  return true;
}

}  // namespace brume::render
